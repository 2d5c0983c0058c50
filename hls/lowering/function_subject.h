// A function of one's own as a subject of lowering. The function is a template on its scalar:
//
//   template <class Scalar>
//   Scalar squared_norm(const Vector3<Scalar>& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }
//
// It takes and returns scalars, conditions (ConditionOf<Scalar>) and aggregates of these, and does
// not branch on them: `select` chooses (hls/kernel/scalar.h).
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "hls/lowering/fields.h"
#include "hls/lowering/lowering_program.h"
#include "hls/lowering/recorded_fixed.h"
#include "hls/lowering/recorded_value.h"

namespace emax {

// The recording of one call; the templates below give it arguments and take the result.
class FunctionRecorder {
 public:
  // `header` is the path of the text that defines the function, `scalar` the type that the model's
  // function is a template of. All must outlive the design.
  FunctionRecorder(std::string_view function, std::string_view header, std::string_view scalar)
      : function_(function), header_(header), scalar_(scalar), recording_(graph_) {}

  void give(RecordedCondition& value) { value = RecordedCondition(input(ValueKind::kCondition)); }
  template <int kExponent, int kMantissa>
  void give(RecordedBinary<kExponent, kMantissa>& value) {
    value = value.of(input(value.type()));
  }
  template <int kWidth, int kFraction, Rounding kRounding, Overflow kOverflow>
  void give(RecordedFixed<kWidth, kFraction, kRounding, kOverflow>& value) {
    value = value.of(input(value.type()));
  }
  template <class Recorded>
  void take(const RecordedNode<Recorded>& value) {
    graph_.add_output("", value.node());
  }

  // Names the ports from the text, and lowers. Throws std::invalid_argument if the text does not
  // give as many names as the function has ports, if no result needs one of the inputs, or if the
  // record of the options has a parameter that there is not, one twice, all of them or none.
  LoweredDesign lower(const LoweringOptions& options);

 private:
  NodeId input(ValueType type) { return graph_.add_input("", type, Arrival::kSample); }
  int keep_record(const std::vector<bool>& in_record, const std::vector<std::size_t>& parameter_of);

  std::string_view function_, header_, scalar_;
  DataflowGraph graph_;
  Recording recording_;
};

template <class Result, class... Arguments>
LoweringSubject function_subject(Result (*function)(Arguments...), std::string_view name,
                                 std::string_view header, std::string_view model = kModelScalar) {
  return {std::string(name), [=](const LoweringOptions& options) {
            FunctionRecorder recorder(name, header, model);
            std::tuple<std::decay_t<Arguments>...> arguments;
            std::apply(
                [&](auto&... each) {
                  for_each_leaf([&](auto& scalar) { recorder.give(scalar); }, each...);
                },
                arguments);
            const auto result = std::apply(function, arguments);
            for_each_leaf([&](const auto& scalar) { recorder.take(scalar); }, result);
            return recorder.lower(options);
          }};
}

// The name of a template cannot stand in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define EMAX_FUNCTION(function, header) \
  ::emax::function_subject(&function<::emax::RecordedValue>, #function, header)

// The same on another scalar: EMAX_FUNCTION_ON(f, "f.h", emax::Fixed<18, 16>), or with
// emax::Binary<5, 10>.
#define EMAX_FUNCTION_ON(function, header, ...)                                           \
  ::emax::function_subject(&function<typename ::emax::RecordedScalar<__VA_ARGS__>::Type>, \
                           #function, header, #__VA_ARGS__)
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace emax
