#pragma once

namespace emax {

class DecimationState;

// The energy of Hoppe, DeRose, Duchamp, McDonald and Stuetzle, "Mesh Optimization" (1993), the
// source's first reference, with lengths in units of the mesh's width:
//   E = E_dist + E_rep + E_spring,  E_dist = sum over the points of their squared distance,
//   E_rep = representation * vertices,  E_spring = spring * sum over the edges of squared length.
struct HoppeWeights {
  double representation = 1e-5;
  double spring = 1e-6;
};

struct HoppeEnergy {
  double distance = 0, representation = 0, spring = 0;
  double total() const { return distance + representation + spring; }
};

// The energy of a state, with the distances that it has for its points. O(n).
HoppeEnergy hoppe_energy(const DecimationState& state, double width, const HoppeWeights& weights);

}  // namespace emax
