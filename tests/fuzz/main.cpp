// libFuzzer's entries for a target.
//
//   fuzz_<target> --write-seeds=FOLDER    writes the target's seeds, each once the reader took it
//   fuzz_<target> [libFuzzer's arguments]
//
// With EMAX_FUZZ_FAULT the reader has that deliberate fault, which fuzzing must find.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "tests/fuzz/target.h"

namespace emax::fuzz {
namespace {

void write_seeds(const std::filesystem::path& folder) {
  std::size_t number = 0;
  for (const std::string& seed : seeds()) {
    read(bytes_of(seed));
    std::ofstream(folder / std::to_string(number++), std::ios::binary) << seed;
  }
}

}  // namespace

Input bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void require(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: this does not hold: %.*s\n", static_cast<int>(what.size()),
               what.data());
  std::abort();
}

}  // namespace emax::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view kWriteSeeds = "--write-seeds=";
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (!argument.starts_with(kWriteSeeds)) continue;
    emax::fuzz::write_seeds(argument.substr(kWriteSeeds.size()));
    std::exit(0);
  }
#ifdef EMAX_FUZZ_FAULT
  emax::deliberate_fault = emax::Fault::EMAX_FUZZ_FAULT;
#endif
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    emax::fuzz::read({bytes, size});
  } catch (const emax::Error& error) {
    const std::string_view message = error.what();
    emax::fuzz::require(message.find('\n') == message.npos, "an error is one line");
  }
  return 0;
}
