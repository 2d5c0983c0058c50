#include "tests/host/worker/test_methods.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "host/worker_pool/message.h"
#include "sw_model/base/error.h"

namespace emax::test {
namespace {

void write_raw(int channel, const Bytes& bytes) {
  if (write(channel, bytes.data(), bytes.size()) < 0) _exit(1);
}

[[noreturn]] void hang() {
  while (true) pause();
}

}  // namespace

void run_test_method(const ChainSettings& settings, int channel) {
  const int fault = settings.parameters.find(kFault).value_or(0);
  constexpr std::array<const char*, 5> kFaults = {"", "test.crash", "test.hang", "test.memory",
                                                  "test.garbage"};
  const bool faulty = fault > 0 && fault < static_cast<int>(kFaults.size());
  const std::string method = faulty ? kFaults[static_cast<std::size_t>(fault)] : settings.method;
  if (method == "test.crash") std::abort();
  if (method == "test.exit") _exit(3);
  if (method == "test.hang") hang();
  if (method == "test.memory") {
#ifdef EMAX_UNLIMITED_ADDRESS_SPACE  // no limit would end this but the machine's memory
    throw std::bad_alloc();
#endif
    std::vector<std::unique_ptr<std::vector<char>>> kept;
    while (true) kept.push_back(std::make_unique<std::vector<char>>(std::size_t{1} << 26, 'x'));
  }
  if (method == "test.garbage") {
    write_raw(channel, {5, 0, 0, 0, 0, 0, 0, 0, 0xff, 1, 2, 3, 4});
    hang();
  }
  if (method == "test.huge") {
    write_raw(channel, Bytes(64, 0xee));
    hang();
  }
  if (method == "test.strange") {
    write_raw(channel, encode(MeshMessage{~std::uint64_t{0}, {}}));
    hang();
  }
  if (method == "test.trickle") {
    write_raw(channel, {100, 0, 0, 0, 0, 0, 0, 0});
    while (true) {
      usleep(200'000);
      write_raw(channel, {0});
    }
  }
  if (method == "test.flood") {
    while (true) write_raw(channel, Bytes(1 << 16, 0xee));
  }
  if (method == "test.nested") {
    Bytes message(8 + 200'000, 0x81);
    const std::uint64_t length = message.size() - 8;
    std::memcpy(message.data(), &length, 8);
    write_raw(channel, message);
    hang();
  }
  static int runs = 0;
  ++runs;
  if (runs > 1 && method == "test.full") throw std::bad_alloc();
  if (runs > 1 && method == "test.null") std::abort();
  if (method == "test.print") {
    std::puts("a library prints this");
    std::fflush(stdout);
    throw Error("printed");
  }
  if (method == "test.error") throw Error("an error on purpose");
}

}  // namespace emax::test
