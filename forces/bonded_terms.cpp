#include "forces/bonded_terms.hpp"

#include "numbers/error.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace noether {

namespace {

/// What a parameter may be.
enum class Allowed : std::uint8_t { any, not_negative, positive, whole };

struct KnownParameter {
  std::string name;
  Allowed allowed = Allowed::any;
};

/// A potential as a topology may name it.
template <class Potential> struct KnownPotential {
  std::string name;
  Potential potential;
  std::vector<KnownParameter> parameters;
};

template <class Potential> using Known = std::vector<KnownPotential<Potential>>;

const KnownParameter stiffness{"k"}, rest_angle{"angle", Allowed::not_negative};
const KnownParameter rest_length{"length", Allowed::not_negative};

Known<BondPotential> known_bonds() {
  return {{"harmonic", BondPotential::harmonic, {stiffness, rest_length}},
          {"morse", BondPotential::morse, {{"depth"}, {"a"}, rest_length}},
          {"fene",
           BondPotential::fene,
           {stiffness, {"longest", Allowed::positive}, {"epsilon"}, {"sigma", Allowed::not_negative}}}};
}

Known<AnglePotential> known_angles() {
  return {{"harmonic", AnglePotential::harmonic, {stiffness, rest_angle}},
          {"cosine", AnglePotential::cosine, {stiffness}},
          {"cosine_squared", AnglePotential::cosine_squared, {stiffness, rest_angle}},
          {"urey_bradley", AnglePotential::urey_bradley, {stiffness, rest_angle, {"k_ends"}, rest_length}}};
}

const std::vector<KnownParameter> of_periodic = {stiffness, {"n", Allowed::whole}, {"phase"}};

Known<DihedralPotential> known_dihedrals() {
  return {
      {"periodic", DihedralPotential::periodic, of_periodic},
      {"ryckaert_bellemans", DihedralPotential::ryckaert_bellemans, {{"c0"}, {"c1"}, {"c2"}, {"c3"}, {"c4"}, {"c5"}}},
      {"one_four", DihedralPotential::one_four, {{"epsilon"}, {"sigma", Allowed::not_negative}, {"charges"}}}};
}

Known<DihedralPotential> known_impropers() {
  return {{"harmonic", DihedralPotential::harmonic_improper, {stiffness, rest_angle}},
          {"periodic", DihedralPotential::periodic, of_periodic}};
}

/// What is expected where a value is refused; empty where it is not.
std::string refusal(Allowed allowed, double value) {
  if (!std::isfinite(value)) return "a finite number";
  if (allowed == Allowed::not_negative && value < 0) return "0 or more";
  if (allowed == Allowed::positive && !(value > 0)) return "a number above 0";
  if (allowed == Allowed::whole && (value < 0 || value != std::round(value))) return "a whole number, 0 or more,";
  return "";
}

template <class Potential>
const KnownPotential<Potential>& find(const Known<Potential>& known, const std::string& name, const char* family) {
  for (const auto& one : known) {
    if (one.name == name) return one;
  }
  std::vector<std::string> names;
  for (const auto& one : known) names.push_back(one.name);
  throw Error(fmt::format("unknown potential '{}' of {}{}", name, family, did_you_mean(name, names)));
}

template <class Potential>
std::vector<BondedKind<Potential>> kinds_of(const std::vector<TermKind>& kinds, const Known<Potential>& known,
                                            const char* family) {
  std::vector<BondedKind<Potential>> found;
  for (const TermKind& kind : kinds) {
    const KnownPotential<Potential>& potential = find(known, kind.potential, family);
    std::vector<std::string> names;
    for (const KnownParameter& one : potential.parameters) names.push_back(one.name);
    if (kind.parameters.size() != names.size()) {
      throw Error(fmt::format("potential '{}' of {} has {} parameters; {} are expected: {}", kind.potential, family,
                              kind.parameters.size(), names.size(), fmt::join(names, ", ")));
    }
    BondedKind<Potential> made{potential.potential, {}};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string expected = refusal(potential.parameters[k].allowed, kind.parameters[k]);
      if (!expected.empty()) {
        throw Error(fmt::format("{} = {} in potential '{}' of {}: {} is expected", names[k], kind.parameters[k],
                                kind.potential, family, expected));
      }
      made.parameters[k] = kind.parameters[k];
    }
    found.push_back(made);
  }
  return found;
}

/// For each of `count` things how many follow in step, it included. @param next_too  (k): whether k + 1 does
template <class NextToo> std::vector<std::uint8_t> steps_together(std::size_t count, const NextToo& next_too) {
  constexpr std::uint8_t most = std::numeric_limits<std::uint8_t>::max();
  std::vector<std::uint8_t> steps(count, 1);
  for (std::size_t k = count; k-- > 1;) {
    if (next_too(k - 1)) steps[k - 1] = static_cast<std::uint8_t>(std::min<int>(steps[k] + 1, most));
  }
  return steps;
}

