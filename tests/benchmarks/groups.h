#pragma once

#include "tests/benchmarks/cases.h"
#include "tests/benchmarks/measurement.h"

namespace emax::benchmarks {

// Every form of the squared distance of a pair, with the points in random order (first group) and
// with neighbours in a row (second).
constexpr const char* kEricsonFloat = "Ericson from the corners, float";
constexpr const char* kLiteral = "the paper's literal (u, v) form, float";
constexpr const char* kVisibleEdge = "visible-edge form (the kernel's), float";
std::string simd_way(std::string_view target);
void add_pair_groups(Groups& groups);

// A case of the search with its group of ways.
struct SearchGroup {
  std::string name;
  std::size_t points, triangles;
  double e_max;      // normalised
  double percent;    // e_max of the cloud's width
  double tolerance;  // by which the e_max of a peer in float may differ, normalised
  double bytes_per_point, bytes_per_triangle;  // that the engine keeps
  bool scan;                                   // not made for the benchmark
  Group* group;
};
constexpr const char* kCold = "emax: e_max, mesh prepared and queried";
constexpr const char* kColdExact = "emax: every point's distance, mesh prepared and queried";
// The same on another target than the best.
std::string cold_way(std::string_view target);
constexpr const char* kEarlyStop = "Embree with our own early stop: e_max, build and query";
constexpr const char* kOpen3d = "Open3D RaycastingScene, build and query";
constexpr const char* kFcpw = "FCPW, build and query";

// e_max and its sister questions beside the peers, and the cases as files in the cache for foreign
// peers. Throws Error when the ways disagree.
std::vector<SearchGroup> add_search_groups(Groups& groups, const CaseFolders& folders, bool quick);

// Warm and cold along sequences of meshes.
void add_sequence_groups(Groups& groups, const CaseFolders& folders, bool quick);

// One thread and two on the dragon, by the clock on the wall.
void add_thread_groups(Groups& groups, const CaseFolders& folders);

// How time grows with a size: each group has one way for each size in `at`.
struct Curve {
  std::string name, axis, unit;
  std::vector<double> at;
  std::vector<std::pair<std::string, Group*>> lines;
};

// The cost of a point from 10^4 to 10^7 points at a fixed ratio of triangles, and the time for the
// dragon's points against meshes of 10^3 to 10^5.6 triangles.
std::vector<Curve> add_scaling_groups(Groups& groups, const CaseFolders& folders);

}  // namespace emax::benchmarks
