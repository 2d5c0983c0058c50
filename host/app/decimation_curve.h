#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "host/app/tolerated_meshes.h"

namespace emax {

// What `decimate` came to under one of several tolerances.
struct CurveRow {
  ToleratedMesh bound;
  double epsilon;  // in the unit of the points
  bool feasible;   // otherwise nothing was written
  std::size_t triangles;
  double e_max;
};

// The picture of triangles over tolerances: part-curve.svg.
std::filesystem::path curve_path(const std::filesystem::path& output);

// As a table.
void print(std::span<const CurveRow> curve);

// Draws the picture and says so, where there are two meshes to draw.
void draw(std::span<const CurveRow> curve, const std::filesystem::path& picture);

// What goes to --json. `mesh`: the file that was decimated.
std::string to_json_text(std::span<const CurveRow> curve, const std::string& mesh);

}  // namespace emax
