// Scalars that record. A function on the kernel's scalar template, called with them, appends its
// operations to a DataflowGraph instead of computing. A recorded condition has no truth value, so a
// function that branches on data does not compile.
//
// An operation's first parameter is made implicitly from a recorded value. This conversion also
// takes the place of the call in the source, so the kernel needs no annotation.
#pragma once

#include <source_location>

#include "hls/kernel/binary.h"
#include "hls/lowering/dataflow_graph.h"

namespace emax {

// During its lifetime, this thread records into `graph`. Recordings nest.
class Recording {
 public:
  explicit Recording(DataflowGraph& graph) : outer_(active) { active = &graph; }
  ~Recording() { active = outer_; }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  static DataflowGraph& graph() { return *active; }

 private:
  static inline thread_local DataflowGraph* active = nullptr;
  DataflowGraph* outer_;
};

#ifdef __cpp_lib_source_location
using CallPlace = std::source_location;
#else
// The replacement for std::source_location in Clang before 16.
class CallPlace {
 public:
  static constexpr CallPlace current(const char* file = __builtin_FILE(),
                                     const char* function = __builtin_FUNCTION(),
                                     unsigned line = __builtin_LINE(),
                                     unsigned column = __builtin_COLUMN()) {
    return {file, function, line, column};
  }
  constexpr const char* file_name() const { return file_; }
  constexpr const char* function_name() const { return function_; }
  constexpr unsigned line() const { return line_; }
  constexpr unsigned column() const { return column_; }

 private:
  constexpr CallPlace(const char* file, const char* function, unsigned line, unsigned column)
      : file_(file), function_(function), line_(line), column_(column) {}

  const char *file_, *function_;
  unsigned line_, column_;
};
#endif

template <class Recorded>
struct Located {
  // Implicit: this conversion is where the place of the operation is taken.
  Located(const Recorded& recorded,  // NOLINT(google-explicit-constructor)
          CallPlace at = CallPlace::current())
      : node(recorded.node()), place{at.file_name(), at.line(), at.column(), at.function_name()} {}

  NodeId node;
  SourcePlace place;
};

// The common base: a node of the graph. CRTP only keeps the kinds of values apart.
template <class Recorded>
class RecordedNode {
 public:
  RecordedNode() = default;
  explicit RecordedNode(NodeId node) : node_(node) {}
  NodeId node() const { return node_; }

 private:
  NodeId node_ = kNoNode;
};

template <class Result, class First>
Result recorded(Operation operation, const Located<First>& a, NodeId b = kNoNode,
                NodeId c = kNoNode) {
  return Result(Recording::graph().add_operation(operation, {a.node, b, c}, a.place));
}

class RecordedCondition : public RecordedNode<RecordedCondition> {
  using Here = Located<RecordedCondition>;

 public:
  using RecordedNode::RecordedNode;

  friend RecordedCondition both(const Here& a, const RecordedCondition& b) {
    return recorded<RecordedCondition>(Operation::kBoth, a, b.node());
  }
  friend RecordedCondition either(const Here& a, const RecordedCondition& b) {
    return recorded<RecordedCondition>(Operation::kEither, a, b.node());
  }
  friend RecordedCondition negated(const Here& a) {
    return recorded<RecordedCondition>(Operation::kNegated, a);
  }
};

// A binary floating-point value: the operations of Binary with the same parameters.
template <int kExponent, int kMantissa>
class RecordedBinary : public RecordedNode<RecordedBinary<kExponent, kMantissa>> {
  using Base = RecordedNode<RecordedBinary>;
  using Number = Binary<kExponent, kMantissa>;
  using Here = Located<RecordedBinary>;

 public:
  static ValueType type() { return ValueType(Number::format()); }
  static RecordedBinary of(NodeId node) { return RecordedBinary(node, IsNode()); }

  RecordedBinary() = default;
  explicit RecordedBinary(double constant)
      : Base(Recording::graph().add_constant(type(), Number(constant).bits())) {}
  explicit RecordedBinary(NodeId node) = delete;  // a node is no constant: of(node)

