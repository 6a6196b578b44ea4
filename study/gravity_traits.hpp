#pragma once
/// What methods do that serve gravity alone, measured.

#include "study/method_traits.hpp"

namespace noether {

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

}  // namespace noether
