// The dataflow graph of a function of the kernel. recorded_value.h records it, schedule.h gives
// each node its cycle, and systemverilog.h writes it as a pipeline.
//
// Nodes are shared as they are recorded (hash-consing): the same operation on the same operands is
// one node. These rewrites keep every bit of the numeric contract (docs/numerics.md):
//   a + b = b + a, a * b = b * a     rounding, flushing, signed zeros and the one NaN are symmetric
//   both, either                     symmetric
//   a * a -> square(a)               the same product
//   a < 0 -> less_zero(a), 0 < a -> greater_zero(a)   a comparison with either zero is one of sign
//   negated(negated(a)) -> a
// and of fixed-point numbers (hls/kernel/fixed.h), whose sums and products are symmetric as well:
//   a < 0 -> fixed_negative(a)       the sign bit
//   fixed_fit(a) -> fixed_wires(a)   where no rounding adds and nothing saturates
// There are no others: no reassociation, no x - 0 or x * 1 (they flush and canonicalise), no
// folding.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "hls/kernel/binary.h"
#include "hls/kernel/fixed.h"

namespace emax {

using NodeId = std::uint32_t;
constexpr NodeId kNoNode = ~NodeId{0};

enum class ValueKind : std::uint8_t { kReal, kCondition, kWord, kFixed };

// A kind of value with its format: a binary floating-point number, a bit, a word of 32 bits, a
// fixed-point number.
struct ValueType {
  // Implicit: the kinds with one format, and binary32.
  constexpr ValueType(ValueKind of)  // NOLINT(google-explicit-constructor)
      : kind(of),
        width(of == ValueKind::kCondition ? 1 : 32),
        fraction(of == ValueKind::kReal ? 23 : 0) {}
  explicit constexpr ValueType(const BinaryFormat& format)
      : kind(ValueKind::kReal), width(format.width()), fraction(format.mantissa) {}
  explicit constexpr ValueType(const FixedFormat& format)
      : kind(ValueKind::kFixed),
        width(format.width),
        fraction(format.fraction),
        rounding(format.rounding),
        overflow(format.overflow) {}

  FixedFormat fixed() const { return {width, fraction, rounding, overflow}; }
  BinaryFormat binary() const { return {width - 1 - fraction, fraction}; }
  bool is_binary32() const { return *this == ValueType(ValueKind::kReal); }
  // Whether words of the two types stand for the same values.
  bool reads_like(const ValueType& other) const {
    return kind == other.kind && width == other.width && fraction == other.fraction;
  }
  auto operator<=>(const ValueType&) const = default;

  ValueKind kind;
  int width;         // bits
  int fraction = 0;  // bits: behind the point, or stored of a mantissa
  Rounding rounding = Rounding::kHalfUp;
  Overflow overflow = Overflow::kSaturate;
};

enum class Operation : std::uint8_t {
  kInput,
  kConstant,
  kAdd,
  kSubtract,
  kMultiply,
  kSquare,
  kDivide,
  kSquareRoot,
  kMagnitude,
  kNegate,  // the sign alone
  kLess,
  kLessZero,
  kGreaterZero,
  kIsNumber,  // not NaN
  kSelect,    // operands: condition, if true, if false
  kBoth,
  kEither,
  kNegated,
  kWordLess,
  kWordSelect,
  kFixedAdd,
  kFixedSubtract,
  kFixedMultiply,  // the exact product, fitted to the result's format
  kFixedNegate,
  kFixedMagnitude,
  kFixedFit,    // to the result's format
  kFixedWires,  // the same where only bits are left out and zeros or copies of the sign added
  kFixedLess,
  kFixedNegative,  // the sign
};
constexpr std::size_t kOperations = 29;

struct OperationInfo {
  std::string_view name;    // in schedules and reports
  std::string_view result;  // in names of nodes: a word for the result
  std::size_t operands;
  ValueKind kind;
};
const OperationInfo& info(Operation operation);

// The place of an operation in the source. `file` and `function` must outlive the graph (literals).
struct SourcePlace {
  std::string_view file;
  std::uint32_t line = 0, column = 0;
  std::string_view function;  // with its signature, as the compiler writes it

