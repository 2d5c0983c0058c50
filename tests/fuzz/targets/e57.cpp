#include "tests/fuzz/files.h"
#include "tests/support/scan_bytes.h"

namespace emax::fuzz {

// The input is the content of the pages, as a fuzzer does not find their checksums.
void read(Input input) {
  const std::string file =
      test::e57_pages({reinterpret_cast<const char*>(input.data()), input.size()});
  read_file(bytes_of(file), ".e57");
}

std::vector<std::string> seeds() { return {test::e57_content()}; }

}  // namespace emax::fuzz
