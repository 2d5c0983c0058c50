#pragma once

#include <mpi.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace emax {

// What the bytes of a rank's results depend on, and what it offers.
struct RankIdentity {
  std::string host;
  unsigned processors = 1;                                   // that are its own
  std::vector<std::pair<std::string, std::string>> program;  // program_identity(), the probe
};

// Of this rank. Collective. Throws Error as computed_probe() does.
RankIdentity rank_identity(MPI_Comm communicator);

// Of all ranks, on rank 0; elsewhere nothing. Collective.
std::vector<RankIdentity> gather_identities(const RankIdentity& own, MPI_Comm communicator);

// Why a rank's results may have other bits than those of rank 0, with a remedy; nothing if none
// may.
std::optional<std::string> difference(const std::vector<RankIdentity>& ranks);

// At most so many ranks are on one host.
unsigned most_on_one_host(const std::vector<RankIdentity>& ranks);

}  // namespace emax
