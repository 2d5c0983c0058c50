// The fixed-point filter's pipeline beside its software twin, on records of meshes. The Verilated
// pipeline meets the same function in the tests lowering.filter_distance_*, on numbers at random.
#include <gtest/gtest.h>

#include <cstdlib>

#include "hls/kernel/emax_kernel.h"
#include "hls/lowering/evaluate.h"
#include "hls/lowering/function_subject.h"
#include "hls/lowering/recorded_fixed.h"
#include "sw_model/model/fixed_filter.h"
#include "sw_model/model/flushed_float.h"
#include "sw_model/model/triangle_frame.h"
#include "testbench/lowered/function_bench.h"
#include "tests/hls/lowering/functions/filter_distance.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

using FilterNumber = FilterScalar<18>;

LoweredDesign filter_design() {
  return EMAX_FUNCTION_ON(filter_distance,
                          EMAX_PROJECT "/tests/hls/lowering/functions/filter_distance.h",
                          FilterNumber)
      .lower({});
}

Bits low_bits(std::int64_t raw, int width) {
  return static_cast<Bits>(raw) & ((Bits{1} << width) - 1);
}

// The words of the inputs: the point, the record's fields in their order, the flag.
std::vector<Bits> filter_inputs(const Vector3<FilterNumber>& p,
                                const TriangleRecord<FilterNumber>& t) {
  std::vector<Bits> inputs;
  const auto put = [&inputs](const FilterNumber& number) {
    inputs.push_back(low_bits(number.raw(), 18));
  };
  put(p.x);
  put(p.y);
  put(p.z);
  for_each_scalar(put, t);
  inputs.push_back((t.tag & kSegmentFlag) != 0 ? 1 : 0);
  return inputs;
}

struct Compared {
  long pairs = 0, different = 0, far = 0;
};

// `result` is the twin's of a point and a record, as the output's bits.
template <class Result>
Compared compare_filter(const DataflowGraph& graph, const Result& result, std::uint64_t seed) {
  Compared compared;
  for (const test::Stimulus& s : test::all_stimuli(seed)) {
    const Normalization normalization = normalization_of(s.cloud);
    const auto points = normalized_points(s.cloud, normalization);
    const auto records = make_records(s.mesh(), normalization);
    const int exponent = filter_exponent(points, records, 18);
    for (std::size_t j = 0; j < records.size(); j += 9) {
      const auto record = filter_record<18>(records[j], exponent);
      if (!record) continue;
      for (std::size_t i = j % 7; i < points.size(); i += 29) {
        const Vector3<FilterNumber> p = filter_point<18>(points[i], exponent);
        const std::vector<Bits> values =
            evaluate<FlushedFloat, Bits>(graph, filter_inputs(p, *record));
        const Bits expected = result(p, *record);
        ++compared.pairs;
        compared.far += expected == kFilterFar;
        compared.different += values[graph.outputs()[0].node] != expected;
      }
    }
  }
  return compared;
}

TEST(FilterLowering, GraphGivesTheFiltersNumbersOfMeshes) {
  const LoweredDesign design = filter_design();
  ASSERT_EQ(design.graph.outputs().size(), 1u);
  EXPECT_EQ(design.graph.node(design.graph.outputs()[0].node).type.width, 37);
  const Compared compared = compare_filter(
      design.graph,
      [](const auto& p, const auto& t) {
        return low_bits(filter_squared_distance<18>(p, t).raw(), 37);
      },
      51);
  EXPECT_EQ(compared.different, 0) << "of " << compared.pairs << ", seed 51";
  EXPECT_GT(compared.pairs, 5000);
}

TEST(FilterLowering, CoresGraphGivesTheSaturatedNumbers) {
  const LoweredDesign design = lower(Form::kFilter, {});
  ASSERT_EQ(design.graph.outputs().size(), 1u);
  EXPECT_EQ(design.graph.node(design.graph.outputs()[0].node).type.width, 33);
  const Compared compared = compare_filter(
      design.graph,
      [](const auto& p, const auto& t) {
        return FilterPair::result(t, (t.tag & kSegmentFlag) != 0, p);
      },
      52);
  EXPECT_EQ(compared.different, 0) << "of " << compared.pairs << ", seed 52";
  EXPECT_GT(compared.pairs, 5000);
  EXPECT_GT(compared.far, 10);
}

TEST(FilterLowering, HasTwentyProductsOf18Bits) {
  const LoweredDesign design = filter_design();
  EXPECT_EQ(design.graph.count(Operation::kFixedMultiply), 20);
}

}  // namespace
}  // namespace emax
