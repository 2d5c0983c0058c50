#include "host/worker_pool/worker_pool.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <set>
#include <vector>

#include "host/parameters/descriptions.h"
#include "host/worker_pool/run_queue.h"
#include "host/worker_pool/worker_process.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Clock = std::chrono::steady_clock;

// An answer that is arriving is accepted although its time is over: the program may have been
// suspended while the worker waited for it to read. This much time is added after each piece of the
// answer. From its first piece on, an answer may take at most the time limit of an evaluation and
// this grace.
constexpr std::chrono::seconds kArrivalGrace{2};

struct Worker {
  std::unique_ptr<WorkerProcess> process;
  bool ready = false;
  bool fresh = true;                           // has answered nothing yet
  std::optional<RunMessage> run;               // the evaluation it works on
  std::optional<Clock::time_point> answering;  // since the first bytes of the answer
  std::set<StageKey> made;                     // reconstructions that it may still hold
  bool spent = false;  // it cannot reconstruct again: it holds only its last reconstruction
  Clock::time_point deadline;
};

std::string describe(const RunMessage& run) {
  return "evaluation " + std::to_string(run.ticket) + " (" + run.settings.method + ")";
}

bool is_single_use(const RunMessage& run) {
  const MethodDescription* method = find_method(run.settings.method);
  return method != nullptr && method->single_use;
}

std::string seconds(std::chrono::milliseconds time) {
  std::string text = std::to_string(time.count() / 1000);
  if (time.count() % 1000 != 0) text += "." + std::to_string(1000 + time.count() % 1000).substr(1);
  return text + " s";
}

}  // namespace

class WorkerPool::Implementation {
 public:
  Implementation(std::span<const Point> points, const DecimationBound& bound,
                 const WorkerPoolOptions& options)
      : time_limit_(options.time_limit),
        command_{worker_program(options.program), options.memory_limit},
        points_(sealed_file(encode(PointsMessage{{points.begin(), points.end()}, bound}))),
        workers_(std::max(1u, options.jobs)) {
    for (Worker& worker : workers_) replace(worker);
  }

  void submit(RunMessage run) {
    run.threads = std::clamp<std::uint64_t>(run.threads, 1, workers_.size());
    queue_.push(std::move(run));
    hand_out();
  }

  std::optional<Completed> wait_until(std::optional<Clock::time_point> end) {
    if (outstanding() == 0) throw Error("no evaluation is outstanding");
    while (completed_.empty()) {
      hand_out();
      if (!completed_.empty()) break;
      if (!poll_once(end)) return std::nullopt;
    }
    Completed first = std::move(completed_.front());
    completed_.pop_front();
    return first;
  }

  void go_on() { hand_out(); }

  void stop() {
    queue_.clear();
    const Bytes message = encode(StopMessage{});
    for (Worker& worker : workers_) {
      if (worker.run) worker.process->send(message);
    }
  }

  std::size_t outstanding() const {
    const auto busy = std::count_if(workers_.begin(), workers_.end(),
                                    [](const Worker& w) { return w.run.has_value(); });
    return queue_.size() + completed_.size() + static_cast<std::size_t>(busy);
  }

 private:
  void replace(Worker& worker) {
    worker.process.reset();  // first, so that never more than `jobs` run
    worker.ready = false;
    worker.fresh = true;
    worker.run.reset();
    worker.made.clear();
    worker.spent = false;
    worker.process = std::make_unique<WorkerProcess>(command_, points_);
  }

  void hand_out() {
    for (Worker& worker : workers_) {
      if (queue_.empty()) return;
      if (worker.run) continue;
      RunMessage run = queue_.take([&](const StageKey& key) { return holds(worker, key); },
                                   [&](const StageKey& key) {
                                     return std::ranges::any_of(workers_, [&](const Worker& other) {
                                       return holds(other, key);
                                     });
                                   });
      if (worker.spent && !worker.made.contains(reconstruction_of(run))) replace(worker);
      give(worker, std::move(run));
    }
  }

  void give(Worker& worker, RunMessage run) {
    const Bytes message = encode(run);
    if (!worker.process->send(message)) {
      if (!worker.ready) throw not_ready(worker);
      replace(worker);  // the worker died while idle; a new one always takes a message
      if (!worker.process->send(message)) throw not_ready(worker);
    }
    worker.run = std::move(run);
    worker.answering.reset();
    worker.deadline = Clock::now() + time_limit_;
  }

  static bool holds(const Worker& worker, const StageKey& reconstruction) {
    return worker.made.contains(reconstruction) ||
           (worker.run && reconstruction_of(*worker.run) == reconstruction);
  }

