#pragma once

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include "host/app/piece_runner.h"
#include "host/tiles/tile.h"
#include "host/worker_pool/worker_parts.h"
#include "host/worker_pool/worker_pool.h"

namespace emax {

// What evaluations, tiles and measurements run on: this machine alone unless a program says
// otherwise.
struct Machines {
  // Those that each process may use which starts workers.
  std::vector<unsigned> processors = {std::max(1u, std::thread::hardware_concurrency())};
  unsigned processes_on_one = 1;  // at most so many of them share a machine and its memory
  MakePool make_pool = make_worker_pool;
  MakeParts make_parts = worker_parts;
  std::shared_ptr<TileRunner> tiles = std::make_shared<LocalTiles>();
  std::shared_ptr<PieceRunner> pieces = std::make_shared<LocalPieces>();
};

}  // namespace emax
