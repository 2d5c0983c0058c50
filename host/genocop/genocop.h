#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "host/genocop/monotone_step.h"
#include "host/genocop/problem.h"
#include "host/genocop/repair.h"
#include "host/genocop/settings.h"

namespace emax {

// A point to be evaluated.
struct Candidate {
  std::uint64_t index = 0;
  Genes genes;
  std::string_view origin;  // "start", "climb", "repair", "sample" or the operator's name
  // The earlier candidate with the same genes, when nothing new was found in a bounded number of
  // draws; its evaluation is to be told again instead of being made again.
  std::optional<std::uint64_t> same_as;
};

struct Best {
  std::uint64_t index = 0;
  Genes genes;
  Evaluation evaluation;  // feasible, or of the least violation when nothing feasible was found
};

struct Individual {
  std::uint64_t id = 0;  // index of its candidate
  Genes free;            // LinearDomain's coordinates
  Evaluation evaluation;
  std::optional<double> repaired_objective;  // of the feasible point its repair ended in
};

// Genocop III (Michalewicz & Nazhiyath 1995; paper, section 2.3) as a state machine, so that
// evaluations may run anywhere and in any number at once. Candidate i is a pure function of
// problem, settings, seed, i and the results 0 .. i-K (K = settings.look_ahead): ask() demands that
// exactly these have been told, which LookAheadScheduler sees to. A run is resumed by asking and
// telling its recorded results again.
class Genocop {
 public:
  // Throws emax::Error for an empty domain and settings out of range.
  Genocop(Problem problem, Settings settings, std::uint64_t seed);
  Genocop(const Genocop&) = delete;  // the monotone step refers to its neighbours
  Genocop& operator=(const Genocop&) = delete;

  // Throws std::logic_error unless told() == max(0, asked() - K + 1).
  Candidate ask();
  // Results in the order of their index; throws std::logic_error otherwise. A feasible evaluation
  // with a NaN or infinite number counts as failed.
  void tell(std::uint64_t index, Evaluation evaluation);

  std::optional<Best> best() const { return best_; }  // of what has been told
  std::uint64_t asked() const { return records_.size(); }
  std::uint64_t told() const { return told_; }
  const Settings& settings() const { return settings_; }

  const std::vector<Individual>& search_population() const { return search_; }
  const std::vector<Individual>& reference_population() const { return references_; }

 private:
  enum class Role { kSearch, kClimb, kRepair };
  struct Record {
    Genes free;
    Role role;
    bool repeated;
    std::optional<RepairChain> chain;
    std::optional<Evaluation> evaluation;
  };
  struct Proposal {
    Genes free;
    std::string_view origin;
    Role role = Role::kSearch;
    std::optional<RepairChain> chain;
  };
  using SortKey = std::pair<int, double>;

  void make_starts();
  Proposal propose(RandomStream& random);
  std::optional<Proposal> next_repair(RandomStream& random);
  std::optional<Proposal> offspring(RandomStream& random);
  double remaining() const;  // share of the budget, 1 - t/T
  bool is_new(const Genes& free) const { return !first_.contains(free); }

  SortKey key(const Individual& individual) const;
  void sort_populations();
  void enter_search(Individual individual, RandomStream& random);
  void enter_references(Individual individual, std::optional<std::uint64_t> replaced);
  void start_repair(const Individual& individual, RandomStream& random);
  void finish_repair(RepairChain chain, const Individual& point, RandomStream& random);

  Settings settings_;
  std::uint64_t seed_;
  Problem problem_;
  LinearDomain domain_;
  std::optional<MonotoneStep> monotone_;
  std::vector<Genes> starts_;
  std::vector<Record> records_;
  std::map<Genes, std::uint64_t> first_;  // the first candidate with these coordinates
  std::uint64_t told_ = 0;
  std::vector<Individual> search_;      // best first
  std::vector<Individual> references_;  // best first; feasible
  std::deque<RepairChain> repairs_;
  std::optional<Best> best_;
};

}  // namespace emax
