#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".obj"); }

std::vector<std::string> seeds() {
  return {tetrahedron(".obj"),
          "# c\nmtllib a.mtl\nv 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nvt 0 0\nvn 0 0 1\n"
          "g a\nusemtl b\ns 1\nf 1/1/1 2/1/1 3/1/1\nf -3//1 -1//1 -2//1\n"};
}

}  // namespace emax::fuzz
