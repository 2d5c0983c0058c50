#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".ply"); }

std::vector<std::string> seeds() {
  using namespace std::string_literals;
  return {tetrahedron(".ply"),
          "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\n"
          "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
          "property float nz\nelement face 1\nproperty list uchar int vertex_index\n"
          "property uchar red\nend_header\n"
          "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1e-3 0 0 0 1\n4 0 1 2 3 255\n",
          "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty char x\n"
          "property uchar y\nproperty char z\nelement tristrips 1\n"
          "property list ushort short vertex_indices\nend_header\n"
          "\0\0\0\1\0\0\0\1\0\1\1\0\0\4\0\0\0\1\0\2\0\3"s};
}

}  // namespace emax::fuzz
