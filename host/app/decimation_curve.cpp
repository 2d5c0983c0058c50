#include "host/app/decimation_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "host/app/scan.h"
#include "host/files/atomic_file.h"
#include "host/report/curve_svg.h"
#include "host/report/json_parts.h"

namespace emax {

std::filesystem::path curve_path(const std::filesystem::path& output) {
  std::filesystem::path path = output;
  return path.replace_filename(output.stem().string() + "-curve.svg");
}

void print(std::span<const CurveRow> curve) {
  fmt::print("  {:<12} {:>12} {:>10} {:>12}  {}\n", "--max-error", "tolerance", "triangles",
             "e_max", "mesh, with its certificate beside it");
  for (const CurveRow& row : curve) {
    fmt::print("  {:<12} {:>12.6g} {:>10} {:>12.6g}  {}\n", row.bound.text, row.epsilon,
               row.feasible ? grouped(row.triangles) : "-", row.e_max,
               row.feasible ? row.bound.output.string() : "infeasible");
  }
}

void draw(std::span<const CurveRow> curve, const std::filesystem::path& picture) {
  const bool percent =
      std::ranges::all_of(curve, [](const CurveRow& row) { return row.bound.tolerance.percent; });
  std::vector<CurvePoint> points;
  for (const CurveRow& row : curve) {
    if (!row.feasible) continue;
    points.push_back({percent ? row.bound.tolerance.value : row.epsilon, row.triangles});
  }
  if (points.size() < 2) return;
  write_atomically(picture,
                   curve_svg(points, percent ? "% of the width" : "the unit of the points"));
  fmt::print("curve          {}\n", picture.string());
}

std::vector<ReportCurvePoint> report_curve(std::span<const CurveRow> curve) {
  std::vector<ReportCurvePoint> points;
  for (const CurveRow& row : curve) {
    points.push_back({row.epsilon, row.feasible ? std::optional(row.triangles) : std::nullopt});
  }
  return points;
}

std::string to_json_text(std::span<const CurveRow> curve, const std::string& mesh,
                         const ReportOptions& report) {
  const auto file = [](const std::string& name) { return name.empty() ? Json() : Json(name); };
  Json rows = Json::array();
  for (const CurveRow& row : curve) {
    rows.push_back({{"max_error", row.bound.text},
                    {"epsilon", row.epsilon},
                    {"feasible", row.feasible},
                    {"triangles", row.triangles},
                    {"e_max", row.e_max},
                    {"mesh", row.feasible ? Json(row.bound.output.string()) : Json()},
                    {"report", file(named_for(report.report, row.bound))},
                    {"picture", file(named_for(report.picture, row.bound))}});
  }
  const Json json = {{"schema", "emax-curve-1"}, {"mesh", mesh}, {"curve", rows}};
  return json.dump(2) + "\n";
}

}  // namespace emax
