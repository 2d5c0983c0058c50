#include "host/device/opencl_program.h"

#include <algorithm>
#include <vector>

#include "hls/kernel/triangle_record.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr cl_int kNoPlatform = -1001;  // CL_PLATFORM_NOT_FOUND_KHR, of the loader

bool is_processor(const cl::Device& device) {
  return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
}

std::vector<cl::Device> all_devices() {
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error& error) {
    if (error.err() != kNoPlatform) throw;
  }
  std::vector<cl::Device> all;
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error& error) {
      if (error.err() != CL_DEVICE_NOT_FOUND) throw;  // a driver without its hardware
    }
    all.insert(all.end(), devices.begin(), devices.end());
  }
  std::stable_partition(all.begin(), all.end(),
                        [](const cl::Device& device) { return !is_processor(device); });
  return all;
}

cl::Device device_of(std::uint32_t number) {
  const std::vector<cl::Device> devices = all_devices();
  const std::string name = "device opencl:" + std::to_string(number);
  if (devices.empty()) {
    throw Error(name +
                ": this machine has no OpenCL device; install the driver of its GPU, or PoCL for "
                "its processor (Debian: pocl-opencl-icd), or leave out --device");
  }
  if (number < devices.size()) return devices[number];
  const std::vector<std::string> titles = opencl_devices();
  std::string there;
  for (std::size_t i = 0; i < titles.size(); ++i) {
    there += (i == 0 ? "opencl:" : ", opencl:") + std::to_string(i) + " (" + titles[i] + ")";
  }
  throw Error(name + ": there is no such device; use " + there);
}

std::uint32_t preferred_lanes(const cl::Device& device) {
  const std::uint32_t width = device.getInfo<CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT>();
  std::uint32_t lanes = 1;
  while (lanes < 16 && 2 * lanes <= width) lanes *= 2;
  return lanes;
}

// The first line of a compiler's log that is an error, or the first one.
std::string first_error(const std::string& log) {
  const std::size_t error = log.find("error:");
  const std::size_t begin = error == log.npos ? 0 : error;
  return log.substr(begin, log.find('\n', begin) - begin);
}

cl::Program compiled(const std::string& title, const cl::Context& context, const cl::Device& device,
                     std::string_view text, std::uint32_t lanes) {
  cl::Program program(context, std::string(text));
  const std::string options = "-cl-std=CL1.2 -w -DLANES=" + std::to_string(lanes) +
                              " -DRECORD_WORDS=" + std::to_string(kRecordWords);
  try {
    program.build(device, options.c_str());
  } catch (const cl::BuildError&) {
    throw Error("device " + title + ": its driver does not compile the kernel: " +
                first_error(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device)) +
                "; update the driver, take another device, or leave out --device");
  }
  return program;
}

}  // namespace

std::vector<std::string> opencl_devices() {
  return with_opencl("opencl", [] {
    std::vector<std::string> names;
    for (const cl::Device& device : all_devices())
      names.push_back(device.getInfo<CL_DEVICE_NAME>());
    return names;
  });
}

void throw_opencl(const std::string& title, const cl::Error& error) {
  throw Error("device " + title + ": " + error.what() + " failed with OpenCL's error " +
              std::to_string(error.err()) + "; take another device, or leave out --device");
}

OpenclProgram::OpenclProgram(const OpenclChoice& choice)
    : name("opencl:" + std::to_string(choice.number)), title(name) {
  with_opencl(title, [&] {
    const cl::Device device = device_of(choice.number);
    title += " (" + device.getInfo<CL_DEVICE_NAME>() + ")";
    is_cpu = is_processor(device);
    units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    lanes = choice.lanes.value_or(preferred_lanes(device));
    context = cl::Context(device);
    program = compiled(title, context, device, choice.text, lanes);
    queue = cl::CommandQueue(context, device);
  });
}

}  // namespace emax
