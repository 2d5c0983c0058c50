#include "hls/lowering/naming.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/source_text.h"

namespace emax {
namespace {

// The kernel's aggregates whose fields name the elements of a braced initialiser.
const std::map<std::string_view, std::vector<std::string>> kFields = {{"Vector3", {"x", "y", "z"}},
                                                                      {"Vector2", {"y", "z"}}};

char neighbour(std::string_view code, std::size_t at, int step) {
  for (auto i = static_cast<std::ptrdiff_t>(at) + step;
       i >= 0 && i < static_cast<std::ptrdiff_t>(code.size()); i += step) {
    const char c = code[static_cast<std::size_t>(i)];
    if (std::isspace(static_cast<unsigned char>(c)) == 0) return c;
  }
  return ';';
}

// Whether this character ends the statement before it: a semicolon, or a brace of a block (not of
// an initialiser).
bool is_boundary(std::string_view code, std::size_t at) {
  if (code[at] == ';') return true;
  if (code[at] == '{') return neighbour(code, at, -1) == ')';
  return code[at] == '}' &&
         std::string_view(",;)}").find(neighbour(code, at, 1)) == std::string_view::npos;
}

std::size_t end_of_statement(std::string_view code, std::size_t from) {
  const std::size_t end = code.find(';', from);
  return end == std::string_view::npos ? code.size() : end;
}

// "Vector3" of "const emax::Vector3<Scalar> q".
std::string aggregate_of(std::string_view declaration) {
  return last_word(declaration.substr(0, declaration.find('<')));
}

}  // namespace

Statement statement_around(std::string_view text, std::uint32_t line, std::uint32_t column) {
  const std::string code = without_comments(text);
  std::size_t at = 0;
  for (std::uint32_t l = 1; l < line && at < code.size(); ++l) at = code.find('\n', at) + 1;
  at = std::min(at + column - 1, code.size());

  Statement statement;
  statement.begin = at;
  while (statement.begin > 0 && !is_boundary(code, statement.begin - 1)) --statement.begin;
  while (statement.begin < at && std::isspace(static_cast<unsigned char>(code[statement.begin]))) {
    ++statement.begin;
  }
  const std::size_t end = end_of_statement(code, at);
  const std::string_view body = std::string_view(code).substr(0, end);
  if (body.substr(statement.begin, 6) == "return") {
    statement.returns_one = neighbour(body, statement.begin + 5, 1) != '{';
    return statement;
  }
  std::size_t equals = body.find('=', statement.begin);
  if (equals == std::string_view::npos) return statement;
  const std::string type = aggregate_of(body.substr(statement.begin, equals - statement.begin));
  std::size_t begin = statement.begin;
  for (const std::size_t comma : commas(body, equals, end)) {
    if (comma > at) break;
    begin = comma + 1;
    ++statement.element;
  }
  equals = body.find('=', begin);
  if (equals == std::string_view::npos || equals > at) return statement;
  statement.declared = last_word(body.substr(begin, equals - begin));
  if (neighbour(body, equals, 1) == '{') {
    const auto element = commas(body, body.find('{', equals) + 1, at).size();
    const auto fields = kFields.find(type);
    const bool known = fields != kFields.end() && element < fields->second.size();
    statement.declared += '_' + (known ? fields->second[element] : std::to_string(element));
    statement.element = 1000 * (statement.element + 1) + element;
  }
  return statement;
}

std::string function_of(std::string_view signature) {
  return last_word(signature.substr(0, signature.find('(')));
}

namespace {

class Namer {
 public:
  Namer(DataflowGraph& graph, const Schedule& schedule, const SourceText& source_text,
        const Labels& labels, const std::string& module)
      : graph_(graph),
        schedule_(schedule),
        labels_(labels),
        owner_(graph.nodes().size(), kNoNode),
        identifiers_(module) {
    for (NodeId id = 0; id < graph.nodes().size(); ++id) {
      const SourcePlace& place = graph.node(id).place;
      statements_.push_back(statement_around(source_text(place.file), place.line, place.column));
    }
    for (std::size_t i = 0; i < graph.inputs().size(); ++i) {
      graph.set_input_name(i, identifiers_.take(graph.inputs()[i].name));
    }
    for (std::size_t i = 0; i < graph.outputs().size(); ++i) {
      graph.set_output_name(i, identifiers_.take(graph.outputs()[i].name));
    }
  }

  void name_all() {
    find_owners();
    for (const Output& output : graph_.outputs()) {
      // The value of a node that is ready earlier is delayed on its way to the port, so the port is
      // another signal.
      if (graph_.is_operation(output.node) && graph_.node(output.node).name.empty() &&
          schedule_.ready[output.node] == schedule_.latency) {
        graph_.set_name(output.node, output.name);
      }
    }
    // Results of statements come first: the nodes inside a statement take their names from its
    // result.
    for (const bool inside : {false, true}) {
      for (NodeId id = 0; id < graph_.nodes().size(); ++id) {
        if (!graph_.is_operation(id) || !graph_.node(id).name.empty()) continue;
        if (inside != (owner_[id] != id)) continue;
        graph_.set_name(id, identifiers_.take(inside ? inner_name(id) : result_name(id)));
      }
    }
  }

 private:
  bool same_statement(NodeId a, NodeId b) const {
    return graph_.node(a).place.file == graph_.node(b).place.file &&
           statements_[a].begin == statements_[b].begin &&
           statements_[a].element == statements_[b].element;
  }

  // The owner of a node is the result of its statement: the node itself, or the result that uses
  // it.
  void find_owners() {
    for (auto id = static_cast<NodeId>(graph_.nodes().size()); id-- > 0;) {
      if (owner_[id] == kNoNode) owner_[id] = id;
      for (const NodeId operand : graph_.operands(id)) {
        if (graph_.is_operation(operand) && same_statement(operand, id) &&
            !labels_.contains(operand)) {
          owner_[operand] = owner_[id];
        }
      }
    }
  }

  std::string result_name(NodeId id) const {
    const Statement& statement = statements_[id];
    if (!statement.declared.empty()) return statement.declared;
    if (const auto label = labels_.find(id); label != labels_.end()) return label->second;
    const Node& node = graph_.node(id);
    if (statement.returns_one) return function_of(node.place.function);
    std::string name;
    for (const NodeId operand : graph_.operands(id)) {
      if (!name.empty()) name += node.operation == Operation::kSubtract ? "_minus_" : "_and_";
      name += short_name(operand);
    }
    return node.operation == Operation::kSubtract
               ? name
               : name + '_' + std::string(info(node.operation).result);
  }

  // The last part of an input's name: "length" of "t_edge13_length".
  std::string short_name(NodeId id) const {
    const std::string& name = graph_.node(id).name;
    if (name.empty()) return "value";
    const bool is_input = graph_.node(id).operation == Operation::kInput;
    return is_input ? name.substr(name.rfind('_') + 1) : name;
  }

  std::string inner_name(NodeId id) const {
    return graph_.node(owner_[id]).name + '_' + std::string(info(graph_.node(id).operation).result);
  }

  DataflowGraph& graph_;
  const Schedule& schedule_;
  const Labels& labels_;
  std::vector<Statement> statements_;
  std::vector<NodeId> owner_;
  Identifiers identifiers_;
};

}  // namespace

void name_nodes(DataflowGraph& graph, const Schedule& schedule, const SourceText& source_text,
                const Labels& labels, const std::string& module) {
  Namer(graph, schedule, source_text, labels, module).name_all();
}

}  // namespace emax
