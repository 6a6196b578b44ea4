#pragma once
/// All classical methods, by name. (Splitting schemes are in integrators/all_schemes.hpp.)

#include "integrators/method.hpp"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

namespace methods {

/// Every classical method of forces and of systems of first order, once, family by family.
std::span<const MethodInfo* const> all();
/// Those that serve Y' = A(t) Y on rotations alone.
std::span<const MethodInfo* const> of_rotations();

/// The method of a name or an alias; null if there is none. @throws Error  as `find_hbvm`
const MethodInfo* find(std::string_view name);

/// The method "hbvm_K_S" or "hbvm_S" of any K and S, which need not be in a list; null for another name.
/// @throws Error  for numbers that no such method has
const MethodInfo* find_hbvm(std::string_view name);

/// Other names of a method, one by one.
std::vector<std::string> aliases_of(const MethodInfo& info);

/// Names and aliases of all schemes and classical methods: what a misspelt name may have meant.
std::vector<std::string> known_names();

// The families, each in a file of its own below integrators/methods/, those on Lie groups below integrators/lie/.
std::span<const MethodInfo> runge_kutta_list();
std::span<const MethodInfo> collocation_list();
std::span<const MethodInfo> hbvm_list();
std::span<const MethodInfo> boris_sdc_list();
std::span<const MethodInfo> encke_list();
std::span<const MethodInfo> wide_gauss_list();
std::span<const MethodInfo> nystrom_list();
std::span<const MethodInfo> extrapolation_list();
std::span<const MethodInfo> multistep_list();
std::span<const MethodInfo> diagonally_implicit_list();
std::span<const MethodInfo> newmark_list();
std::span<const MethodInfo> rosenbrock_list();
std::span<const MethodInfo> bdf_list();
std::span<const MethodInfo> discrete_gradient_list();
std::span<const MethodInfo> simo_tarnow_wong_list();
std::span<const MethodInfo> rkmk_list();
std::span<const MethodInfo> exponential_list();
std::span<const MethodInfo> magnus_list();
std::span<const MethodInfo> variational_list();
std::span<const MethodInfo> weber_list();
std::span<const MethodInfo> extended_space_list();

}  // namespace methods

/// Why a method, or a scheme, does not take an option of a group that is not its own.
std::string lacks_option(std::string_view name, const OptionGroup& group, std::string_view key);

/// @param rounding  of the numbers it is to run with; only methods that go to rounding take relative tolerances below
///   four times as much
/// @throws Error  for options that a method does not take, and tolerances out of range, naming the key
void check_options(const MethodInfo& info, const MethodOptions& options, double rounding = 0x1p-52);

/// The classical method of a name or an alias, with options.
/// @throws Error  for an unknown name, with a proposal
MethodChoice method(std::string_view name, const MethodOptions& options = {});
/// The same with options of its own: `method("newmark", NewmarkOptions{.beta = 0.3})`.
template <Described T> MethodChoice method(std::string_view name, T own, MethodOptions options = {}) {
  options.own = std::move(own);
  return method(name, options);
}

}  // namespace noether
