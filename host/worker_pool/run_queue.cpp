#include "host/worker_pool/run_queue.h"

#include <algorithm>

#include "host/parameters/descriptions.h"

namespace emax {

StageKey reconstruction_of(const RunMessage& run) {
  const bool known = find_method(run.settings.method) != nullptr;
  return known ? reconstruction_key(run.settings) : StageKey{run.settings.method, {}};
}

RunMessage RunQueue::take(const Holds& free_one, const Holds& anybody) {
  auto next = std::ranges::find_if(
      queue_, [&](const RunMessage& run) { return free_one(reconstruction_of(run)); });
  if (next == queue_.end()) {
    next = std::ranges::find_if(
        queue_, [&](const RunMessage& run) { return !anybody(reconstruction_of(run)); });
  }
  if (next == queue_.end()) next = queue_.begin();
  RunMessage run = std::move(*next);
  queue_.erase(next);
  return run;
}

}  // namespace emax
