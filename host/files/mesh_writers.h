#pragma once

#include <cstdint>
#include <string>

#include "host/files/mesh_file.h"
#include "host/files/point_groups.h"

namespace emax {

// The bytes of a file, by a function for each format. Indices are within the vertices.
std::string ply_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string obj_bytes(const TriangleMesh& mesh);
std::string stl_bytes(const TriangleMesh& mesh);
std::string off_bytes(const TriangleMesh& mesh);
std::string glb_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string threemf_bytes(const TriangleMesh& mesh, const MeshNotes& notes);
std::string dxf_bytes(const TriangleMesh& mesh, const MeshNotes& notes);

std::string glb_of_groups(const PointGroups& groups);
std::string dxf_of_groups(const PointGroups& groups);

}  // namespace emax
