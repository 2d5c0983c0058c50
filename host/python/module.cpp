#include <emax/error.h>
#include <nanobind/nanobind.h>

#include "host/python/bindings.h"
#include "host/python/certified_mesh.h"
#include "sw_model/model/self_test.h"

namespace nb = nanobind;

// The part of the package that is compiled. Its functions take what emax/*.py has made of the
// arguments.
NB_MODULE(_core, module) {
  const nb::exception<emax::Error> error(module, "Error", PyExc_Exception);
  module.attr("version") = EMAX_VERSION;
  emax::verify_arithmetic();
  emax::bind_arrays(module);
  emax::bind_certified_mesh(module);
  emax::bind_decimate(module);
  emax::bind_error(module);
  emax::bind_verify(module);
  emax::bind_reconstruct(module);
  emax::bind_minimize(module);
}
