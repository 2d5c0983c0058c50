#include "host/device/device_address.h"

#include <algorithm>
#include <charconv>

#include "host/device/board_ports.h"
#include "host/device/device_evaluator.h"
#include "host/device/filtering_evaluator.h"
#include "host/device/link_device.h"
#include "host/device/opencl_device.h"
#include "host/device/queued_device.h"
#include "host/device/xrt_device.h"
#include "sw_model/base/error.h"
#include "sw_model/protocol/cpp_device.h"
#include "sw_model/protocol/timed_board.h"
#include "testbench/core/rtl_device.h"

namespace emax {
namespace {

struct Form {
  const char* text;
  const char* meaning;
};
constexpr Form kForms[] = {
    {"cpu", "this processor"},
    {"sim", "the device in C++"},
    {"sim:board=NAME", "the same, with a prediction of the time that a board would take"},
    {"sim:filter", "the same behind the fixed-point filter"},
    {"rtl[:pes=N]", "the Verilated core of N elements"},
    {"rtl:filter", "the core of one element behind the Verilated filter"},
    {"rtl:board", "both cores of a board, Verilated, behind their store"},
    {"opencl[:N]", "a GPU by OpenCL, or a processor"},
    {"tty:PATH[@BAUD]", "a board on a serial port"},
    {"xrt:XCLBIN[@INDEX]", "an Alveo card; not tested on a card"},
};
constexpr std::uint32_t kFilterElements = 4;  // of the filter before a core
constexpr std::uint32_t kLeastBaud = 1200, kMostBaud = 12000000;

[[noreturn]] void refuse(std::string_view text, const std::string& remedy) {
  throw Error("unknown device '" + std::string(text) + "'; " + remedy);
}

std::optional<std::uint32_t> number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

DeviceAddress parse_rtl(std::string_view text, std::string_view options) {
  constexpr std::string_view kElements = "pes=";
  const auto counts = rtl_element_counts();
  const auto elements =
      options.starts_with(kElements) ? number(options.substr(kElements.size())) : std::nullopt;
  if (!elements || std::find(counts.begin(), counts.end(), *elements) == counts.end()) {
    std::string accepted;
    for (const std::uint32_t count : counts) {
      accepted += (accepted.empty() ? "rtl:pes=" : ", rtl:pes=") + std::to_string(count);
    }
    refuse(text, "use rtl, rtl:filter, rtl:board or one of " + accepted);
  }
  return {.kind = "rtl", .elements = *elements};
}

DeviceAddress parse_opencl(std::string_view text, std::string_view place) {
  const auto which = number(place);
  if (!which) refuse(text, "the number after opencl: counts devices from 0");
  return {.kind = "opencl", .number = *which};
}

DeviceAddress parse_tty(std::string_view text, std::string_view place) {
  DeviceAddress address = {.kind = "tty", .is_board = true};
  const std::size_t at = place.rfind('@');
  if (at != place.npos) {
    const auto baud = number(place.substr(at + 1));
    if (!baud || *baud < kLeastBaud || *baud > kMostBaud) {
      refuse(text, "the number after @ is a speed of " + std::to_string(kLeastBaud) + " to " +
                       std::to_string(kMostBaud) + " baud");
    }
    address.baud = *baud;
  }
  address.place = place.substr(0, at);
  if (address.place.empty()) refuse(text, "use tty:PATH[@BAUD], such as tty:/dev/ttyUSB0");
  return address;
}

std::unique_ptr<Device> make_opencl_device(std::uint32_t number) {
  auto device = std::make_unique<OpenclDevice>(OpenclChoice{.number = number});
  device->verify_arithmetic();
  return device;
}

std::unique_ptr<Device> make_device(const DeviceAddress& address) {
  if (address.kind == "rtl") {
    return address.is_board ? make_rtl_board() : make_rtl_device(address.elements);
  }
  if (address.kind == "opencl") return make_opencl_device(address.number);
  if (address.kind == "tty") {
    return std::make_unique<LinkDevice>(
        std::make_unique<SerialChannel>(address.place, address.baud),
        LinkLimits::for_baud(address.baud));
  }
  if (address.is_board) return std::make_unique<TimedBoard>(*address.board);
  return std::make_unique<CppDevice>(address.elements);
}

std::unique_ptr<Device> make_filter_device(const DeviceAddress& address) {
  if (address.kind == "rtl") return make_rtl_filter(address.filter_elements);
  return std::make_unique<CppFilter>(address.filter_elements);
}

// Both cores of a board, which share its stream of commands.
std::unique_ptr<Evaluator> make_board_evaluator(const DeviceAddress& address) {
  BoardPorts ports = ports_of(std::make_unique<QueuedDevice>(
      make_device(address), QueuedDevice::kMostWords, CommandSet::kBoard));
  const std::size_t store_words = require_store(*ports.filter);
  auto exact = std::make_unique<DeviceEvaluator>(std::move(ports.exact));
  return std::make_unique<FilteringEvaluator>(std::move(ports.filter), std::move(exact),
                                              store_words);
}

}  // namespace

DeviceAddress DeviceAddress::parse(std::string_view text) {
  if (text == "cpu" || text == "sim" || text == "rtl" || text == "opencl")
    return {.kind = std::string(text)};
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const std::string_view rest = colon == text.npos ? "" : text.substr(colon + 1);
  constexpr std::string_view kBoard = "board=";
  if (kind == "sim" && rest.starts_with(kBoard)) {
    const BoardModel board = board_model(rest.substr(kBoard.size()));
    return {.kind = "sim",
            .board = board,
            .elements = board.elements,
            .filter_elements = board.filter_elements,
            .is_board = board.store_bits > 0};
  }
  if ((kind == "sim" || kind == "rtl") && rest == "filter") {
    return {.kind = std::string(kind), .filter_elements = kFilterElements};
  }
  if (text == "rtl:board") return {.kind = "rtl", .is_board = true};
  if (kind == "rtl" && colon != text.npos) return parse_rtl(text, rest);
  if (kind == "opencl" && colon != text.npos) return parse_opencl(text, rest);
  if (kind == "tty") return parse_tty(text, rest);
  if (kind == "xrt" && !rest.empty()) return {.kind = "xrt", .place = std::string(rest)};
  std::string accepted;
  for (const Form& form : kForms)
    accepted += (accepted.empty() ? "" : ", ") + std::string(form.text);
  refuse(text, "use one of " + accepted);
}

std::string device_help() {
  std::string help;
  for (const Form& form : kForms) {
    help += (help.empty() ? "" : ", ") + std::string(form.text) + " (" + form.meaning + ")";
  }
  return help;
}

std::unique_ptr<Evaluator> make_evaluator(const DeviceAddress& address) {
  if (address.kind == "cpu") return nullptr;
  if (address.kind == "xrt") {
    return std::make_unique<DeviceEvaluator>(
        std::make_unique<XrtDevice>(open_xrt_card(address.place)));
  }
  if (address.is_board) return make_board_evaluator(address);
  auto exact =
      std::make_unique<DeviceEvaluator>(std::make_unique<QueuedDevice>(make_device(address)));
  if (address.filter_elements == 0) return exact;
  auto filter = std::make_unique<QueuedDevice>(make_filter_device(address),
                                               QueuedDevice::kMostWords, CommandSet::kFilter);
  return std::make_unique<FilteringEvaluator>(std::move(filter), std::move(exact));
}

}  // namespace emax
