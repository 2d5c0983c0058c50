#include "host/app/measured_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/app/scan.h"
#include "host/geometry/merge_vertices.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// What a triangle takes while it is read and prepared for the kernel and the certificate; measured.
// In a part it may have corners of its own.
constexpr std::uint64_t kBytesPerMeasured = 256, kBytesInPart = 400;

// Smaller meshes are always held whole, and a part has no fewer triangles.
constexpr std::uint64_t kFewTriangles = std::uint64_t{1} << 14;
// Of the memory; the rest is for the points of the pieces under way and what is known of all.
constexpr std::uint64_t kPartFifths = 2;
constexpr std::uint64_t kLeastMemory = 100'000'000;

// What gives so many bytes.
std::string option_for(std::uint64_t bytes) {
  constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;
  return fmt::format("--memory {}MB", (bytes + kMegabyte - 1) / kMegabyte);
}

bool fits(std::uint64_t triangles, std::uint64_t memory) {
  return triangles <= std::max(kFewTriangles, memory / 2 / kBytesPerMeasured);
}

}  // namespace

MeasuredMesh::MeasuredMesh(const std::filesystem::path& path, std::uint64_t memory,
                           std::size_t part_triangles)
    : path_(path), memory_(memory), parts_(std::in_place, path), part_triangles_(part_triangles) {
  if (!parts_->promised()) throw Error(path.string() + ": has to be held whole");
}

MeasuredMesh::MeasuredMesh(const std::filesystem::path& path, std::uint64_t memory)
    : path_(path), memory_(memory), parts_(std::in_place, path) {
  const std::optional<std::uint64_t> promised = parts_->promised();
  if (promised && !fits(*promised, memory)) {
    if (memory < kLeastMemory) {
      throw Error(fmt::format(
          "{}: {} triangles are measured in parts, which takes {} MB, more than the {} MB of "
          "--memory; give more memory",
          path.string(), grouped(*promised), kLeastMemory / 1'000'000, memory / 1'000'000));
    }
    part_triangles_ =
        static_cast<std::size_t>(std::max(kFewTriangles, memory / kBytesInPart * kPartFifths / 5));
    return;
  }
  parts_.reset();
  file_ = read_mesh_file(path);
  const std::uint64_t triangles = file_.mesh.triangles.size();
  if (fits(triangles, memory)) return;
  remark_ = fmt::format(
      "{} is held whole, about {:.2g} GB: only binary PLY and binary STL are read in parts",
      path.string(), static_cast<double>(triangles * kBytesPerMeasured) / 1e9);
}

void MeasuredMesh::drop_unused_vertices() {
  emax::drop_unused_vertices(file_.mesh.vertices, file_.mesh.triangles);
}

std::uint64_t MeasuredMesh::memory_for_parts() const { return memory_ / 5 * kPartFifths; }

PartwiseCheck MeasuredMesh::check(std::size_t threads,
                                  const std::function<bool()>& interrupted) const {
  return check_in_parts(*parts_, memory_for_parts(), threads, interrupted);
}

void MeasuredMesh::require_whole(std::string_view what) const {
  if (is_whole()) return;
  throw Error(fmt::format(
      "{}: {} triangles are measured in parts, and {} needs all of them at once; give {}, or leave "
      "it out",
      path_.string(), grouped(*parts_->promised()), what,
      option_for(2 * kBytesPerMeasured * *parts_->promised())));
}

}  // namespace emax
