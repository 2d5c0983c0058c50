#include "testbench/diagnosis/save_file.h"

#include <gtkwave/fstapi.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "sw_model/base/error.h"

namespace emax {
namespace {

const std::string kElement = "TOP.emax_element.";
const std::string kDatapath = kElement + "distance.datapath.";

// Flags of a line in GTKWave's format: right-justified hexadecimal, right-justified binary,
// heading.
constexpr const char* kHexadecimal = "@22\n";
constexpr const char* kBinary = "@28\n";
constexpr const char* kHeading = "@200\n";

}  // namespace

std::vector<SignalGroup> signal_groups(const std::optional<NodeMismatch>& mismatch) {
  const auto of_element = [](std::vector<std::string> names) {
    for (std::string& name : names) name = kElement + name;
    return names;
  };
  std::vector<SignalGroup> groups = {
      {"clock and reset", of_element({"clk", "aresetn"})},
      {"handshakes",
       of_element({"s_axis_record_tvalid", "s_axis_record_tready", "s_axis_point_tvalid",
                   "s_axis_point_tready", "s_axis_point_tuser", "s_axis_point_tlast",
                   "m_axis_nearest_tvalid", "m_axis_nearest_tready", "m_axis_nearest_tlast",
                   "m_axis_worst_tvalid", "m_axis_worst_tready"})}};
  if (!mismatch) {
    groups.push_back({"what the datapath gives, and the reductions behind it",
                      of_element({"valid", "first_pair", "final_here", "last_here", "index",
                                  "squared_distance", "minimum", "minimum_index", "minimum_final",
                                  "minimum_last", "worst_done", "worst"})});
    return groups;
  }
  groups.push_back({"failing node", {kDatapath + mismatch->name}});
  SignalGroup operands{"its operands", {}};
  for (const OperandValue& operand : mismatch->operands) {
    if (!operand.element) continue;  // a constant
    for (const std::string& name : {operand.name, operand.signal}) {
      const std::string signal = kDatapath + name;
      if (std::ranges::find(operands.signals, signal) == operands.signals.end()) {
        operands.signals.push_back(signal);
      }
    }
  }
  groups.push_back(operands);
  return groups;
}

std::map<std::string, std::string> signals_of(const std::string& waveform) {
  const std::unique_ptr<void, void (*)(void*)> reader(fstReaderOpen(waveform.c_str()),
                                                      [](void* open) { fstReaderClose(open); });
  if (!reader) throw Error(waveform + ": is no waveform that can be read");
  std::map<std::string, std::string> signals;
  std::vector<std::string> scopes = {""};
  while (const fstHier* item = fstReaderIterateHier(reader.get())) {
    if (item->htyp == FST_HT_SCOPE) {
      scopes.push_back(scopes.back() + item->u.scope.name + ".");
    } else if (item->htyp == FST_HT_UPSCOPE) {
      scopes.pop_back();
    } else if (item->htyp == FST_HT_VAR) {
      std::string name = scopes.back() + item->u.var.name;
      std::erase(name, ' ');
      signals[name.substr(0, name.find('['))] = name;
    }
  }
  return signals;
}

std::string save_file(const std::vector<SignalGroup>& groups, const std::string& waveform,
                      std::uint64_t time) {
  const std::map<std::string, std::string> known = signals_of(waveform);
  const std::string at = std::to_string(time);
  // The save file names both places, so that GTKWave finds the waveform after both were moved.
  const std::string save = std::filesystem::path(waveform).replace_extension(".gtkw").string();
  std::string text = "[*] Open with: gtkwave waveform.gtkw\n[dumpfile] \"" + waveform +
                     "\"\n[savefile] \"" + save + "\"\n[timestart] " +
                     std::to_string(time > 60 ? time - 60 : 0) + "\n*-3.000000 " + at;
  for (char marker = 'A'; marker <= 'Z'; ++marker) text += " -1";
  text += "\n[sst_expanded] 0\n";
  for (const SignalGroup& group : groups) {
    text += kHeading + ("-" + group.heading) + "\n";
    for (const std::string& name : group.signals) {
      const auto found = known.find(name);
      if (found == known.end()) throw Error(waveform + " has no signal " + name);
      const bool is_vector = found->second.size() > name.size();
      text += (is_vector ? kHexadecimal : kBinary) + found->second + "\n";
    }
  }
  return text;
}

}  // namespace emax
