#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/files/tolerance.h"

namespace emax {

// One tolerance of `decimate` and the mesh that is written for it.
struct ToleratedMesh {
  std::string text;  // as given
  Tolerance tolerance;
  std::filesystem::path output;
};

// The tolerances of --max-error, which commas separate, or that of the level (given_tolerance). If
// there are several, the output's name is given for each with the tolerance after its stem
// (part-0.1pct.ply). Throws Error.
std::vector<ToleratedMesh> tolerated_meshes(const std::string& tolerances, int level,
                                            const std::filesystem::path& output);

// Another file of this tolerance, named in the same way. An empty path stays empty.
std::string named_for(const std::filesystem::path& file, const ToleratedMesh& mesh);

// In place of a length for --hole-reach: all holes stay open.
inline constexpr const char* kNoHoleReach = "none";
// The length of --hole-reach, if it is given and not kNoHoleReach. Throws Error where it is no
// length, and where it is given without `features`.
std::optional<Tolerance> given_hole_reach(const std::string& text, const std::string& features);

}  // namespace emax
