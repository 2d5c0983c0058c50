#include "hls/lowering/testbench_text.h"

#include <stdexcept>
#include <vector>

#include "hls/lowering/systemverilog.h"
#include "hls/lowering/verilog_text.h"

namespace emax {

namespace {

std::vector<std::string> module_ports(const auto& list) {
  std::vector<std::string> names;
  for (const auto& port : list) names.push_back("module." + port.name);
  return names;
}

// "{module.a, module.b},\n"
std::string braced(const std::vector<std::string>& items) {
  return listed("      {", "       ", items, "},");
}

// A text for each of the inputs for which `make` gives one.
std::vector<std::string> of_inputs(const LoweredDesign& design, const auto& make) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < design.graph.inputs().size(); ++i) {
    if (std::string text = make(design.graph.inputs()[i], i); !text.empty()) {
      texts.push_back(std::move(text));
    }
  }
  return texts;
}

// The places of the arguments that the record holds.
std::vector<std::string> record_places(const LoweredDesign& design) {
  return of_inputs(design, [](const Input& input, std::size_t place) {
    return input.arrival == Arrival::kMemory ? std::to_string(place) : std::string();
  });
}

// What both mains have in common: the module and the bench up to its latency.
std::string beginning(const LoweredDesign& design, const std::string& module, const char* bench) {
  if (!is_own(design)) {
    throw std::invalid_argument(
        "a testbench is for functions of one's own; the kernel's forms have theirs, ./dev cosim");
  }
  return generated_line(design) + "#include \"V" + module + ".h\"\n#include \"" +
         std::string(design.about.source) +
         "\"\n#include \"hls/lowering/function_subject.h\"\n"
         "#include \"testbench/lowered/function_bench.h\"\n\n"
         "int main(int argc, char** argv) {\n  V" +
         module + " module;\n" + "  const emax::" + bench + " bench = {\n      \"" +
         std::string(design.about.function) + "\", ";
}

// The function on bits.
std::string function_model(const LoweredDesign& design) {
  return "      emax::on_words(&" + std::string(design.about.function) + "<" +
         std::string(design.about.scalar) + ">),\n";
}

// The module's ports and the function on bits.
std::string function_and_ports(const LoweredDesign& design) {
  return braced(module_ports(design.graph.inputs())) +
         braced(module_ports(design.graph.outputs())) + function_model(design);
}

// `clock` drives the module.
std::string evaluation() {
  return "      [&](bool clock) {\n        module.clk = clock;\n        module.eval();\n      }";
}

// The lowering as it was asked for. Latencies decide where values wait; the rest of the options
// is of the text alone.
std::string lowered_again(const LoweredDesign& design) {
  const std::string function(design.about.function), header(design.about.source);
  const std::string scalar(design.about.scalar);
  const bool is_default = scalar == kModelScalar;
  std::string text = "      [] {\n        emax::LoweringOptions options;\n";
  for (const LatencyLimits& limits : kLatencyLimits) {
    const int cycles = design.options.latencies.*limits.cycles;
    if (cycles == Latencies{}.*limits.cycles) continue;
    text += "        options.latencies." + std::string(limits.name) + " = " +
            std::to_string(cycles) + ";\n";
  }
  std::vector<std::string> record;
  for (const std::string& name : design.options.record) record.push_back("\"" + name + "\"");
  if (!record.empty()) text += listed("        options.record = {", "            ", record, "};");
  return text + "        return EMAX_FUNCTION" + (is_default ? "(" : "_ON(") + function + ", \"" +
         header + "\"" + (is_default ? "" : ", " + scalar) + ").lower(options);\n      }";
}

}  // namespace

std::string testbench_source(const LoweredDesign& design) {
  const auto cycles = of_inputs(design, [&](const Input& input, std::size_t) {
    return std::to_string(design.schedule.start[input.node]);
  });
  return beginning(design, design.options.module, "FunctionBench") +
         std::to_string(design.schedule.latency) + ",\n" + function_and_ports(design) +
         (is_clocked(design) ? evaluation() : "      [&](bool) { module.eval(); }") + ",\n" +
         lowered_again(design) +
         (design.about.record_bits > 0 ? ",\n" + listed("      {", "       ", cycles, "}};")
                                       : "};\n") +
         "  return emax::run_bench(bench, argc, argv);\n}\n";
}

std::string unit_testbench_source(const LoweredDesign& design) {
  const auto items = of_inputs(design, [](const Input& input, std::size_t) {
    return input.arrival == Arrival::kSample ? "module." + input.name : std::string();
  });
  std::string text = beginning(design, design.options.module + "_unit", "UnitBench");
  if (design.about.record_bits == 0) {
    throw std::invalid_argument(std::string(design.about.name) +
                                " has no record; give its parameters with --record");
  }
  return text + std::to_string(design.schedule.latency) + ", " +
         std::to_string(design.last_read()) + ",\n" + braced(record_places(design)) +
         braced(items) + braced(module_ports(design.graph.outputs())) + function_model(design) +
         "      {module.write_enable, module.write_slot, module.slot},\n"
         "      [&](const auto& words) { emax::set_words(module.write_record, words); },\n" +
         evaluation() + "};\n  return emax::run_unit_bench(bench, argc, argv);\n}\n";
}

std::string stream_testbench_source(const LoweredDesign& design) {
  std::string records;
  if (design.about.record_bits > 0) {
    records =
        ",\n      emax::RecordPorts{module.s_axis_record_tvalid, "
        "module.s_axis_record_tready,\n" +
        listed("                        {", "                         ", record_places(design),
               "}}");
    records.pop_back();
  }
  return beginning(design, design.options.module + "_stream", "StreamBench") + "\n" +
         function_and_ports(design) +
         "      {module.aresetn, module.s_axis_tvalid, module.s_axis_tready, module.s_axis_tlast,\n"
         "       module.m_axis_tvalid, module.m_axis_tready, module.m_axis_tlast},\n" +
         evaluation() + records + "};\n  return emax::run_stream_bench(bench, argc, argv);\n}\n";
}

}  // namespace emax
