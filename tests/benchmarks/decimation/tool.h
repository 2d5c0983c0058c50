#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// One way to call a tool: named options, and the parameter that is bisected.
struct OptionSet {
  enum class Parameter { kTriangles, kTolerance };  // target, or bound as a multiple of epsilon

  std::string name;
  Parameter parameter;
  // Throws what the tool throws. A mesh without triangles where it gives none.
  std::function<TriangleMesh(double)> simplify;
  double finest = 0.05, coarsest = 3;  // tolerances of the bisection
  // Processor time of the last call, where the tool measures it itself.
  std::function<double()> seconds = {};
};

// A decimator made by others. Its option sets, for one start and epsilon; the likeliest to be best
// first. What can be prepared of the mesh is prepared here: converting it is not timed.
struct Tool {
  std::string name;     // of the table
  std::string key;      // of the command line
  std::string version;  // of its library
  std::function<std::vector<OptionSet>(const TriangleMesh& start, double epsilon)> option_sets;
};

Tool openmesh_tool();
Tool vtk_quadric_tool();
Tool vtk_decimate_pro_tool();
Tool meshoptimizer_tool();
Tool cgal_lindstrom_turk_tool();
Tool cgal_garland_heckbert_tool();
// Lindstrom and Turk's within CGAL's polyhedral envelope.
Tool cgal_envelope_tool();

}  // namespace emax::benchmarks
