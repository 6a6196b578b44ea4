#pragma once
/// Choices without a branch: how code over the number type chooses in lanes as it does in one number.

#include <concepts>

namespace noether {

/// `a` where the condition holds, else `b`; both are evaluated. In lanes (numbers/pack.hpp) each lane chooses for
/// itself.
///
///     const Real push = noether::select(x > Real(1), k * (x - Real(1)), Real(0));
///
/// @throws never
template <std::same_as<bool> Condition, class T> constexpr T select(Condition condition, const T& a, const T& b) {
  return condition ? a : b;
}
/// Whether a condition holds in some lane. @throws never
constexpr bool any(bool condition) { return condition; }
/// Whether a condition holds in every lane. @throws never
constexpr bool all(bool condition) { return condition; }

}  // namespace noether
