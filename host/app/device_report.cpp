#include "host/app/device_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "host/app/interrupt.h"
#include "host/app/scan.h"
#include "sw_model/base/error.h"

namespace emax {

std::string describe_counters(const std::optional<DeviceCounters>& counted) {
  if (!counted) return fmt::format("{} instructions", engine_targets().front().name);
  const DeviceCounters& counters = *counted;
  std::string text =
      fmt::format("{} blocks, {} pairs", grouped(counters.blocks), grouped(counters.pairs));
  if (counters.filtered_pairs) {
    text += fmt::format(", {} pairs in the filter, which left {} of {} points",
                        grouped(*counters.filtered_pairs), grouped(*counters.points_left),
                        grouped(*counters.filtered_points));
  }
  if (counters.words_in > 0) {
    text += fmt::format(", {} words in, {} out", grouped(counters.words_in),
                        grouped(counters.words_out));
  }
  if (counters.cycles) {
    const auto share = [&](const std::optional<std::uint64_t>& part) {
      return 100.0 * static_cast<double>(*part) /
             static_cast<double>(std::max<std::uint64_t>(*counters.cycles, 1));
    };
    std::string shares;
    const auto add = [&](const std::optional<std::uint64_t>& part, const char* name) {
      if (!part) return;
      shares += fmt::format("{}{:.1f}% {}", shares.empty() ? "" : ", ", share(part), name);
    };
    add(counters.busy, "busy");
    add(counters.stalled, "stalled");
    add(counters.idle, "idle");
    text += fmt::format(", {} cycles{}", grouped(*counters.cycles),
                        shares.empty() ? "" : " (" + shares + ")");
  }
  if (counters.resends) text += fmt::format(", {} resends", grouped(*counters.resends));
  return text;
}

void CpuTwin::measure(MeshView mesh, const MeasuredError& by_device) {
  const auto start = std::chrono::steady_clock::now();
  const MeasuredError here = constraint_.measure(mesh, was_interrupted);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  require_same(here, by_device);
}

void require_same(const MeasuredError& here, const MeasuredError& by_device) {
  if (here.kept != by_device.kept || here.excluded != by_device.excluded) {
    throw DeviceFailure(
        fmt::format("the device gives e_max^2 bits 0x{:08x}, the CPU 0x{:08x}; this is a defect of "
                    "the program, please report it",
                    by_device.kept.squared_bits, here.kept.squared_bits));
  }
}

void print_prediction(Facts& facts, const BoardModel& board, const DeviceCounters& counters,
                      double cpu_seconds) {
  const std::uint64_t cycles = counters.cycles.value_or(0);
  const std::string filter =
      board.filter_elements > 0 ? fmt::format(" and {} of the filter", board.filter_elements) : "";
  facts.add_passing("predicted",
                    "{:.3g} s on {} ({}), estimated: computing {:.3g} s ({} elements{} at {:.0f} "
                    "MHz), link {:.3g} s ({:.6g} MB/s)",
                    predicted_seconds(board, counters), board.name, board.device,
                    predicted_seconds(board, cycles, 0, 0), board.elements, filter,
                    board.clock_hz / 1e6,
                    predicted_seconds(board, 0, counters.words_in, counters.words_out),
                    board.link_bytes_per_second / 1e6);
  facts.add_passing("this CPU",
                    "{:.3g} s, measured: the same work on one thread, its search included",
                    cpu_seconds);
}

}  // namespace emax
