#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".dxf"); }

std::vector<std::string> seeds() { return {tetrahedron(".dxf")}; }

}  // namespace emax::fuzz
