#include "host/python/attended.h"

#include <optional>

#include "sw_model/base/error.h"

namespace nb = nanobind;

namespace emax {
namespace {

constexpr std::chrono::milliseconds kGlance{50};

}  // namespace

void Watch::advance(double share, std::size_t triangles) {
  const std::lock_guard lock(mutex_);
  share_ = share;
  triangles_ = triangles;
  news_ = true;
}

void Watch::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool Watch::wait(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, time, [this] { return ended_; });
}

void Watch::tell(const nb::object& progress) {
  double share = 0;
  std::size_t triangles = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!news_) return;
    news_ = false;
    share = share_;
    triangles = triangles_;
  }
  progress(share, triangles);
}

nb::object attend(Watch& watch, const nb::object& progress) {
  nb::object stopped_by = nb::none();
  for (;;) {
    bool ended = false;
    {
      const nb::gil_scoped_release released;
      ended = watch.wait(kGlance);
    }
    if (ended) return stopped_by;
    try {
      if (PyErr_CheckSignals() != 0) nb::raise_python_error();
      if (!watch.stopped() && !progress.is_none()) watch.tell(progress);
    } catch (nb::python_error& error) {
      if (stopped_by.is_none()) stopped_by = nb::borrow(error.value());
      watch.stop();
    }
  }
}

nb::tuple attended(const nb::object& progress,
                   const std::function<std::function<nb::object()>(Watch&)>& work) {
  Watch watch;
  std::function<nb::object()> result;
  std::exception_ptr failure;
  std::thread thread([&] {
    try {
      result = work(watch);
    } catch (const Interrupted&) {  // there is no result yet
    } catch (...) {
      failure = std::current_exception();
    }
    watch.end();
  });
  nb::object stopped_by = attend(watch, progress);
  {
    const nb::gil_scoped_release released;
    thread.join();
  }
  if (failure) std::rethrow_exception(failure);
  return nb::make_tuple(result ? result() : nb::none(), stopped_by);
}

}  // namespace emax
