#include <deque>

#include "tests/testbench/link/link_bench.h"

namespace emax {
namespace {

// The simplest host that the protocol allows, over a channel with faults. Its time is clock cycles.
class FaultyHost {
 public:
  FaultyHost(LinkBench& bench, std::uint32_t faults) : bench_(bench), faults_(faults) {}

  void run(const std::vector<Word>& words) {
    words_ = words;
    while (!open_) {
      transmit(plain_frame(FrameKind::kReset));
      wait();
    }
    int without_progress = 0;
    while (answered_ < words_.size()) {
      const std::size_t before = acknowledged_ + answered_;
      send_what_fits();
      wait();
      if (acknowledged_ + answered_ != before) {
        without_progress = 0;
        continue;
      }
      expect(++without_progress < 100, "the link hangs");
      send_again();
      wait();
    }
  }

  std::size_t repeats() const { return repeats_; }

 private:
  struct Sent {
    std::uint8_t sequence;
    std::size_t begin, end;
  };

  // Damages, drops, doubles or holds back until after the next.
  void transmit(const Frame& frame) {
    std::vector<std::uint8_t> bytes = encode(frame);
    const std::vector<std::uint8_t> late = std::move(held_);
    held_.clear();
    if (bench_.random.below(1000) < faults_) {
      switch (bench_.random.below(5)) {
        case 0:
          bytes[bench_.random.below(size(bytes))] ^= flip();
          break;
        case 1:
          bytes.resize(bench_.random.below(size(bytes)));
          break;
        case 2:
          bytes.insert(bytes.end(), bytes.begin(), bytes.end());
          break;
        case 3:
          bytes.erase(bytes.begin() + bench_.random.below(size(bytes)));
          break;
        default:
          std::swap(held_, bytes);
      }
    }
    bench_.send(bytes);
    bench_.send(late);
  }

  std::uint8_t flip() { return static_cast<std::uint8_t>(1u << bench_.random.below(8)); }
  static std::uint32_t size(const std::vector<std::uint8_t>& bytes) {
    return static_cast<std::uint32_t>(bytes.size());
  }

  // A reset that came late, or twice, is obeyed; sent is then all that the device forgot. This host
  // does not begin anew, so its channel holds no reset back (see run()).
  void send_what_fits() {
    while (sent_ < words_.size() && sent_ - acknowledged_ < credit_ && under_way_.size() < 100) {
      const std::size_t fits = std::min(words_.size() - sent_, credit_ - (sent_ - acknowledged_));
      const std::size_t count = std::min<std::size_t>(fits, 1 + bench_.random.below(256));
      under_way_.push_back({sequence_++, sent_, sent_ + count});
      sent_ += count;
      transmit_data(under_way_.back());
    }
  }

  void transmit_data(const Sent& sent) {
    const auto at = [&](std::size_t i) { return words_.begin() + static_cast<std::ptrdiff_t>(i); };
    transmit(data_frame(sent.sequence, {at(sent.begin), at(sent.end)}, expected_));
  }

  void send_again() {
    repeats_ += under_way_.size();
    for (const Sent& sent : under_way_) transmit_data(sent);
    transmit(plain_frame(FrameKind::kPoll, expected_));
  }

  void wait() {
    for (const Frame& frame : bench_.settle()) {
      if (bench_.random.below(1000) < faults_) continue;  // lost on the way
      take(frame);
      if (bench_.random.below(1000) < faults_) take(frame);
    }
    if (bench_.random.below(1000) < 2 * faults_) bench_.clock(kGapClocks + 10);
  }

  void take(const Frame& frame) {
    expect(frame.version == kLinkVersion && frame.session == kSession,
           "a frame of another session");
    expect(frame.kind == FrameKind::kStatus || frame.kind == FrameKind::kData, "a session is lost");
    open_ = true;
    while (!under_way_.empty()) {
      const auto passed = static_cast<std::uint8_t>(frame.expected - under_way_.front().sequence);
      if (passed == 0 || passed > under_way_.size()) break;
      acknowledged_ = under_way_.front().end;
      under_way_.pop_front();
    }
    credit_ = frame.credit;
    expect(credit_ <= kRoom, "more is promised than there is");
    if (frame.kind != FrameKind::kData) return;
    if (frame.sequence == expected_) {
      for (const Word word : frame.payload) {
        expect(answered_ < words_.size(), "more answers than words");
        expect(word == static_cast<Word>(~words_[answered_++]), "a wrong number");
      }
      ++expected_;
    }
    transmit(plain_frame(FrameKind::kStatus, expected_));
  }

  LinkBench& bench_;
  std::uint32_t faults_;
  std::vector<Word> words_;
  std::deque<Sent> under_way_;
  std::vector<std::uint8_t> held_;
  bool open_ = false;
  std::uint8_t sequence_ = 0, expected_ = 0;
  std::size_t sent_ = 0, acknowledged_ = 0, answered_ = 0, credit_ = 0, repeats_ = 0;
};

// Words whose echo is answers with headers: many short ones, some of several frames.
std::vector<Word> words_to_echo(Random& random, std::size_t count) {
  std::vector<Word> words;
  while (words.size() < count) {
    const std::uint32_t length = random.one_in(4) ? random.below(600) : random.below(8);
    words.push_back(~(random.below(256) << 24 | length));
    for (std::uint32_t i = 0; i < length; ++i)
      words.push_back(random.one_in(4) ? 0xe54de54du : random.word());
  }
  return words;
}

}  // namespace

void pass_words_through_faults(LinkBench& bench, std::size_t count, std::uint32_t faults) {
  const std::vector<Word> words = words_to_echo(bench.random, count);
  bench.echoes = true;
  FaultyHost host(bench, faults);
  host.run(words);
  expect(bench.taken == words, "the core took other words than were sent");
  expect((host.repeats() > 0) == (faults > 0), "faults without repeats or repeats without faults");
}

}  // namespace emax
