#pragma once

#include "host/decimate/bounded_decimation.h"
#include "host/tiles/box_tree.h"
#include "host/tiles/tile.h"
#include "host/tiles/tile_points.h"

namespace emax {

// Decimation in tiles, for meshes that are too large to be decimated as a whole, and for many
// threads. A tile is a part of the mesh of about so many triangles. It is decimated with what is
// around it as it is, in bounds to the parts of the one fixed reference and of the cloud that are
// near it, so that errors do not add up. The seams between tiles stay; tiles of other places
// follow, whose inside the seams then are. Tiles that see nothing of each other are decimated at
// the same time. The result keeps what BoundedDecimator promises, and is the same for any number of
// threads.
//
// Time is that of the tiles, and O(n log n) to find what is near them. Memory is about 100 bytes a
// triangle of the reference, a bit a point, and for each thread what the decimation of a tile
// takes.
class TiledDecimator {
 public:
  // `reference` is as reference_surface() gives it. It, the points and the runner must outlive the
  // decimator.
  TiledDecimator(const TriangleMesh& reference, const TilePoints& points,
                 std::size_t triangles_of_a_tile, TileRunner& runner);

  // Points that are left out are given by their numbers. Throws as BoundedDecimator::run().
  DecimatedMesh run(const DecimationSettings& settings) const;

 private:
  class Run;
  const TriangleMesh& reference_;
  const TilePoints& points_;
  DataExtent extent_;
  TileRunner& runner_;
  std::size_t tile_;
  BoxTree reference_tree_;
};

}  // namespace emax
