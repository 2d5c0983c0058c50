// The only header that includes OpenCL's.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <string>

#include "host/device/opencl_device.h"

namespace emax {

// The kernel compiled for a device, and the queue to it, which keeps the order of its commands.
struct OpenclProgram {
  // Throws Error as OpenclDevice does.
  explicit OpenclProgram(const OpenclChoice& choice);

  std::string name;   // "opencl:0"
  std::string title;  // "opencl:0 (name of the hardware)"
  bool is_cpu;
  std::uint32_t units;  // that compute
  std::uint32_t lanes;
  cl::Context context;
  cl::Program program;
  cl::CommandQueue queue;
};

// A fault of OpenCL as an Error that names device, call and code.
[[noreturn]] void throw_opencl(const std::string& title, const cl::Error& error);

template <class Action>
auto with_opencl(const std::string& title, Action action) {
  try {
    return action();
  } catch (const cl::Error& error) {
    throw_opencl(title, error);
  }
}

}  // namespace emax
