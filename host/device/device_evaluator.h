#pragma once

#include <deque>
#include <memory>

#include "host/block_search/evaluator.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The driver: it turns blocks into commands for a device, and the device's answers into results. If
// the device throws an Error, it throws DeviceFailure and does not use the device again.
class DeviceEvaluator : public Evaluator {
 public:
  // Throws Error if the device is not compatible.
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
