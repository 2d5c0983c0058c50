#include "hls/lowering/testbench_text.h"

#include <algorithm>
#include <stdexcept>

#include "hls/lowering/verilog_text.h"

namespace emax {

std::string testbench_source(const LoweredDesign& design) {
  const std::string module = design.options.module, function(design.about.function);
  if (design.about.name != design.about.function) {
    throw std::invalid_argument(
        "--testbench is for functions of one's own; the kernel's forms have "
        "theirs, ./dev cosim");
  }
  const auto ports = [&](const auto& list) {
    std::vector<std::string> names;
    for (const auto& port : list) names.push_back("module." + port.name);
    return names;
  };
  const bool clocked = std::any_of(design.schedule.ready.begin(), design.schedule.ready.end(),
                                   [](int cycle) { return cycle > 0; });
  return generated_line(design) + "#include \"V" + module + ".h\"\n#include \"" +
         std::string(design.about.source) +
         "\"\n#include \"testbench/lowered/function_bench.h\"\n\n"
         "int main(int argc, char** argv) {\n  V" +
         module + " module;\n" + "  const emax::FunctionBench bench = {\n      \"" + function +
         "\", " + std::to_string(design.schedule.latency) + ",\n" +
         listed("      {", "       ", ports(design.graph.inputs()), "},") +
         listed("      {", "       ", ports(design.graph.outputs()), "},") +
         "      emax::on_words(&" + function + "<" + std::string(design.about.scalar) + ">),\n" +
         "      [&](bool" + (clocked ? " clock) {\n        module.clk = clock;\n" : ") {\n") +
         "        module.eval();\n      }};\n  return emax::run_bench(bench, argc, argv);\n}\n";
}

}  // namespace emax
