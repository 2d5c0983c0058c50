#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".3mf"); }

std::vector<std::string> seeds() { return {tetrahedron(".3mf")}; }

}  // namespace emax::fuzz