  friend RecordedBinary operator+(const Here& a, const RecordedBinary& b) {
    return of(add(a, Operation::kAdd, a.node, b.node()));
  }
  friend RecordedBinary operator-(const Here& a, const RecordedBinary& b) {
    return of(add(a, Operation::kSubtract, a.node, b.node()));
  }
  friend RecordedBinary operator*(const Here& a, const RecordedBinary& b) {
    return of(add(a, Operation::kMultiply, a.node, b.node()));
  }
  friend RecordedBinary operator/(const Here& a, const RecordedBinary& b) {
    return of(add(a, Operation::kDivide, a.node, b.node()));
  }
  friend RecordedBinary square_root(const Here& a) {
    return of(add(a, Operation::kSquareRoot, a.node));
  }
  friend RecordedBinary operator-(const Here& a) { return of(add(a, Operation::kNegate, a.node)); }
  friend RecordedBinary magnitude(const Here& a) {
    return of(add(a, Operation::kMagnitude, a.node));
  }
  friend RecordedCondition operator<(const Here& a, const RecordedBinary& b) {
    return RecordedCondition(add(a, Operation::kLess, a.node, b.node()));
  }
  // The other comparisons are made of this one. Nothing is less than, equal to or greater than a
  // NaN, so `a <= b` is not the opposite of `b < a` alone.
  friend RecordedCondition operator>(const Here& a, const RecordedBinary& b) {
    return RecordedCondition(add(a, Operation::kLess, b.node(), a.node));
  }
  friend RecordedCondition operator<=(const Here& a, const RecordedBinary& b) {
    return RecordedCondition(not_less(a, b.node(), a.node));
  }
  friend RecordedCondition operator>=(const Here& a, const RecordedBinary& b) {
    return RecordedCondition(not_less(a, a.node, b.node()));
  }
  // Both sides alike: an operand order that C++20 may reverse.
  friend RecordedCondition operator==(const Here& a, const Here& b) {
    return RecordedCondition(equal(a, b.node));
  }
  friend RecordedCondition operator!=(const Here& a, const Here& b) {
    return RecordedCondition(add(a, Operation::kNegated, equal(a, b.node)));
  }
  friend RecordedBinary select(const Located<RecordedCondition>& condition,
                               const RecordedBinary& if_true, const RecordedBinary& if_false) {
    return of(Recording::graph().add_operation(
        Operation::kSelect, {condition.node, if_true.node(), if_false.node()}, condition.place));
  }

 private:
  struct IsNode {};
  RecordedBinary(NodeId node, IsNode /*tag*/) : Base(node) {}

  // An operation at the place of `at`, which it is made for.
  static NodeId add(const Here& at, Operation operation, NodeId a, NodeId b = kNoNode) {
    return Recording::graph().add_operation(operation, {a, b, kNoNode}, at.place);
  }
  // Whether x and y are numbers and x is not less than y.
  static NodeId not_less(const Here& at, NodeId x, NodeId y) {
    const NodeId numbers = add(at, Operation::kBoth, add(at, Operation::kIsNumber, x),
                               add(at, Operation::kIsNumber, y));
    return add(at, Operation::kBoth, numbers,
               add(at, Operation::kNegated, add(at, Operation::kLess, x, y)));
  }
  static NodeId equal(const Here& a, NodeId b) {
    return add(a, Operation::kBoth, not_less(a, b, a.node), not_less(a, a.node, b));
  }
};

using RecordedValue = RecordedBinary<8, 23>;  // binary32

// An unsigned 32-bit integer.
class RecordedWord : public RecordedNode<RecordedWord> {
 public:
  using RecordedNode::RecordedNode;

  friend RecordedCondition operator<(const Located<RecordedWord>& a, const RecordedWord& b) {
    return recorded<RecordedCondition>(Operation::kWordLess, a, b.node());
  }
  friend RecordedWord select(const Located<RecordedCondition>& condition,
                             const RecordedWord& if_true, const RecordedWord& if_false) {
    return recorded<RecordedWord>(Operation::kWordSelect, condition, if_true.node(),
                                  if_false.node());
  }
};

// The scalar that records what functions do on `Scalar`.
template <class Scalar>
struct RecordedScalar;
template <>
struct RecordedScalar<float> {
  using Type = RecordedValue;
};
template <int kExponent, int kMantissa>
struct RecordedScalar<Binary<kExponent, kMantissa>> {
  using Type = RecordedBinary<kExponent, kMantissa>;
};

}  // namespace emax
