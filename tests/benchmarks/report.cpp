#include "tests/benchmarks/report.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sw_model/simd/emax_simd.h"
#include "tests/benchmarks/cgal_peer.h"
#include "tests/benchmarks/embree_peer.h"
#include "tests/benchmarks/engine.h"

namespace emax::benchmarks {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string cell(const std::vector<double>& values) {
  if (values.empty()) return "not measured";
  const Spread spread = spread_of(values);
  return digits(spread.median) + " (" + range(spread) + ")";
}

// One figure of every case, and the geometric mean over the cases in each round.
class Column {
 public:
  std::string add(std::vector<double> values) {
    std::string text = cell(values);
    rounds_.push_back(std::move(values));
    return text;
  }
  std::string mean() const {
    std::vector<double> means(rounds_.empty() ? 0 : rounds_.front().size(), 1);
    for (const std::vector<double>& values : rounds_) {
      if (values.size() != means.size()) return "not measured";
      for (std::size_t i = 0; i < values.size(); ++i) {
        means[i] *= std::pow(values[i], 1 / static_cast<double>(rounds_.size()));
      }
    }
    return cell(means);
  }

 private:
  std::vector<std::vector<double>> rounds_;
};

std::string fastest_peer(const Group& group) {
  std::string name = "none";
  std::optional<double> least;
  for (const Way& way : group.ways()) {
    if (!way.peer || way.times.empty()) continue;
    const double time = spread_of(way.times).median;
    if (!least || time < *least) least = time, name = way.title;
  }
  return name.substr(0, name.find_first_of(" ,"));
}

constexpr std::string_view kSummary = R"(
## e_max against the peers

Build and query for a mesh that was never seen before; the cloud is prepared beforehand. "ms" is our
e_max. The other columns are ratios of times: medians over the rounds, in brackets the least and the
greatest. The mean is the geometric mean over the scans.

- "Exact": the fastest exact peer over our e_max. The peers are CGAL, Embree, Open3D and FCPW, each in
  its best mode; each gives every point's distance.
- "Early stop": Embree, when it stops early on its way to the maximum as we do, over our e_max.
- "Every point": the fastest exact peer over our own exact distance of every point.

| case | points | triangles | e_max of width | ms | fastest exact peer | exact | early stop | every point |
|---|---:|---:|---:|---:|---|---:|---:|---:|
)";

void write_summary(std::ostream& out, std::span<const SearchGroup> searches) {
  out << kSummary;
  Column cold, stopped, exact, none;
  for (const bool scans : {true, false}) {
    for (const SearchGroup& search : searches) {
      if (search.scan != scans) continue;
      const Group& group = *search.group;
      const std::optional<Spread> time = group.time(kCold);
      out << fmt::format("| {} | {} | {} | {:.3f} % | {} | {} | {} | {} | {} |\n", search.name,
                         search.points, search.triangles, search.percent,
                         time ? digits(time->median) : "not measured", fastest_peer(group),
                         (scans ? cold : none).add(group.speedups(kCold)),
                         (scans ? stopped : none).add(group.ratios(kEarlyStop, kCold)),
                         (scans ? exact : none).add(group.speedups(kColdExact)));
    }
    if (!scans) break;
    out << fmt::format("| **mean** | | | | | | {} | {} | {} |\n", cold.mean(), stopped.mean(),
                       exact.mean());
  }
  for (const EngineTarget& target : engine_targets().subspan(1)) {
    Column exact_here, stopped_here;
    for (const SearchGroup& search : searches) {
      if (!search.scan) continue;
      exact_here.add(search.group->speedups(cold_way(target.name)));
      stopped_here.add(search.group->ratios(kEarlyStop, cold_way(target.name)));
    }
    out << fmt::format("\nThe means with {} alone: exact {}, early stop {}.\n", target.name,
                       exact_here.mean(), stopped_here.mean());
  }
  out << "\nBytes that the engine keeps for a point of the cloud and for a triangle of the mesh:";
  for (const SearchGroup& search : searches) {
    out << fmt::format(" {} {:.1f} and {:.0f};", search.name, search.bytes_per_point,
                       search.bytes_per_triangle);
  }
  out.seekp(-1, std::ios::end);
  out << ".\n";
}

