#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/benchmarks/cases.h"

namespace emax::benchmarks {

// What every tool starts from: a mesh that all of them accept, within half of epsilon of every
// point of the cloud.
struct DecimationScan {
  std::string text;  // what it is, half a sentence
  double width, epsilon;
  std::vector<Point> cloud;  // without the points that could not be joined to the mesh
  std::size_t left_out = 0;
  TriangleMesh start;
  double start_seconds = 0;                           // to make it of the mesh at hand
  bool sharp = false;                                 // its sharp edges are to be kept
  std::function<double(const Point&)> true_distance;  // to the surface that was scanned, if known
};

// bunny, dragon, fandisk: a mesh and its vertices; building: a cloud and its greedy projection;
// torus: a synthetic scan with noise; smooth-torus, sphere, ellipsoid: without noise; NAME.off:
// this file of the folder meshes/ and its vertices. Epsilon in percent of the width. Throws Error
// when there is no such scan or its file is missing.
DecimationScan decimation_scan(const CaseFolders& folders, std::string_view name, double percent);

// The torus with other points: about so many, little noise.
DecimationScan smooth_torus(std::size_t points, double percent);

}  // namespace emax::benchmarks
