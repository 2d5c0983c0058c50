#include "host/tiles/cloud_partition.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "host/tiles/records.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::size_t kBuffered = 2048;  // points of a part

Eigen::Vector3f rounded(const Normalization& normalization, const Point& p) {
  return normalization.apply(p).cast<float>();
}

using nlohmann::json;

json numbers(const Point& p) { return {p.x(), p.y(), p.z()}; }

std::filesystem::path index_file(const std::filesystem::path& folder) {
  return folder / "parts.json";
}

// Appends points to the files of their parts.
class PartWriter {
 public:
  PartWriter(std::size_t parts, const std::function<std::filesystem::path(std::size_t)>& file_of)
      : buffers_(parts) {
    for (std::size_t part = 0; part < parts; ++part) {
      paths_.push_back(file_of(part));
      std::ofstream(paths_.back(), std::ios::binary | std::ios::trunc);
    }
    locks_ = std::make_unique<std::mutex[]>(parts);
  }

  void add(std::size_t part, const NumberedPoint& point) {
    const std::lock_guard lock(locks_[part]);
    buffers_[part].push_back(point);
    if (buffers_[part].size() == kBuffered) flush(part);
  }
  void finish() {
    for (std::size_t part = 0; part < buffers_.size(); ++part) flush(part);
  }

 private:
  void flush(std::size_t part) {
    errno = 0;
    std::ofstream file(paths_[part], std::ios::binary | std::ios::app);
    const std::string_view bytes = bytes_of_records(std::span<const NumberedPoint>(buffers_[part]));
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) {
      throw Error(
          fmt::format("{}: cannot be written: {}; the parts of a cloud need 32 bytes a "
                      "point beside the result, and as much again while it is made",
                      paths_[part].string(), std::strerror(errno)));
    }
    buffers_[part].clear();
  }

  std::vector<std::filesystem::path> paths_;
  std::vector<std::vector<NumberedPoint>> buffers_;
  std::unique_ptr<std::mutex[]> locks_;
};

SpacePartition cut_space(const CloudSource& source, std::uint64_t most_points) {
  SpaceCount count;
  source.for_each([&](std::span<const Point> points, std::uint64_t) {
    std::vector<SpaceCell> cells;
    cells.reserve(points.size());
    for (const Point& p : points) cells.push_back(space_cell(rounded(source.normalization, p)));
    count.add(cells);
  });
  return {count, most_points};
}

}  // namespace

CloudPartition::CloudPartition(const CloudSource& source, std::uint64_t most_points,
                               const std::filesystem::path& folder)
    : normalization_(source.normalization),
      folder_(folder),
      space_(cut_space(source, most_points)) {
  PartWriter writer(parts().size(), [&](std::size_t part) { return file_of(part); });
  source.for_each([&](std::span<const Point> points, std::uint64_t first) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      writer.add(part_of(rounded(normalization_, points[i])), {points[i], first + i});
    }
  });
  writer.finish();
  for (const SpacePartition::Part& part : parts()) points_ += part.points;
  json nodes, points;
  for (const SpacePartition::Node& n : space_.nodes()) {
    nodes.push_back({n.axis, n.plane, n.first, n.last});
  }
  for (const SpacePartition::Part& part : parts()) points.push_back(part.points);
  write_atomically(index_file(folder), json{{"origin", numbers(normalization_.origin)},
                                            {"scale", normalization_.scale},
                                            {"nodes", nodes},
                                            {"points", points}}
                                           .dump());
}

CloudPartition::CloudPartition(const std::filesystem::path& folder) : folder_(folder) {
  try {
    std::ifstream file(index_file(folder));
    const json index = json::parse(file);
    const json& origin = index.at("origin");
    normalization_ = {Point(origin.at(0), origin.at(1), origin.at(2)), index.at("scale")};
    std::vector<SpacePartition::Node> nodes;
    for (const json& n : index.at("nodes")) nodes.push_back({n.at(0), n.at(1), n.at(2), n.at(3)});
    space_ = SpacePartition(std::move(nodes), index.at("points").get<std::vector<std::uint64_t>>());
  } catch (const json::exception& error) {
    throw Error(index_file(folder).string() +
                ": does not tell the parts of a cloud: " + error.what());
  }
  for (const SpacePartition::Part& part : parts()) points_ += part.points;
}

bool CloudPartition::is_in(const std::filesystem::path& folder) {
  return exists(index_file(folder));
}

std::filesystem::path CloudPartition::file_of(std::size_t part) const {
  return folder_ / fmt::format("points-{}.bin", part);
}

void CloudPartition::for_each(
    std::size_t part, const std::function<void(std::span<const NumberedPoint>)>& take) const {
  read_records<NumberedPoint>(file_of(part), take);
}

std::vector<NumberedPoint> CloudPartition::read(std::size_t part, double halo) const {
  const SpacePartition::Part& wanted = parts()[part];
  std::vector<NumberedPoint> found;
  for (std::size_t other = 0; other < parts().size(); ++other) {
    if (!are_within(wanted, parts()[other], halo)) continue;
    for_each(other, [&](std::span<const NumberedPoint> piece) {
      for (const NumberedPoint& p : piece) {
        const Eigen::Vector3d at = rounded(normalization_, p.position).cast<double>();
        if (other == part || squared_distance_from(wanted, at) <= halo * halo) found.push_back(p);
      }
    });
  }
  std::ranges::sort(found, {}, &NumberedPoint::number);
  return found;
}

std::vector<NumberedPoint> thinned(std::vector<NumberedPoint> points,
                                   const Normalization& normalization, double side) {
  if (side <= 0) return points;
  std::set<std::array<double, 3>> taken;
  std::erase_if(points, [&](const NumberedPoint& p) {
    const Eigen::Array3d cube = (normalization.apply(p.position).array() / side).floor();
    return !taken.insert({cube.x(), cube.y(), cube.z()}).second;
  });
  return points;
}

double squared_distance_from(const SpacePartition::Part& part, const Eigen::Vector3d& normalised) {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double beyond = 0;
    if (part.first[axis] > 0) {
      beyond = std::max(beyond, space_plane(part.first[axis]) - normalised[axis]);
    }
    if (part.last[axis] < kSpaceCells) {
      beyond = std::max(beyond, normalised[axis] - space_plane(part.last[axis]));
    }
    squared += beyond * beyond;
  }
  return squared;
}

double depth_within(const SpacePartition::Part& part, const Eigen::Vector3d& normalised) {
  double depth = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (part.first[axis] > 0) {
      depth = std::min(depth, normalised[axis] - space_plane(part.first[axis]));
    }
    if (part.last[axis] < kSpaceCells) {
      depth = std::min(depth, space_plane(part.last[axis]) - normalised[axis]);
    }
  }
  return depth;
}

bool are_within(const SpacePartition::Part& a, const SpacePartition::Part& b, double distance) {
  for (int axis = 0; axis < 3; ++axis) {
    if (space_plane(a.first[axis]) - space_plane(b.last[axis]) > distance) return false;
    if (space_plane(b.first[axis]) - space_plane(a.last[axis]) > distance) return false;
  }
  return true;
}

}  // namespace emax
