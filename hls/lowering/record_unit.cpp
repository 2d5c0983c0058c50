#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/systemverilog.h"
#include "hls/lowering/verilog_text.h"

namespace emax {
namespace {

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string unit_module(const LoweredDesign& design) {
  const int record_bits = 32 * info(design.form).record_words;
  const std::string& module = design.options.module;
  if (record_bits == 0) {
    throw std::invalid_argument(std::string(info(design.form).name) +
                                " has no record, so there is no unit: leave --unit out");
  }
  const Schedule& schedule = design.schedule;
  std::set<int> slots;  // the cycles in which fields are read, but 0
  for (const Input& input : design.graph.inputs()) {
    const int cycle = schedule.start[input.node] - 1;
    if (input.arrival == Arrival::kMemory && cycle > 0) slots.insert(cycle);
  }
  Identifiers identifiers(module);
  for (const Input& input : design.graph.inputs()) identifiers.take(input.name);
  for (const Output& output : design.graph.outputs()) identifiers.take(output.name);
  // The slot as it is presented and delayed to the cycles of `slots`; a write's enable and slot as
  // they come and delayed by one cycle for each of `slots`.
  std::map<int, std::string> slot_at = {{0, "slot"}};
  std::vector<std::string> enables = {"write_enable"}, write_slots = {"write_slot"};
  for (const int cycle : slots) {
    slot_at[cycle] = identifiers.take(at_cycle("slot", cycle));
    const std::string suffix = "_" + std::to_string(enables.size());
    enables.push_back(identifiers.take("write_enable" + suffix));
    write_slots.push_back(identifiers.take("write_slot" + suffix));
  }
  std::vector<bool> used(static_cast<std::size_t>(record_bits), false);
  std::vector<std::string> reals, conditions, samples, late_reals, late_conditions;
  std::vector<std::string> ports = {".clk"};
  std::string memories;
  for (const Input& input : design.graph.inputs()) {
    ports.push_back("." + input.name);
    if (input.arrival == Arrival::kSample) {
      samples.push_back(input.name);
      continue;
    }
    const int cycle = schedule.start[input.node] - 1;
    const auto late =
        static_cast<std::size_t>(std::distance(slots.begin(), slots.upper_bound(cycle)));
    const int bits = width(design.graph.node(input.node).kind);
    (bits == 1 ? conditions : reals).push_back(input.name);
    for (int bit = 0; bit < bits; ++bit) used[input.record_bit + static_cast<unsigned>(bit)] = true;
    const std::string low = std::to_string(input.record_bit);
    const std::string range =
        bits == 1 ? low
                  : std::to_string(input.record_bit + static_cast<unsigned>(bits) - 1) + ":" + low;
    std::string data = "write_record[" + range + "]";
    if (late > 0) {
      const std::string name = identifiers.take(input.name + "_late");
      (bits == 1 ? late_conditions : late_reals).push_back(name);
      memories +=
          instance("delay_line #(.WIDTH(" + std::to_string(bits) + "), .DEPTH(" +
                       std::to_string(late) + "))",
                   identifiers.take(name + "_delay"), ".clk, .d(" + data + "), .q(" + name + ")");
      data = name;
    }
    memories +=
        instance("field_memory #(.WIDTH(" + std::to_string(bits) + "), .SLOT_BITS(SLOT_BITS))",
                 identifiers.take(input.name + "_memory"),
                 ".clk, .write_enable(" + enables[late] + "), .write_slot(" + write_slots[late] +
                     "), .write_data(" + data + "),\n      .read_slot(" + slot_at.at(cycle) +
                     "), .read_data(" + input.name + ")");
  }
  for (const Output& output : design.graph.outputs()) ports.push_back("." + output.name);
  std::vector<std::string> slot_names;
  std::string slot_delays;
  for (auto to = std::next(slot_at.begin()); to != slot_at.end(); ++to) {
    const auto& [at, from] = *std::prev(to);
    slot_names.push_back(to->second);
    slot_delays += delay_line(kNarrowBits / 2, "SLOT_BITS", to->first - at, design.options.delays,
                              identifiers.take(to->second + "_delay"), from, to->second);
  }
  std::string writes;
  for (std::size_t late = 1; late < enables.size(); ++late) {
    for (const auto& names : {enables, write_slots}) {
      writes += "    " + names[late] + " <= " + names[late - 1] + ";\n";
    }
  }
  const std::vector<std::string> late_enables(enables.begin() + 1, enables.end());
  const std::vector<std::string> late_slots(write_slots.begin() + 1, write_slots.end());
  std::string unused;
  for (int bit = 0; bit < record_bits;) {
    int end = bit;
    while (end < record_bits && !used[static_cast<std::size_t>(end)]) ++end;
    if (end > bit) {
      unused += ", write_record[" + std::to_string(end - 1) + ":" + std::to_string(bit) + "]";
    }
    bit = std::max(end, bit + 1);
  }
  std::string sample_ports;
  for (const std::string& name : samples) {
    sample_ports += "    input  logic [31:0] " + name + ",  // cycle 0\n";
  }
  std::string output_ports;
  for (const Output& output : design.graph.outputs()) {
    const bool is_last = &output == &design.graph.outputs().back();
    output_ports += "    output logic " + vector_type(width(design.graph.node(output.node).kind)) +
                    output.name + (is_last ? "" : ",") + "  // cycle " +
                    std::to_string(schedule.latency) + "\n";
  }
  std::string text =
      generated_line(design) + "//\n// " + module +
      R"( with the memory of its records beside it: 2^SLOT_BITS slots, word w of a record
// at bits 32 w + 31 to 32 w, in the order of the record's fields. Each field has a memory of its
// own, read with the slot delayed to the cycle in which the datapath needs the field, and written
// a cycle later than the fields that are read before: a write reaches a few memories at a time.
//
// A record written at a clock edge may be used by a slot presented in the cycle after it. A slot
// may be written again in any cycle later than LAST_READ after the one that presented it last.
module )" +
      module + R"(_unit #(
    parameter int SLOT_BITS = 4
) (
    input  logic clk,
    input  logic write_enable,
    input  logic [SLOT_BITS-1:0] write_slot,
    input  logic [)" +
      std::to_string(record_bits - 1) + R"(:0] write_record,
    input  logic [SLOT_BITS-1:0] slot,  // cycle 0
)" + sample_ports +
      output_ports + ");\n  localparam int LATENCY = " + std::to_string(schedule.latency) +
      ";\n  localparam int LAST_READ = " + std::to_string(design.last_read()) + ";\n";
  text += declarations("logic [SLOT_BITS-1:0] ", slot_names);
  text += declarations("logic [31:0] ", reals) + declarations("logic ", conditions);
  text += declarations("logic [31:0] ", late_reals) + declarations("logic ", late_conditions);
  text += declarations("logic ", late_enables) + declarations("logic [SLOT_BITS-1:0] ", late_slots);
  text += "\n" + slot_delays + "\n";
  if (!writes.empty()) text += "  always_ff @(posedge clk) begin\n" + writes + "  end\n\n";
  text += memories + "\n";
  // The unit is used as it is with and without probes.
  const std::string probes = std::to_string(32 * design.probes.size() - 1);
  text += "`ifdef EMAX_PROBES\n  logic [" + probes + ":0] unused_probes;\n`endif\n";
  text += "  " + module + " datapath (\n";
  text += listed("      ", "      ", ports, "");
  text += "`ifdef EMAX_PROBES\n      , .probes(unused_probes)\n`endif\n  );\n\n";
  return text + "  wire unused_parts = &{1'b0, LATENCY[0], LAST_READ[0]" + unused +
         "};\nendmodule\n";
}

std::string schedule_header(const LoweredDesign& design) {
  const std::string prefix = upper(design.options.module);
  return generated_line(design) + "`ifndef " + prefix + "_SCHEDULE_SVH\n`define " + prefix +
         "_SCHEDULE_SVH\n`define " + prefix + "_LATENCY " +
         std::to_string(design.schedule.latency) + "\n`define " + prefix + "_LAST_READ " +
         std::to_string(design.last_read()) + "\n`endif\n";
}

}  // namespace emax
