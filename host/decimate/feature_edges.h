#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

// Schroeder's classes of a vertex (Schroeder, Zarge, Lorensen, "Decimation of Triangle Meshes",
// section 3.1). A feature edge is one over which the normals turn by more than the feature angle.
enum class VertexClass : std::uint8_t {
  kSimple,        // one closed fan of triangles, no feature edge
  kComplex,       // no fan: an edge of more than two triangles, or several fans
  kBoundary,      // one open fan
  kInteriorEdge,  // a closed fan with two feature edges: the feature passes through
  kCorner,        // with one feature edge or more than two: the feature ends or branches
};

// Feature edges of a mesh, kept through edge collapses. Only edges of the start become features: a
// surface that gets coarser turns more at its edges, but gets no new features. Each feature edge
// knows the vertices of the start's features that it stands for.
class FeatureEdges {
 public:
  FeatureEdges() = default;  // none
  // `angle` in degrees, over 0. Every used vertex is classified.
  // O(n log n) for vertices of few triangles.
  FeatureEdges(const TriangleMesh& mesh, double angle);

  bool empty() const { return edges_.empty(); }
  VertexClass vertex_class(std::uint32_t vertex) const {
    return vertex < classes_.size() ? classes_[vertex] : VertexClass::kSimple;
  }
  bool on(std::uint32_t a, std::uint32_t b) const { return edges_.contains(key(a, b)); }

  // Where an edge collapse that keeps the features may put its vertex: nowhere, anywhere, along the
  // feature that the edge is part of, or only at one of the edge's ends. A corner stays where it
  // is, a feature is only shortened along itself, and a vertex that is not on a feature may be
  // drawn into it.
  enum class Collapse { kForbidden, kAnywhere, kAlong, kAtFirst, kAtSecond };
  Collapse permitted(std::uint32_t a, std::uint32_t b) const;
  // Whether the vertices of the start's features stay within the distance of a feature edge when a
  // and b are drawn together at `at`. `positions` are those of the vertices.
  // O(vertices of the start that the features at a and b stand for).
  bool stays_near(std::uint32_t a, std::uint32_t b, const Point& at,
                  std::span<const Point> positions, double squared_distance) const;
  // Call this after b was drawn into a.
  void collapsed(std::uint32_t a, std::uint32_t b, std::span<const Point> positions);

  // Whether the vertex may not be relocated.
  bool fixed(std::uint32_t vertex) const { return on_feature(vertex) || beside_.contains(vertex); }

 private:
  // What is drawn into a vertex when a feature, or its end, is shortened: the other ends of the
  // feature edges there, each once, and the vertices of the start that they will stand for.
  struct Shortened {
    std::vector<std::uint32_t> ends;
    std::vector<Point> passed;
  };
  Shortened shorten(std::uint32_t a, std::uint32_t b) const;
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
  }
  bool on_feature(std::uint32_t v) const {
    return vertex_class(v) == VertexClass::kInteriorEdge || vertex_class(v) == VertexClass::kCorner;
  }

  std::vector<VertexClass> classes_;
  // The vertices of the start by feature edge, and the other ends of the feature edges by vertex.
  // Only looked up, never iterated over.
  std::unordered_map<std::uint64_t, std::vector<Point>> edges_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> beside_;
};

}  // namespace emax
