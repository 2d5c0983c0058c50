#include "host/device/opencl_device.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "host/device/opencl_commands.h"
#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/flushed_float.h"
#include "sw_model/model/probe_pairs.h"

namespace emax {
namespace {

struct OperandPairs {
  std::vector<Word> a, b;
};

// Every pair of special values, pairs of any bits, and pairs whose product is about the smallest
// normal number.
OperandPairs operand_pairs() {
  constexpr Word kSpecial[] = {0,          1,          0x007fffff, 0x00800000, 0x00800001,
                               0x00ffffff, 0x01000000, 0x1f800000, 0x20000001, 0x3f000000,
                               0x3f7fffff, 0x3f800000, 0x3f800001, 0x4b800001, 0x7f000000,
                               0x7f7fffff, 0x7f800000, 0x7fc00000, 0x7f800001, 0x7fffffff};
  OperandPairs pairs;
  const auto add = [&pairs](Word a, Word b) {
    pairs.a.push_back(a);
    pairs.b.push_back(b);
  };
  for (const Word a : kSpecial) {
    for (const Word b : kSpecial) {
      for (const Word signs : {0u, 1u, 2u, 3u}) add(a | signs << 31, b | (signs >> 1) << 31);
    }
  }
  ProbePairs random;
  constexpr int kRandom = 2048;
  for (int i = 0; i < kRandom; ++i) {
    const Word a = random.word(), b = random.word() ^ a >> 9;
    add(a, b);
    add(a, (b & 0x007fffff) | (a & 0x7f800000));  // of the same size
    const Word exponent = 1 + (a >> 16) % 126;    // with b's, that of the smallest normal product
    add((a & 0x807fffff) | exponent << 23, (b & 0x807fffff) | (127 - exponent) << 23);
  }
  return pairs;
}

std::string hex(Word word) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08x", static_cast<unsigned>(word));
  return text;
}

[[noreturn]] void refuse_arithmetic(const OpenclProgram& opencl, const std::string& what) {
  throw Error("device " + opencl.title + ": " + what +
              "; its arithmetic cannot give the bits of the other devices, take another device or "
              "leave out --device");
}

void compare_operators(const OpenclProgram& opencl) {
  OperandPairs pairs = operand_pairs();
  const std::size_t n = pairs.a.size();
  std::vector<Word> results(4 * n);
  cl::Buffer a(opencl.context, pairs.a.begin(), pairs.a.end(), true);
  cl::Buffer b(opencl.context, pairs.b.begin(), pairs.b.end(), true);
  cl::Buffer out(opencl.context, CL_MEM_WRITE_ONLY, results.size() * sizeof(Word));
  cl::Kernel operate(opencl.program, "operate");
  operate.setArg(0, a);
  operate.setArg(1, b);
  operate.setArg(2, out);
  opencl.queue.enqueueNDRangeKernel(operate, cl::NullRange, cl::NDRange(n));
  opencl.queue.enqueueReadBuffer(out, CL_TRUE, 0, results.size() * sizeof(Word), results.data());
  for (std::size_t i = 0; i < n; ++i) {
    const FlushedFloat x(bits_float(pairs.a[i])), y(bits_float(pairs.b[i]));
    const Word expected[] = {to_word(x + y), to_word(x - y), to_word(x * y), x < y ? 1u : 0u};
    const char* const signs[] = {" + ", " - ", " * ", " < "};
    for (std::size_t k = 0; k < std::size(expected); ++k) {
      if (results[k * n + i] == expected[k]) continue;
      refuse_arithmetic(opencl, hex(pairs.a[i]) + signs[k] + hex(pairs.b[i]) + " gives " +
                                    hex(results[k * n + i]) + " and not " + hex(expected[k]));
    }
  }
}

void compare_distances(OpenclDevice& device, const OpenclProgram& opencl) {
  ProbePairs pairs;
  std::vector<Vector3<float>> points(64);
  for (Vector3<float>& point : points) point = pairs.point();
  for (int i = 0; i < 16; ++i) {
    const std::vector<TriangleRecord<float>> records = {pairs.record()};
    std::vector<Word> words;
    append_load_points(words, points);
    append_records(words, records);
    append_reduce(words, true);
    device.send(words);
    if (receive_reduce(device, points.size(), true).points_squared_bits !=
        nearest_squared_bits(points, records)) {
      refuse_arithmetic(opencl, "the distances of its kernel differ from the model's");
    }
  }
}

}  // namespace

OpenclDevice::OpenclDevice(const OpenclChoice& choice) {
  with_opencl("opencl:" + std::to_string(choice.number),
              [&] { commands_ = std::make_unique<Commands>(choice); });
}

OpenclDevice::~OpenclDevice() = default;

std::string OpenclDevice::name() const { return commands_->opencl().name; }

void OpenclDevice::verify_arithmetic() {
  with_opencl(commands_->opencl().title, [&] { compare_operators(commands_->opencl()); });
  compare_distances(*this, commands_->opencl());
}

void OpenclDevice::send(std::span<const Word> words) {
  with_opencl(commands_->opencl().title, [&] {
    while (!words.empty()) commands_->take(cursor_.take(words));
  });
}

void OpenclDevice::receive(std::span<Word> words) {
  with_opencl(commands_->opencl().title, [&] { commands_->give(words); });
}

}  // namespace emax
