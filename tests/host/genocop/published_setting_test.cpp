#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "run_search.h"

namespace emax {
namespace {

using testing_help::run_search;

TEST(PublishedSetting, UsesNothingElse) {
  Settings settings = Settings::original();
  settings.budget = 3000;
  std::set<std::string> origins;
  const auto best = run_search(benchmark::g09(), settings, 68,
                               [&](const Genocop&, const Candidate& c, const Evaluation&) {
                                 origins.insert(std::string(c.origin));
                               });
  std::set<std::string> expected = {"start", "repair"};
  for (const OperatorEntry& entry : kOperators) expected.insert(std::string(entry.name));
  expected.erase("uniform_mutation");  // Genocop's, not among the ten
  EXPECT_EQ(origins, expected);
  EXPECT_TRUE(best->evaluation.feasible());
}

// Offspring take a place whatever their value, but never that of the best; with replace_worse_only
// none that is worse does.
TEST(PublishedSetting, OffspringReplaceWhateverTheirValue) {
  using Key = std::pair<int, double>;
  const auto key = [](const Individual& individual) {
    const Evaluation& e = individual.evaluation;
    if (e.feasible()) return Key{0, e.objective};
    return individual.repaired_objective ? Key{0, *individual.repaired_objective}
                                         : Key{1, e.violation};
  };
  for (const bool worse_only : {false, true}) {
    Settings settings = Settings::original();
    settings.budget = 3000;
    settings.replacement_probability = 0;
    settings.replace_worse_only = worse_only;
    std::vector<Key> before;
    int worse = 0;
    run_search(benchmark::g09(), settings, 76, [&](const Genocop& search, auto&&, auto&&) {
      std::vector<Key> now;
      for (const Individual& member : search.search_population()) now.push_back(key(member));
      if (before.size() == settings.search_population) {
        EXPECT_LE(now.front(), before.front());
        std::vector<Key> gone, come;
        std::ranges::set_difference(before, now, std::back_inserter(gone));
        std::ranges::set_difference(now, before, std::back_inserter(come));
        worse += !gone.empty() && !come.empty() && come.front() > gone.front() ? 1 : 0;
      }
      before = now;
    });
    if (worse_only) {
      EXPECT_EQ(worse, 0);
    } else {
      EXPECT_GT(worse, 100);
    }
  }
}

// Where all offspring are of references, a full search population of the published setting stays.
TEST(PublishedSetting, PopulationsMeetInRepairsAlone) {
  for (const bool share : {false, true}) {
    Settings settings = Settings::original();
    settings.budget = 3000;
    settings.replacement_probability = 0;
    settings.reference_share = 1;
    settings.share_feasible = share;
    std::vector<std::uint64_t> before;
    int changes = 0, full = 0;
    run_search(benchmark::g09(), settings, 77, [&](const Genocop& search, auto&&, auto&&) {
      std::vector<std::uint64_t> now;
      for (const Individual& member : search.search_population()) now.push_back(member.id);
      std::ranges::sort(now);
      const bool was_full = full > 0 && before.size() == settings.search_population;
      changes += was_full && now != before ? 1 : 0;
      full += search.reference_population().size() == settings.reference_population ? 1 : 0;
      before = now;
    });
    EXPECT_GT(full, 500);
    if (share) {
      EXPECT_GT(changes, 100);
    } else {
      EXPECT_EQ(changes, 0);
    }
  }
}

}  // namespace
}  // namespace emax
