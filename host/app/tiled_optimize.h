#pragma once

#include "host/app/commands.h"

namespace emax {

// `emax optimize --tiles`: a surface in tiles (run_reconstruct()) and its decimation in tiles
// (run_decimate()). After an interruption the same command goes on with the tiles that are done.
int run_optimize_in_tiles(const OptimizeOptions& options);

}  // namespace emax
