#include "tests/benchmarks/foreign_peers.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/files/atomic_file.h"
#include "sw_model/base/error.h"

namespace emax::benchmarks {
namespace {

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

void write_case(const std::filesystem::path& folder, std::span<const Vector3<float>> points,
                std::span<const Vector3<float>> vertices, std::span<const Triangle> triangles) {
  static_assert(sizeof(Vector3<float>) == 3 * sizeof(float));
  std::filesystem::create_directories(folder);
  write_atomically(folder / "points.f32", bytes_of(points));
  write_atomically(folder / "vertices.f32", bytes_of(vertices));
  write_atomically(folder / "triangles.i32", bytes_of(triangles));
}

std::string measure_foreign_peers(const std::string& command, const std::filesystem::path& folder,
                                  std::span<const SearchGroup> searches) {
  const auto none = [&](const std::string& why) {
    for (const SearchGroup& search : searches) {
      for (const char* way : {kOpen3d, kFcpw}) search.group->not_measured(way, why);
    }
    return "Open3D and FCPW not measured: " + why;
  };
  if (command.empty()) return none("the Python packages could not be installed");
  const std::filesystem::path file = folder / "peers.json";
  std::filesystem::remove(file);
  std::string line = command + " --output " + file.string();
  for (const SearchGroup& search : searches) line += " " + (folder / search.name).string();
  // The command comes from the caller's own command line.
  if (std::system(line.c_str()) != 0 || !std::filesystem::exists(file)) {
    return none("the script of the Python peers failed");
  }
  const nlohmann::json results = nlohmann::json::parse(std::ifstream(file));
  for (const SearchGroup& search : searches) {
    for (const auto& [peer, way] : {std::pair{"open3d", kOpen3d}, std::pair{"fcpw", kFcpw}}) {
      const nlohmann::json& result = results.at("cases").at(search.name).at(peer);
      if (result.contains("failure")) {
        search.group->not_measured(way, result.at("failure").get<std::string>());
        continue;
      }
      const double theirs = result.at("e_max").get<double>();
      if (std::abs(theirs - search.e_max) > search.tolerance) {
        throw Error(fmt::format("{}: e_max is {} by the search, {} by {}; find out which is wrong",
                                search.name, search.e_max, theirs, peer));
      }
      search.group->record(way, result.at("seconds").get<double>());
    }
  }
  return results.at("versions").get<std::string>();
}

}  // namespace emax::benchmarks
