#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".pts"); }

std::vector<std::string> seeds() {
  return {"4\n0 0 0 7 1 2 3\n1 0 0 7 1 2 3\n0 1 0 7 1 2 3\n0 0 1 7 1 2 3\n",
          "0,0,0\n1,0,0\n0,1,0\n"};
}

}  // namespace emax::fuzz
