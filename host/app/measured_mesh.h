#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "host/files/mesh_file.h"
#include "host/files/mesh_parts.h"
#include "host/geometry/triangle_mesh.h"
#include "host/tiles/partwise_check.h"

namespace emax {

// A mesh that points are measured against: in memory, or in a file that is read in parts, where
// what is prepared of the whole takes more than half of the memory that is permitted.
class MeasuredMesh {
 public:
  explicit MeasuredMesh(TriangleMesh mesh) : file_{std::move(mesh), {}, {}} {}
  // `memory`: bytes. Throws Error as read_mesh_file() does, and where the memory is too small for
  // parts.
  MeasuredMesh(const std::filesystem::path& path, std::uint64_t memory);
  // In parts of this size. Throws Error for a file that has to be held whole.
  MeasuredMesh(const std::filesystem::path& path, std::uint64_t memory, std::size_t part_triangles);

  const std::filesystem::path& path() const { return path_; }
  bool is_whole() const { return !parts_; }
  const MeshFile& file() const { return file_; }                  // if it is whole
  const TriangleMesh& whole() const { return file_.mesh; }        // likewise
  void drop_unused_vertices();                                    // likewise
  const MeshParts& parts() const { return *parts_; }              // if it is not
  std::size_t part_triangles() const { return part_triangles_; }  // likewise

  // What is left for the points of a cloud that is read in pieces.
  std::uint64_t memory_for_points() const { return is_whole() ? memory_ : memory_ / 4; }
  // Of a mesh in parts, while it is not measured: what other work with it may take, and its faults,
  // its topology and its size.
  std::uint64_t memory_for_parts() const;
  PartwiseCheck check(std::size_t threads, const std::function<bool()>& interrupted) const;
  // Throws Error if the mesh is in parts, where `what` needs it whole.
  void require_whole(std::string_view what) const;
  // Where it is held whole although it should be read in parts: why; else empty.
  const std::string& remark() const { return remark_; }

 private:
  std::filesystem::path path_;
  std::uint64_t memory_ = 0;
  MeshFile file_;
  std::optional<MeshParts> parts_;
  std::size_t part_triangles_ = 0;
  std::string remark_;
};

}  // namespace emax
