#pragma once

#include <cstdint>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// A cloud as it was read: 64-bit coordinates in the file's unit, points in file order.
struct PointCloud {
  std::vector<Point> points;
  std::vector<Point> normals;             // empty, or one per point
  std::vector<std::uint32_t> file_index;  // empty, or each point's index in the file when invalid
                                          // points were skipped

  std::uint32_t index_in_file(std::size_t i) const {
    return file_index.empty() ? static_cast<std::uint32_t>(i) : file_index[i];
  }
};

}  // namespace emax
