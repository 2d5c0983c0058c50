// Sends wrong frames of every kind into the whole Verilated board (UART, link, store, cores). After
// any of them the board must take a reset in time and then answer a block of either core correctly,
// of words that are sent or that lie in the store. It must never give a wrong word to a request
// that was sent in order.
//
//   emax_frame_fuzz [--frames N] [--blocks N] [--seed N]
//
// --blocks: the number of blocks that are asked after every 200 frames (1).
// Exit code 0 when nothing was wrong, 1 otherwise, 2 for wrong arguments.
#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/frames.h"
#include "testbench/board/simulated_board.h"
#include "testbench/core/board_stimuli.h"
#include "testbench/stimuli/random.h"

namespace emax {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kFramesARound = 200;

// A minimal host: one frame at a time.
class Host {
 public:
  void raw(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      bytes = bytes.subspan(board_.write(bytes));
      listen(1us);
    }
  }

  // Throws Error when no status of the session comes.
  void reset(std::uint16_t session) {
    session_ = session;
    sequence_ = expected_ = 0;
    answers_.clear();
    for (int attempt = 0; attempt < 20; ++attempt) {
      latest_.reset();
      raw(encode({.kind = FrameKind::kReset, .session = session}));
      if (listen_until(1ms, [&] { return latest_.has_value(); })) return;
      // The board may still read an unfinished frame; silence ends that frame.
    }
    throw Error("the board took no reset");
  }

  // Sends the words of a block and returns its answer. Throws Error when no answer comes.
  std::vector<Word> ask(std::span<const Word> words, std::size_t answer) {
    while (!words.empty()) {
      const auto part = words.first(std::min<std::size_t>(words.size(), 100));
      raw(encode({.kind = FrameKind::kData,
                  .session = session_,
                  .sequence = sequence_++,
                  .expected = expected_,
                  .payload = {part.begin(), part.end()}}));
      words = words.subspan(part.size());
      if (!listen_until(100ms, [&] { return acknowledged_ == sequence_; })) {
        throw Error("the board acknowledged no frame");
      }
    }
    for (int attempt = 0; attempt < 100; ++attempt) {
      if (listen_until(10ms, [&] { return answers_.size() >= answer; })) return answers_;
      raw(encode({.kind = FrameKind::kPoll, .session = session_, .expected = expected_}));
    }
    throw Error("the board gave no answer");
  }

  std::uint16_t session() const { return session_; }

 private:
  template <class Done>
  bool listen_until(std::chrono::steady_clock::duration limit, Done done) {
    for (const auto end = board_.now() + limit; !done() && board_.now() < end;) listen(100us);
    return done();
  }

  void listen(std::chrono::microseconds wait) {
    std::array<std::uint8_t, 4096> bytes;
    reader_.add(std::span(bytes).first(board_.read(bytes, wait)));
    while (const auto frame = reader_.next()) {
      if (frame->session != session_ || frame->kind == FrameKind::kLost) continue;
      latest_ = frame;
      acknowledged_ = frame->expected;
      if (frame->kind != FrameKind::kData || frame->sequence != expected_) continue;
      ++expected_;
      answers_.insert(answers_.end(), frame->payload.begin(), frame->payload.end());
    }
  }

  SimulatedBoard board_;
  FrameReader reader_;
  std::uint16_t session_ = 0;
  std::uint8_t sequence_ = 0, expected_ = 0, acknowledged_ = 0;
  std::optional<Frame> latest_;
  std::vector<Word> answers_;
};

// A word that is a command header with a probability of two thirds.
Word any_word(Random& random) {
  return random.one_in(3)
             ? random.word()
             : random.below(7) << kCountBits | random.below(random.one_in(4) ? 1100 : 6);
}

