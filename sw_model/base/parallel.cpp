#include "sw_model/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace emax {

std::size_t processor_threads() { return std::max(1u, std::thread::hardware_concurrency()); }

void in_pieces(std::size_t threads, std::size_t count, std::size_t piece,
               const std::function<void(std::size_t, std::size_t, std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&](std::size_t thread) {
    try {
      for (std::size_t first; (first = next.fetch_add(piece)) < count;) {
        work(thread, first, std::min(first + piece, count));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    const std::size_t useful = std::min(threads, (count + piece - 1) / piece);
    for (std::size_t thread = 1; thread < useful; ++thread) others.emplace_back(run, thread);
    run(0);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace emax
