#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/geometry/unit.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// Points of a cloud that the file holds and the reader left out.
struct LeftOut {
  std::string reason;  // as "empty cells"
  std::uint64_t points = 0;
};

// One of several scans in a file.
struct ScanPart {
  std::string name;       // empty where the file gives none
  std::size_t begin = 0;  // its first point; it ends where the next scan begins
};

// A cloud as it was read: 64-bit coordinates in the file's unit, points in file order.
struct PointCloud {
  std::vector<Point> points;
  std::vector<Point> normals;             // empty, or one per point
  std::vector<std::uint32_t> file_index;  // empty, or each point's index in the file when some
                                          // points were left out
  std::vector<ScanPart> scans = {};       // empty for formats without scans
  std::vector<LeftOut> left_out = {};     // by reason, each at least one point
  std::optional<Unit> unit = {};          // nothing where the file does not state it
  // The farthest that rounding to the numbers of the file may have moved a point. It is 0 where the
  // numbers have 64 bits, and for text and meshes, where it is not known.
  double resolution = 0;
  // The index in the file of the first point where file_index is empty: not 0 in a piece of a
  // cloud.
  std::uint32_t first_index = 0;
  // Of a piece that was not wanted: the number of its points, none of which is given.
  std::uint64_t unwanted = 0;

  std::uint32_t index_in_file(std::size_t i) const {
    return file_index.empty() ? first_index + static_cast<std::uint32_t>(i) : file_index[i];
  }
};

}  // namespace emax
