#include "testbench/core/rtl_device.h"

#include <string>

#include "sw_model/base/error.h"

namespace emax {
namespace {

// Cycles without a word taken or given until the device counts as hung. A full ring of records over
// a full block takes 16 x 1,024.
constexpr std::uint32_t kPatience = 1u << 18;

}  // namespace

RtlDevice::RtlDevice(std::unique_ptr<CoreSimulation> core) : core_(std::move(core)) {
  core_->set_answer_ready(true);
}

void RtlDevice::send(std::span<const Word> words) {
  for (const Word& word : words) {
    for (std::uint32_t waited = 0;; ++waited) {
      const bool taken = core_->outputs().command_ready;
      clock(&word);
      if (taken) break;
      if (waited == kPatience) {
        throw Error("device rtl: it takes no words any more; this is a defect of the program");
      }
    }
  }
}

void RtlDevice::receive(std::span<Word> words) {
  for (std::uint32_t waited = 0; answers_.size() < words.size(); ++waited) {
    if (waited == kPatience || !core_->outputs().under_way || core_->assertion_failed()) {
      throw Error("device rtl: no answer comes; this is a defect of the program");
    }
    const std::size_t before = answers_.size();
    clock(nullptr);
    if (answers_.size() > before) waited = 0;
  }
  for (Word& word : words) {
    word = answers_.front();
    answers_.pop_front();
  }
}

void RtlDevice::clock(const Word* word) {
  core_->offer_command(word);
  const CoreOutputs now = core_->outputs();
  if (now.answer_valid) answers_.push_back(now.answer);
  core_->clock();
}

}  // namespace emax
