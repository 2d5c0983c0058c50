#include "host/device/board_ports.h"

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "sw_model/base/error.h"
#include "sw_model/protocol/commands.h"

namespace emax {
namespace {

enum class Core : std::size_t { kExact, kFilter };

// The board itself, and for each core the answers that came while the other one's were awaited.
class SharedBoard {
 public:
  explicit SharedBoard(std::unique_ptr<Device> device) : device_(std::move(device)) {}

  const Device& device() const { return *device_; }

  void send(Core core, std::vector<Word> words) {
    CommandCursor cursor(CommandSet::kBoard);
    std::size_t at = 0;
    for (std::span<const Word> rest = words; !rest.empty();) {
      const CommandCursor::Part part = cursor.take(rest);
      const Word opcode = header_opcode(part.header);
      if (core == Core::kFilter && (opcode == kIdentify || opcode == kCounters) &&
          header_count(part.header) == kOfExact) {
        words[at] = command_header(static_cast<Opcode>(opcode), kOfFilter);
      }
      if (is_answered(part.header, CommandSet::kBoard)) asked_.push_back(core);
      at += part.words.size();
    }
    device_->send(words);
  }

  void receive(Core core, std::span<Word> words) {
    std::deque<Word>& own = answers_[static_cast<std::size_t>(core)];
    while (own.size() < words.size()) fetch();
    const auto end = own.begin() + static_cast<std::ptrdiff_t>(words.size());
    std::copy(own.begin(), end, words.begin());
    own.erase(own.begin(), end);
  }

 private:
  // The next answer, to whoever asked for it.
  void fetch() {
    if (asked_.empty()) {
      throw Error("device " + device_->name() +
                  ": waiting for an answer that no command asked for; this is a defect of the "
                  "program");
    }
    std::vector<Word> answer(1);
    device_->receive(answer);
    answer.resize(1 + header_count(answer[0]));
    device_->receive(std::span(answer).subspan(1));
    std::deque<Word>& owner = answers_[static_cast<std::size_t>(asked_.front())];
    asked_.pop_front();
    owner.insert(owner.end(), answer.begin(), answer.end());
  }

  std::unique_ptr<Device> device_;
  std::deque<Core> asked_;  // for every answer that is to come
  std::array<std::deque<Word>, 2> answers_;
};

class BoardPort : public Device {
 public:
  BoardPort(std::shared_ptr<SharedBoard> board, Core core)
      : board_(std::move(board)), core_(core) {}

  std::string name() const override { return board_->device().name(); }
  void send(std::span<const Word> words) override {
    board_->send(core_, {words.begin(), words.end()});
  }
  void receive(std::span<Word> words) override { board_->receive(core_, words); }
  DeviceCounters counters() const override { return board_->device().counters(); }

 private:
  std::shared_ptr<SharedBoard> board_;
  Core core_;
};

}  // namespace

BoardPorts ports_of(std::unique_ptr<Device> board) {
  const auto shared = std::make_shared<SharedBoard>(std::move(board));
  return {std::make_unique<BoardPort>(shared, Core::kExact),
          std::make_unique<BoardPort>(shared, Core::kFilter)};
}

}  // namespace emax
