#pragma once
/// All classical methods, by name. (Splitting schemes are in integrators/schemes.hpp.)

#include "integrators/method.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

namespace methods {

/// Every classical method, once, family by family.
std::span<const MethodInfo* const> all();

/// The method of a name or an alias; null if there is none.
const MethodInfo* find(std::string_view name);

/// Other names of a method, one by one.
std::vector<std::string> aliases_of(const MethodInfo& info);

// The families, each in a file of its own below integrators/methods/.
std::span<const MethodInfo> runge_kutta_list();

}  // namespace methods

/// The classical method of a name or an alias, with options.
/// @throws Error  for an unknown name, with a proposal
MethodChoice method(std::string_view name, const MethodOptions& options = {});

}  // namespace noether
