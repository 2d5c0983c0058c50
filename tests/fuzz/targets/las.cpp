#include "tests/fuzz/files.h"
#include "tests/support/scan_bytes.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".las"); }

std::vector<std::string> seeds() {
  return {test::las_bytes({{0, 0, 0, 1}, {100, 5, -7, 2}, {3, 900, 2, 0}})};
}

}  // namespace emax::fuzz
