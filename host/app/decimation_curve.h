#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/app/report_options.h"
#include "host/app/tolerated_meshes.h"
#include "host/report/report_data.h"

namespace emax {

// The result of `decimate` for one of several tolerances.
struct CurveRow {
  ToleratedMesh bound;
  double epsilon;  // in the unit of the points
  bool feasible;   // false: nothing was written
  std::size_t triangles;
  double e_max;
};

// The picture of triangles over tolerances: part-curve.svg.
std::filesystem::path curve_path(const std::filesystem::path& output);

// Prints the curve as a table.
void print(std::span<const CurveRow> curve);

// Draws the picture and prints its name, if there are at least two meshes to draw.
void draw(std::span<const CurveRow> curve, const std::filesystem::path& picture);

// The same for a report.
std::vector<ReportCurvePoint> report_curve(std::span<const CurveRow> curve);

// The content of --json. `mesh`: the file that was decimated; `report`: the options as given.
std::string to_json_text(std::span<const CurveRow> curve, const std::string& mesh,
                         const ReportOptions& report);

}  // namespace emax
