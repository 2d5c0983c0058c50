// Fixed-point scalars that record (hls/lowering/recorded_value.h). RecordedFixed has the operations
// of Fixed with the same parameters.
#pragma once

#include "hls/kernel/fixed.h"
#include "hls/lowering/recorded_value.h"

namespace emax {

template <int kWidth, int kFraction, Rounding kRounding, Overflow kOverflow>
class RecordedFixed : public RecordedNode<RecordedFixed<kWidth, kFraction, kRounding, kOverflow>> {
  using Base = RecordedNode<RecordedFixed>;
  using Number = Fixed<kWidth, kFraction, kRounding, kOverflow>;
  using Here = Located<RecordedFixed>;

 public:
  static ValueType type() { return ValueType(Number::format()); }
  static RecordedFixed of(NodeId node) { return RecordedFixed(node, IsNode()); }

  RecordedFixed() = default;
  explicit RecordedFixed(double constant)
      : Base(Recording::graph().add_constant(type(), bits_of(Number(constant)))) {}
  // Another format's number, fitted to this one.
  template <int kOther, int kOthers, Rounding kAnyRounding, Overflow kAnyOverflow>
  explicit RecordedFixed(const RecordedFixed<kOther, kOthers, kAnyRounding, kAnyOverflow>& other,
                         CallPlace at = CallPlace::current())
      : Base(Recording::graph().add_operation(
            Operation::kFixedFit, {other.node(), kNoNode, kNoNode},
            {at.file_name(), at.line(), at.column(), at.function_name()}, type())) {}

  friend RecordedFixed operator+(const Here& a, const RecordedFixed& b) {
    return number(Operation::kFixedAdd, a, b.node());
  }
  friend RecordedFixed operator-(const Here& a, const RecordedFixed& b) {
    return number(Operation::kFixedSubtract, a, b.node());
  }
  friend RecordedFixed operator*(const Here& a, const RecordedFixed& b) {
    static_assert(2 * kWidth <= kMostFixedBits + 2, "the exact product has at most 64 bits");
    return of(Recording::graph().add_operation(Operation::kFixedMultiply,
                                               {a.node, b.node(), kNoNode}, a.place, type()));
  }
  friend RecordedFixed operator-(const Here& a) { return number(Operation::kFixedNegate, a); }
  friend RecordedFixed magnitude(const Here& a) { return number(Operation::kFixedMagnitude, a); }

  // The other comparisons are made of this one.
  friend RecordedCondition operator<(const Here& a, const RecordedFixed& b) {
    return less(a, a.node, b.node());
  }
  friend RecordedCondition operator>(const Here& a, const RecordedFixed& b) {
    return less(a, b.node(), a.node);
  }
  friend RecordedCondition operator<=(const Here& a, const RecordedFixed& b) {
    return logic(a, Operation::kNegated, less(a, b.node(), a.node));
  }
  friend RecordedCondition operator>=(const Here& a, const RecordedFixed& b) {
    return logic(a, Operation::kNegated, less(a, a.node, b.node()));
  }
  // Both sides alike: an operand order that C++20 may reverse.
  friend RecordedCondition operator!=(const Here& a, const Here& b) {
    return logic(a, Operation::kEither, less(a, a.node, b.node), less(a, b.node, a.node));
  }
  friend RecordedCondition operator==(const Here& a, const Here& b) {
    return logic(a, Operation::kNegated,
                 logic(a, Operation::kEither, less(a, a.node, b.node), less(a, b.node, a.node)));
  }
  friend RecordedFixed select(const Located<RecordedCondition>& condition,
                              const RecordedFixed& if_true, const RecordedFixed& if_false) {
    return of(Recording::graph().add_operation(
        Operation::kSelect, {condition.node, if_true.node(), if_false.node()}, condition.place));
  }

 private:
  struct IsNode {};
  RecordedFixed(NodeId node, IsNode /*tag*/) : Base(node) {}

  static std::uint64_t bits_of(const Number& constant) {
    return static_cast<std::uint64_t>(constant.raw()) & ((std::uint64_t{1} << kWidth) - 1);
  }
  static RecordedFixed number(Operation operation, const Here& a, NodeId b = kNoNode) {
    return of(Recording::graph().add_operation(operation, {a.node, b, kNoNode}, a.place));
  }
  // Operations at the place of the comparison that they are made for.
  static RecordedCondition less(const Here& place, NodeId a, NodeId b) {
    return RecordedCondition(
        Recording::graph().add_operation(Operation::kFixedLess, {a, b, kNoNode}, place.place));
  }
  static RecordedCondition logic(const Here& place, Operation operation, const RecordedCondition& a,
                                 const RecordedCondition& b = RecordedCondition()) {
    return RecordedCondition(
        Recording::graph().add_operation(operation, {a.node(), b.node(), kNoNode}, place.place));
  }
};

template <class Result, int kA, int kFractionA, Rounding kRoundingA, Overflow kOverflowA, int kB,
          int kFractionB, Rounding kRoundingB, Overflow kOverflowB>
Result product(const RecordedFixed<kA, kFractionA, kRoundingA, kOverflowA>& a,
               const RecordedFixed<kB, kFractionB, kRoundingB, kOverflowB>& b,
               CallPlace at = CallPlace::current()) {
  static_assert(kA + kB <= kMostFixedBits + 2, "the exact product has at most 64 bits");
  return Result::of(Recording::graph().add_operation(
      Operation::kFixedMultiply, {a.node(), b.node(), kNoNode},
      {at.file_name(), at.line(), at.column(), at.function_name()}, Result::type()));
}

template <int kOther, int kOthers, Rounding kRounding, Overflow kOverflow, int kWidth,
          int kFraction>
struct FormatOf<RecordedFixed<kOther, kOthers, kRounding, kOverflow>, kWidth, kFraction> {
  using Type = RecordedFixed<kWidth, kFraction, kRounding, kOverflow>;
};

template <int kWidth, int kFraction, Rounding kRounding, Overflow kOverflow>
struct RecordedScalar<Fixed<kWidth, kFraction, kRounding, kOverflow>> {
  using Type = RecordedFixed<kWidth, kFraction, kRounding, kOverflow>;
};

}  // namespace emax
