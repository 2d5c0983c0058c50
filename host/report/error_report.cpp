#include "host/report/error_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/report/json_parts.h"

namespace emax {
namespace {

constexpr std::size_t kBarLength = 40;

class Text {
 public:
  explicit Text(const ErrorReport& report) : report_(report) {}

  std::string take() {
    line("\ncloud to mesh, {} points      [cloud's unit]  [% of the width]\n",
         report_.cloud.statistics.count);
    statistics(report_.cloud.statistics, true);
    if (!report_.cloud.worst.empty()) {
      line("  worst points      distance  at (x, y, z), nearest triangle\n");
      for (const FarPoint& far : report_.cloud.worst) {
        line("    {:<12} {:>11.6g}  ({:.9g}, {:.9g}, {:.9g}), {}\n", far.point, far.distance,
             far.position.x(), far.position.y(), far.position.z(), far.triangle);
      }
    }
    if (report_.reference) reference(*report_.reference);
    return std::move(text_);
  }

 private:
  template <class... Arguments>
  void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
  }

  void length(const std::string& name, double value) {
    line("  {:<16} {:>12.6g}  {:>12.4g}\n", name, value, 100 * value / report_.width);
  }

  void statistics(const ErrorStatistics& s, bool with_maximum) {
    if (with_maximum) length("maximum", s.maximum);
    length("mean", s.mean);
    length("RMS", s.rms);
    for (const auto& [percent, value] : s.quantiles) length(fmt::format("{:g} %", percent), value);
    if (s.exceeding) {
      line("  exceeding        {:>12}  = {:.4g}% beyond {:.6g}\n", *s.exceeding,
           100 * static_cast<double>(*s.exceeding) / static_cast<double>(s.count), *report_.limit);
    }
    line("  histogram\n");
    std::size_t most = 1;
    for (const ErrorStatistics::Bin& bin : s.histogram) most = std::max(most, bin.count);
    for (const ErrorStatistics::Bin& bin : s.histogram) {
      // Rounded up, so that a bin with few distances still shows.
      const std::size_t bar = (bin.count * kBarLength + most - 1) / most;
      line("    up to {:>10.4g} |{:<40}| {}\n", bin.up_to, std::string(bar, '#'), bin.count);
    }
  }

  void reference(const ReferenceErrors& r) {
    const std::string name = fmt::format("{} {}, {} {}", r.is_cloud ? "cloud" : "surface", r.name,
                                         r.size, r.is_cloud ? "points" : "triangles");
    line("\nmesh to {}\n", name);
    surface(r.from_mesh, "triangle", "over the whole surface", "samples of equal area");
    if (!r.to_mesh) {
      line("\nthe reference is the cloud: its distances to the mesh are those at the top\n");
      return;
    }
    line("\n{} to mesh\n", name);
    if (r.is_cloud) {
      surface(*r.to_mesh, "point", "over all points", "points");
    } else {
      surface(*r.to_mesh, "triangle", "over the whole surface", "samples of equal area");
    }
  }

  void surface(const SurfaceErrors& s, const char* part, const char* extent, const char* samples) {
    const SurfaceDistance& d = s.distance;
    length("maximum at most", d.upper);
    length("maximum at least", d.lower);
    line("  at ({:.9g}, {:.9g}, {:.9g}), {} {}; certified {}\n", d.witness.x(), d.witness.y(),
         d.witness.z(), part, d.triangle, extent);
    line("  over {} {}\n", s.statistics.count, samples);
    statistics(s.statistics, false);
  }

  const ErrorReport& report_;
  std::string text_;
};

Json to_json(const Point& p) { return {p.x(), p.y(), p.z()}; }

Json to_json(const ErrorStatistics& s) {
  Json quantiles = Json::array();
  for (const auto& [percent, value] : s.quantiles) {
    quantiles.push_back({{"percent", percent}, {"distance", value}});
  }
  Json histogram = Json::array();
  for (const auto& [up_to, count] : s.histogram) {
    histogram.push_back({{"up_to", up_to}, {"count", count}});
  }
  return {{"count", s.count},
          {"maximum", s.maximum},
          {"mean", s.mean},
          {"rms", s.rms},
          {"quantiles", quantiles},
          {"histogram", histogram},
          {"exceeding", s.exceeding ? Json(*s.exceeding) : Json()}};
}

Json to_json(const SurfaceErrors& s, const ReferenceErrors& r) {
  return {{"reference", r.name},
          {"kind", r.is_cloud ? "cloud" : "surface"},
          {"size", r.size},
          {"upper", s.distance.upper},
          {"lower", s.distance.lower},
          {"witness", to_json(s.distance.witness)},
          {"triangle", s.distance.triangle},
          {"samples", to_json(s.statistics)}};
}

}  // namespace

std::string to_text(const ErrorReport& report) { return Text(report).take(); }

Json to_json(const ErrorReport& report) {
  Json worst = Json::array();
  for (const FarPoint& far : report.cloud.worst) {
    worst.push_back({{"point", far.point},
                     {"position", to_json(far.position)},
                     {"distance", far.distance},
                     {"triangle", far.triangle}});
  }
  Json json = {{"width", report.width},       {"cloud_to_mesh", to_json(report.cloud.statistics)},
               {"worst_points", worst},       {"mesh_to_reference", Json()},
               {"reference_to_mesh", Json()}, {"reference_topology", Json()}};
  if (report.reference) {
    const ReferenceErrors& r = *report.reference;
    json["mesh_to_reference"] = to_json(r.from_mesh, r);
    if (r.to_mesh) json["reference_to_mesh"] = to_json(*r.to_mesh, r);
    if (r.topology) json["reference_topology"] = emax::to_json(*r.topology);
  }
  return json;
}

}  // namespace emax
