#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "host/tiles/space_partition.h"
#include "sw_model/base/mesh_view.h"
#include "sw_model/model/normalization.h"

namespace emax {

// A cloud that may be larger than the memory.
struct CloudSource {
  using Take = std::function<void(std::span<const Point> points, std::uint64_t first)>;

  Normalization normalization;
  // Gives all points to `take`, in pieces in any order and, maybe, on several threads; `first` is
  // the number of a piece's first point. Called twice.
  std::function<void(const Take&)> for_each;
};

struct NumberedPoint {
  Point position;
  std::uint64_t number;  // in the cloud
};

// Of the points in each cube of a grid the first, where `side` is the cubes', normalised; all where
// it is 0. So no region stays denser than about a point in each square of the side. O(n).
std::vector<NumberedPoint> thinned(std::vector<NumberedPoint> points,
                                   const Normalization& normalization, double side);

// A cloud in files, one for each part of space (SpacePartition), so that a part can be read with
// what is around it. One pass over the cloud counts, a second one writes 32 bytes a point. Of the
// memory it takes 64 KB a part, and less than 100 MB to count.
class CloudPartition {
 public:
  // Writes into `folder`, which exists. Throws Error, if the disk is full too.
  CloudPartition(const CloudSource& source, std::uint64_t most_points,
                 const std::filesystem::path& folder);
  // Of what another one wrote there. Throws Error if it did not end.
  explicit CloudPartition(const std::filesystem::path& folder);
  static bool is_in(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  const Normalization& normalization() const { return normalization_; }
  std::span<const SpacePartition::Part> parts() const { return space_.parts(); }
  std::uint64_t points() const { return points_; }
  // Which part a point belongs to. Points that are equal once they are normalised and rounded to
  // binary32 belong to the same.
  std::size_t part_of(const Eigen::Vector3f& normalised) const {
    return space_.part_of(space_cell(normalised));
  }
  // The points of a part, and those around it whose normalised distance from its cells is at most
  // `halo`, in the order of their numbers.
  std::vector<NumberedPoint> read(std::size_t part, double halo) const;
  // Gives the points of a part alone to `take`, in pieces, in the order in which they were written.
  void for_each(std::size_t part,
                const std::function<void(std::span<const NumberedPoint>)>& take) const;

 private:
  std::filesystem::path file_of(std::size_t part) const;

  Normalization normalization_;
  std::filesystem::path folder_;
  SpacePartition space_;
  std::uint64_t points_ = 0;
};

// The squared distance of a normalised point from the cells of a part.
double squared_distance_from(const SpacePartition::Part& part, const Eigen::Vector3d& normalised);
// The distance of a normalised point within a part from the nearest plane that cuts it off;
// infinite without one.
double depth_within(const SpacePartition::Part& part, const Eigen::Vector3d& normalised);
// Whether cells of the two are no farther apart than that along any axis.
bool are_within(const SpacePartition::Part& a, const SpacePartition::Part& b, double distance);

}  // namespace emax
