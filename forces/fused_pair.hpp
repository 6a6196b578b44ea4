#pragma once
/// Several pair potentials in one loop.

#include "forces/pair_force.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace noether {

/// The sum of pair potentials, for one PairForce: distances, and what is added to the sums, are computed once.
///
///     PairForce<Pair<LennardJonesPair, ReactionField>> force{{{1, 1}, {0.9, 78.3}}, 0.9, Cutoff::shifted};
///
/// A potential with a range of its own is zero from there on; PairForce ends what is left at its cutoff. If all of them
/// have one, so has the sum.
template <PairPotential... Parts> struct Pair {
  static constexpr bool charged = (ChargedPairPotential<Parts> || ...);

  std::tuple<Parts...> parts;

  Pair() = default;
  Pair(Parts... given) : parts(std::move(given)...) {}  // NOLINT: potentials stand for their sum

  /// @throws Error  as the parts do
  void check() const {
    each([](const auto& part) {
      if constexpr (requires { part.check(); }) part.check();
    });
  }
  double scale() const requires(!charged) { return sum_of_scales(0); }
  double scale(double product) const requires charged { return sum_of_scales(product); }
  /// The widest range of the parts.
  double range() const requires(EndsByItself<Parts>&&...) {
    double widest = 0;
    each([&](const auto& part) { widest = std::max(widest, part.range()); });
    return widest;
  }
  /// Pairs nearer than that end the run; 0 where no part has such a distance.
  double nearest() const {
    double nearest = 0;
    each([&](const auto& part) {
      if constexpr (requires { part.nearest(); }) nearest = std::max(nearest, part.nearest());
    });
    return nearest;
  }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const requires(!charged) { return sum(r2, Real(0)); }
  template <class Real> PairTerms<Real> operator()(const Real& r2, const Real& product) const requires charged {
    return sum(r2, product);
  }

 private:
  template <class Body> void each(const Body& body) const {
    std::apply([&](const auto&... part) { (body(part), ...); }, parts);
  }
  double sum_of_scales(double product) const {
    double scale = 0;
    each([&](const auto& part) { scale += detail::scale_of(part, product); });
    return scale;
  }
  template <class Real> PairTerms<Real> sum(const Real& r2, const Real& product) const {
    PairTerms<Real> sum{Real(0), Real(0)};
    each([&](const auto& part) {
      PairTerms<Real> terms = detail::bare_terms(part, r2, product);
      if constexpr (EndsByItself<std::decay_t<decltype(part)>>) {
        const bool acts = r2 < Real(part.range() * part.range());
        terms = {acts ? terms.energy : Real(0), acts ? terms.force : Real(0)};
      }
      sum.energy += terms.energy;
      sum.force += terms.force;
    });
    return sum;
  }
};

}  // namespace noether
