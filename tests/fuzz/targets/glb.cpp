#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".glb"); }

std::vector<std::string> seeds() { return {tetrahedron(".glb")}; }

}  // namespace emax::fuzz
