#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".xyz"); }

std::vector<std::string> seeds() {
  return {"# c\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1e-3 0 0 0 1\n0 0 -1 1 0 0 // d\n",
          "0;0;0\n1;0;0\n0;1;0\n", "0, 0, 0\n1, 0, 0\n0, 1, 0\n"};
}

}  // namespace emax::fuzz
