#include "engine/type_parameters.hpp"

#include "engine/charge.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// Where a table of parameters goes wrong.
[[noreturn]] void refuse_parameters(const std::string& key, const std::string& message) {
  throw Error(message, {.key = key});
}

int type_at(const Topology& topology, const std::string& name, const std::string& key) {
  try {
    return type_of_name(topology, name);
  } catch (const Error& error) {
    refuse_parameters(key, error.message());
  }
}

void check_lennard_jones(double epsilon, double sigma, const std::string& key) {
  for (const auto& [name, value] : {std::pair("epsilon", epsilon), std::pair("sigma", sigma)}) {
    if (value >= 0 && std::isfinite(value)) continue;
    refuse_parameters(key, fmt::format("{} is {}; 0 or more is expected", name, format_number(value)));
  }
}

void set_mass(ParticleSystem<double>& s, const Topology& topology, int type, double mass) {
  for (Index i = 0; i < s.size(); ++i) {
    if (topology.type(i) == type) s.masses()[i] = mass;
  }
}

void set_charge(ParticleSystem<double>& s, const Topology& topology, int type, double charge) {
  if (!s.has<Charge>()) s.add_column<Charge>();
  auto& charges = s.column<Charge>();
  for (Index i = 0; i < s.size(); ++i) {
    if (topology.type(i) == type) charges[i] = charge;
  }
}

void set_one(ParticleSystem<double>& s, Topology& topology, const TypeParameters& one, std::vector<bool>& known,
             const std::string& key) {
  const int type = type_at(topology, one.type, key);
  if (one.mass && !(*one.mass >= 0 && std::isfinite(*one.mass))) {
    refuse_parameters(
        key, fmt::format("the mass of type '{}' is {}; 0 or more is expected", one.type, format_number(*one.mass)));
  }
  if (one.mass) set_mass(s, topology, type, *one.mass);
  if (one.charge) set_charge(s, topology, type, *one.charge);
  if (one.epsilon.has_value() != one.sigma.has_value()) {
    refuse_parameters(key, fmt::format("type '{}' has {} but no {}; give both or neither", one.type,
                                       one.epsilon ? "epsilon" : "sigma", one.epsilon ? "sigma" : "epsilon"));
  }
  if (!one.epsilon) return;
  check_lennard_jones(*one.epsilon, *one.sigma, key);
  topology.pair_kinds.resize(known.size());
  topology.pair_kinds[static_cast<std::size_t>(type)] = {*one.epsilon, *one.sigma};
  known[static_cast<std::size_t>(type)] = true;
}

}  // namespace

int type_of_name(const Topology& topology, const std::string& name) {
  const auto& names = topology.type_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw Error(fmt::format("there is no type '{}'{}", name, did_you_mean(name, names)), {.value = name});
}

void set_type_parameters(ParticleSystem<double>& s, Topology& topology, const std::vector<TypeParameters>& types,
                         const std::vector<PairParameters>& pairs) {
  std::vector<bool> known(static_cast<std::size_t>(topology.type_count()), !topology.pair_kinds.empty());
  for (std::size_t k = 0; k < types.size(); ++k) set_one(s, topology, types[k], known, fmt::format("type.{}", k));
  const auto missing = std::find(known.begin(), known.end(), false);
  if (missing != known.end() && !topology.pair_kinds.empty()) {
    const auto type = static_cast<std::size_t>(missing - known.begin());
    refuse_parameters("type", fmt::format("type '{}' has no epsilon and sigma, but others do; give epsilon = 0 where "
                                          "there is no Lennard-Jones force",
                                          topology.type_names[type]));
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::string key = fmt::format("pair.{}", k);
    const int a = type_at(topology, pairs[k].first, key), b = type_at(topology, pairs[k].second, key);
    check_lennard_jones(pairs[k].epsilon, pairs[k].sigma, key);
    topology.explicit_pairs[{std::min(a, b), std::max(a, b)}] = {pairs[k].epsilon, pairs[k].sigma};
  }
}

}  // namespace noether
