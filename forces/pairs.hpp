#pragma once
/// What all pair forces of short range share: how they end at their cutoff, and the plain loop over pairs.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/images.hpp"
#include "forces/secant.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// How pair forces end at the cutoff r_c.
enum class Cutoff : std::uint8_t {
  plain,             ///< cut: the energy jumps when a pair crosses r_c
  shifted,           ///< U - U(r_c): the force jumps
  shifted_force,     ///< U - U(r_c) - (r - r_c) U'(r_c): the force is continuous
  switch_c2,         ///< times a polynomial in r^2 from `switch_from` on: two continuous derivatives
  switch_c4,         ///< the same with four continuous derivatives, for shadow Hamiltonians and higher order
  potential_switch,  ///< the polynomial of switch_c2 in r, as OpenMM and GROMACS have it: two continuous derivatives
  charmm_switch,     ///< CHARMM's cubic polynomial in r^2: one continuous derivative
  force_switch,  ///< less a shift below `switch_from`, from there on the force less a cubic polynomial in r that takes
                 ///< it and its derivative to 0, as GROMACS and CHARMM have it: two continuous derivatives
};

template <> struct EnumNames<Cutoff> {
  static constexpr std::array<std::pair<Cutoff, std::string_view>, 8> values = {
      {{Cutoff::plain, "plain"},
       {Cutoff::shifted, "shifted"},
       {Cutoff::shifted_force, "shifted_force"},
       {Cutoff::switch_c2, "switch_c2"},
       {Cutoff::switch_c4, "switch_c4"},
       {Cutoff::potential_switch, "potential_switch"},
       {Cutoff::charmm_switch, "charmm_switch"},
       {Cutoff::force_switch, "force_switch"}}};
};

namespace detail {

/// Whether a style begins at `switch_from`.
inline bool is_switched(Cutoff style) {
  return style != Cutoff::plain && style != Cutoff::shifted && style != Cutoff::shifted_force;
}

/// S and dS/dt of a switch that falls from 1 at t = 0 to 0 at t = 1.
template <class Real> struct Switch {
  Real value, slope;

  [[gnu::always_inline]] Switch(Cutoff style, const Real& t) {
    const Real t2 = t * t, u = Real(1) - t, u2 = u * u;
    if (style == Cutoff::switch_c2 || style == Cutoff::potential_switch) {
      value = Real(1) - t2 * t * (Real(10) + t * (Real(6) * t - Real(15)));
      slope = Real(-30) * t2 * u2;
    } else if (style == Cutoff::charmm_switch) {
      value = Real(1) - t2 * (Real(3) - Real(2) * t);
      slope = Real(-6) * t * u;
    } else {
      value = Real(1) - t2 * t2 * t * (Real(126) + t * (Real(-420) + t * (Real(540) + t * (Real(70) * t - Real(315)))));
      slope = Real(-630) * t2 * t2 * u2 * u2;
    }
  }
};

/// Adds `f` to the first of two particles and `-f` to the second.
template <class Real>
void add_pair_of(ForceSink<Real>& out, const ParticleSystem<Real>& s, const Topology::Pair& pair, const Vec3<Real>& f) {
  const auto [i, j] = pair;
  if (s.masses()[i] != Real(0)) out.accelerations().add(i, f / s.masses()[i]);
  if (s.masses()[j] != Real(0)) out.accelerations().add(j, -f / s.masses()[j]);
}

/// Adds all pairs in turn, each image in range, but those that the topology excludes or scales.
/// @param terms  (i, j, r2, add): calls `add(PairTerms)` if the pair acts
/// @cost O(n^2)
template <class Real, class Terms>
void add_pairs_in_turn(ForceSink<Real>& out, const ParticleSystem<Real>& s, double range, const Terms& terms) {
  const Topology* topology = s.topology();
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j <= i; ++j) {
      if (i != j && topology != nullptr && topology->is_special(i, j)) continue;
      const Real part = i == j ? Real(1) / Real(2) : Real(1);
      for_images(s, i, j, range, [&](const Vec3<Real>& d, bool) {
        terms(i, j, norm2(d), [&](const PairTerms<Real>& found) {
          const Vec3<Real> f = found.force * d;
          if (i != j) add_pair_of(out, s, {i, j}, f);
          out.energy(part * found.energy);
          out.virial(part * f * d.transpose());
        });
      });
    }
  }
}

