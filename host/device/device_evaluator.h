#pragma once

#include <deque>
#include <memory>

#include "host/block_search/evaluator.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The driver: turns blocks into commands for a device and its answers into results. Throws
// DeviceFailure where the device throws an Error; nothing is asked of it after that.
class DeviceEvaluator : public Evaluator {
 public:
  // Throws Error when the device is not compatible.
  explicit DeviceEvaluator(std::unique_ptr<Device> device);

  std::string name() const override { return device_->name(); }
  std::size_t block_points() const override;
  void begin(std::span<const Vector3<float>> points,
             std::span<const TriangleRecord<float>> records) override;
  void submit(const Block& block, bool list_points) override;
  BlockAnswer collect() override;
  DeviceCounters counters() const override;

 private:
  struct Asked {
    std::vector<std::uint32_t> points;
    bool list_points;
  };

  template <class Action>
  auto on_device(Action action);

  std::unique_ptr<Device> device_;
  std::span<const Vector3<float>> points_;
  std::span<const TriangleRecord<float>> records_;
  std::deque<Asked> in_flight_;
  bool failed_ = false;
  DeviceCounters counters_;
};

}  // namespace emax
