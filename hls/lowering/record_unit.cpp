#include <algorithm>
#include <cctype>
#include <functional>
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

// Fields of a record in memories that are read at different cycles.
//
// A field that the datapath reads at cycle c is read with the slot delayed by c - 1. The fields are
// written in groups by their cycle of reading, each group a cycle later than the one before, so
// that one write reaches a few memories at a time.
class RecordUnit {
 public:
  explicit RecordUnit(const LoweredDesign& design)
      : design_(design),
        module_(design.options.module),
        identifiers_(module_),
        used_(static_cast<std::size_t>(design.about.record_bits), false) {
    if (used_.empty()) {
      throw std::invalid_argument(std::string(design.about.name) +
                                  " has no record, so there is no unit: leave --unit out" +
                                  (is_own(design) ? ", or give parameters with --record" : ""));
    }
    for (const Input& input : design_.graph.inputs()) identifiers_.take(input.name);
    for (const Output& output : design_.graph.outputs()) identifiers_.take(output.name);
    name_slots();
    for (const Input& input : design_.graph.inputs()) {
      ports_.push_back("." + input.name);
      if (input.arrival == Arrival::kSample) {
        samples_.push_back(&input);
      } else {
        add_field(input);
      }
    }
    for (const Output& output : design_.graph.outputs()) ports_.push_back("." + output.name);
  }

  std::string text() {
    const std::string slot_delays = delay_slots();
    std::string text = head() + declarations("logic [SLOT_BITS-1:0] ", slot_names());
    text += declarations_of(fields_) + declarations_of(late_fields_);
    text += declarations("logic ", {enables_.begin() + 1, enables_.end()});
    text += declarations("logic [SLOT_BITS-1:0] ", {write_slots_.begin() + 1, write_slots_.end()});
    text += "\n" + slot_delays + "\n" + late_writes() + memories_ + "\n" + datapath();
    return text + "  wire unused_parts = &{1'b0, LATENCY[0], LAST_READ[0]" + unused_bits() +
           "};\nendmodule\n";
  }

 private:
  // Names by their bits, the widest first.
  using Fields = std::map<int, std::vector<std::string>, std::greater<>>;

  static std::string declarations_of(const Fields& fields) {
    std::string text;
    for (const auto& [bits, names] : fields) {
      text += declarations("logic " + vector_type(bits), names);
    }
    return text;
  }

  // The cycle in which the slot of a field is presented to its memory.
  int slot_cycle(const Input& input) const { return design_.schedule.start[input.node] - 1; }

  // Names the slot at each of the cycles in which fields are read, and the writes' delayed enables
  // and slots.
  void name_slots() {
    for (const Input& input : design_.graph.inputs()) {
      const int cycle = slot_cycle(input);
      if (input.arrival == Arrival::kMemory && cycle > 0) late_cycles_.insert(cycle);
    }
    for (const int cycle : late_cycles_) {
      slot_at_[cycle] = identifiers_.take(at_cycle("slot", cycle));
      const std::string suffix = "_" + std::to_string(enables_.size());
      enables_.push_back(identifiers_.take("write_enable" + suffix));
      write_slots_.push_back(identifiers_.take("write_slot" + suffix));
    }
  }

  void add_field(const Input& input) {
    const int cycle = slot_cycle(input);
    const auto late = static_cast<std::size_t>(
        std::distance(late_cycles_.begin(), late_cycles_.upper_bound(cycle)));
    const int bits = design_.graph.node(input.node).type.width;
    fields_[bits].push_back(input.name);
    for (int bit = 0; bit < bits; ++bit)
      used_.at(input.record_bit + static_cast<unsigned>(bit)) = true;
    memories_ +=
        instance("field_memory #(.WIDTH(" + std::to_string(bits) + "), .SLOT_BITS(SLOT_BITS))",
                 identifiers_.take(input.name + "_memory"),
                 ".clk, .write_enable(" + enables_[late] + "), .write_slot(" + write_slots_[late] +
                     "), .write_data(" + write_data(input, bits, late) + "),\n      .read_slot(" +
                     slot_at_.at(cycle) + "), .read_data(" + input.name + ")");
  }

  // The field in the written record, delayed by `late` cycles.
  std::string write_data(const Input& input, int bits, std::size_t late) {
    const std::string low = std::to_string(input.record_bit);
    const std::string high =
        std::to_string(input.record_bit + static_cast<unsigned>(bits) - 1) + ":";
    std::string data = "write_record[" + (bits == 1 ? "" : high) + low + "]";
    if (late == 0) return data;
    const std::string name = identifiers_.take(input.name + "_late");
    late_fields_[bits].push_back(name);
    memories_ += instance(
        "delay_line #(.WIDTH(" + std::to_string(bits) + "), .DEPTH(" + std::to_string(late) + "))",
        identifiers_.take(name + "_delay"), ".clk, .d(" + data + "), .q(" + name + ")");
    return name;
  }

  std::vector<std::string> slot_names() const {
    std::vector<std::string> names;
    for (const int cycle : late_cycles_) names.push_back(slot_at_.at(cycle));
    return names;
  }

  std::string delay_slots() {
    std::string text;
    for (auto to = std::next(slot_at_.begin()); to != slot_at_.end(); ++to) {
      const auto& [at, from] = *std::prev(to);
      text += delay_line(kNarrowBits / 2, "SLOT_BITS", to->first - at, design_.options.delays,
                         identifiers_.take(to->second + "_delay"), from, to->second);
    }
    return text;
  }

