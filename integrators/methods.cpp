#include "integrators/methods.hpp"

#include "engine/suggest.hpp"
#include "engine/text.hpp"
#include "integrators/schemes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace methods {

std::span<const MethodInfo* const> all() {
  static const std::vector<const MethodInfo*> list = [] {
    std::vector<const MethodInfo*> every;
    for (const auto& family :
         {runge_kutta_list(), collocation_list(), nystrom_list(), extrapolation_list(), multistep_list(),
          diagonally_implicit_list(), newmark_list(), rosenbrock_list(), bdf_list()}) {
      for (const MethodInfo& info : family) every.push_back(&info);
    }
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
  for (const MethodInfo* info : all()) add(info->name, aliases_of(*info));
  return known;
}

const MethodInfo* find(std::string_view name) {
  for (const MethodInfo* info : all()) {
    if (info->name == name) return info;
    const auto aliases = aliases_of(*info);
    if (std::find(aliases.begin(), aliases.end(), name) != aliases.end()) return info;
  }
  return nullptr;
}

}  // namespace methods

MethodChoice method(std::string_view name, const MethodOptions& options) {
  if (const MethodInfo* info = methods::find(name)) return {info, options};
  throw Error(fmt::format("unknown method '{}'{}", name, did_you_mean(name, methods::known_names())));
}

void check_options(const MethodInfo& info, const MethodOptions& options, double rounding) {
  const auto fail = [](std::string_view key, const std::string& message) {
    throw Error(message, {.key = std::string(key)});
  };
  const auto takes = [&](std::string_view option) { return info.options.find(option) != std::string_view::npos; };
  if (options.adaptive.value_or(false) && !info.adaptive) {
    fail("adaptive", fmt::format("method '{}' has no error estimate, so its steps cannot be adaptive", info.name));
  }
  if (!options.adaptive.value_or(true) && !info.fixed) {
    fail("adaptive", fmt::format("method '{}' chooses its steps itself; they cannot be fixed", info.name));
  }
  for (const auto& [value, key] : {std::pair(options.rtol, "rtol"), std::pair(options.atol, "atol")}) {
    if (value && !info.is_adaptive(options)) {
      fail(key, fmt::format("method '{}' takes steps of one length here, so {} means nothing to it; take it out",
                            info.name, key));
    }
    if (value && !(*value >= 0 && std::isfinite(*value))) {
      throw Error(fmt::format("{} = {} is no tolerance; a number of at least 0 is expected", key, *value),
                  {.key = key, .value = fmt::format("{}", *value)});
    }
  }
  // The references take 1e-16 for "to rounding"; others would shorten their steps without end.
  if (options.rtol && *options.rtol > 0 && *options.rtol < 4 * rounding && info.rtol > 1e-15) {
    throw Error(fmt::format("rtol = {} is more than {} can tell; at least {:.1g} is expected, or a method that goes to "
                            "rounding, such as 'gauss_8'",
                            *options.rtol, rounding < 1e-20 ? "extended precision" : "doubles", 4 * rounding),
                {.key = "rtol", .value = fmt::format("{}", *options.rtol)});
  }
  for (const auto& [value, key] : {std::pair(options.beta, "beta"), std::pair(options.gamma, "gamma")}) {
    if (value && !takes(key)) fail(key, fmt::format("method '{}' has no {}; take it out", info.name, key));
  }
  if (options.jacobian && !takes("jacobian")) {
    fail("jacobian",
         fmt::format("method '{}' solves no linear systems, so jacobian means nothing to it; take it out", info.name));
  }
  if (info.is_adaptive(options) && options.rtol.value_or(info.rtol) == 0 && options.atol.value_or(info.atol) == 0) {
    fail("rtol", "rtol and atol are both 0, so no step could pass; give one of them above 0");
  }
  if (options.first && !(*options.first > 0 && std::isfinite(*options.first))) {
    fail("step", fmt::format("a first step of {} is no step; a finite time above 0 is expected", *options.first));
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
