#pragma once
/// Every method that the library knows: schemes and classical methods alike.

#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"

#include <string_view>
#include <vector>

namespace noether {

/// A method to be measured: exactly one of the two is given.
struct KnownMethod {
  const Scheme* scheme = nullptr;
  const MethodInfo* info = nullptr;

  /// Significant digits of the shortest coefficient in its source.
  int printed_digits() const { return scheme != nullptr ? scheme->printed_digits : info->printed_digits; }
  std::string_view name() const { return scheme != nullptr ? scheme->name : info->name; }
};

/// Every scheme, then every classical method.
std::vector<KnownMethod> all_known_methods();

}  // namespace noether
