#pragma once

#include <nanobind/nanobind.h>

namespace emax {

// Each adds the functions of its source to the module.
void bind_decimate(nanobind::module_& module);
void bind_error(nanobind::module_& module);
void bind_verify(nanobind::module_& module);
void bind_reconstruct(nanobind::module_& module);
void bind_minimize(nanobind::module_& module);

}  // namespace emax
