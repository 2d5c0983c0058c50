#pragma once

#include <deque>
#include <functional>

#include "host/parameters/chain_parameters.h"
#include "host/worker_pool/message.h"

namespace emax {

// Which reconstruction an evaluation needs.
StageKey reconstruction_of(const RunMessage& run);

// Evaluations that wait for somebody who is free.
class RunQueue {
 public:
  using Holds = std::function<bool(const StageKey&)>;

  void push(RunMessage run) { queue_.push_back(std::move(run)); }
  bool empty() const { return queue_.empty(); }
  std::size_t size() const { return queue_.size(); }
  void clear() { queue_.clear(); }

  // Takes out an evaluation whose reconstruction the free one holds, else one whose reconstruction
  // nobody holds, else the first. The queue must not be empty. O(size).
  RunMessage take(const Holds& free_one, const Holds& anybody);

 private:
  std::deque<RunMessage> queue_;
};

}  // namespace emax
