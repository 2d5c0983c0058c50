#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "host/mpi/piece_message.h"

namespace emax {

// A rank's share of the pieces of a cloud, measured on threads of its own: the caller's speaks to
// MPI. It reads cloud and meshes itself. The destructor ends it soon.
class RankMeasurement {
 public:
  RankMeasurement(PiecesTask task, std::size_t threads);
  ~RankMeasurement();
  RankMeasurement(const RankMeasurement&) = delete;
  RankMeasurement& operator=(const RankMeasurement&) = delete;

  // The findings of a piece, if there are any within this time. Throws what ended the measurement:
  // Error also where the files are others than rank 0's.
  std::optional<Bytes> wait_for(std::chrono::milliseconds duration);
  // All findings were taken, and parts() are there.
  bool is_done();
  const Bytes& parts() const { return parts_; }

 private:
  void measure();
  void measure_pieces();
  void push(Bytes found);
  bool is_stopped() const { return stopped_; }

  const PiecesTask task_;
  const std::size_t threads_;
  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<Bytes> found_;
  bool ended_ = false;
  std::exception_ptr failure_;
  Bytes parts_;
  std::atomic<bool> stopped_ = false;
  std::jthread thread_;  // the last member: it ends before what it works on
};

}  // namespace emax
