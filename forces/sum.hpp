#pragma once
/// Sums of forces: known to the compiler (`Sum`), or assembled while the program runs (`ForceField`).

#include "engine/erasure.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace noether {

namespace detail {
inline std::optional<bool> one_says_so(std::optional<bool> a, std::optional<bool> b) {
  if (a.value_or(false) || b.value_or(false)) return true;
  return a && b ? std::optional<bool>(false) : std::nullopt;
}
inline void merge(ForceClaims& all, const ForceClaims& one) {
  all.energy = all.energy && one.energy;
  all.virial = all.virial && one.virial;
  all.velocity_dependent = all.velocity_dependent || one.velocity_dependent;
  all.time_dependent = all.time_dependent || one.time_dependent;
  all.dissipative = all.dissipative || one.dissipative;
  all.keeps_momentum = all.keeps_momentum && one.keeps_momentum;
  all.keeps_angular_momentum = all.keeps_angular_momentum && one.keeps_angular_momentum;
  all.periodic = all.periodic && one.periodic;
  all.sets = all.sets && one.sets;
  all.kepler = all.kepler || one.kepler;
  all.bonded = all.bonded || one.bonded;
  all.pair_coefficients = all.pair_coefficients || one.pair_coefficients;
  all.charges = one_says_so(all.charges, one.charges);
  all.exclusions = one_says_so(all.exclusions, one.exclusions);
  all.drag += one.drag;
  all.range = std::max(all.range, one.range);
}
}  // namespace detail

/// Forces added at compile time, in order: `Sum(Gravity{}, j2)`. Itself a force.
template <class... Fs> class Sum {
 public:
  explicit Sum(Fs... forces) : forces_(std::move(forces)...) {}

  template <class Real>
    requires(Force<Fs, Real>&&...)
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const auto add = [&](const auto& force) {
      if constexpr (std::is_same_v<Real, Pack>) {
        add_in_lanes(force, out, s);
      } else {
        force.add_to(out, s);
      }
    };
    std::apply([&](const auto&... force) { (add(force), ...); }, forces_);
  }
  bool has_lanes() const {
    return std::apply([](const auto&... force) { return (noether::has_lanes(force) && ...); }, forces_);
  }
  bool has_derivative() const {
    const auto one = [](const auto& force) {
      if constexpr (requires { force.has_derivative(); }) return force.has_derivative();
      return true;
    };
    return std::apply([&](const auto&... force) { return (one(force) && ...); }, forces_);
  }
  ForceClaims claims() const {
    ForceClaims all{.periodic = true, .sets = sizeof...(Fs) == 1, .charges = false, .exclusions = false};
    std::apply([&](const auto&... force) { (detail::merge(all, claims_of(force)), ...); }, forces_);
    return all;
  }
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    std::apply([&](const auto&... force) { (check_force(force, s), ...); }, forces_);
  }
  std::string name() const { return "sum"; }
  std::string signature() const {
    std::string all;
    std::apply([&](const auto&... force) { ((all += (all.empty() ? "" : " + ") + detail::signature_of(force)), ...); },
               forces_);
    return all;
  }

 private:
  std::tuple<Fs...> forces_;
};

/// Forces added at run time, in order: `forces.add(Gravity{})`. Itself a force; one virtual call per term.
template <class Real = double> class ForceField {
 public:
  template <class F> ForceField& add(F force) {
    terms_.emplace_back(std::move(force));
    return *this;
  }

  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (const auto& term : terms_) term.add_to(out, s);
  }
  bool has_lanes() const {
    return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.has_lanes(); });
  }
  void add_to(ForceSink<Pack>& out, const ParticleSystem<Pack>& s) const {
    for (const auto& term : terms_) term.add_to(out, s);
  }
  bool has_derivative() const {
    return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.has_derivative(); });
  }
  void add_to(ForceSink<Dual<Real, 1>>& out, const ParticleSystem<Dual<Real, 1>>& s) const {
    for (const auto& term : terms_) term.add_to(out, s);
  }
  ForceClaims claims() const {
    ForceClaims all{.periodic = true, .sets = terms_.size() == 1, .charges = false, .exclusions = false};
    for (const auto& term : terms_) detail::merge(all, term.claims());
    return all;
  }
  void check(const ParticleSystem<Real>& s) const {
    for (const auto& term : terms_) term.check(s);
  }
  std::string name() const { return "force_field"; }
  std::string signature() const {
    std::string all;
    for (const auto& term : terms_) all += (all.empty() ? "" : " + ") + term.signature();
    return all;
  }
  const std::vector<AnyForce<Real>>& terms() const { return terms_; }

 private:
  std::vector<AnyForce<Real>> terms_;
};

extern template class ForceField<double>;
extern template class ForceField<Quad>;

}  // namespace noether
