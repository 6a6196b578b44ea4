#include "integrators/all_methods.hpp"

#include "integrators/all_schemes.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace methods {

std::span<const MethodInfo* const> all() {
  static const std::vector<const MethodInfo*> list = [] {
    std::vector<const MethodInfo*> every;
    for (const auto& family : {runge_kutta_list(),
                               collocation_list(),
                               encke_list(),
                               wide_gauss_list(),
                               nystrom_list(),
                               extrapolation_list(),
                               multistep_list(),
                               diagonally_implicit_list(),
                               newmark_list(),
                               rosenbrock_list(),
                               bdf_list(),
                               hbvm_list(),
                               discrete_gradient_list(),
                               simo_tarnow_wong_list(),
                               rkmk_list(),
                               exponential_list(),
                               variational_list(),
                               weber_list(),
                               extended_space_list(),
                               boris_sdc_list()}) {
      for (const MethodInfo& info : family) every.push_back(&info);
    }
    return every;
  }();
  return list;
}

std::span<const MethodInfo* const> of_rotations() {
  static const std::vector<const MethodInfo*> list = [] {
    std::vector<const MethodInfo*> every;
    for (const MethodInfo& info : magnus_list()) every.push_back(&info);
    return every;
  }();
  return list;
}

std::vector<std::string> aliases_of(const MethodInfo& info) { return words_of(info.aliases); }

std::vector<std::string> known_names() {
  std::vector<std::string> known;
  const auto add = [&](std::string_view name, const std::vector<std::string>& aliases) {
    known.emplace_back(name);
    known.insert(known.end(), aliases.begin(), aliases.end());
  };
  for (const Scheme* scheme : schemes::all()) add(scheme->name, schemes::aliases_of(*scheme));
  for (const auto& list : {all(), of_rotations()}) {
    for (const MethodInfo* info : list) add(info->name, aliases_of(*info));
  }
  return known;
}

const MethodInfo* find(std::string_view name) {
  for (const auto& list : {all(), of_rotations()}) {
    for (const MethodInfo* info : list) {
      if (info->name == name) return info;
      const auto aliases = aliases_of(*info);
      if (std::find(aliases.begin(), aliases.end(), name) != aliases.end()) return info;
    }
  }
  return find_hbvm(name);
}

}  // namespace methods

MethodChoice method(std::string_view name, const MethodOptions& options) {
  if (const MethodInfo* info = methods::find(name)) return {info, options};
  throw Error(fmt::format("unknown method '{}'{}", name, did_you_mean(name, methods::known_names())));
}

std::vector<const OptionGroup*> MethodInfo::option_groups() const {
  std::vector<const OptionGroup*> groups;
  if (adaptive) groups.push_back(error_control);
  for (const OptionGroup* group : options) {
    if (group != nullptr) groups.push_back(group);
  }
  return groups;
}

bool MethodInfo::takes(const OptionGroup& group) const {
  const auto groups = option_groups();
  return std::find(groups.begin(), groups.end(), &group) != groups.end();
}

MethodOptions MethodInfo::resolved(const MethodOptions& options_given) const {
  MethodOptions all = options_given;
  const bool chooses = is_adaptive(options_given);
  all.adaptive = adaptive && fixed ? std::optional(chooses) : std::nullopt;
  all.rtol = chooses ? std::optional(all.rtol.value_or(rtol)) : std::nullopt;
  all.atol = chooses ? std::optional(all.atol.value_or(atol)) : std::nullopt;
  return all;
}

