// dump_cloud FILE [CLASS...]: reads a cloud as emax does and writes it to standard output: a line
// of JSON about it, then the coordinates as 64-bit numbers. With --skip-invalid before FILE it
// leaves out points that are not finite. An Error goes to standard error; the exit code is then 1.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "host/files/cloud_file.h"
#include "sw_model/base/error.h"

namespace {

int dump(int count, char** arguments) {
  emax::CloudReadOptions options;
  int at = 1;
  if (at < count && std::strcmp(arguments[at], "--skip-invalid") == 0) {
    options.skip_invalid = true;
    ++at;
  }
  const char* const file = arguments[at];
  for (++at; at < count; ++at) {
    options.left_out_classes.push_back(static_cast<std::uint8_t>(std::atoi(arguments[at])));
  }
  const emax::PointCloud cloud = emax::read_cloud(file, options);
  std::string scans;
  for (const emax::ScanPart& scan : cloud.scans) {
    scans += fmt::format("{}[\"{}\", {}]", scans.empty() ? "" : ", ", scan.name, scan.begin);
  }
  fmt::print(
      "{{\"points\": {}, \"unit\": \"{}\", \"resolution\": {}, \"scans\": [{}], "
      "\"left_out\": \"{}\", \"last_index\": {}}}\n",
      cloud.points.size(), cloud.unit ? cloud.unit->name : "", cloud.resolution, scans,
      emax::describe(cloud.left_out), cloud.index_in_file(cloud.points.size() - 1));
  for (const emax::Point& p : cloud.points) std::fwrite(p.data(), sizeof(double), 3, stdout);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  try {
    return dump(count, arguments);
  } catch (const emax::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
