#pragma once
/// What pair forces give, in any number type and at any SIMD level.

#include "engine/force_sink.hpp"
#include "forces/lennard_jones.hpp"
#include "neighbors/neighbor_list.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/settings.hpp"

#include <memory>
#include <optional>

namespace noether::test {

inline constexpr Cutoff cutoff_styles[] = {Cutoff::plain,         Cutoff::shifted,     Cutoff::shifted_force,
                                           Cutoff::switch_c2,     Cutoff::switch_c4,   Cutoff::potential_switch,
                                           Cutoff::charmm_switch, Cutoff::force_switch};

/// The same particles as two kinds of atoms, some pairs left out and some at half their strength.
inline ParticleSystem<double> with_two_types(ParticleSystem<double> s) {
  auto topology = std::make_shared<Topology>();
  for (Index i = 0; i < s.size(); ++i) topology->types.push_back(i % 3 == 0 ? 1 : 0);
  topology->pair_kinds = {{1, 1}, {0.5, 1.2}};
  topology->explicit_pairs[{0, 1}] = {0.8, 1.05};
  topology->exclusions = {{0, 1}, {4, 9}};
  topology->scaled_pairs = {{{0, 2}, 0.5}, {{0, 3}, 0.25}};
  s.set_topology(topology);
  return s;
}

/// Calls `check(force, s)` at every SIMD level for a liquid, a mixture, and a box smaller than the range, of 2.2 sigma.
template <class Check> void for_liquids(const LennardJonesForce& argon, const Check& check) {
  LennardJonesForce by_types = argon;
  by_types.epsilon = by_types.sigma = std::nullopt;
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    CAPTURE(name(level), static_cast<int>(argon.cutoff_style));
    check(argon, liquid(3, 0.85, 1, 0.1));
    check(by_types, with_two_types(liquid(3, 0.5, 1, 0.2)));
    check(argon, liquid(1, 0.85, 1, 0.1));
  }
}

struct Evaluated {
  VectorColumn<double> a;
  double energy;
  Mat3<double> virial;
  std::optional<Failure> failure;
};

/// Everything that a force gives, computed in numbers of type `Real`.
template <class Real, class F>
Evaluated evaluated(const F& force, const ParticleSystem<double>& s, Workspace* lists = nullptr) {
  const ParticleSystem<Real> particles = s.as<Real>();
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, particles, {.energy = true, .virial = true}, lists);
  force.add_to(sink, particles);
  Evaluated all{VectorColumn<double>(s.size()), static_cast<double>(sink.potential()), {}, sink.failure()};
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) all.a.component(k)[i] = static_cast<double>(a.component(k)[i]);
  }
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) all.virial(r, c) = static_cast<double>(sink.virial()(r, c));
  }
  return all;
}

inline double largest_difference(const VectorColumn<double>& a, const VectorColumn<double>& b) {
  return (a.all() - b.all()).cwiseAbs().maxCoeff();
}

/// The forces on particles of mass 1, whole numbers of `unit`, add up to nothing, exactly.
inline void check_sum_is_zero(const VectorColumn<double>& a, double unit) {
  for (int k = 0; k < 3; ++k) {
    std::int64_t sum = 0;
    for (Index i = 0; i < a.size(); ++i) sum += static_cast<std::int64_t>(a.component(k)[i] / unit);
    CHECK(sum == 0);
  }
}

/// A list that is some steps old gives the bits of a new one, while particles move on and cross the box.
template <class F> void check_old_lists(const F& force, ParticleSystem<double> s, double cutoff) {
  Workspace list;
  const NeighborList& kept = list.put(NeighborList(cutoff, {.skin = 0.2}));
  for (int n = 0; n < 60; ++n) {
    s.advance_positions(0.01);
    const Evaluated old = evaluated<double>(force, s, &list), fresh = evaluated<double>(force, s);
    REQUIRE(old.a.all() == fresh.a.all());
    REQUIRE(old.energy == fresh.energy);
    REQUIRE(old.virial == fresh.virial);
  }
  CHECK(kept.statistics().sorts > 1);
  CHECK(kept.statistics().searches > kept.statistics().sorts);
  CHECK(kept.statistics().searches < 30);
}

/// A pair force gives the same bits by any neighbor list, on any number of threads, and without energies.
template <class F> void check_bits_of_lists(const F& force, const ParticleSystem<double>& s, double cutoff) {
  const Evaluated first = evaluated<double>(force, s);
  for (const double skin : {0.01, 0.1, 0.3, 0.6}) {
    for (const int threads : {1, 2, 3, 8}) {
      const Threads now(threads);
      Workspace list;
      list.put(NeighborList(cutoff, {.skin = skin, .verify = threads == 1}));
      const Evaluated again = evaluated<double>(force, s, &list);
      CHECK(again.a.all() == first.a.all());
      CHECK(again.energy == first.energy);
      CHECK(again.virial == first.virial);
    }
  }
  VectorColumn<double> a(s.size());
  ForceSink<double> forces_only(a, s, {});
  force.add_to(forces_only, s);
  CHECK(a.all() == first.a.all());
}

}  // namespace noether::test
