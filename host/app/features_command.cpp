#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/phase_progress.h"
#include "host/app/scan.h"
#include "host/features/find_features.h"
#include "host/files/atomic_file.h"
#include "host/files/point_groups.h"
#include "host/files/tolerance.h"
#include "host/picture/colour.h"
#include "host/report/json_parts.h"
#include "host/report/shape_text.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kShownRegions = 20;

Json coordinates(const Point& p) { return Json{p.x(), p.y(), p.z()}; }

class FeaturesCommand {
 public:
  explicit FeaturesCommand(const FeaturesOptions& options) : options_(options) {
    for (std::size_t i = 0; i < options.outputs.size(); ++i) {
      const std::string& output = options.outputs[i];
      check_output(output, kGroupEndings);
      check_distinct({output, options.json}, {options.cloud});
      for (std::size_t j = 0; j < i; ++j) check_distinct({output, options.outputs[j]}, {});
      check_not_among_scans(output, options.cloud);
    }
    if (!options.json.empty()) {
      check_output(options.json, kJsonEndings);
      check_distinct({options.json}, {options.cloud});
    }
  }

  int run() {
    progress_.begin("reading", reading_seconds(options_.cloud));
    scan_ = read_scan(options_.cloud, options_.reading, options_.unit);
    FeatureSearch search;
    if (const auto tolerance = given_tolerance(options_.max_error, options_.level)) {
      search.max_error = tolerance_below_width(*tolerance, "--max-error", scan_);
    }
    search.planes = options_.method == "hough" ? PlaneMethod::kHough : PlaneMethod::kGrowing;
    search.least_support = options_.least_support;
    search.seed = options_.seed;
    search.threads = options_.jobs > 0 ? options_.jobs : processor_threads();
    search.check = [] {
      if (was_interrupted()) throw Interrupted{};
    };
    constexpr double kSecondsOfPoint = 5e-6;
    progress_.begin("searching", kSecondsOfPoint * static_cast<double>(scan_.cloud.points.size()));
    features_ = find_features(scan_.cloud.points, search);
    progress_.begin("writing");
    write();
    progress_.end();
    print();
    if (json_is_wanted(options_.json)) write_json(options_.json, to_json().dump(2) + "\n");
    return kExitOk;
  }

 private:
  std::string name_of(std::size_t region) const {
    return fmt::format("{}_{}", kind_of(features_.regions[region].shape), region + 1);
  }

  void write() const {
    if (options_.outputs.empty()) return;
    PointGroups groups = {.points = scan_.cloud.points,
                          .group_of = std::vector(scan_.cloud.points.size(), PointGroups::kNone),
                          .groups = {},
                          .unit = scan_.unit};
    for (std::size_t r = 0; r < features_.regions.size(); ++r) {
      const Region& region = features_.regions[r];
      groups.groups.push_back({name_of(r), distinct_colour(r), {}});
      if (std::holds_alternative<Plane>(region.shape)) groups.groups[r].outline = region.outline;
      for (const std::uint32_t i : region.points) {
        groups.group_of[i] = static_cast<std::uint32_t>(r);
      }
    }
    std::vector<OutputFile> files;
    for (const std::string& output : options_.outputs) {
      files.push_back({output, group_bytes(groups, output)});
    }
    write_together(files);
  }

  std::size_t points_of_regions() const {
    std::size_t count = 0;
    for (const Region& region : features_.regions) count += region.points.size();
    return count;
  }
  std::size_t count_of(std::string_view name) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        features_.regions, [&](const Region& region) { return kind_of(region.shape) == name; }));
  }

  void print() {
    facts_.add("cloud", "{}", describe(scan_));
    print_left_out(facts_, scan_.cloud);
    print_doubtful_unit(facts_, scan_.width, scan_.unit);
    const FeatureOptions& taken = features_.options;
    facts_.add("searched", "within {} of a shape{}, of {} points or more; seed {}",
               length_text(taken.band, scan_.unit),
               options_.max_error.empty() && options_.level == 0 ? ", which suits the scan" : "",
               grouped(taken.least_support), taken.seed);
    facts_.add("found", "{} planes, {} cylinders, {} spheres; they have {} of the points",
               count_of("plane"), count_of("cylinder"), count_of("sphere"),
               grouped(points_of_regions()));
    const std::size_t shown =
        options_.all ? features_.regions.size() : std::min(kShownRegions, features_.regions.size());
    for (std::size_t r = 0; r < shown; ++r) {
      const Region& region = features_.regions[r];
      facts_.add(name_of(r), "{} points, area {:.4g}, rms {:.2g}: {}",
                 grouped(region.points.size()), region.area, region.rms,
                 equation_text(region.shape));
    }
    if (shown < features_.regions.size()) {
      facts_.add("...", "{} smaller ones; --all prints them", features_.regions.size() - shown);
    }
    for (const std::string& output : options_.outputs) facts_.add("written", "{}", output);
  }

  Json to_json() const {
    const FeatureOptions& taken = features_.options;
    Json json = {{"schema", "emax-features-1"},
                 {"cloud", options_.cloud},
                 {"points", scan_.cloud.points.size()},
                 {"unit", nullptr},
                 {"method", options_.method},
                 {"max_error", taken.band},
                 {"spacing", taken.spacing},
                 {"noise", taken.noise},
                 {"least_points", taken.least_support},
                 {"seed", taken.seed},
                 {"regions", Json::array()}};
    if (scan_.unit) json["unit"] = scan_.unit->name;
    for (std::size_t r = 0; r < features_.regions.size(); ++r) {
      const Region& region = features_.regions[r];
      Json told = {
          {"name", name_of(r)}, {"kind", kind_of(region.shape)}, {"points", region.points.size()},
          {"rms", region.rms},  {"area", region.area},           {"outline", Json::array()}};
      told.update(equation_json(region.shape));
      for (const Point& corner : region.outline) told["outline"].push_back(coordinates(corner));
      json["regions"].push_back(std::move(told));
    }
    return json;
  }

  const FeaturesOptions& options_;
  PhaseProgress progress_;
  Facts facts_;
  Scan scan_ = {{}, {}, 0};
  Features features_;
};

}  // namespace

int run_features(const FeaturesOptions& options) { return FeaturesCommand(options).run(); }

}  // namespace emax