/// Every particle there is and none twice; every kind there is.
/// @param may_repeat  (term): whether it may have a particle twice
template <std::size_t size, class MayRepeat>
void check_terms(const std::vector<BondedTerm<size>>& terms, std::size_t kinds, Index n, const char* one,
                 const char* section, const MayRepeat& may_repeat) {
  for (const BondedTerm<size>& term : terms) {
    if (kinds == 0) {
      throw Error(fmt::format("there is {}, but no parameters for its kind; give the parameters of each kind in "
                              "section '{}' of the structure",
                              one, section),
                  {.key = "structure"});
    }
    if (term.type < 0 || static_cast<std::size_t>(term.type) >= kinds) {
      throw Error(fmt::format("{} is of kind {}, but there are {} kinds", one, term.type, kinds));
    }
    for (std::size_t k = 0; k < size; ++k) {
      const Index i = term.particles[k];
      if (i < 0 || i >= n) throw Error(fmt::format("{} is of particle {}, but there are {}", one, i, n));
      if (!may_repeat(term) && std::count(term.particles.begin(), term.particles.end(), i) > 1) {
        throw Error(fmt::format("{} has particle {} twice; different ones are expected", one, i));
      }
    }
  }
}

}  // namespace

BondedTerms::BondedTerms(std::shared_ptr<const Topology> topology, Index n)
    : bonds(kinds_of(topology->bond_kinds, known_bonds(), "bonds")),
      angles(kinds_of(topology->angle_kinds, known_angles(), "angles")),
      dihedrals(kinds_of(topology->dihedral_kinds, known_dihedrals(), "dihedrals")),
      impropers(kinds_of(topology->improper_kinds, known_impropers(), "impropers")),
      origin_(std::move(topology)),
      topology_(origin_->rigid.empty() ? origin_ : std::make_shared<const Topology>(origin_->without_rigid_terms(n))) {
  const auto never = [](const auto&) { return false; };
  check_terms(topology_->bonds, bonds.size(), n, "a bond", "Bond Coeffs", never);
  check_terms(topology_->angles, angles.size(), n, "an angle", "Angle Coeffs", never);
  // Of a pair that no three bonds join the ends stand in the middle too.
  check_terms(topology_->dihedrals, dihedrals.size(), n, "a dihedral", "Dihedral Coeffs", [&](const auto& term) {
    const auto& [first, second, third, last] = term.particles;
    return dihedrals[static_cast<std::size_t>(term.type)].potential == DihedralPotential::one_four && first == second &&
           third == last && first != last;
  });
  check_terms(topology_->impropers, impropers.size(), n, "an improper", "Improper Coeffs", never);
  struct Place {
    Index owner;
    std::uint64_t slot;  // and the sign
  };
  std::vector<Place> places;
  std::uint64_t slots = 0;
  const auto add = [&](const auto& terms) {
    for (const auto& term : terms) {
      const auto own = static_cast<std::size_t>(slots_of(term));
      for (std::size_t k = 0; k < term.particles.size(); ++k) {
        places.push_back({term.particles[k], k < own ? 2 * (slots + k) : 2 * slots + 1});
      }
      slots += own;
    }
    terms_ += static_cast<Index>(terms.size());
  };
  add(topology_->bonds);
  add(topology_->angles);
  add(topology_->dihedrals);
  add(topology_->impropers);
  if (slots > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw Error(fmt::format("{} bonded terms are too many; less than 2^29 are expected", terms_));
  }
  slots_ = static_cast<Index>(slots);
  // Counted, then dealt out in the order of the slots.
  first_.assign(static_cast<std::size_t>(n) + 1, 0);
  for (const Place& place : places) ++first_[static_cast<std::size_t>(place.owner) + 1];
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) first_[i + 1] += first_[i];
  slot_.resize(places.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Place& place : places) {
    slot_[next[static_cast<std::size_t>(place.owner)]++] = static_cast<std::uint32_t>(place.slot);
  }
  particles_in_step_ = steps_together(static_cast<std::size_t>(n), [&](std::size_t i) {
    const std::uint32_t from = first_[i], size = first_[i + 1] - from;
    bool next_too = first_[i + 2] - first_[i + 1] == size;
    for (std::uint32_t k = from; k < from + size && next_too; ++k) next_too = slot_[k + size] == slot_[k] + 2;
    return next_too;
  });
  const auto& bonds_of = topology_->bonds;
  bonds_in_step_ = steps_together(bonds_of.size(), [&](std::size_t k) {
    const auto &one = bonds_of[k].particles, &next_one = bonds_of[k + 1].particles;
    return next_one[0] == one[0] + 1 && next_one[1] == one[1] + 1;
  });
  for (auto& kind : angles) kind.parameters[5] = std::cos(kind.parameters[1]);
}

}  // namespace noether
