// Names for the nodes of a graph, out of the source they were recorded from.
//
//   const Scalar along13 = y * e2.y + z * e2.z;   along13; inside it along13_product, ..._product_2
//   const Vector3<Scalar> q = {p.x - v.x, ...};   q_x, q_y, q_z: the fields of known aggregates
//   return select(...);                           a label if the node has one, else the function
//   return {{y, f(z - t.length)}, ...};                  a label, else the operands: z_minus_length
//
// What would be named twice is numbered from _2 on (identifiers.h).
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "hls/lowering/dataflow_graph.h"
#include "hls/lowering/schedule.h"

namespace emax {

// The text of a source file by the path that a SourcePlace gives; empty if unknown.
using SourceText = std::function<std::string_view(std::string_view path)>;

// Names for results of functions, which no declaration names: by node.
using Labels = std::map<NodeId, std::string>;

// Gives every input, output and operation a name that is unique among them and a legal identifier
// of SystemVerilog. Inputs and outputs keep theirs where they are legal and unique. A node has the
// name of its output where it drives the output's port itself: it is ready in the schedule's last
// cycle, and no other output comes before. `module` is the name of the module that they are for.
// O(nodes * (log nodes + length of the source)).
void name_nodes(DataflowGraph& graph, const Schedule& schedule, const SourceText& source_text,
                const Labels& labels, const std::string& module);

// The statement around a place, for what a name is made of.
struct Statement {
  std::size_t begin = 0;     // offset in the text
  std::size_t element = 0;   // which declarator, and which element of its braces, the place is in
  std::string declared;      // the variable, with the field of an aggregate; empty for none
  bool returns_one = false;  // a return of one value, not of several in braces
};
Statement statement_around(std::string_view text, std::uint32_t line, std::uint32_t column);

// "edge_residual" of "emax::RecordedValue emax::edge_residual(const Scalar&) [with Scalar = ...]".
std::string function_of(std::string_view signature);

}  // namespace emax
