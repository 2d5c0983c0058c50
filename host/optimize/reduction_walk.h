#pragma once

#include <cstddef>
#include <optional>

namespace emax {

// How far one surface may be decimated: looks, along a gene of which the triangles fall and the
// violation rises, for the greatest value that keeps the constraints. The lower end comes first; a
// surface that breaks them there, decimated not at all, is hopeless, and its violation is the floor
// that no decimation can lower. Then the violation's zero is enclosed by secants, kept off the ends
// of the bracket, until the bracket is not worth a trial or the trials are spent. Where the
// violation is not quite monotone this costs triangles, never a wrong result.
class ReductionWalk {
 public:
  static constexpr int kMostTrials = 8;

  ReductionWalk(double lower, double upper) : lower_(lower), upper_(upper) {}

  // The value to try; none when the walk has ended. The same until the trial is told.
  std::optional<double> next() const;
  // What came of next(). A failed trial counts as one that breaks the constraints.
  void told(bool evaluated_ok, std::size_t triangles, double violation);

 private:
  double lower_, upper_;  // the bracket: the greatest value that holds, the least above that breaks
  std::optional<double> violation_below_, violation_above_;  // at its ends, once tried
  std::size_t triangles_below_ = 0, triangles_above_ = 0;
  int trials_ = 0;
  bool hopeless_ = false;
};

}  // namespace emax
