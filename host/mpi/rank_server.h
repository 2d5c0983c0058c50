#pragma once

#include "host/mpi/rank_link.h"

namespace emax {

// What ranks other than 0 do until rank 0 sends them kQuit: they run evaluations in worker
// processes of their own, and decimate tiles and measure pieces of clouds with so many threads.
void serve_rank(RankLink& link, std::size_t threads);

}  // namespace emax
