#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <emax/genocop.h>
#include "host/genocop/adaptive_frequencies.h"
#include "host/genocop/differential_evolution.h"
#include "host/genocop/finish.h"
#include "host/genocop/linear_step.h"
#include "host/genocop/monotone_step.h"
#include "host/genocop/repair.h"
#include "host/genocop/settings.h"

namespace emax {

// A point to be evaluated.
struct Candidate {
  std::uint64_t index = 0;
  Genes genes;
  // "start", "climb", "finish", "linear_model", "repair", "differential", "sample" or the
  // operator's name
  std::string_view origin;
  // The earlier candidate with the same genes, if a bounded number of draws found nothing new. Tell
  // its evaluation again instead of evaluating the genes again.
  std::optional<std::uint64_t> same_as;
  // The result that Problem::known gave for these genes; tell it instead of evaluating.
  std::optional<Evaluation> known;
};

// The index of a point that Problem::known gave.
inline constexpr std::uint64_t kKnownBefore = ~std::uint64_t{0};

struct Best {
  std::uint64_t index = 0;
  Genes genes;
  Evaluation evaluation;  // feasible, or of the least violation if nothing feasible was found
};

struct Individual {
  std::uint64_t id = 0;  // index of its candidate; known results count down from 2^64-1
  Genes free;            // LinearDomain's coordinates
  Evaluation evaluation;
  std::optional<double> repaired_objective;  // of the feasible point that ended its repair
};

// Genocop III (Michalewicz & Nazhiyath 1995; paper, section 2.3) as a state machine, so that
// evaluations may run anywhere and any number at once. Candidate i is a pure function of problem,
// settings, seed, i and the results 0 .. i-K (K = settings.look_ahead). ask() requires that exactly
// these results have been told; LookAheadScheduler ensures that. To resume a run, ask and tell its
// recorded results again.
class Genocop {
 public:
  // Throws emax::Error for a problem without genes, an empty domain, settings out of range, and
  // known results that do not fit the problem.
  Genocop(Problem problem, Settings settings, std::uint64_t seed);
  Genocop(const Genocop&) = delete;  // members refer to domain_ and problem_
  Genocop& operator=(const Genocop&) = delete;

  // Throws std::logic_error unless told() == max(0, asked() - K + 1). O(told() * genes), and
  // O((genes + constraints)^3) for the local models.
  Candidate ask();
  // Takes results in the order of their index; throws std::logic_error otherwise. An evaluation
  // whose objective is NaN or infinite, or whose violation is NaN, counts as failed.
  void tell(std::uint64_t index, Evaluation evaluation);

  std::optional<Best> best() const { return best_; }  // of the results told so far
  std::uint64_t asked() const { return records_.size(); }
  std::uint64_t told() const { return told_; }
  const Settings& settings() const { return settings_; }

  const std::vector<Individual>& search_population() const { return search_; }
  const std::vector<Individual>& reference_population() const { return references_; }

 private:
  enum class Role { kSearch, kClimb, kRepair, kLinear, kFinish, kDifferential };
  using SortKey = std::pair<int, double>;
  struct Bred {  // the operator's entry and the better parent
    std::size_t entry;
    SortKey parent;
    bool from_references;
  };
  struct Record {
    Genes free;
    Role role;
    bool repeated;
    std::optional<RepairChain> chain;
    std::optional<Bred> bred;
    std::size_t member;  // of the differential evolution
    std::optional<Evaluation> evaluation;
  };
  struct Proposal {
    Genes free;
    std::string_view origin;
    Role role = Role::kSearch;
    std::optional<RepairChain> chain = std::nullopt;
    std::optional<Bred> bred = std::nullopt;
    std::size_t member = 0;
  };
  struct Descent {                   // from its starts until nothing more is gained
    std::uint64_t first = 0;         // its first candidate
    std::uint64_t after_starts = 0;  // the candidate after its starts
    std::uint64_t gained = 0;        // results told at its last gain
    std::optional<Evaluation> best;
  };

  // genocop.cpp: results that are told
  void take_known();
  void learn(const Genes& free, const Evaluation& evaluation);
  void note_gain(const Evaluation& evaluation);
  bool offer_best(std::uint64_t index, const Genes& free, const Evaluation& evaluation);
  SortKey key(const Individual& individual) const;
  void sort_populations();
  void enter_search(Individual individual, RandomStream& random);
  void enter_references(Individual individual, std::optional<std::uint64_t> replaced);
  void enter_finished(Individual individual);
  bool start_repair(const Individual& individual, std::optional<std::size_t> bred_by,
                    RandomStream& random);
  void finish_repair(RepairChain chain, const Individual& point, RandomStream& random);
  void end_repair(const RepairChain& chain, const Evaluation& result);
  void reward(std::size_t entry, bool success);

  // proposals.cpp: candidates that are asked for
  void make_starts();
  Genes next_of_sobol(RandomStream& random);
  void make_more_starts(std::size_t count);
  bool descent_is_over() const;
  void begin_anew();
  Proposal propose(RandomStream& random);
  std::optional<Proposal> next_repair(RandomStream& random);
  std::optional<Proposal> next_linear(RandomStream& random);
  std::optional<Proposal> next_finish(RandomStream& random);
  double many_genes() const;
  double share_of_finish() const;
  std::optional<Proposal> next_differential(RandomStream& random);
  bool start_finish();
  std::optional<Proposal> offspring(RandomStream& random);
  double remaining() const;  // of the budget that is left: 1 - t/T
  Genes cache_key(const Genes& free) const;
  bool is_new(const Genes& free) const;
  // The result of a point with the same key; nothing while that point is in flight.
  std::optional<Evaluation> result_of(const Genes& cached) const;

  Settings settings_;
  std::uint64_t seed_;
  Problem problem_;
  LinearDomain domain_;
  std::optional<MonotoneStep> monotone_;
  std::optional<LinearStep> linear_;
  std::optional<Finish> finish_;
  std::optional<DifferentialEvolution> differential_;
  AdaptiveFrequencies frequencies_;
  std::deque<Genes> starts_;   // not yet asked
  std::uint64_t sampled_ = 0;  // points of Sobol's sequence that were starts
  Descent descent_;
  std::vector<Record> records_;
  std::map<Genes, std::uint64_t> first_;  // by cache key: the first candidate
  std::map<Genes, Evaluation> known_;     // by cache key: Problem::known
  std::uint64_t told_ = 0;
  std::vector<Individual> search_;      // best first
  std::vector<Individual> references_;  // best first; feasible
  std::deque<RepairChain> repairs_;
  std::optional<Best> best_;
  std::vector<Genes> finished_;                    // where local searches started and ended
  std::optional<std::uint64_t> finish_reference_;  // the reference of the running local search
};

}  // namespace emax
