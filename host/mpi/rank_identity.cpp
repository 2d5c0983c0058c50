#include "host/mpi/rank_identity.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/app/run_identity.h"
#include "host/mpi/computed_probe.h"

namespace emax {
namespace {

using nlohmann::json;

constexpr const char* kProbe = "probe";

std::string host_name() {
  std::array<char, MPI_MAX_PROCESSOR_NAME + 1> name{};
  int length = 0;
  MPI_Get_processor_name(name.data(), &length);
  return {name.data(), static_cast<std::size_t>(length)};
}

// Those that this process may use, or an equal share where others on its machine may use them too.
unsigned own_processors(MPI_Comm communicator) {
  MPI_Comm here;
  MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  int ranks = 1;
  MPI_Comm_size(here, &ranks);
  MPI_Comm_free(&here);
  const auto all = static_cast<unsigned>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
  const unsigned mine = std::max(1u, std::thread::hardware_concurrency());
  return std::min(mine, std::max(1u, all / static_cast<unsigned>(ranks)));
}

std::string to_text(const RankIdentity& identity) {
  return json{
      {"host", identity.host}, {"processors", identity.processors}, {"program", identity.program}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

RankIdentity from_text(const std::string& text) {
  const json j = json::parse(text);
  return {j.at("host"), j.at("processors"), j.at("program")};
}

}  // namespace

RankIdentity rank_identity(MPI_Comm communicator) {
  RankIdentity identity{host_name(), own_processors(communicator), program_identity()};
  int ranks = 1;
  MPI_Comm_size(communicator, &ranks);
  if (ranks == 1) return identity;  // there is nothing to compare it with
  identity.program.emplace_back(kProbe, fmt::format("{:08x}", computed_probe()));
  return identity;
}

std::vector<RankIdentity> gather_identities(const RankIdentity& own, MPI_Comm communicator) {
  int rank = 0, size = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &size);
  const std::string text = to_text(own);
  const auto length = static_cast<int>(text.size());
  std::vector<int> lengths(static_cast<std::size_t>(size)), begins(lengths.size());
  MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, communicator);
  for (std::size_t r = 1; r < lengths.size(); ++r) begins[r] = begins[r - 1] + lengths[r - 1];
  std::string all(static_cast<std::size_t>(begins.back() + lengths.back()), '\0');
  MPI_Gatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), begins.data(), MPI_CHAR, 0,
              communicator);
  std::vector<RankIdentity> ranks;
  for (std::size_t r = 0; rank == 0 && r < lengths.size(); ++r) {
    ranks.push_back(from_text(
        all.substr(static_cast<std::size_t>(begins[r]), static_cast<std::size_t>(lengths[r]))));
  }
  return ranks;
}

std::optional<std::string> difference(const std::vector<RankIdentity>& ranks) {
  const RankIdentity& first = ranks.front();
  for (std::size_t r = 1; r < ranks.size(); ++r) {
    const RankIdentity& other = ranks[r];
    const auto [here, there] = std::ranges::mismatch(first.program, other.program);
    if (here == first.program.end() && there == other.program.end()) continue;
    const auto value = [](const RankIdentity& of, auto at) {
      return at == of.program.end() ? std::string("nothing") : at->second;
    };
    const std::string name = here != first.program.end() ? here->first : std::string(there->first);
    return fmt::format(
        "rank {} on {} would give other bytes than rank 0 on {}: {} {} there, {} here; {}", r,
        other.host, first.host, name, value(other, there), value(first, here),
        name == kProbe || name == "processor"
            ? "take machines with the same processor and C library"
            : "start the same emax_mpi, with its emax_worker, on all of them");
  }
  return std::nullopt;
}

unsigned most_on_one_host(const std::vector<RankIdentity>& ranks) {
  std::map<std::string, unsigned> counts;
  unsigned most = 0;
  for (const RankIdentity& rank : ranks) most = std::max(most, ++counts[rank.host]);
  return most;
}

}  // namespace emax
