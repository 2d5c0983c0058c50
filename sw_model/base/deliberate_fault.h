#pragma once

namespace emax {

// Faults that tests switch on, to show that a check sees them.
enum class Fault {
  kNone,
  // In the search for e_max in blocks.
  kSearchWithoutMargin,  // lower bounds are taken as exact
  kSearchDropsTies,      // groups that could hold a lower index are dropped
  // In the fixed-point filter.
  kFilterWithoutMargin,     // the filter's distance is taken as exact
  kFilterTrustsSaturated,   // a distance is trusted although its numbers may have left their range
  kFilterKeepsOldGreatest,  // points meet the greatest minimum of a search before
  kFilterDropsNearest,      // the kernel goes without triangles that may be nearest
  kFilterTrustsGreatest,    // a block is settled although its greatest result leaves points open
  // In the store of a board.
  kStoreTrustsOldItems,  // what was stored before counts as there
  kLogForgetsStored,     // a board that lost its store does not get it again
  // In the time of a board on its line.
  kAnswersLeaveAlone,        // each answer has a frame of its own
  kDataNotRepeated,          // a frame of the host is never answered by the data frame under way
  kSendsBeforeAcknowledged,  // a data frame does not wait until the one before is acknowledged
  // In the distance between surfaces.
  kCutsWithoutMargin,    // the rounding of cuts is not added
  kNearestOfEachCorner,  // a bound is taken from each corner's own nearest triangle
  kStopsEarly,           // the search ends after the first cut
  // In the decimator.
  kSkipsPoints,         // points may be beyond the limit
  kSkipsBackBound,      // the mesh may leave the reference
  kSkipsReference,      // the reference may leave the mesh
  kSkipsIntersections,  // triangles may meet
  kClosesWideHoles,     // what closes a hole on a plane may reach anywhere
  kForgetsPlanes,       // vertices do not stay on the planes that the mesh follows
  kForgetsThresholds,   // the planes of the thresholds before are taken for others
  kForgetsSpread,       // the error is not spread on planes where a candidate asks for it
  kForgetsTrueEdges,    // no edge of the mesh stands for a true one
  kForgetsRefused,      // an edge that was refused once is not collapsed later
  kTakesTangents,       // the plane that touches a curved surface is taken for it
  kGivesUpEarly,        // a race counts as lost that can still be won
  kMovesSeams,          // the surroundings of a tile may change
  kTrustsJoined,        // points that a joined one moved the mesh away from are not looked for
  // In the search for planes, cylinders and spheres.
  kCurvedIsPlane,    // a strip of a curved surface counts as a plane
  kFitsEveryNormal,  // a plane takes points whose neighbourhoods do not fit it
  // In the reconstruction from shapes.
  kSpansBeyondCurves,    // what curves cut off without a point of the shape stays
  kSpansAlikeAlongAxes,  // a cylinder is spanned no farther along its axis than around it
  // In the readers of files, messages and frames.
  kTrustsCounts,    // a count or length is not compared with the bytes that are there
  kTrustsIndices,   // an index is not compared with the number of vertices
  kKeepsInvalid,    // points that a file marks as invalid are kept
  kSkipsCrc,        // a CRC is not compared
  kTrustsPromises,  // the box that a stream promises is not compared with that of its points
  // In the measurement and the check of a mesh in parts.
  kForgetsParts,        // a point keeps its distance from the last part alone
  kForgetsPassedEdges,  // what the nodes of a range connect is not connected among lower ones
  kOneCellEach,         // a triangle is in the cell of space of its lower corner alone
  kForgetsReach,        // a mesh is compared with what lies in the same cell alone
  // In reports.
  kSideOfOneTriangle,    // the side of a mesh is taken from the nearest triangle's normal alone
  kPictureWithoutDepth,  // what is drawn first hides what is nearer
  kReportUnescaped,      // text of a report may end its element
};

#ifdef EMAX_DELIBERATE_FAULTS
#define EMAX_FAULT(name) (::emax::deliberate_fault == ::emax::Fault::name)
#else
#define EMAX_FAULT(name) false
#endif

// Only code that is compiled with EMAX_DELIBERATE_FAULTS reads this, and only tests link that code.
// Everywhere else EMAX_FAULT is false.
inline Fault deliberate_fault = Fault::kNone;

// The fault is switched on while this object lives.
class DeliberateFault {
 public:
  explicit DeliberateFault(Fault fault) { deliberate_fault = fault; }
  ~DeliberateFault() { deliberate_fault = Fault::kNone; }
  DeliberateFault(const DeliberateFault&) = delete;
  DeliberateFault& operator=(const DeliberateFault&) = delete;
};

}  // namespace emax
