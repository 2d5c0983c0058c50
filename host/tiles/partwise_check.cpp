#include "host/tiles/partwise_check.h"

#include <algorithm>
#include <utility>

#include "host/tiles/cell_intersections.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// What a triangle takes in a part, which may have corners of its own; measured.
constexpr std::uint64_t kBytesInCheckedPart = 250;
constexpr std::uint64_t kMostSampled = std::uint64_t{1} << 16;

std::size_t checked_part(std::uint64_t memory) {
  return static_cast<std::size_t>(std::max<std::uint64_t>(memory / 4 / kBytesInCheckedPart, 1));
}

}  // namespace

MeshConnectivity connectivity_in_parts(const MeshParts& mesh, std::uint64_t memory,
                                       const std::function<bool()>& interrupted) {
  return connectivity_in_parts(mesh, checked_part(memory), memory / 4 * 3, [&](const MeshPart&) {
    if (interrupted && interrupted()) throw Interrupted{};
  });
}

PartwiseCheck check_in_parts(const MeshParts& mesh, std::uint64_t memory, std::size_t threads,
                             const std::function<bool()>& interrupted) {
  const std::size_t part = checked_part(memory);
  const std::function<void()> poll = [&] {
    if (interrupted && interrupted()) throw Interrupted{};
  };
  const std::uint64_t most = std::min<std::uint64_t>(kMostSampled, memory / 400 + 1);
  const std::uint64_t stride = *mesh.promised() / most + 1;
  BoxSample sample;
  sample.weight = static_cast<double>(stride);
  const MeshConnectivity connected =
      connectivity_in_parts(mesh, part, memory / 4 * 3, [&](const MeshPart& p) {
        poll();
        const std::uint64_t before = p.first % stride;  // since the last of the sample
        const auto first = static_cast<std::size_t>(before == 0 ? 0 : stride - before);
        for (std::size_t t = first; t < p.mesh.triangles.size(); t += stride) {
          sample.boxes.push_back(bounds_of(p.mesh.view().corners(t)));
        }
      });
  const IntersectionCounts met =
      intersections_in_parts(mesh, part, memory / 4 * 3, threads, std::move(sample), poll);
  if (met.read != connected.triangles) {
    mesh.input().fail("was changed while it was read", "leave it as it is meanwhile");
  }
  PartwiseCheck found = {connected.validity, connected.topology, connected.triangles,
                         connected.vertices};
  found.validity.degenerate_triangles = met.flat;
  found.validity.self_intersections = met.pairs;
  found.validity.self_intersecting_triangles = met.triangles;
  return found;
}

}  // namespace emax
