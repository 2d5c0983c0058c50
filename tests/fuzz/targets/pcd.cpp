#include <liblzf/lzf.h>

#include <cstring>

#include "tests/fuzz/files.h"

namespace emax::fuzz {
namespace {

std::string header(const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ normal_x normal_y normal_z\nSIZE 4 4 4 1 4 4 4\n"
         "TYPE F F F U F F F\nCOUNT 1 1 1 4 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\n"
         "POINTS 4\nDATA " +
         data + "\n";
}

// Four points.
std::string values() {
  std::string bytes(4 * 28, '\0');
  for (std::size_t i = 0; i < 4; ++i) {
    const float x = static_cast<float>(i);
    std::memcpy(&bytes[28 * i], &x, sizeof x);
  }
  return bytes;
}

std::string compressed() {
  const std::string from = values();
  std::string to(from.size(), '\0');
  const auto full = static_cast<unsigned>(from.size());
  const std::uint32_t sizes[2] = {lzf_compress(from.data(), full, to.data(), full), full};
  return header("binary_compressed") +
         std::string(reinterpret_cast<const char*>(sizes), sizeof sizes) + to.substr(0, sizes[0]);
}

}  // namespace

void read(Input input) { read_file(input, ".pcd"); }

std::vector<std::string> seeds() {
  return {
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4\nHEIGHT 1\nDATA ascii\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
      header("binary") + values(), compressed()};
}

}  // namespace emax::fuzz
