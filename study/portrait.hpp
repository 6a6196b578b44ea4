#pragma once
/// Portraits of methods: what each of them does, measured, beside what it claims.

#include "integrators/methods.hpp"
#include "integrators/schemes.hpp"

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
struct Portrait {
  std::string name = {}, family = {}, use = {};
  int highest_order = 0;  ///< among the orders of a method that varies it
  MethodTraits measured = {}, claimed = {};

  /// The cells in which measurement and claim differ, in words: "order: claims 4, measured 2".
  std::vector<std::string> differences() const;
};

/// A method to be measured: exactly one of the two is given.
struct Sitter {
  const Scheme* scheme = nullptr;
  const MethodInfo* info = nullptr;

  /// Significant digits of the shortest coefficient in its source.
  int printed_digits() const { return scheme != nullptr ? scheme->printed_digits : info->printed_digits; }
  std::string_view name() const { return scheme != nullptr ? scheme->name : info->name; }
};

/// Every scheme, then every classical method.
std::vector<Sitter> all_sitters();

/// What a method says of itself, with steps of one length where it has them.
MethodTraits claimed_traits(const Sitter& sitter);

/// The same as found by running it, in extended precision on small problems:
///
/// - order: slope of the errors at t = 6 over a ladder of steps, the smaller one of two orbits of Henon and Heiles;
/// - evaluations: counted by the integrator between two lengths of a run;
/// - symplectic: |M^T J M - J| of the map of 24 steps there, by differences; reversible: 24 steps, velocities turned,
/// 24;
/// - momentum, angular momentum: 24 steps of three bodies, to rounding;
/// - energy: 100 periods of a regular orbit of Henon and Heiles;
/// - stability: see `stability_limit_of`.
/// @throws never  what a method cannot do is found to fail
/// @cost half a second on average, some seconds for the multistep methods that iterate
MethodTraits measured_traits(const Sitter& sitter);

/// Where a method becomes unstable on the oscillator.
struct StabilityLimit {
  double z =
      0;  ///< first unstable h omega, to 2e-4 (5 % of an iteration); 0: at every step, infinity: nowhere up to 12
  bool of_iteration = false;  ///< beyond it a step is not unstable, but cannot be made
};

/// First h omega at which the oscillator grows by more than 1e-15 a step: by the matrix of one step where a step is a
/// map; else by a run whose start is disturbed, and by the growth of what remains once the disturbance has decayed.
/// Empty for methods without steps of one length.
std::optional<StabilityLimit> stability_limit_of(const Sitter& sitter);

/// Measures a method and puts its claims beside.
Portrait portrait_of(const Sitter& sitter);

/// A row of docs/methods.md: name, order, forces, symplectic, reversible, momentum, angular momentum, energy, steps,
/// stability limit, use.
std::vector<std::string> cells_of(const Portrait& portrait);

/// docs/methods.md: the portraits as one table for each family, with a word on how they were made.
std::string portraits_page(const std::vector<Portrait>& portraits);

}  // namespace noether