/// Adds the secants of all pairs, each image that is in range in either state, but those that the topology excludes;
/// scaled ones are scaled.
/// @param terms  as above @param closest  see SecantPair
/// @cost O(n^2)
template <class Real, class Terms>
void add_pair_secants(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to,
                      double range, double closest, const Terms& terms) {
  Secants<Real> secants(out, from, to);
  const Topology* topology = to.topology();
  for (Index i = 0; i < to.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      bool acts = !(closest > 0);  // pairs that have no such energy may be as close as they like
      if (!acts) terms(i, j, Real(range * range / 2), [&](const PairTerms<Real>&) { acts = true; });
      if (!acts) continue;
      const double part = topology != nullptr ? topology->pair_factor(i, j) : 1;
      secants.pair({.i = i, .j = j, .range = range, .nearest_part = part, .closest = closest}, [&](const Real& r2) {
        PairTerms<Real> found{Real(0), Real(0)};
        terms(i, j, r2, [&](const PairTerms<Real>& one) { found = one; });
        return found;
      });
    }
  }
}

/// What a kick may move a particle by, as parts of the distance to its neighbor and of the range. An r^-12 wall shakes
/// two particles of one mass with (h omega)^2 = 27 of the first part; beyond 4 no step follows, and nobody is to begin
/// there, but a hot melt bears it for moments. Kicks below the part of the range are never asked.
inline constexpr double thrown_at_start = 0.19, thrown_later = 0.5, thrown_of_range = 0.05;

/// What pairs of doubles outside the neighbor list keep to, as those within it do.
struct PairLimits {
  double range = 0;             ///< of the force [length]
  double nearest = 0;           ///< pairs nearer than that are none of the potential's [length]
  double strongest = 0;         ///< what exact sums take of a pair [mass length/time^2]
  std::string_view force = {};  ///< as messages call it
};

/// Two particles, and the force on the first of them.
struct PairForceOn {
  Index i, j;
  double r2;
  Vec3<double> force;
};

/// Tells `out` of a pair that is too close, or that no step follows. @return whether its force is a number
bool look_closer(ForceSink<double>& out, const ParticleSystem<double>& s, const PairForceOn& pair,
                 const PairLimits& limits);

/// The same, of pairs that are nearly all well. @return whether the force can be added
inline bool can_add(ForceSink<double>& out, const ParticleSystem<double>& s, const PairForceOn& pair,
                    const PairLimits& limits) {
  const double size = std::abs(pair.force[0]) + std::abs(pair.force[1]) + std::abs(pair.force[2]);
  const double lightest = std::min(s.masses()[pair.i], s.masses()[pair.j]);
  const bool weak = size * out.kick() * out.kick() <= thrown_of_range * limits.range * lightest;
  const bool well = size < limits.strongest && pair.r2 >= limits.nearest * limits.nearest;
  return (well && (weak || out.kick() == 0)) || look_closer(out, s, pair, limits);
}

/// Adds what the images of a pair beyond the nearest one do to each other: what the topology excludes or scales is the
/// pair itself, which is the nearest, and no copy of it.
template <class Real, class Terms>
void add_far_images(ForceSink<Real>& out, const ParticleSystem<Real>& s, const Topology::Pair& pair, const Terms& terms,
                    const PairLimits& limits) {
  const Index i = pair.first, j = pair.second;
  for_images(s, i, j, limits.range, [&](const Vec3<Real>& d, bool nearest) {
    if (nearest) return;
    terms(i, j, norm2(d), [&](const PairTerms<Real>& found) {
      const Vec3<Real> f = found.force * d;
      if constexpr (std::is_same_v<Real, double>) {
        if (!can_add(out, s, {i, j, norm2(d), f}, limits)) return;
      }
      add_pair_of(out, s, pair, f);
      out.energy(found.energy);
      out.virial(f * d.transpose());
    });
  });
}

