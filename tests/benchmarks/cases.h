#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// A cloud and a mesh to measure it against.
struct BenchmarkCase {
  std::string name;  // also the name of files
  std::string text;  // what both are, half a sentence
  std::vector<Point> cloud;
  TriangleMesh mesh;
};

// Meshes that an optimization would evaluate one after the other on one cloud.
struct SequenceCase {
  std::string name, text;
  std::vector<Point> cloud;
  std::vector<TriangleMesh> meshes;
};

struct CaseFolders {
  std::filesystem::path data;   // bunny00.off, building.ply, dragon.ply
  std::filesystem::path cache;  // of meshes that take long to make; made when it is not there
};

// Greedy projection with the standard values, as an optimization begins; `name` is the file's.
TriangleMesh reconstructed(const CaseFolders& folders, const std::string& name,
                           std::span<const Point> cloud);

// The bunny, the dragon and the building against decimated meshes, and slivers; the first alone
// when `quick`. Throws Error when a scan is missing.
std::vector<BenchmarkCase> search_cases(const CaseFolders& folders, bool quick);

std::vector<SequenceCase> sequence_cases(const CaseFolders& folders, bool quick);

// `points` points of the dragon's surface, spread by area, and its mesh decimated to one triangle
// for kScalingRatio points. Every call gives the same. At most 10^7 points.
constexpr std::size_t kScalingRatio = 20;
BenchmarkCase surface_case(const CaseFolders& folders, std::size_t points);

// The dragon's vertices and its mesh decimated to about so many triangles.
BenchmarkCase dragon_case(const CaseFolders& folders, std::size_t triangles);

}  // namespace emax::benchmarks
