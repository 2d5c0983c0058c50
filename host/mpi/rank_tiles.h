#pragma once

#include <string>
#include <vector>

#include "host/mpi/rank_link.h"
#include "host/tiles/tile.h"

namespace emax {

// Tiles on the ranks of a job: each rank, rank 0 too, decimates one at a time with its processors.
class RankTiles final : public TileRunner {
 public:
  // `hosts`: of each rank. The link must outlive this.
  RankTiles(RankLink& link, std::vector<std::string> hosts)
      : link_(link), hosts_(std::move(hosts)) {}

  // Rank 0 decimates with settings.threads threads. Throws Error where another rank cannot.
  std::vector<DecimatedTile> run(std::size_t count, const MakeTile& make,
                                 const DecimationSettings& settings,
                                 const Advanced& advanced) override;

 private:
  class Batch;
  RankLink& link_;
  std::vector<std::string> hosts_;
};

}  // namespace emax
