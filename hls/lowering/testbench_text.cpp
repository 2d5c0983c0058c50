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

// What both mains have in common: the module and the bench up to its latency.
std::string beginning(const LoweredDesign& design, const std::string& module, const char* bench) {
  if (design.about.name != design.about.function) {
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

// The module's ports and the function on bits.
std::string function_and_ports(const LoweredDesign& design) {
  return listed("      {", "       ", module_ports(design.graph.inputs()), "},") +
         listed("      {", "       ", module_ports(design.graph.outputs()), "},") +
         "      emax::on_words(&" + std::string(design.about.function) + "<" +
         std::string(design.about.scalar) + ">),\n";
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
  return text + "        return EMAX_FUNCTION" + (is_default ? "(" : "_ON(") + function + ", \"" +
         header + "\"" + (is_default ? "" : ", " + scalar) + ").lower(options);\n      }";
}

}  // namespace

std::string testbench_source(const LoweredDesign& design) {
  return beginning(design, design.options.module, "FunctionBench") +
         std::to_string(design.schedule.latency) + ",\n" + function_and_ports(design) +
         "      [&](bool" +
         (is_clocked(design) ? " clock) {\n        module.clk = clock;\n" : ") {\n") +
         "        module.eval();\n      },\n" + lowered_again(design) +
         "};\n  return emax::run_bench(bench, argc, argv);\n}\n";
}

std::string stream_testbench_source(const LoweredDesign& design) {
  return beginning(design, design.options.module + "_stream", "StreamBench") + "\n" +
         function_and_ports(design) +
         "      {module.aresetn, module.s_axis_tvalid, module.s_axis_tready, module.s_axis_tlast,\n"
         "       module.m_axis_tvalid, module.m_axis_tready, module.m_axis_tlast},\n"
         "      [&](bool clock) {\n        module.clk = clock;\n        module.eval();\n      }};\n"
         "  return emax::run_stream_bench(bench, argc, argv);\n}\n";
}

}  // namespace emax
