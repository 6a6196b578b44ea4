#pragma once
/// Who is compared: a method over one of the Hamiltonians a scene can be written with.

#include "scene/scene.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// One method of a comparison.
struct Candidate {
  std::string label;    ///< in tables: the method, with "@kinetic_potential" where that is not the scene's Hamiltonian
  std::string method;   ///< as `[integrator]` names it
  bool joined = false;  ///< over the plain Hamiltonian with all forces, instead of the scene's own splitting
  bool adaptive = false;        ///< it chooses its steps, by a tolerance
  bool below_rounding = false;  ///< its states have further digits than doubles

  bool operator==(const Candidate&) const = default;
};

/// The step or the tolerance of one run.
struct Setting {
  double step = 0;       ///< [time]; 0 for adaptive methods
  double tolerance = 0;  ///< relative; 0 for methods of fixed steps
};

/// The candidate of a name: a scheme, a word or a classical method, optionally "@" and the name of the scene's
/// Hamiltonian, or of the plain one.
///
/// A splitting scheme runs on the scene's own splitting; what cannot runs on the plain Hamiltonian, kinetic_potential,
/// where all that the splitting has in itself can stand beside it as forces.
/// @throws Error  for a name that is not known, with a proposal, and for a method that cannot serve the scene
Candidate candidate(const Scene& scene, std::string_view name);

/// Methods worth comparing on a scene, its own first: those that can serve it.
std::vector<Candidate> default_opponents(const Scene& scene);

/// Methods that can serve a scene with errors below the rounding of doubles.
std::vector<Candidate> opponents_below_rounding(const Scene& scene);

/// The scene run by an candidate, without monitors, writers and stops: the run alone.
/// @throws Error  if the method cannot serve it
Scene variant(const Scene& scene, const Candidate& who, const Setting& setting);

/// The absolute tolerance that goes with a relative one, in the ratio of the scene's own; where a scene gives none,
/// none for particles, and of a system the method's own ratio or a thousandth.
std::optional<double> absolute_tolerance(const Scene& scene, double relative);

/// Evaluations of forces that one step of about `step` takes, measured on a few; adaptive methods: 0.
/// @param spent  is increased by the evaluations that this takes
double evaluations_per_step(const Scene& scene, const Candidate& who, double step, double* spent = nullptr);

}  // namespace noether