  std::string late_writes() const {
    std::string writes;
    for (std::size_t late = 1; late < enables_.size(); ++late) {
      for (const auto* names : {&enables_, &write_slots_}) {
        writes += "    " + (*names)[late] + " <= " + (*names)[late - 1] + ";\n";
      }
    }
    return writes.empty() ? "" : "  always_ff @(posedge clk) begin\n" + writes + "  end\n\n";
  }

  std::string unused_bits() const {
    std::string unused;
    const auto bits = used_.size();
    for (std::size_t bit = 0; bit < bits;) {
      std::size_t end = bit;
      while (end < bits && !used_[end]) ++end;
      if (end > bit) {
        unused += ", write_record[" + std::to_string(end - 1) + ":" + std::to_string(bit) + "]";
      }
      bit = std::max(end, bit + 1);
    }
    return unused;
  }

  // Where the bits of a record are, and how they are stored.
  std::string record_comment() const {
    if (!is_own(design_)) {
      return R"(, word w of a record
// at bits 32 w + 31 to 32 w, in the order of the record's fields. Each field has a memory of its
// own, read with the slot delayed to the cycle in which the datapath needs the field, and written
// a cycle later than the fields that are read before: a write reaches a few memories at a time.
)";
    }
    std::vector<std::string> fields;
    for (const Input& input : design_.graph.inputs()) {
      if (input.arrival != Arrival::kMemory) continue;
      const int bits = design_.graph.node(input.node).type.width;
      const std::string low = std::to_string(input.record_bit);
      const std::string high =
          std::to_string(input.record_bit + static_cast<unsigned>(bits) - 1) + ":";
      fields.push_back(input.name + " [" + (bits == 1 ? "" : high) + low + "]");
    }
    return ". The bits of a record:\n" + listed("// ", "// ", fields, ".") +
           R"(// Each field has a memory of its own, read with the slot delayed to the cycle in which the datapath
// needs the field, and written a cycle later than the fields that are read before: a write reaches a
// few memories at a time.
)";
  }

  std::string head() const {
    std::string sample_ports, output_ports;
    for (const Input* input : samples_) {
      sample_ports += "    input  logic " +
                      vector_type(design_.graph.node(input->node).type.width) + input->name +
                      ",  // cycle 0\n";
    }
    for (const Output& output : design_.graph.outputs()) {
      const bool is_last = &output == &design_.graph.outputs().back();
      output_ports += "    output logic " +
                      vector_type(design_.graph.node(output.node).type.width) + output.name +
                      (is_last ? "" : ",") + "  // cycle " +
                      std::to_string(design_.schedule.latency) + "\n";
    }
    return generated_line(design_) + "//\n// " + module_ +
           " with the memory of its records beside it: 2^SLOT_BITS slots" + record_comment() +
           R"(//
// A record written at a clock edge may be used by a slot presented in the cycle after it. A slot
// may be written again in any cycle later than LAST_READ after the one that presented it last.
module )" + module_ +
           R"(_unit #(
    parameter int SLOT_BITS = 4
) (
    input  logic clk,
    input  logic write_enable,
    input  logic [SLOT_BITS-1:0] write_slot,
    input  logic [)" +
           std::to_string(used_.size() - 1) + R"(:0] write_record,
    input  logic [SLOT_BITS-1:0] slot,  // cycle 0
)" + sample_ports +
           output_ports +
           ");\n  localparam int LATENCY = " + std::to_string(design_.schedule.latency) +
           ";\n  localparam int LAST_READ = " + std::to_string(design_.last_read()) + ";\n";
  }

  // The unit is the same with and without probes.
  std::string datapath() const {
    const std::string probes = std::to_string(32 * design_.probes.size() - 1);
    return "`ifdef EMAX_PROBES\n  logic [" + probes + ":0] unused_probes;\n`endif\n" + "  " +
           module_ + " datapath (\n" + listed("      ", "      ", ports_, "") +
           "`ifdef EMAX_PROBES\n      , .probes(unused_probes)\n`endif\n  );\n\n";
  }

  const LoweredDesign& design_;
  const std::string& module_;
  Identifiers identifiers_;
  std::vector<bool> used_;     // bits of the record
  std::set<int> late_cycles_;  // cycles above 0 in which fields are read
  // The slot, and the slot delayed to each of the late cycles. A write's enable and slot, undelayed
  // and delayed by one more cycle for each of the late cycles.
  std::map<int, std::string> slot_at_ = {{0, "slot"}};
  std::vector<std::string> enables_ = {"write_enable"}, write_slots_ = {"write_slot"};
  std::vector<const Input*> samples_;
  Fields fields_, late_fields_;
  std::vector<std::string> ports_ = {".clk"};
  std::string memories_;
};

}  // namespace

std::string unit_module(const LoweredDesign& design) { return RecordUnit(design).text(); }

std::string schedule_header(const LoweredDesign& design) {
  const std::string prefix = upper(design.options.module);
  return generated_line(design) + "`ifndef " + prefix + "_SCHEDULE_SVH\n`define " + prefix +
         "_SCHEDULE_SVH\n`define " + prefix + "_LATENCY " +
         std::to_string(design.schedule.latency) + "\n`define " + prefix + "_LAST_READ " +
         std::to_string(design.last_read()) + "\n`endif\n";
}

}  // namespace emax
