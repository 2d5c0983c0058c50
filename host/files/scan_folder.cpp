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

std::uint64_t left_out_points(const PointCloud& cloud) {
  return std::accumulate(cloud.left_out.begin(), cloud.left_out.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const LeftOut& part) { return sum + part.points; });
}

std::string unit_text(const std::optional<Unit>& unit) {
  return unit ? fmt::format("is in {}", unit->name) : "states no unit";
}

// What the clouds of a folder say beside their points.
class JoinedFacts {
 public:
  explicit JoinedFacts(std::string first) : first_(std::move(first)) {}

  // `kept`: the points of the file that are not left out.
  void add(const fs::path& file, const PointCloud& cloud, std::uint64_t kept) {
    if (points_ > 0 && cloud.unit != whole_.unit) {
      throw Error(fmt::format("{}: {}, but {} {}; convert them to one unit", file.string(),
                              unit_text(cloud.unit), first_, unit_text(whole_.unit)));
    }
    const std::uint64_t points = kept + left_out_points(cloud);
    if (points > std::numeric_limits<std::uint32_t>::max() - points_) {
      throw Error(
          fmt::format("{}: the folder has more points than 32-bit indices can name; split "
                      "the folder",
                      file.string()));
    }
    for (const LeftOut& part : cloud.left_out) {
      const auto known = std::ranges::find(whole_.left_out, part.reason, &LeftOut::reason);
      known != whole_.left_out.end() ? void(known->points += part.points)
                                     : whole_.left_out.push_back(part);
    }
    whole_.unit = cloud.unit;
    whole_.resolution = std::max(whole_.resolution, cloud.resolution);
    points_ += points;
  }

  std::uint64_t points() const { return points_; }  // of all files so far
  PointCloud finish() { return std::move(whole_); }

 private:
  std::string first_;
  PointCloud whole_;
  std::uint64_t points_ = 0;
};

// Puts clouds one behind the other.
class Joined {
 public:
  // `before`: the points of the files before.
  void add(const std::string& name, PointCloud cloud, std::uint64_t before) {
    const std::size_t begin = whole_.points.size();
    const bool has_normals = !cloud.normals.empty() && (begin == 0 || !whole_.normals.empty());
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      index_.push_back(static_cast<std::uint32_t>(before + cloud.index_in_file(i)));
    }
    whole_.points.insert(whole_.points.end(), cloud.points.begin(), cloud.points.end());
    whole_.normals.insert(whole_.normals.end(), cloud.normals.begin(), cloud.normals.end());
    if (!has_normals) whole_.normals.clear();
    if (cloud.scans.empty()) cloud.scans.push_back({});
    for (const ScanPart& scan : cloud.scans) {
      whole_.scans.push_back(
          {scan.name.empty() ? name : name + '/' + scan.name, begin + scan.begin});
    }
  }

  PointCloud finish(PointCloud facts) {
    whole_.left_out = std::move(facts.left_out);
    whole_.unit = facts.unit;
    whole_.resolution = facts.resolution;
    if (!whole_.left_out.empty()) whole_.file_index = std::move(index_);
    return std::move(whole_);
  }

 private:
  PointCloud whole_;
  std::vector<std::uint32_t> index_;  // of each point among those of all files
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
  const std::vector<fs::path> files = scans_in(folder);
  JoinedFacts facts(files.front().filename().string());
  Joined joined;
  for (const fs::path& file : files) {
    PointCloud cloud = read_cloud(file, options);
    const std::uint64_t before = facts.points();
    facts.add(file, cloud, cloud.points.size());
    joined.add(file.filename().string(), std::move(cloud), before);
  }
  return joined.finish(facts.finish());
}

PointCloud read_scan_folder_in_pieces(const fs::path& folder, const CloudReadOptions& options,
                                      std::size_t piece_points,
                                      const std::function<void(PointCloud)>& take,
                                      const PieceChoice& choice) {
  const std::vector<fs::path> files = scans_in(folder);
  JoinedFacts facts(files.front().filename().string());
  for (const fs::path& file : files) {
    const auto before = static_cast<std::uint32_t>(facts.points());
    std::uint64_t kept = 0;
    const auto give = [&](PointCloud piece) {
      piece.first_index += before;
      for (std::uint32_t& index : piece.file_index) index += before;
      kept += piece.points.size() + piece.unwanted;
      take(std::move(piece));
    };
    const PointCloud rest = read_cloud_in_pieces(file, options, piece_points, give, choice);
    facts.add(file, rest, kept);
  }
  return facts.finish();
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
