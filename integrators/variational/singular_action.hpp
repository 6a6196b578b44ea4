#pragma once
/// What variational methods say where they cannot go on.

#include "integrators/vector_field.hpp"

#include <string_view>

namespace noether {

/// The outcome of a step of `h` whose solution ends after a fraction of it, near q: D1 D2 L_d is singular there.
template <class Real> Failure singular_action(double h, double fraction, const Vector<Real>& q);

/// Refuses a field that has no Lagrangian. @throws SchemeMismatch
[[noreturn]] void refuse_without_lagrangian(std::string_view method, std::string_view field);

}  // namespace noether
