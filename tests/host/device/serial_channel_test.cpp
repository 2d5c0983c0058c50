#include "host/device/serial_channel.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "host/device/link_device.h"
#include "testbench/link/faulty_channel.h"
#include "testbench/link/link_twin.h"
#include "tests/support/board_work.h"
#include "tests/support/messages.h"

namespace emax {
namespace {

using namespace std::chrono_literals;

const test::BoardKind kWork = {"pty", 8, 200, 50, {}};

// The twin behind a pseudo-terminal, at a path that stays the same when it is plugged in again.
class PlugAndBoard {
 public:
  explicit PlugAndBoard(const ByteFaults& faults = {})
      : path_(std::filesystem::temp_directory_path() /
              ("emax_serial_test_" + std::to_string(getpid()))),
        twin_([] { return std::make_unique<CppDevice>(); }),
        channel_(twin_, 61, faults, faults) {
    plug_in();
  }
  ~PlugAndBoard() { unplug(); }

  void plug_in() {
    line_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    EXPECT_EQ(grantpt(line_), 0);
    EXPECT_EQ(unlockpt(line_), 0);
    std::filesystem::create_symlink(ptsname(line_), path_);
    plugged_ = true;
    thread_ = std::thread([this] { carry_bytes(); });
  }
  void unplug() {
    if (!plugged_.exchange(false)) return;
    thread_.join();
    close(line_);
    std::filesystem::remove(path_);
    twin_.power_cycle();
  }

  std::string path() const { return path_; }
  std::uint64_t bytes() const { return bytes_; }
  const FaultCounts& faults() const { return channel_.counts(); }  // while unplugged

 private:
  void carry_bytes() {
    std::vector<std::uint8_t> in, out;
    while (plugged_) {
      pollfd waiting = {line_, POLLIN, 0};
      poll(&waiting, 1, in.empty() && out.empty() ? 1 : 0);
      std::uint8_t bytes[256];
      if (in.empty()) {
        const ssize_t count = read(line_, bytes, sizeof bytes);
        if (count > 0) in.assign(bytes, bytes + count);
        if (count > 0) bytes_ += static_cast<std::uint64_t>(count);
      }
      in.erase(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(channel_.write(in)));
      for (const auto end = channel_.now() + 1ms; channel_.now() < end;) {
        const std::size_t came = channel_.read(bytes, 1ms);
        out.insert(out.end(), bytes, bytes + came);
      }
      const ssize_t count = write(line_, out.data(), out.size());
      if (count > 0) out.erase(out.begin(), out.begin() + count);
    }
  }

  const std::filesystem::path path_;
  LinkedBoardTwin twin_;
  FaultyChannel channel_;
  int line_ = -1;
  std::atomic<bool> plugged_ = false;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::thread thread_;
};

TEST(SerialChannel, CarriesTheLink) {
  PlugAndBoard board;
  LinkDevice device(std::make_unique<SerialChannel>(board.path()));
  const auto blocks = test::some_blocks(kWork, 62);
  EXPECT_EQ(test::answers_of(device, blocks), test::undisturbed_answers(blocks));
  EXPECT_EQ(device.link_counters().damaged, 0u);
  EXPECT_EQ(device.name(), "tty:" + board.path());
}

TEST(SerialChannel, CarriesTheLinkWithDamage) {
  PlugAndBoard board({.flip = 3e-4, .drop = 1e-4});
  const auto blocks = test::some_blocks(kWork, 63);
  {
    LinkDevice device(std::make_unique<SerialChannel>(board.path()), {.repeat = 20ms});
    EXPECT_EQ(test::answers_of(device, blocks), test::undisturbed_answers(blocks));
    EXPECT_GT(device.link_counters().resends, 0u);
  }
  board.unplug();
  EXPECT_GT(board.faults().flips, 3u);
}

TEST(SerialChannel, IsFoundAgainAfterItWasUnplugged) {
  PlugAndBoard board;
  LinkDevice device(std::make_unique<SerialChannel>(board.path()), {.repeat = 20ms});
  const auto blocks = test::some_blocks(kWork, 64);
  std::thread person([&board] {
    while (board.bytes() < 20000) std::this_thread::yield();
    board.unplug();
    std::this_thread::sleep_for(250ms);
    board.plug_in();
  });
  EXPECT_EQ(test::answers_of(device, blocks), test::undisturbed_answers(blocks));
  person.join();
  EXPECT_EQ(device.link_counters().losses, 1u);
  EXPECT_EQ(device.link_counters().recoveries, 1u);
}

TEST(SerialChannel, StaysUnplugged) {
  PlugAndBoard board;
  LinkDevice device(std::make_unique<SerialChannel>(board.path()), {.absence = 300ms});
  board.unplug();
  const auto blocks = test::some_blocks(kWork, 65);
  EXPECT_EQ(test::message_of([&] { test::answers_of(device, blocks); }),
            "device tty:" + board.path() +
                ": the board has been gone for 0.3 s; plug it in and run again");
}

TEST(SerialChannel, IsOursAlone) {
  PlugAndBoard board;
  const SerialChannel first(board.path());
  EXPECT_EQ(test::message_of([&] { SerialChannel second(board.path()); }),
            "device tty:" + board.path() + ": " + why_not_opened(EWOULDBLOCK));
}

TEST(SerialChannel, SaysWhatHindersIt) {
  EXPECT_EQ(test::message_of([] { SerialChannel channel("/dev/ttyNONE0"); }),
            "device tty:/dev/ttyNONE0: there is no such port; plug the board in and see `ls "
            "/dev/serial/by-id`");
  EXPECT_EQ(test::message_of([] { SerialChannel channel("/dev/null"); }),
            "device tty:/dev/null: this is not a serial port; name one such as /dev/ttyUSB0");
  EXPECT_NE(why_not_opened(EACCES).find("dialout"), std::string::npos);
  EXPECT_NE(why_not_opened(EBUSY).find("another process"), std::string::npos);
  EXPECT_EQ(why_not_opened(EMFILE), "Too many open files");
}

}  // namespace
}  // namespace emax