  // Waits for an event and handles it. Returns false if `end` or a signal comes first.
  bool poll_once(std::optional<Clock::time_point> end) {
    std::vector<pollfd> polled;
    Clock::time_point until = end.value_or(Clock::time_point::max());
    for (const Worker& worker : workers_) {
      polled.push_back({worker.process->channel(), POLLIN, 0});
      if (worker.run) until = std::min(until, worker.deadline);
    }
    // Rounded up, so that the wait does not end just before a deadline.
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    const int timeout = static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
    const int events = poll(polled.data(), polled.size(), timeout);
    if (events < 0 && errno == EINTR) return false;
    if (events < 0) throw Error(std::string("cannot wait for workers: ") + std::strerror(errno));
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (polled[i].revents != 0) {
        listen(workers_[i]);
      } else if (workers_[i].run && Clock::now() >= workers_[i].deadline) {
        give_up(workers_[i],
                {FailureReason::kTimedOut, "took longer than " + seconds(time_limit_)});
      }
    }
    return events > 0 || !end || Clock::now() < *end || !completed_.empty();
  }

  void listen(Worker& worker) {
    const WorkerProcess::Received received = worker.process->receive();
    if (received == WorkerProcess::Received::kEnd) {
      if (!worker.ready) throw not_ready(worker);
      give_up(worker, worker.process->end());
      return;
    }
    if (worker.run) {
      const Clock::time_point now = Clock::now();
      if (!worker.answering) worker.answering = now;
      const Clock::time_point last = *worker.answering + time_limit_ + kArrivalGrace;
      worker.deadline = std::max(worker.deadline, std::min(now + kArrivalGrace, last));
    }
    while (std::optional<Message> message = next_message(worker)) {
      if (!take(worker, std::move(*message))) return;
    }
  }

  // Returns nothing if no whole message has arrived, or if the bytes are not a message; then the
  // worker is replaced.
  std::optional<Message> next_message(Worker& worker) {
    Failure garbled{FailureReason::kGarbled, {}};
    try {
      return worker.process->next_message();
    } catch (const Error& e) {
      garbled.message = e.what();
    }
    give_up(worker, garbled);
    return std::nullopt;
  }

  // Returns false if the worker was replaced.
  bool take(Worker& worker, Message message) {
    if (const auto* unusable = std::get_if<UnusableMessage>(&message)) {
      throw Error("a worker cannot work: " + unusable->message);
    }
    if (std::holds_alternative<ReadyMessage>(message) && !worker.ready) {
      worker.ready = true;
      worker.answering.reset();
      if (worker.run) worker.deadline = Clock::now() + time_limit_;
      return true;
    }
    if (auto* mesh = std::get_if<MeshMessage>(&message);
        mesh && worker.run && mesh->ticket == worker.run->ticket) {
      if (is_single_use(*worker.run)) {
        worker.spent = true;
        worker.made.clear();
      }
      worker.made.insert(reconstruction_of(*worker.run));
      worker.fresh = false;
      completed_.push_back({mesh->ticket, std::move(mesh->result)});
      worker.run.reset();
      return true;
    }
    if (auto* failure = std::get_if<FailureMessage>(&message);
        failure && worker.run && failure->ticket == worker.run->ticket) {
      const bool sound =
          failure->failure.reason == FailureReason::kError && !is_single_use(*worker.run);
      if (!sound) {
        give_up(worker, failure->failure);
      } else {
        worker.fresh = false;
        fail(worker, failure->failure);
      }
      return sound;
    }
    give_up(worker, {FailureReason::kGarbled, "an answer to no request"});
    return false;
  }

  void fail(Worker& worker, const Failure& failure) {
    if (!worker.run) return;
    completed_.push_back({worker.run->ticket,
                          Failure{failure.reason, describe(*worker.run) + ": " + failure.message}});
    worker.run.reset();
  }

  // A library that gets no memory may crash, so a crash may also mean a lack of memory.
  void give_up(Worker& worker, const Failure& failure) {
    const bool may_lack_memory =
        failure.reason == FailureReason::kOutOfMemory || failure.reason == FailureReason::kCrashed;
    if (may_lack_memory && !worker.fresh && worker.run) {
      RunMessage again = std::move(*worker.run);
      replace(worker);
      give(worker, std::move(again));
      return;
    }
    fail(worker, failure);
    replace(worker);
  }

  Error not_ready(Worker& worker) const {
    const std::string why = worker.process->end().message;
    const std::string remedy = command_.memory_limit != 0 ? "; raise the memory limit" : "";
    return Error("the worker " + command_.program.string() + " ended before it was ready: " + why +
                 remedy);
  }

  std::chrono::milliseconds time_limit_;
  WorkerProcess::Command command_;
  FileDescriptor points_;
  std::vector<Worker> workers_;
  RunQueue queue_;
  std::deque<Completed> completed_;
};

WorkerPool::WorkerPool(std::span<const Point> points, const DecimationBound& bound,
                       const WorkerPoolOptions& options)
    : implementation_(std::make_unique<Implementation>(points, bound, options)) {}

WorkerPool::~WorkerPool() = default;

void WorkerPool::submit(RunMessage run) { implementation_->submit(std::move(run)); }

Completed WorkerPool::wait() {
  while (true) {
    if (auto completed = implementation_->wait_until(std::nullopt)) return std::move(*completed);
  }
}

std::optional<Completed> WorkerPool::wait_for(std::chrono::milliseconds duration) {
  return implementation_->wait_until(Clock::now() + duration);
}

void WorkerPool::go_on() { implementation_->go_on(); }

void WorkerPool::stop() { implementation_->stop(); }

std::size_t WorkerPool::outstanding() const { return implementation_->outstanding(); }

std::unique_ptr<EvaluationPool> make_worker_pool(std::span<const Point> points,
                                                 const DecimationBound& bound,
                                                 const WorkerPoolOptions& options) {
  return std::make_unique<WorkerPool>(points, bound, options);
}

}  // namespace emax
