#pragma once
/// Sums of forces: known to the compiler (`Sum`), or assembled while the program runs (`ForceField`).

#include "engine/erasure.hpp"
#include "numbers/cost_book.hpp"

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
  const bool gyrate = (!all.velocity_dependent || all.gyrates) && (!one.velocity_dependent || one.gyrates);
  all.velocity_dependent = all.velocity_dependent || one.velocity_dependent;
  all.gyrates = all.velocity_dependent && gyrate;
  all.time_dependent = all.time_dependent || one.time_dependent;
  all.dissipative = all.dissipative || one.dissipative;
  all.keeps_momentum = all.keeps_momentum && one.keeps_momentum;
  all.keeps_angular_momentum = all.keeps_angular_momentum && one.keeps_angular_momentum;
  all.periodic = all.periodic && one.periodic;
  all.sets = all.sets && one.sets;
  if (one.kepler) {
    all.kepler = true;
    all.G = one.G;
    all.softening = std::max(all.softening, one.softening);
  }
  all.fixed_figure = all.fixed_figure || one.fixed_figure;
  all.turning_figures = all.turning_figures || one.turning_figures;
  all.bonded = all.bonded || one.bonded;
  all.meshed = all.meshed || one.meshed;
  all.on_bodies = all.on_bodies || one.on_bodies;
  all.pair_coefficients = all.pair_coefficients || one.pair_coefficients;
  all.charges = one_says_so(all.charges, one.charges);
  all.exclusions = one_says_so(all.exclusions, one.exclusions);
  all.drag += one.drag;
  all.range = std::max(all.range, one.range);
  all.tangent = std::min(all.tangent, one.tangent);
  for (const char letter : one.kicks) {
    if (all.kicks.find(letter) == std::string::npos) all.kicks += letter;
  }
  std::sort(all.kicks.begin(), all.kicks.end());
}
}  // namespace detail

/// Forces added at compile time, in order: `Sum(Gravity{}, j2)`. Itself a force.
template <class... Fs> class Sum {
 public:
  explicit Sum(Fs... forces) : forces_(std::move(forces)...) {}

  template <class Real>
    requires(Force<Fs, Real>&&...)
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    std::size_t term = 0;
    const auto add = [&](const auto& force) {
      const std::size_t k = term++;
      if (!out.takes_all() && !out.takes(claims_of(force).kicks)) return;
      out.in_room(k, [&] {
        if constexpr (std::is_same_v<Real, Pack>) {
          add_in_lanes(force, out, s);
        } else {
          force.add_to(out, s);
        }
      });
    };
    std::apply([&](const auto&... force) { (add(force), ...); }, forces_);
  }
  template <class Real> void bind(const ParticleSystem<Real>& s) {
    const auto one = [&](auto& force) {
      if constexpr (requires { force.bind(s); }) force.bind(s);
    };
    std::apply([&](auto&... force) { (one(force), ...); }, forces_);
  }
  /// Calls `visit` with one force after the other.
  template <class Visit> void for_each(const Visit& visit) const {
    std::apply([&](const auto&... force) { (visit(force), ...); }, forces_);
  }
  bool has_secant() const {
    return std::apply([](const auto&... force) { return (noether::has_secant<double>(force) && ...); }, forces_);
  }
  /// @throws LogicError  if one of them knows no secants
  template <class Real>
    requires(Force<Fs, Real>&&...)
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    std::size_t term = 0;
    const auto add = [&](const auto& force) {
      const std::size_t k = term++;
      if (!out.takes_all() && !out.takes(claims_of(force).kicks)) return;
      out.in_room(k, [&] { detail::add_secant_of(force, out, from, to); });
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
    ForceClaims all{.periodic = true,
                    .sets = sizeof...(Fs) == 1,
                    .charges = false,
                    .exclusions = false,
                    .kicks = "",
                    .tangent = TangentPattern::sparse};
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
    kicks_.push_back(terms_.back().claims().kicks);
    return *this;
  }

  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for_terms(out, [&](const AnyForce<Real>& term) { term.add_to(out, s); });
  }
  void bind(const ParticleSystem<Real>& s) {
    for (auto& term : terms_) term.bind(s);
  }
  bool has_secant() const {
    return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.has_secant(); });
  }
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    for_terms(out, [&](const AnyForce<Real>& term) { term.add_secant_to(out, from, to); });
  }
  bool has_lanes() const {
    return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.has_lanes(); });
  }
  void add_to(ForceSink<Pack>& out, const ParticleSystem<Pack>& s) const {
    for_terms(out, [&](const AnyForce<Real>& term) { term.add_to(out, s); });
  }
  bool has_derivative() const {
    return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.has_derivative(); });
  }
  void add_to(ForceSink<Dual<Real, 1>>& out, const ParticleSystem<Dual<Real, 1>>& s) const {
    for_terms(out, [&](const AnyForce<Real>& term) { term.add_to(out, s); });
  }
  ForceClaims claims() const {
    ForceClaims all{.periodic = true,
                    .sets = terms_.size() == 1,
                    .charges = false,
                    .exclusions = false,
                    .kicks = "",
                    .tangent = TangentPattern::sparse};
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
  template <class Sink, class Add> void for_terms(Sink& out, const Add& add) const {
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      if (!out.takes_all() && !out.takes(kicks_[k])) continue;
      const Spent spent("force", [&] { return terms_[k].name(); });
      out.in_room(k, [&] { add(terms_[k]); });
    }
  }

  std::vector<AnyForce<Real>> terms_;
  std::vector<std::string> kicks_;  ///< of each term
};

extern template class ForceField<double>;
extern template class ForceField<Quad>;

}  // namespace noether
