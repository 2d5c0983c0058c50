#include "host/device/opencl_device.h"

#include <gtest/gtest.h>

#include "host/block_search/block_search.h"
#include "host/device/device_evaluator.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

// The kernel's text with one change, as a fault.
std::string text_with(std::string_view before, std::string_view after) {
  std::string text(opencl_text());
  const std::size_t place = text.find(before);
  EXPECT_NE(place, text.npos) << before;
  EXPECT_EQ(text.find(before, place + 1), text.npos) << before;
  return text.replace(place, before.size(), after);
}

std::string refusal(const OpenclChoice& choice) {
  try {
    OpenclDevice(choice).verify_arithmetic();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  EXPECT_EQ(text.find('\n'), text.npos) << text;
  for (const char* word : words) EXPECT_NE(text.find(word), text.npos) << word << " in " << text;
}

// Every stimulus by the whole way of a device, without the self-test before it.
int inputs_that_differ(const OpenclChoice& choice) {
  DeviceEvaluator evaluator(std::make_unique<OpenclDevice>(choice));
  int differing = 0;
  for (const test::Stimulus& s : test::all_stimuli(90)) {
    const PreparedCloud cloud(s.cloud);
    const TriangleTree mesh(s.mesh(), cloud.normalization());
    differing += search_nearest(cloud, mesh, evaluator) !=
                 nearest_squared_bits(cloud.points(), mesh.records());
  }
  return differing;
}

TEST(OpenclDevice, GivesTheModelsBitsForAnyNumberOfLanes) {
  for (const std::uint32_t lanes : {1u, 2u, 4u, 8u, 16u}) {
    SCOPED_TRACE(lanes);
    EXPECT_EQ(refusal({.lanes = lanes}), "");
    EXPECT_EQ(inputs_that_differ({.lanes = lanes}), 0);
  }
}

TEST(OpenclDeviceFault, SelfTestSeesProductsThatAreNotFlushed) {
  const std::string text = text_with("select(product, signed_zero(product), tiny)", "product");
  expect_words(refusal({.text = text}), {"opencl:0 (", " * ", "gives", "leave out --device"});
}

// A product below the smallest normal number that only a subnormal's few digits round up to it.
TEST(OpenclDeviceFault, SelfTestSeesProductsThatAreRoundedAsSubnormals) {
  const std::string text = text_with("(magnitude_word(scaled) < as_uint(0x1p-62f))", "0");
  expect_words(refusal({.text = text}), {"opencl:0 (", " * ", "0x00800000"});
}

TEST(OpenclDeviceFault, SelfTestSeesContraction) {
  const std::string text = text_with("x_sum = fp_add(x_product, x_product_2)",
                                     "x_sum = fma(fp_flushed(t_normal_x), q_x, x_product_2)");
  expect_words(refusal({.text = text}), {"opencl:0 (", "the distances of its kernel differ"});
}

TEST(OpenclDeviceFault, ComparisonSeesARecordLeftOut) {
  const std::string text = text_with("i < end; ++i", "i + 1 < end; ++i");
  EXPECT_GT(inputs_that_differ({.text = text}), 0);
}

TEST(OpenclDevice, SaysWhatStopsIt) {
  expect_words(refusal({.number = 99}), {"opencl:99", "no such device", "opencl:0 ("});
  expect_words(refusal({.text = "kernel void meet_records() { undeclared = 1; }"}),
               {"opencl:0 (", "does not compile", "undeclared", "leave out --device"});
  expect_words(refusal({.text = "kernel void another(global int* a) { *a = 1; }"}),
               {"opencl:0", "clCreateKernel", "-46"});
}

std::vector<Word> answers_to(const std::vector<Word>& commands, std::size_t count) {
  OpenclDevice device({});
  // In two parts, as a stream may come.
  device.send(std::span(commands).first(commands.size() / 2));
  device.send(std::span(commands).subspan(commands.size() / 2));
  std::vector<Word> answers(count);
  device.receive(answers);
  EXPECT_THROW(device.receive(answers), Error);  // nothing more was asked
  return answers;
}

TEST(OpenclDevice, AnswersMalformedCommandsAsTheTopDoes) {
  const Word error = command_header(kError, 1), reduce = command_header(kReduce, 0);
  EXPECT_EQ(answers_to({reduce, command_header(Opcode{77}, 0), reduce}, 4),
            (std::vector<Word>{error, kNoPoints, error, kUnknownCommand}));
  std::vector<Word> commands = {command_header(kLoadPoints, kMaxBlockPoints + 1)};
  commands.resize(1 + kPointWords * (kMaxBlockPoints + 1));
  commands.insert(commands.end(), {reduce, command_header(kCounters, 0)});
  EXPECT_EQ(answers_to(commands, 3),
            (std::vector<Word>{error, kTooManyPoints, command_header(kCounters, 0)}));
  // A block without records: every point is infinitely far.
  EXPECT_EQ(answers_to({command_header(kLoadPoints, 1), 0, 0, 0, reduce}, 3),
            (std::vector<Word>{command_header(kReduce, kAnswerWorst), 0x7f800000u, 0}));
}

// More records than one transfer takes.
TEST(OpenclDevice, TakesAnyNumberOfRecords) {
  const test::Stimulus s = test::bumpy_sphere(100, 100, 40, 91);
  const PreparedCloud cloud(s.cloud);
  const TriangleTree mesh(s.mesh(), cloud.normalization());
  ASSERT_GT(mesh.records().size(), 1u << 14);
  DeviceEvaluator evaluator(std::make_unique<OpenclDevice>(OpenclChoice{}));
  EXPECT_EQ(brute_force_emax(cloud, mesh, evaluator), emax_model(cloud.points(), mesh.records()));
}

}  // namespace
}  // namespace emax
