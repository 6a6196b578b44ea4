#pragma once
/// What methods do, measured, beside what they claim.

#include "study/known_method.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// What becomes of the energy on a regular orbit, over many periods.
enum class EnergyError : std::uint8_t { kept, bounded, drifts };

/// "kept", "bounded", "drifts".
std::string_view text_of(EnergyError energy);

/// What can be said of a method, by itself or by a measurement; where a claim is empty, the method says nothing.
struct MethodTraits {
  /// p of an error O(h^p) with steps of one length. Methods without them: the highest of their orders as a claim, and
  /// as a measurement the work exponent, error ~ evaluations^-p.
  std::optional<double> order = {};
  std::optional<double> evaluations = {};  ///< forces a fixed step, after the start; empty: it iterates, so it depends
  bool symplectic = false;
  bool reversible = false;
  bool momentum = false;
  bool angular_momentum = false;
  EnergyError energy = EnergyError::drifts;
  bool fixed_steps = true, own_steps = false;  ///< steps of one length, steps of its choice
  /// First h omega on the oscillator that is unstable; 0: every one is, infinity: none is found.
  std::optional<double> stability_limit = {};
  bool limit_of_iteration = false;  ///< measured only: beyond the limit its equations are not solved
};

/// One method: a scheme over kinetic and potential energy, or a classical method.
struct MeasuredMethod {
  std::string name = {}, family = {}, use = {};
  int highest_order = 0;  ///< among the orders of a method that varies it
  MethodTraits measured = {}, claimed = {};

  /// The cells in which measurement and claim differ, in words: "order: claims 4, measured 2".
  std::vector<std::string> differences() const;
};

/// What a method says of itself, with steps of one length where it has them.
MethodTraits claimed_traits(const KnownMethod& known);

/// The same as found by running it, in extended precision on small problems:
///
/// - order: slope of the errors at t = 6 over a ladder of steps, the smaller one of two orbits of Henon and Heiles;
/// - evaluations: counted by the integrator between two lengths of a run;
/// - symplectic: |M^T J M - J| of the map of 24 steps there, by differences; reversible: 24 steps, velocities turned,
/// 24;
/// - momentum, angular momentum: 24 steps of three bodies, to rounding;
/// - energy: 100 periods of a regular orbit of Henon and Heiles; methods for gravity alone: see
/// `measured_gravity_traits`;
/// - stability: see `stability_limit_of`.
/// @throws never  what a method cannot do is found to fail
/// @cost half a second on average, some seconds for the multistep methods that iterate
MethodTraits measured_traits(const KnownMethod& known);

/// As `measured_traits`, for a method of fixed steps that serves gravity alone, on states of two words if it has them:
/// a star and two planets in place of the well.
///
/// - order: slope of the errors at t = 6 over a ladder of steps, against Gauss's method in 113 bits;
/// - symplectic, reversible, momentum, angular momentum: 24 steps of half a unit of time, of which the inner planet
/// needs two pi for a turn;
/// - energy: a hundred such turns.
///
/// Differences count where they are far above the rounding of two words, and far below what a step of that length
/// loses.
/// @throws never  what a method cannot do is found to fail
MethodTraits measured_gravity_traits(const KnownMethod& known);

/// Measures a method and puts its claims beside.
MeasuredMethod measured_method(const KnownMethod& known);

}  // namespace noether