// The time of `way` against that of Ericson's form in float, points in random order; in brackets,
// neighbours in a row. Negative is less time.
std::string change(const Group& at_random, const Group& in_a_row, const std::string& way) {
  const auto percent = [&](const Group& group) {
    const std::optional<Spread> ratio = group.ratio(way);
    return ratio ? fmt::format("{:+.0f} %", 100 * (ratio->median - 1)) : "not measured";
  };
  return percent(at_random) + " (" + percent(in_a_row) + ")";
}

void write_claim(std::ostream& out, const Group& at_random, const Group& in_a_row) {
  const std::string best(simd_targets().front().name());
  out << fmt::format(
      "\n## The paper's claim\n\n"
      "The paper (section 4) has \"computation times 94% lower than a matrix-free approach\". Here "
      "the matrix-free approach is Ericson's form in float, with points in random order (in "
      "brackets: neighbours in a row). Called pair by pair, the time of a pair changes by {} with "
      "the paper's literal (u, v) form and by {} with the visible-edge form. It changes by {} with "
      "the visible-edge form vectorised over points ({}).\n",
      change(at_random, in_a_row, kLiteral), change(at_random, in_a_row, kVisibleEdge),
      change(at_random, in_a_row, simd_way(best)), best);
}

}  // namespace

std::string report(const Results& results) {
  std::ostringstream out;
  out << "# Benchmarks\n\nWritten by `./dev bench`: figures of one machine, not promises.\n\n";
  out << fmt::format("- {}; one thread and CPU time unless said otherwise; SIMD targets:",
                     processor());
  for (const SimdTarget& target : simd_targets()) out << ' ' << target.name();
  out << fmt::format(
      "\n- GCC {}, {}, no -march; Eigen {}.{}.{}, CGAL {}, Embree {}, Google Benchmark {}; {}\n",
      __VERSION__, EMAX_BUILD_TYPE, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION,
      CgalPeer::version(), EmbreePeer::version(), EMAX_BENCHMARK_VERSION, results.foreign_versions);
  out << fmt::format(
      "- {} rounds; each measures everything once. Times are the median over the rounds; a ratio "
      "is the median of the rounds' own ratios.\n",
      results.rounds);
  if (!results.searches.empty()) write_summary(out, results.searches);
  if (!results.curves.empty()) out << "\n## Scaling\n\nPlots of the tables below.\n\n";
  for (const Curve& curve : results.curves) {
    out << fmt::format("![{} by {}](plots/{}.svg)\n", curve.unit, curve.axis, curve.name);
  }
  const Groups& groups = results.groups;
  if (groups.size() > 1 && groups[0].ratio(kLiteral)) write_claim(out, groups[0], groups[1]);
  for (const Group& group : groups) group.write(out);
  return out.str();
}

std::string curves_json(std::span<const Curve> curves) {
  nlohmann::json all = nlohmann::json::array();
  for (const Curve& curve : curves) {
    nlohmann::json lines = nlohmann::json::array();
    for (const auto& [title, group] : curve.lines) {
      nlohmann::json line = {{"title", title}};
      for (std::size_t i = 0; i < curve.at.size(); ++i) {
        if (group->ways()[i].times.empty()) continue;
        const Spread spread = spread_of(group->ways()[i].times);
        line["at"].push_back(curve.at[i]);
        line["median"].push_back(spread.median);
        line["least"].push_back(spread.least);
        line["greatest"].push_back(spread.greatest);
      }
      if (line.contains("at")) lines.push_back(std::move(line));
    }
    all.push_back(
        {{"name", curve.name}, {"axis", curve.axis}, {"unit", curve.unit}, {"lines", lines}});
  }
  return all.dump(1) + '\n';
}

}  // namespace emax::benchmarks
