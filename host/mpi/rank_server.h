#pragma once

#include "host/mpi/rank_link.h"

namespace emax {

// What ranks other than 0 do: they run evaluations in worker processes of their own as rank 0 asks
// them to, until it sends them kQuit.
void serve_rank(RankLink& link);

}  // namespace emax