namespace {

[[noreturn]] void refuse_option(std::string_view key, const std::string& message) {
  throw Error(message, {.key = std::string(key)});
}

/// Refuses what a method does not take, and what those say of themselves that it takes.
void check_groups(const MethodInfo& info, const MethodOptions& options) {
  if (const OptionGroup* own = options.own.group(); own != nullptr && !info.takes(*own)) {
    const std::string_view key = own->values(options).front().name;
    refuse_option(key, fmt::format("method '{}' has no options of '{}'; take them out", info.name, own->name));
  }
  if (options.jacobian && !info.takes(*linear_solver))
    refuse_option("jacobian", lacks_option(info.name, *linear_solver, "jacobian"));
  if ((options.group || options.spin_axes) && !info.takes(*bodies_on_group)) {
    const std::string_view key = options.group ? "group" : "spin_axes";
    refuse_option(key, lacks_option(info.name, *bodies_on_group, key));
  }
  for (const OptionGroup* group : info.option_groups()) group->check(options);
}

void check_tolerances(const MethodInfo& info, const MethodOptions& options, double rounding) {
  for (const OptionValue& one : error_control->values(options)) {
    const double* value = std::get_if<double>(&one.value);
    if (value == nullptr) continue;
    if (!info.is_adaptive(options)) {
      refuse_option(one.name,
                    fmt::format("method '{}' takes steps of one length here, so {} has no effect; take it out",
                                info.name, one.name));
    }
    const bool is_length = one.name == "max_step";
    if (is_length && !(*value > 0 && std::isfinite(*value)))
      refuse_field(one.name, fmt::format("{}", *value), "is not a valid longest step; a time above 0 is expected");
    if (!is_length && !(*value >= 0 && std::isfinite(*value)))
      refuse_field(one.name, fmt::format("{}", *value), "is not a valid tolerance; 0 or more is expected");
  }
  // The references take 1e-16 for "to rounding"; others would shorten their steps without end.
  if (options.rtol && *options.rtol > 0 && *options.rtol < 4 * rounding && info.rtol > 1e-15) {
    refuse_field("rtol", fmt::format("{}", *options.rtol),
                 fmt::format("is below the rounding of {}; at least {:.1g} is expected, or a method that solves to "
                             "rounding, such as 'gauss_8'",
                             rounding < 1e-20 ? "extended precision" : "doubles", 4 * rounding));
  }
  if (info.is_adaptive(options) && options.rtol.value_or(info.rtol) == 0 && options.atol.value_or(0) == 0) {
    refuse_option("rtol", "rtol and atol are both 0, so no step could be accepted; give one of them above 0");
  }
}

}  // namespace

std::string lacks_option(std::string_view name, const OptionGroup& group, std::string_view key) {
  if (group.lacks.empty()) return fmt::format("method '{}' has no {}; take it out", name, key);
  return fmt::format("method '{}' {}, so {} has no effect here; take it out", name, group.lacks, key);
}

void check_options(const MethodInfo& info, const MethodOptions& options, double rounding) {
  if (options.adaptive.value_or(false) && !info.adaptive) {
    refuse_option("adaptive",
                  fmt::format("method '{}' has no error estimate, so its steps cannot be adaptive", info.name));
  }
  if (!options.adaptive.value_or(true) && !info.fixed) {
    refuse_option("adaptive", fmt::format("method '{}' chooses its steps itself; they cannot be fixed", info.name));
  }
  check_tolerances(info, options, rounding);
  check_groups(info, options);
  if (options.first && !(*options.first > 0 && std::isfinite(*options.first))) {
    refuse_option("step",
                  fmt::format("a first step of {} is not valid; a finite time above 0 is expected", *options.first));
  }
}

template <> std::unique_ptr<Method<double>> make_method(const MethodInfo& info, const MethodOptions& options) {
  check_options(info, options);
  return info.make(info, options);
}

template <> std::unique_ptr<Method<Quad>> make_method(const MethodInfo& info, const MethodOptions& options) {
  check_options(info, options, static_cast<double>(std::numeric_limits<Quad>::epsilon()));
  if (info.make_quad == nullptr) {
    throw Error(fmt::format("method '{}' computes in double only, not in extended precision", info.name));
  }
  return info.make_quad(info, options);
}

}  // namespace noether
