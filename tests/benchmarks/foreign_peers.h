#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "hls/kernel/scalar.h"
#include "tests/benchmarks/groups.h"

namespace emax::benchmarks {

// The case as files that the script of the foreign peers reads: points, vertices (binary32) and
// triangles (int32), little endian, three to a row.
void write_case(const std::filesystem::path& folder, std::span<const Vector3<float>> points,
                std::span<const Vector3<float>> vertices, std::span<const Triangle> triangles);

// Peers that are Python packages: `command` (a script and its interpreter) measures all cases under
// `folder` once, in a process of its own. An empty command stands for packages that are not there.
// Their times go to the groups; where there are none the groups say why. Throws Error when a peer's
// e_max is another than the engine's. Returns the packages' versions.
std::string measure_foreign_peers(const std::string& command, const std::filesystem::path& folder,
                                  std::span<const SearchGroup> searches);

}  // namespace emax::benchmarks
