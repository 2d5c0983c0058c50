#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/files/mesh_file.h"
#include "host/files/point_groups.h"

namespace emax {

// The bytes of a file, by a function for each format. Indices are within the vertices.
std::string ply_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string obj_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string stl_bytes(const TriangleMesh& mesh);
std::string off_bytes(const TriangleMesh& mesh);
std::string glb_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string threemf_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string dxf_bytes(const TriangleMesh& mesh, const MeshNotes& notes);

// The triangles that follow each other and are of one group.
struct GroupRun {
  std::uint32_t group;  // kNone: none
  std::size_t begin, end;
};
std::vector<GroupRun> group_runs(const TriangleGroups& groups);
inline std::string_view name_of(const TriangleGroups& groups, std::uint32_t group) {
  return group == TriangleGroups::kNone ? std::string_view("none") : groups.groups[group].name;
}

std::string glb_of_groups(const PointGroups& groups);
std::string dxf_of_groups(const PointGroups& groups);

}  // namespace emax
