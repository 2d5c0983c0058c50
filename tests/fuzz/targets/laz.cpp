#include "tests/fuzz/files.h"

namespace emax::fuzz {

void read(Input input) { read_file(input, ".laz"); }

std::vector<std::string> seeds() {
  const std::filesystem::path folder(EMAX_TEST_DATA);
  return {test::bytes_of(folder / "written_by_laspy_2.7_format_1.laz"),
          test::bytes_of(folder / "written_by_laspy_2.7_format_7.laz")};
}

}  // namespace emax::fuzz