/// A scaled pair as it was found.
template <class Real> struct ScaledPairFound {
  Real r2, energy;
  Vec3<Real> force;  ///< on the first of the two
  bool acts;
};

/// Adds these pairs at their nearest images, scaled; doubles within their limits, or the run ends. All threads find the
/// forces, one adds them, in the order of the pairs.
/// @param terms  as above
template <class Real, class Terms>
void add_scaled_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s,
                      const std::vector<Topology::ScaledPair>& pairs, const Terms& terms, const PairLimits& limits) {
  thread_local std::vector<ScaledPairFound<Real>> memory;
  if (memory.size() < pairs.size()) memory.resize(pairs.size());
  std::vector<ScaledPairFound<Real>>& all = memory;  // this thread's, written by all
  for_blocks(static_cast<Index>(pairs.size()), [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const auto [i, j] = pairs[k].pair;
      const Vec3<Real> d = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
      ScaledPairFound<Real>& found = all[k];
      found.r2 = norm2(d);
      found.acts = false;
      terms(i, j, found.r2, [&](const PairTerms<Real>& one) {
        found.acts = true;
        found.force = Real(pairs[k].factor) * one.force * d;
        found.energy = Real(pairs[k].factor) * one.energy;
      });
    }
  });
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k].pair;
    const ScaledPairFound<Real>& found = all[k];
    if (!found.acts) continue;
    if constexpr (std::is_same_v<Real, double>) {
      if (!can_add(out, s, {i, j, found.r2, found.force}, limits)) continue;
    }
    out.pair(i, j, found.force);
    out.energy(found.energy);
  }
}

/// Adds the pairs whose force the topology scales, at their nearest images, and, in a box that is small for the range,
/// all others in range of these and of excluded pairs.
/// @param terms  as above
template <class Real, class Terms>
void add_special_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s, const Terms& terms,
                       const PairLimits& limits) {
  if (s.topology() == nullptr) return;
  const std::vector<Topology::ScaledPair>& pairs = s.topology()->scaled_pairs;
  add_scaled_pairs(out, s, pairs, terms, limits);
  if (!feels_far_images(s.box(), limits.range)) return;
  for (const Topology::Pair& pair : s.topology()->exclusions) add_far_images(out, s, pair, terms, limits);
  for (const Topology::ScaledPair& scaled : pairs) add_far_images(out, s, scaled.pair, terms, limits);
}

/// The pairs that the topology excludes or scales, with what that takes away from each.
inline const std::vector<Topology::ScaledPair>& taken_away(const Topology& topology) {
  thread_local std::vector<Topology::ScaledPair> pairs;
  pairs.clear();
  for (const Topology::Pair& pair : topology.exclusions) pairs.push_back({pair, 1});
  for (const Topology::ScaledPair& scaled : topology.scaled_pairs) pairs.push_back({scaled.pair, 1 - scaled.factor});
  return pairs;
}

/// @throws Error  for a cutoff that is no length, or a switch that begins outside it or that there is none of
void check_cutoff(double cutoff, Cutoff style, std::optional<double> switch_from);

/// What helps a run whose step came upon such a pair, as its message ends; nothing helps where nearer pairs attract.
/// @param kick  of the step; 0: there is none @param nearest  see PairLimits
std::string_view help_of_close_pairs(double kick, double nearest);

/// Names particle `i` and the one nearest to it. @param force  as a message calls it @cost O(n)
Failure overlap(const ParticleSystem<double>& s, Index i, std::string_view force, std::string_view help);
/// The same of a pair whose force moves particle `i` by `way` in one kick [length].
Failure thrown(const ParticleSystem<double>& s, Index i, std::string_view force, double way);
/// The same where so many are near particle `i` that no list can hold them.
Failure crowded(const ParticleSystem<double>& s, Index i, double range);

}  // namespace detail

}  // namespace noether
