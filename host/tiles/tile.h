#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// A part of a mesh that is decimated by itself: its free triangles, and around them those that
// stay.
struct Tile {
  TriangleMesh mesh;                    // free triangles first
  std::size_t free = 0;                 // how many
  std::vector<std::uint32_t> vertices;  // the number in the whole mesh of each of its vertices
  TriangleMesh reference;               // the first `covered` triangles are to stay near the mesh
  std::size_t covered = 0;
  std::vector<Point> points;                 // of the cloud
  std::vector<std::uint32_t> point_numbers;  // in the whole cloud
};

// What takes the place of a tile's free triangles. Vertices from `vertices.size()` of the tile on
// are new.
struct DecimatedTile {
  std::vector<Point> added;  // new vertices
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> left_out;  // points, by their number in the whole cloud
  bool interrupted = false;
};

// Where tiles are decimated that see nothing of each other.
class TileRunner {
 public:
  virtual ~TileRunner() = default;

  using MakeTile = std::function<Tile(std::size_t)>;
  using Advanced = std::function<void(std::size_t, double)>;  // a tile, and the share of it
  // decimate_tile(make(i), settings) for each i below `count`, in their order. `make` may be called
  // by several threads, for each tile once; settings.interrupted and `advanced` by one at a time.
  virtual std::vector<DecimatedTile> run(std::size_t count, const MakeTile& make,
                                         const DecimationSettings& settings,
                                         const Advanced& advanced) = 0;
};

// On this processor, with settings.threads threads.
class LocalTiles final : public TileRunner {
 public:
  std::vector<DecimatedTile> run(std::size_t count, const MakeTile& make,
                                 const DecimationSettings& settings,
                                 const Advanced& advanced) override;
};

// Decimates the free triangles and leaves the others as they are, with all their vertices. Throws
// std::logic_error if the decimator does not.
DecimatedTile decimate_tile(const Tile& tile, DecimationSettings settings);

}  // namespace emax
