// Scalars that record. A function on the kernel's scalar template, called with them, appends its
// operations to a DataflowGraph instead of computing. A recorded condition has no truth value, so a
// function that branches on data does not compile.
//
// An operation's first parameter is made implicitly from a recorded value. This conversion also
// takes the place of the call in the source, so the kernel needs no annotation.
#pragma once

#include <source_location>

#include "hls/kernel/word.h"
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

// A binary32 value.
class RecordedValue : public RecordedNode<RecordedValue> {
  using Here = Located<RecordedValue>;

 public:
  using RecordedNode::RecordedNode;
  explicit RecordedValue(float value)
      : RecordedNode(Recording::graph().add_constant(ValueKind::kReal, to_word(value))) {}

  friend RecordedValue operator+(const Here& a, const RecordedValue& b) {
    return recorded<RecordedValue>(Operation::kAdd, a, b.node());
  }
  friend RecordedValue operator-(const Here& a, const RecordedValue& b) {
    return recorded<RecordedValue>(Operation::kSubtract, a, b.node());
  }
  friend RecordedValue operator*(const Here& a, const RecordedValue& b) {
    return recorded<RecordedValue>(Operation::kMultiply, a, b.node());
  }
  friend RecordedValue operator/(const Here& a, const RecordedValue& b) {
    return recorded<RecordedValue>(Operation::kDivide, a, b.node());
  }
  friend RecordedValue square_root(const Here& a) {
    return recorded<RecordedValue>(Operation::kSquareRoot, a);
  }
  friend RecordedValue operator-(const Here& a) {
    return recorded<RecordedValue>(Operation::kNegate, a);
  }
  friend RecordedCondition operator<(const Here& a, const RecordedValue& b) {
    return recorded<RecordedCondition>(Operation::kLess, a, b.node());
  }
  // The other comparisons are made of this one. Nothing is less than, equal to or greater than a
  // NaN, so `a <= b` is not the opposite of `b < a` alone.
  friend RecordedCondition operator>(const Here& a, const RecordedValue& b) {
    return at(a, Operation::kLess, b, RecordedValue(a.node));
  }
  friend RecordedCondition operator<=(const Here& a, const RecordedValue& b) {
    return not_less(a, b, RecordedValue(a.node));
  }
  friend RecordedCondition operator>=(const Here& a, const RecordedValue& b) {
    return not_less(a, RecordedValue(a.node), b);
  }
  friend RecordedCondition operator==(const Here& a, const RecordedValue& b) {
    return logic(a, Operation::kBoth, a <= b, a >= b);
  }
  friend RecordedCondition operator!=(const Here& a, const RecordedValue& b) {
    return logic(a, Operation::kNegated, a == b);
  }
  friend RecordedValue magnitude(const Here& a) {
    return recorded<RecordedValue>(Operation::kMagnitude, a);
  }
  friend RecordedValue select(const Located<RecordedCondition>& condition,
                              const RecordedValue& if_true, const RecordedValue& if_false) {
    return recorded<RecordedValue>(Operation::kSelect, condition, if_true.node(), if_false.node());
  }

 private:
  // Operations at the place of a comparison that they are made for.
  static RecordedCondition at(const Here& place, Operation operation, const RecordedValue& a,
                              const RecordedValue& b = RecordedValue()) {
    return RecordedCondition(
        Recording::graph().add_operation(operation, {a.node(), b.node(), kNoNode}, place.place));
  }
  static RecordedCondition logic(const Here& place, Operation operation, const RecordedCondition& a,
                                 const RecordedCondition& b = RecordedCondition()) {
    return RecordedCondition(
        Recording::graph().add_operation(operation, {a.node(), b.node(), kNoNode}, place.place));
  }
  // Whether a and b are numbers and a is not less than b.
  static RecordedCondition not_less(const Here& place, const RecordedValue& a,
                                    const RecordedValue& b) {
    const RecordedCondition numbers =
        logic(place, Operation::kBoth, at(place, Operation::kIsNumber, a),
              at(place, Operation::kIsNumber, b));
    return logic(place, Operation::kBoth, numbers,
                 logic(place, Operation::kNegated, at(place, Operation::kLess, a, b)));
  }
};

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

}  // namespace emax
