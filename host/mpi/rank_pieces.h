#pragma once

#include <string>
#include <vector>

#include "host/app/piece_runner.h"
#include "host/mpi/rank_link.h"

namespace emax {

// Pieces of a cloud on the ranks of a job. Each rank reads cloud and meshes itself and measures its
// share of the pieces with its processors; rank 0 gathers what they find.
class RankPieces final : public PieceRunner {
 public:
  // `processors` and `hosts`: of each rank. The link must outlive this.
  RankPieces(RankLink& link, std::vector<unsigned> processors, std::vector<std::string> hosts)
      : link_(link), processors_(std::move(processors)), hosts_(std::move(hosts)) {}

  // 0 for one rank, and for what only rank 0 can read.
  std::size_t threads(const std::filesystem::path& cloud, const MeterFiles& files) const override;
  // Throws Error also where another rank cannot measure, or has other files. A cloud that is not
  // cut is measured by rank 0.
  void run(const ScanPieces& scan, PieceMeter& meter, const MeterFiles& files,
           const PieceQuestion& question, const std::function<bool()>& interrupted,
           const Take& take) override;

 private:
  class Round;
  RankLink& link_;
  std::vector<unsigned> processors_;
  std::vector<std::string> hosts_;
  std::uint64_t rounds_ = 0;  // so far
};

}  // namespace emax