  auto operator<=>(const SourcePlace&) const = default;
};

struct Node {
  Operation operation;
  ValueType type;
  std::array<NodeId, 3> operands = {kNoNode, kNoNode, kNoNode};
  std::uint64_t word = 0;  // kConstant: its bits; kInput: its place in inputs()
  SourcePlace place = {};
  std::string name = {};
};

// How an input reaches the pipeline: with the sample at cycle 0, or from a memory that is read at
// the cycle in which the input is needed.
enum class Arrival : std::uint8_t { kSample, kMemory };

struct Input {
  std::string name;
  Arrival arrival;
  std::uint32_t record_bit;  // lowest bit in the record, if from a memory
  NodeId node;
};

struct Output {
  std::string name;
  NodeId node;
};

// Every operand's id is lower than its consumer's. Recording costs O(log n) a node.
class DataflowGraph {
 public:
  enum class Sharing : std::uint8_t { kOn, kOff };  // kOff: the brute-force twin, no rewrites
  explicit DataflowGraph(Sharing sharing = Sharing::kOn) : sharing_(sharing) {}

  NodeId add_input(std::string name, ValueType type, Arrival arrival, std::uint32_t record_bit = 0);
  NodeId add_constant(ValueType type, std::uint64_t word);
  // `result` is the type of a fixed-point product or fit; the operands give that of other results.
  // Throws std::invalid_argument if an operand is missing or of the wrong type, or if `result` is.
  NodeId add_operation(Operation operation, std::array<NodeId, 3> operands, SourcePlace place,
                       std::optional<ValueType> result = {});
  void add_output(std::string name, NodeId node);

  // Keeps only the nodes that the outputs need. Their order is that of a walk from the outputs with
  // operands left to right, so it does not depend on the order in which a compiler evaluates
  // operands. Returns the new id of each old node (kNoNode if it was removed).
  std::vector<NodeId> remove_dead();

  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(NodeId id) const { return nodes_[id]; }
  const std::vector<Input>& inputs() const { return inputs_; }
  const std::vector<Output>& outputs() const { return outputs_; }
  void set_name(NodeId id, std::string name) { nodes_[id].name = std::move(name); }
  // Also names the input's node.
  void set_input_name(std::size_t input, const std::string& name);
  void set_output_name(std::size_t output, std::string name);
  // Lets the input come from a memory, which has it from `record_bit` of the record on.
  void keep_input_in_record(std::size_t input, std::uint32_t record_bit);

  // The operands of a node, without the unused places.
  struct Operands {
    const NodeId *first, *last;
    const NodeId* begin() const { return first; }
    const NodeId* end() const { return last; }
  };
  Operands operands(NodeId id) const {
    const Node& node = nodes_[id];
    return {node.operands.data(), node.operands.data() + info(node.operation).operands};
  }
  bool is_operation(NodeId id) const {
    return nodes_[id].operation != Operation::kInput &&
           nodes_[id].operation != Operation::kConstant;
  }
  std::size_t count(Operation operation) const;

 private:
  bool is_zero(NodeId id) const;
  NodeId append(Node node);
  void check_operands(Operation operation, const std::array<NodeId, 3>& operands) const;
  ValueType type_of(Operation operation, const std::array<NodeId, 3>& operands,
                    const std::optional<ValueType>& result) const;
  // Makes a node with operands the simplest one that gives the same bits.
  void rewrite(Node& node) const;

  Sharing sharing_;
  std::vector<Node> nodes_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::map<std::tuple<Operation, std::array<NodeId, 3>, std::uint64_t, ValueType>, NodeId> known_;
};

}  // namespace emax
