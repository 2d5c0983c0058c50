#pragma once

#include <string>

#include "tests/benchmarks/decimation/tool.h"

namespace emax::benchmarks {

// A decimator in another process, which answers many calls. The shell runs `command` with the name
// of a folder as one more word. The process first writes a line of JSON:
//
//   {"name": …, "version": …, "sets": [{"name": …, "parameter": "triangles" or "tolerance"}, …]}
//
// For each line {"set": index, "parameter": number} on its standard input it decimates the mesh in
// the folder's `start` with these options, writes the result to `result`, both as raw_mesh.h has
// them, and answers {"seconds": number}: the processor time of the call alone, without conversions.
// A line {"failure": reason} says why it cannot, at the beginning too. The start is centred and
// scaled to a width of 1, which suits binary32 and fixed thresholds; tolerances are in that scale.
//
// A process that ends during a call is started again for the next one. Throws Error, here and in
// calls, with the reason: what the process says, how it ended, or what is wrong with its mesh.
Tool external_tool(const std::string& command);

}  // namespace emax::benchmarks
