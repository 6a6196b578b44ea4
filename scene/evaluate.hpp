#pragma once
/// The initial state of a scene, looked at once: energy by term, virial, forces.

#include "forces/lattice_accuracy.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

struct Evaluation {
  double kinetic = 0, potential = 0;                  ///< [energy]; NaN where a force has none
  std::vector<std::pair<std::string, double>> terms;  ///< potential energy of each force; equal names are numbered
  Mat3<double> virial = Mat3<double>::Zero();         ///< sum of x (x) f [energy]; NaN where a force has none
  std::optional<double> pressure;                     ///< of a periodic box, where every force tells its virial
  VectorColumn<double> forces;                        ///< m a, shape (n, 3); drag is not among them
  double force_max = 0;                               ///< largest |m a|
  std::optional<double> gradient_error;               ///< worst of those with a potential, where it was asked for
  Index gradient_asked = 0;                           ///< at how many particles
  /// Of each sum over a lattice of charges, by its name among the terms, where it was asked for.
  std::vector<std::pair<std::string, LatticeAccuracy>> lattices = {};
  Outcome outcome;  ///< `completed`, or why a force cannot be computed: what it has a part in is no number then
};

/// Evaluates every force of a scene at its start.
/// @param check  compare each force with differences of its energy, and sums over a lattice of charges with Ewald's
/// @cost one evaluation of each force; to check 18 for each of `gradient_asked`, and what `lattice_accuracy` costs
Evaluation evaluate(const Scene& scene, bool check = false);

}  // namespace noether
