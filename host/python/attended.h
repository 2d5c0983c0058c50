#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace emax {

// What the thread that works and the thread that called from Python tell each other.
class Watch {
 public:
  bool stopped() const { return stopped_; }
  void stop() { stopped_ = true; }

  // Of the thread that works: how far it is.
  void advance(double share, std::size_t triangles);
  void end();

  // Of the thread that called. Waits for the end or a while; true at the end.
  bool wait(std::chrono::milliseconds time);
  // Calls `progress` with the latest news, if there are any since the last call.
  void tell(const nanobind::object& progress);

 private:
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false, news_ = false;
  double share_ = 0;
  std::size_t triangles_ = 0;
};

// Waits with the GIL released until the work has ended; takes Ctrl-C and calls `progress` in the
// meantime. Returns the exception of Python that stopped the work, or None.
nanobind::object attend(Watch& watch, const nanobind::object& progress);

// Calls work(watch) in a thread of its own, so that no code of Python runs in threads of emax.
// Returns (result or None, exception of Python that stopped it or None). An exception of the work
// is thrown.
nanobind::tuple attended(const nanobind::object& progress,
                         const std::function<std::function<nanobind::object()>(Watch&)>& work);

}  // namespace emax
