#include "host/files/scan_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "host/files/input_file.h"
#include "host/files/sha256.h"
#include "host/files/spooled_input.h"
#include "sw_model/base/error.h"

namespace emax {
namespace fs = std::filesystem;

namespace {

// The points that the file of this cloud holds, those that were left out included.
std::uint64_t points_in_file(const PointCloud& cloud) {
  return std::accumulate(cloud.left_out.begin(), cloud.left_out.end(),
                         std::uint64_t{cloud.points.size()},
                         [](std::uint64_t sum, const LeftOut& part) { return sum + part.points; });
}

std::string unit_text(const std::optional<Unit>& unit) {
  return unit ? fmt::format("is in {}", unit->name) : "states no unit";
}

// Puts clouds one behind the other.
class Joined {
 public:
  void add(const std::string& name, PointCloud cloud) {
    const std::size_t begin = whole_.points.size();
    const bool has_normals = !cloud.normals.empty() && (begin == 0 || !whole_.normals.empty());
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      index_.push_back(static_cast<std::uint32_t>(points_ + cloud.index_in_file(i)));
    }
    whole_.points.insert(whole_.points.end(), cloud.points.begin(), cloud.points.end());
    whole_.normals.insert(whole_.normals.end(), cloud.normals.begin(), cloud.normals.end());
    if (!has_normals) whole_.normals.clear();
    if (cloud.scans.empty()) cloud.scans.push_back({});
    for (const ScanPart& scan : cloud.scans) {
      whole_.scans.push_back(
          {scan.name.empty() ? name : name + '/' + scan.name, begin + scan.begin});
    }
    for (const LeftOut& part : cloud.left_out) {
      const auto known = std::ranges::find(whole_.left_out, part.reason, &LeftOut::reason);
      known != whole_.left_out.end() ? void(known->points += part.points)
                                     : whole_.left_out.push_back(part);
    }
    whole_.unit = cloud.unit;
    whole_.resolution = std::max(whole_.resolution, cloud.resolution);
    points_ += points_in_file(cloud);
  }

  const PointCloud& whole() const { return whole_; }
  std::uint64_t points() const { return points_; }
  PointCloud finish() {
    if (!whole_.left_out.empty()) whole_.file_index = std::move(index_);
    return std::move(whole_);
  }

 private:
  PointCloud whole_;
  std::vector<std::uint32_t> index_;  // of each point among those of all files
  std::uint64_t points_ = 0;          // of all files
};

}  // namespace

std::vector<fs::path> scans_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    const bool is_cloud =
        std::ranges::find(cloud_endings(), format_ending(path)) != cloud_endings().end();
    if (is_cloud && entry.is_regular_file() && !path.filename().string().starts_with('.')) {
      files.push_back(path);
    }
  }
  std::ranges::sort(files, {}, [](const fs::path& path) { return path.filename().string(); });
  if (files.empty()) {
    throw Error(
        fmt::format("{}: is a folder in which no file is a cloud; name a file, or a folder "
                    "of scans",
                    folder.string()));
  }
  return files;
}

PointCloud read_scan_folder(const fs::path& folder, const CloudReadOptions& options) {
  Joined joined;
  const std::vector<fs::path> files = scans_in(folder);
  for (const fs::path& file : files) {
    PointCloud cloud = read_cloud(file, options);
    const std::optional<Unit>& unit = joined.whole().unit;
    if (file != files.front() && cloud.unit != unit) {
      throw Error(fmt::format("{}: {}, but {} {}; convert them to one unit", file.string(),
                              unit_text(cloud.unit), files.front().filename().string(),
                              unit_text(unit)));
    }
    if (points_in_file(cloud) > std::numeric_limits<std::uint32_t>::max() - joined.points()) {
      throw Error(
          fmt::format("{}: the folder has more points than 32-bit indices can name; split "
                      "the folder",
                      file.string()));
    }
    joined.add(file.filename().string(), std::move(cloud));
  }
  return joined.finish();
}

std::string sha256_of_folder(const fs::path& folder) {
  std::string lines;
  for (const fs::path& file : scans_in(folder)) {
    lines += fmt::format("{}  {}\n", sha256_of_file(file), file.filename().string());
  }
  return sha256(lines);
}

std::uint64_t bytes_of_input(const fs::path& path) {
  if (path == kStandardInput) return InputStream(path).size();
  if (!fs::is_directory(path)) return fs::file_size(path);
  const std::vector<fs::path> files = scans_in(path);
  return std::accumulate(
      files.begin(), files.end(), std::uint64_t{0},
      [](std::uint64_t sum, const fs::path& file) { return sum + fs::file_size(file); });
}

std::string name_of_input(const fs::path& path) {
  if (path.has_filename()) return path.filename().string();
  return path.parent_path().filename().string();
}

}  // namespace emax
