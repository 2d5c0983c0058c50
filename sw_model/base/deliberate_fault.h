#pragma once

namespace emax {

// What tests break on purpose, to show that a check sees it.
enum class Fault {
  kNone,
  kSearchWithoutMargin,  // of e_max in blocks: lower bounds are taken as exact
  kSearchDropsTies,      // and groups that could hold a lower index are dropped
  kCutsWithoutMargin,    // of the distance between surfaces: the rounding of cuts is forgotten
  kNearestOfEachCorner,  // and a bound is taken from each corner's own nearest triangle
  kStopsEarly,           // and the search ends after the first cut
  kSkipsPoints,          // of the decimator: points may be beyond the limit
  kSkipsBackBound,       // the mesh may leave the reference
  kSkipsReference,       // the reference may leave the mesh
  kSkipsIntersections,   // triangles may meet
};

#ifdef EMAX_DELIBERATE_FAULTS
#define EMAX_FAULT(name) (::emax::deliberate_fault == ::emax::Fault::name)
#else
#define EMAX_FAULT(name) false
#endif

// Read by code that is compiled with EMAX_DELIBERATE_FAULTS, which tests alone link; for everything
// else EMAX_FAULT is false.
inline Fault deliberate_fault = Fault::kNone;

// The fault is there while this lives.
class DeliberateFault {
 public:
  explicit DeliberateFault(Fault fault) { deliberate_fault = fault; }
  ~DeliberateFault() { deliberate_fault = Fault::kNone; }
  DeliberateFault(const DeliberateFault&) = delete;
  DeliberateFault& operator=(const DeliberateFault&) = delete;
};

}  // namespace emax
