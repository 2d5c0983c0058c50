#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".ptx"); }

std::vector<std::string> seeds() {
  return {
      "1\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n1 2 3 1\n"
      "1 0 0 0.5\n0 0 0 0.5\n0 2 3 0.25\n"};
}

}  // namespace emax::fuzz
