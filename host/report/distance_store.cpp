#include "host/report/distance_store.h"

#include <algorithm>

namespace emax {
namespace {

constexpr std::uint64_t kReadPoints = std::uint64_t{1} << 17;

}  // namespace

DistanceStore::DistanceStore(std::uint64_t points, std::uint64_t memory_bytes,
                             const std::string& cloud)
    : points_(points) {
  if (points <= memory_bytes / sizeof(double)) {
    held_.resize(static_cast<std::size_t>(points));
  } else {
    file_.emplace(NamedInput{cloud}, "the distances of its points cannot be written");
  }
}

void DistanceStore::put(std::uint64_t first, std::span<const double> distances) {
  if (!file_) {
    std::ranges::copy(distances, held_.begin() + static_cast<std::ptrdiff_t>(first));
    return;
  }
  file_->write(first * sizeof(double),
               {reinterpret_cast<const char*>(distances.data()), distances.size_bytes()});
}

void DistanceStore::read(const std::function<void(std::span<const double>)>& take) const {
  if (!file_) {
    take(held_);
    return;
  }
  std::vector<double> some;
  for (std::uint64_t first = 0; first < points_; first += some.size()) {
    some.resize(static_cast<std::size_t>(std::min(kReadPoints, points_ - first)));
    file_->read(first * sizeof(double),
                {reinterpret_cast<char*>(some.data()), some.size() * sizeof(double)});
    take(some);
  }
}

}  // namespace emax
