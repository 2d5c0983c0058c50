#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".stl"); }

std::vector<std::string> seeds() {
  return {tetrahedron(".stl"),
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
          "endloop\nendfacet\nendsolid a\n"};
}

}  // namespace emax::fuzz
