// Names for the nodes of a graph, from the source that they were recorded from.
//
//   const Scalar along13 = y * e2.y + z * e2.z;   along13; inside it along13_product, ..._product_2
//   const Vector3<Scalar> q = {p.x - v.x, ...};   q_x, q_y, q_z: the fields of known aggregates
//   return select(...);                           a label if the node has one, else the function
//   return {{y, f(z - t.length)}, ...};                  a label, else the operands: z_minus_length
//
// A name that would occur twice is numbered from _2 on (identifiers.h).
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "hls/lowering/dataflow_graph.h"
#include "hls/lowering/schedule.h"

namespace emax {

// Gives the text of a source file for the path in a SourcePlace; empty if the file is unknown.
using SourceText = std::function<std::string_view(std::string_view path)>;

// Names, by node, for results of functions that no declaration names.
using Labels = std::map<NodeId, std::string>;

// Gives every input, output and operation a unique name that is a legal identifier of
// SystemVerilog. Inputs and outputs keep their names if these are legal and unique. A node gets the
// name of its output if it drives the output's port directly: it is ready in the schedule's last
// cycle, and it drives no earlier output. `module` is the name of the module that has these names.
// O(nodes * (log nodes + length of the source)).
void name_nodes(DataflowGraph& graph, const Schedule& schedule, const SourceText& source_text,
                const Labels& labels, const std::string& module);

// The statement around a place, which the name is made from.
struct Statement {
  std::size_t begin = 0;     // offset in the text
  std::size_t element = 0;   // the place's declarator, and its element of the braces
  std::string declared;      // the variable, with the field of an aggregate; empty for none
  bool returns_one = false;  // a return of one value, not of several in braces
};
Statement statement_around(std::string_view text, std::uint32_t line, std::uint32_t column);

// "edge_residual" of "emax::RecordedValue emax::edge_residual(const Scalar&) [with Scalar = ...]".
std::string function_of(std::string_view signature);

}  // namespace emax
