#include <mpi.h>

#include <csignal>
#include <memory>
#include <optional>

#include "host/app/interrupt.h"
#include "host/app/program.h"
#include "host/app/standard_streams.h"
#include "host/mpi/rank_identity.h"
#include "host/mpi/rank_parts.h"
#include "host/mpi/rank_pieces.h"
#include "host/mpi/rank_pool.h"
#include "host/mpi/rank_server.h"
#include "host/mpi/rank_tiles.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// Rank 0 is `emax`, and the others make evaluations, decimate tiles, reconstruct parts and measure
// pieces for it.
int run_first(RankLink& link, const std::vector<RankIdentity>& ranks, int argc, char** argv) {
  Machines machines;
  std::vector<std::string> hosts;
  machines.processors.clear();
  for (const RankIdentity& rank : ranks) {
    machines.processors.push_back(rank.processors);
    hosts.push_back(rank.host);
  }
  machines.processes_on_one = most_on_one_host(ranks);
  RankJob job(link, machines.processors, hosts);
  machines.tiles = std::make_shared<RankTiles>(link, hosts);
  machines.pieces = std::make_shared<RankPieces>(link, machines.processors, hosts);
  machines.make_pool = [&job](std::span<const Point> points, const DecimationBound& bound,
                              const WorkerPoolOptions& options) {
    return job.make_pool(points, bound, options);
  };
  machines.make_parts = [&](const std::filesystem::path& folder,
                            const WorkerPartsOptions& options) {
    return rank_parts(link, machines.processors, hosts, folder, options);
  };
  return run_program(argc, argv, machines);
}

// Rank 0 says what is wrong; all ranks know that something is.
bool all_are_alike(const std::vector<RankIdentity>& ranks) {
  int alike = 1;
  if (!ranks.empty()) {
    if (const std::optional<std::string> why = difference(ranks)) {
      to_standard_error("emax_mpi: " + *why + "\n");
      alike = 0;
    }
  }
  MPI_Bcast(&alike, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return alike != 0;
}

int run(int argc, char** argv) {
  const RankIdentity own = rank_identity(MPI_COMM_WORLD);
  const std::vector<RankIdentity> ranks = gather_identities(own, MPI_COMM_WORLD);
  if (!all_are_alike(ranks)) return kExitError;
  RankLink link(MPI_COMM_WORLD);
  if (link.rank() == 0) return run_first(link, ranks, argc, argv);
  // Rank 0 decides when the job ends.
  for (const int signal_number : {SIGHUP, SIGINT, SIGTERM}) std::signal(signal_number, SIG_IGN);
  serve_rank(link, own.processors);
  return kExitOk;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  emax::open_standard_streams();
  MPI_Init(&argc, &argv);
  int code = emax::kExitError;
  try {
    code = emax::run(argc, argv);
  } catch (const std::exception& error) {
    emax::to_standard_error(std::string("emax_mpi: ") + error.what() + "\n");
    MPI_Abort(MPI_COMM_WORLD, emax::kExitError);  // other ranks wait for this one
  }
  MPI_Finalize();
  return code;
}
