#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// One call of a tool, and how far the cloud is from what it gave.
struct Trial {
  TriangleMesh mesh;
  double seconds = 0;
  double error = 0;
  std::string failure = {};  // what the tool threw, if it did
};

// A tool with its options, called with a coarseness in [0, 1]: 0 asks for the finest mesh.
using Attempt = std::function<Trial(double coarseness)>;

// The coarseness as a tool's own parameter, from its finest to its coarsest value in equal ratios.
double parameter_at(double coarseness, double finest, double coarsest);
// And back, within [0, 1].
double coarseness_at(double parameter, double finest, double coarsest);

struct BisectionSettings {
  double limit = 0;  // the greatest error that passes
  int steps = 10;    // of a scan from 1 to 0
  double start = 1;  // where it begins
  double width = 0;  // the bisection ends when its bracket is as narrow,
  double share = 0;  // or the triangles of its ends differ by no more than this share, or by one
  std::optional<std::size_t> beat = {};  // it also ends when no fewer triangles than this can come
};

struct Found {
  std::optional<Trial> best;  // the fewest triangles of all calls that pass; nothing if none does
  double coarseness = 0;      // of the best
  int calls = 0;
  double seconds = 0;  // of all calls
  double least_error;  // of all calls
};

// The fewest triangles within the limit. Errors of real tools are not monotone, so the coarsest
// step of a scan that passes is taken, coarsest first, then bisected with the coarser step that did
// not; then some coarser ones near the result are tried, again from each that passes.
Found fewest_within(const Attempt& attempt, const BisectionSettings& settings);

}  // namespace emax::benchmarks
