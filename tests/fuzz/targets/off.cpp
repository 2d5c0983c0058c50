#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".off"); }

std::vector<std::string> seeds() {
  return {tetrahedron(".off"),
          "CNOFF 4 1 0\n0 0 0 0 0 1 9 9 9\n1 0 0 0 0 1 9 9 9\n1 1 0 0 0 1 9 9 9\n"
          "0 1 0 0 0 1 9 9 9\n4 0 1 2 3 255 0 0\n"};
}

}  // namespace emax::fuzz
