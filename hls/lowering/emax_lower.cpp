// emax_lower: makes SystemVerilog, and OpenCL C, from a function of the kernel.
#include "hls/lowering/designs.h"
#include "hls/lowering/lowering_program.h"

int main(int argc, char** argv) {
  std::vector<emax::LoweringSubject> forms;
  for (const emax::Form form : emax::kForms) {
    forms.push_back({std::string(emax::info(form).name),
                     [form](const auto& options) { return emax::lower(form, options); }});
  }
  return emax::lowering_program(argc, argv, forms);
}
