#include <emax/genocop.h>

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "host/genocop/look_ahead_scheduler.h"

namespace emax {
namespace {

// Threads that take candidates from one scheduler until it has no more.
class Evaluations {
 public:
  Evaluations(Genocop& search, const std::function<Evaluation(const Genes&)>& evaluate,
              const MinimizeOptions& options)
      : scheduler_(search, options.budget),
        evaluate_(evaluate),
        interrupted_(options.interrupted) {}

  std::size_t run(std::size_t jobs) {
    std::vector<std::thread> others;
    for (std::size_t job = 1; job < jobs; ++job) others.emplace_back([this] { work(); });
    work();
    for (std::thread& other : others) other.join();
    if (failure_) std::rethrow_exception(failure_);
    return made_;
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (!ended_) {
      try {
        if (interrupted_ && interrupted_()) break;
        const std::optional<Candidate> candidate = scheduler_.next();
        if (!candidate) {
          if (scheduler_.finished()) break;
          changed_.wait(lock);
          continue;
        }
        lock.unlock();
        const Evaluation evaluation = evaluate_(candidate->genes);
        lock.lock();
        ++made_;
        scheduler_.complete(candidate->index, evaluation);
      } catch (...) {
        if (!lock.owns_lock()) lock.lock();
        if (!failure_) failure_ = std::current_exception();
        break;
      }
      changed_.notify_all();
    }
    ended_ = true;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  LookAheadScheduler scheduler_;
  const std::function<Evaluation(const Genes&)>& evaluate_;
  const std::function<bool()>& interrupted_;
  std::size_t made_ = 0;
  bool ended_ = false;
  std::exception_ptr failure_;
};

}  // namespace

inline namespace v1 {

Minimum minimize(const Problem& problem, const std::function<Evaluation(const Genes&)>& evaluate,
                 const MinimizeOptions& options) {
  if (options.budget == 0) throw Error("budget: at least one evaluation");
  if (options.jobs == 0) throw Error("jobs: at least one");
  Settings settings;
  settings.budget = options.budget;
  // The evaluations here do not search along a monotone gene.
  settings.monotone_walk = false;
  if (options.jobs > settings.look_ahead) {
    throw Error("jobs: at most " + std::to_string(settings.look_ahead) +
                ", the evaluations that may be out at a time");
  }
  Genocop search(problem, settings, options.seed);
  const std::size_t made = Evaluations(search, evaluate, options).run(options.jobs);
  const std::optional<Best> best = search.best();
  if (!best) throw Error("nothing was evaluated");
  return {best->genes, best->evaluation, made};
}

}  // namespace v1
}  // namespace emax