std::vector<std::uint8_t> any_frame(const Host& host, std::uint8_t turn, Random& random) {
  Frame frame = {.kind = FrameKind::kData,
                 .session = host.session(),
                 .sequence = turn,
                 .expected = static_cast<std::uint8_t>(random.below(3)),
                 .credit = static_cast<std::uint16_t>(random.word())};
  for (std::uint32_t words = 1 + random.below(random.one_in(20) ? 256 : 8); words > 0; --words) {
    frame.payload.push_back(any_word(random));
  }
  if (random.one_in(4)) frame.kind = static_cast<FrameKind>(random.below(8));
  if (frame.kind == FrameKind::kReset && !random.one_in(4)) frame.kind = FrameKind::kPoll;
  if (frame.kind != FrameKind::kData && !random.one_in(4)) frame.payload.clear();
  if (random.one_in(8)) frame.session = static_cast<std::uint16_t>(random.word());
  if (random.one_in(8)) frame.sequence = static_cast<std::uint8_t>(random.word());
  if (random.one_in(16)) frame.version = static_cast<std::uint8_t>(random.word());
  std::vector<std::uint8_t> bytes = encode(frame);
  const auto any_byte = [&] { return random.below(bytes.size()); };
  switch (random.below(12)) {
    case 0:
      bytes[any_byte()] ^= static_cast<std::uint8_t>(1u << random.below(8));
      break;
    case 1:
      bytes.resize(any_byte());
      break;
    case 2:
      bytes.erase(bytes.begin() + any_byte());
      break;
    case 3:
      bytes.insert(bytes.begin() + any_byte(), static_cast<std::uint8_t>(random.word()));
      break;
    case 4:
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.word());
      break;
    default:
      break;
  }
  return bytes;
}

std::vector<Word> any_block(unsigned store_bits, Random& random) {
  static const auto exact = test::materials(3);
  static const test::FilterMaterial filter = test::filter_material(3);
  const auto& material = exact[random.below(static_cast<std::uint32_t>(exact.size()))];
  const std::size_t points = 1 + random.below(20), records = random.below(5);
  return test::any_board_block(material, filter, {points, records}, store_bits, random);
}

// The board's store is asked for; what lies in it at first is not known, so that every piece that a
// block names was stored before.
unsigned store_bits(Host& host) {
  const Word question = command_header(kIdentify, kOfStore);
  const auto answer = host.ask(std::span(&question, 1), 1 + kAnswerStore);
  if (answer.size() != 1 + kAnswerStore || !std::has_single_bit(answer[2])) {
    throw Error("the board has no store");
  }
  return static_cast<unsigned>(std::countr_zero(answer[2]));
}

int run(std::uint64_t frames, std::uint64_t blocks, std::uint64_t seed) {
  Random random(named_seed("frames", seed));
  Host host;
  std::uint64_t sent = 0, right = 0, wrong = 0;
  std::uint16_t session = 0;
  host.reset(++session);
  const unsigned bits = store_bits(host);
  while (sent < frames) {
    host.reset(++session);
    std::uint8_t turn = 0;
    for (std::uint32_t i = 0; i < kFramesARound && sent < frames; ++i, ++sent) {
      const auto bytes = any_frame(host, turn, random);
      host.raw(bytes);
      // Most of these frames are accepted, one after the other.
      if (!random.one_in(8)) ++turn;
    }
    for (std::uint64_t i = 0; i < blocks; ++i) {
      host.reset(++session);
      const auto block = any_block(bits, random);
      const auto expected = test::answers_of_board(block, bits);
      ++(host.ask(block, expected.size()) == expected ? right : wrong);
    }
  }
  std::printf("fuzz: seed %llu, %llu frames, %llu answers right, %llu wrong\n",
              static_cast<unsigned long long>(seed), static_cast<unsigned long long>(sent),
              static_cast<unsigned long long>(right), static_cast<unsigned long long>(wrong));
  return wrong == 0 && right > 0 ? 0 : 1;
}

}  // namespace
}  // namespace emax

int main(int argc, char** argv) {
  std::uint64_t frames = 2000, blocks = 1, seed = 1;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i];
    char* end = nullptr;
    const std::uint64_t value = i + 1 < argc ? std::strtoull(argv[i + 1], &end, 10) : 0;
    if (end == nullptr || *end != '\0' || value == 0 ||
        (option != "--frames" && option != "--blocks" && option != "--seed")) {
      std::fprintf(stderr, "usage: emax_frame_fuzz [--frames N] [--blocks N] [--seed N]\n");
      return 2;
    }
    (option == "--frames" ? frames : option == "--blocks" ? blocks : seed) = value;
  }
  try {
    return emax::run(frames, blocks, seed);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz: %s\n", error.what());
    return 1;
  }
}
