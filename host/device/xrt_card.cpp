// The card of the `xrt` device, with XRT's native API. Compiled and linked, but not tested on a
// card.
#include <xrt/xrt_bo.h>
#include <xrt/xrt_device.h>
#include <xrt/xrt_kernel.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "hls/boards/alveo/movers.h"
#include "host/device/xrt_device.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kReadWords = std::size_t{1} << 16;
constexpr Word kCyclesPerMillisecond = 300000;  // at the clock that the kernels are linked for

struct CardAddress {
  std::string xclbin;
  unsigned index = 0;
};

CardAddress parse(std::string_view text) {
  const std::size_t at = text.rfind('@');
  CardAddress address = {std::string(text.substr(0, at)), 0};
  if (at != std::string_view::npos) {
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data() + at + 1, end, address.index);
    if (failure != std::errc{} || rest != end) {
      throw Error("device xrt:" + std::string(text) +
                  ": the text after the @ is not the number of a card");
    }
  }
  if (!std::filesystem::is_regular_file(address.xclbin)) {
    throw Error("device xrt:" + std::string(text) + ": there is no file '" + address.xclbin +
                "'; give xrt:XCLBIN or xrt:XCLBIN@INDEX (docs/boards.md)");
  }
  return address;
}

// Whether a run has ended. Throws if it failed.
bool ended(const xrt::run& run, milliseconds wait) {
  const ert_cmd_state state = wait == milliseconds{0} ? run.state() : run.wait(wait);
  switch (state) {
    case ERT_CMD_STATE_COMPLETED:
      return true;
    case ERT_CMD_STATE_NEW:
    case ERT_CMD_STATE_QUEUED:
    case ERT_CMD_STATE_SUBMITTED:
    case ERT_CMD_STATE_RUNNING:
    case ERT_CMD_STATE_TIMEOUT:  // the wait timed out, not the run
      return false;
    default:
      throw std::runtime_error("a data mover ended with state " + std::to_string(state));
  }
}

// The memory that the first argument of a data mover lies in.
xrt::memory_group memory_of(const xrt::kernel& mover) {
  return static_cast<xrt::memory_group>(mover.group_id(0));
}

class XrtCard : public CardMovers {
 public:
  XrtCard(std::string_view text, const CardAddress& address)
      : name_("xrt:" + std::string(text)),
        device_(address.index),
        uuid_(device_.load_xclbin(address.xclbin)),
        to_core_(device_, uuid_, "emax_to_core", xrt::kernel::cu_access_mode::exclusive),
        from_core_(device_, uuid_, "emax_from_core", xrt::kernel::cu_access_mode::exclusive),
        answers_(device_, (kMovedHeader + kReadWords) * sizeof(Word), memory_of(from_core_)),
        reading_(from_core_) {
    for (xrt::run& run : writing_) run = xrt::run(to_core_);
  }

  std::string name() const override { return name_; }

  void start_write(std::size_t slot, std::span<const Word> words, bool reset) override {
    explained([&] {
      xrt::bo& buffer = buffers_[slot];
      // Never empty: a transfer without words needs a buffer, too.
      const std::size_t bytes = std::max(words.size_bytes(), sizeof(Word));
      if (!buffer || buffer.size() < bytes) {
        buffer = xrt::bo(device_, bytes, memory_of(to_core_));
      }
      if (!words.empty()) {
        buffer.write(words.data(), words.size_bytes(), 0);
        buffer.sync(XCL_BO_SYNC_BO_TO_DEVICE, words.size_bytes(), 0);
      }
      xrt::run& run = writing_[slot];
      run.set_arg(0, buffer);
      run.set_arg(1, static_cast<Word>(words.size()));
      run.set_arg(2, Word{reset});
      run.start();
    });
  }

  bool written(std::size_t slot, milliseconds wait) override {
    bool done = false;
    explained([&] { done = ended(writing_[slot], wait); });
    return done;
  }

  void start_read(const AnswersDue& due, milliseconds patience) override {
    explained([&] {
      reading_.set_arg(0, answers_);
      reading_.set_arg(1, due.answers);
      reading_.set_arg(2, due.payload);
      reading_.set_arg(3, static_cast<Word>(kReadWords));
      reading_.set_arg(4, static_cast<Word>(patience.count()) * kCyclesPerMillisecond);
      reading_.start();
    });
  }

  std::optional<MovedAnswers> read(milliseconds wait) override {
    std::optional<MovedAnswers> moved;
    explained([&] {
      if (!ended(reading_, wait)) return;
      std::array<Word, kMovedHeader> header;
      answers_.sync(XCL_BO_SYNC_BO_FROM_DEVICE, sizeof header, 0);
      answers_.read(header.data(), sizeof header, 0);
      moved = MovedAnswers{{}, {header[kAnswersLeft], header[kPayloadLeft]}};
      moved->words.resize(std::min<std::size_t>(header[kMovedWords], kReadWords));
      const std::size_t bytes = moved->words.size() * sizeof(Word);
      if (bytes == 0) return;
      answers_.sync(XCL_BO_SYNC_BO_FROM_DEVICE, bytes, sizeof header);
      answers_.read(moved->words.data(), bytes, sizeof header);
    });
    return moved;
  }

 private:
  template <class Action>
  void explained(Action action) const {
    try {
      action();
    } catch (const std::exception& failure) {
      throw Error("device " + name_ + ": " + failure.what() +
                  "; reset the card with `xbutil reset` and run again");
    }
  }

  std::string name_;
  xrt::device device_;
  xrt::uuid uuid_;
  xrt::kernel to_core_, from_core_;
  std::array<xrt::bo, kSlots> buffers_;
  std::array<xrt::run, kSlots> writing_;
  xrt::bo answers_;
  xrt::run reading_;
};

}  // namespace

std::unique_ptr<CardMovers> open_xrt_card(std::string_view text) {
  const CardAddress address = parse(text);
  try {
    return std::make_unique<XrtCard>(text, address);
  } catch (const std::exception& failure) {
    throw Error(
        "device xrt:" + std::string(text) + ": no card answers (" + failure.what() +
        "); is XRT set up (source /opt/xilinx/xrt/setup.sh), and does `xbutil examine` list "
        "the card?");
  }
}

}  // namespace emax
