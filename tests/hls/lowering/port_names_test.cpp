#include "hls/lowering/port_names.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "hls/lowering/fields.h"
#include "hls/lowering/function_subject.h"

namespace emax {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kHeaderText = R"(
// struct Ray { Scalar wrong; };
template <class Scalar>
struct Ray {
  emax::Vector3<Scalar> origin, direction;  // of unit length
  Scalar limit;
};
template <class Scalar> struct Hit { Scalar t; ConditionOf<Scalar> inside; };

template <class Scalar, class Other = std::pair<Scalar, Scalar>>
inline Hit<Scalar> meet(const Ray<Scalar>& ray,
                        Scalar radius /* , int */, const std::pair<Scalar, int>& other) {
  return {meet_other(ray), radius < other};
}
template <class Scalar> Scalar norm(const emax::Vector3<Scalar>& p) { return p.x; }
float none() { return norm(1); }
)";

TEST(PortNames, ComeFromParametersAndFields) {
  const PortNames names = port_names(kHeaderText, "meet");
  EXPECT_EQ(names.inputs,
            (Names{"ray_origin_x", "ray_origin_y", "ray_origin_z", "ray_direction_x",
                   "ray_direction_y", "ray_direction_z", "ray_limit", "radius", "other"}));
  EXPECT_EQ(names.outputs, (Names{"t", "inside"}));
  EXPECT_EQ(port_names(kHeaderText, "norm").inputs, (Names{"p_x", "p_y", "p_z"}));
  EXPECT_EQ(port_names(kHeaderText, "norm").outputs, Names{"norm"});
  EXPECT_EQ(port_names(kHeaderText, "none").inputs, Names{});
  EXPECT_THROW(port_names(kHeaderText, "meet_other"),
               std::invalid_argument);  // called, not defined
}

struct Inner {
  float a;
  bool b;
};
struct Outer {
  Inner first, second;
  float third;
};

TEST(Fields, AreVisitedInTheirOrder) {
  Outer outer = {{1, true}, {2, false}, 3};
  std::vector<float> visited;
  for_each_leaf([&](auto& scalar) { visited.push_back(static_cast<float>(scalar)); }, outer);
  EXPECT_EQ(visited, (std::vector<float>{1, 1, 2, 0, 3}));
}

template <class Scalar>
struct Unnamed {
  Scalar x, y;
};
template <class Scalar>
Scalar first_of(const Unnamed<Scalar>& value) {
  return value.x + value.y;
}

// The struct is not in the text, so the text has fewer names than the function has inputs.
TEST(FunctionSubject, RefusesATextThatDoesNotNameEveryPort) {
  const LoweringSubject subject =
      function_subject(&first_of<RecordedValue>, "first_of", "tests/hls/lowering/no_such_file.h");
  EXPECT_THROW(subject.lower({}), std::invalid_argument);
}

}  // namespace
}  // namespace emax
