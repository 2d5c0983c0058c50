#pragma once

#include <cstddef>
#include <filesystem>

#include "host/tiles/part_plan.h"

namespace emax {

// A step of a part of the cloud whose files are in this folder, with the plan there
// (host/tiles/tiled_reconstruction.h). About 1.5 KB a point of the part and of what is around it.
// Throws Error.
void run_part_step(const std::filesystem::path& folder, PartStep step, std::size_t part);

}  // namespace emax
