#pragma once
/// The Lennard-Jones potential between all pairs up to a cutoff.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/neighbor_list.hpp"
#include "engine/pack.hpp"
#include "forces/lennard_jones_row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// How pair forces end at the cutoff r_c.
enum class Cutoff : std::uint8_t {
  plain,          ///< cut: the energy jumps when a pair crosses r_c
  shifted,        ///< U - U(r_c): the force jumps
  shifted_force,  ///< U - U(r_c) - (r - r_c) U'(r_c): the force is continuous
  switch_c2,      ///< times a polynomial in r^2 from `switch_from` on: two continuous derivatives
  switch_c4,      ///< the same with four continuous derivatives, for shadow Hamiltonians and higher order
};

template <> struct EnumNames<Cutoff> {
  static constexpr std::array<std::pair<Cutoff, std::string_view>, 5> values = {
      {{Cutoff::plain, "plain"},
       {Cutoff::shifted, "shifted"},
       {Cutoff::shifted_force, "shifted_force"},
       {Cutoff::switch_c2, "switch_c2"},
       {Cutoff::switch_c4, "switch_c4"}}};
};

namespace detail {
/// Energy and F/r of a pair, over any number type.
template <class Real> struct PairTerms { Real energy, force; };

/// Calls `act(d)` for the images of a pair that can be in range; of a particle with itself for those of its copies.
template <class Real, class Act>
void for_images(const ParticleSystem<Real>& s, Index i, Index j, double range, const Act& act) {
  const Box& box = s.box();
  const Vec3<Real> near = box.minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
  std::array<int, 3> most{};  // beyond the nearest image
  for (int k = 0; k < 3 && box.is_periodic(); ++k) {
    most[static_cast<std::size_t>(k)] = static_cast<int>(std::max(0.0, std::ceil(range / box.edges()[k] - 0.5)));
  }
  for (int c = -most[2]; c <= most[2]; ++c) {
    for (int b = -most[1]; b <= most[1]; ++b) {
      for (int a = -most[0]; a <= most[0]; ++a) {
        if (i == j && a == 0 && b == 0 && c == 0) continue;
        Vec3<Real> d = near;
        if (a != 0) d[0] += Real(a * box.edges()[0]);
        if (b != 0) d[1] += Real(b * box.edges()[1]);
        if (c != 0) d[2] += Real(c * box.edges()[2]);
        act(d);
      }
    }
  }
}

/// What `lennard_jones_simd.cpp` does in lanes of doubles.
template <class Real>
PairTerms<Real> lennard_jones_terms(const Real& r2, const LennardJonesRow& row, LennardJonesStyle style) {
  using std::sqrt;
  const Real inverse2 = Real(1) / r2, inverse6 = inverse2 * inverse2 * inverse2;
  const Real energy = inverse6 * (inverse6 * Real(row.energy12) - Real(row.energy6));
  const Real force = inverse2 * (inverse6 * (inverse6 * Real(row.force12) - Real(row.force6)));
  const Real a(row.style[0]), b(row.style[1]);
  if (style == LennardJonesStyle::shifted) return {energy - a, force};
  if (style == LennardJonesStyle::shifted_force) {
    const Real inverse = sqrt(inverse2);
    return {energy - a + b * r2 * inverse, force - b * inverse};
  }
  const Real t = (r2 - a) * b;
  if (!(t > Real(0))) return {energy, force};
  const Real t2 = t * t, u = Real(1) - t, u2 = u * u;
  Real s, slope;
  if (style == LennardJonesStyle::switch_c2) {
    s = Real(1) - t2 * t * (Real(10) + t * (Real(6) * t - Real(15)));
    slope = Real(-30) * t2 * u2;
  } else {
    s = Real(1) - t2 * t2 * t * (Real(126) + t * (Real(-420) + t * (Real(540) + t * (Real(70) * t - Real(315)))));
    slope = Real(-630) * t2 * t2 * u2 * u2;
  }
  return {energy * s, s * force - Real(2) * b * energy * slope};
}

/// The rows of all pairs of types, and what they were made for.
struct LennardJonesTable {
  std::vector<LennardJonesRow> rows;  ///< shape (types, types)
  int types = 1;
  LennardJonesStyle style = LennardJonesStyle::shifted;
  double force_unit = 1, energy_unit = 1;
  double tail_energy = 0, tail_virial = 0;  ///< times 1 / volume
  std::array<double, 7> key{};
  std::shared_ptr<const Topology> topology;
};
}  // namespace detail

/// Lennard-Jones pairs, cut off in one of five ways.
///
///     U = sum over pairs with r < cutoff of 4 epsilon ((sigma/r)^12 - (sigma/r)^6), as `cutoff_style` ends it
///
/// Parameters are those of the types of the particles (engine/topology.hpp), mixed or explicit, or one epsilon and
/// sigma for all. Pairs that the topology excludes are left out, scaled ones are scaled. In a box whose edges are
/// shorter than twice the cutoff all images in range count, a particle's own among them.
///
/// Doubles are summed in whole units of 2^-47 of the strongest attraction's scale, so that a sum depends on no order:
/// forces have the same bits for any neighbor list and any number of threads, and add up to nothing exactly. A pair
/// stronger than 2^61 units ends the run as `overlap`.
/// @cost doubles O(n); other number types O(n^2)
/// @source LennardJones1931, Verlet1967
struct LennardJonesForce {
  double cutoff = 0;                               ///< [length]
  Cutoff cutoff_style = Cutoff::shifted_force;     ///<
  std::optional<double> switch_from = {};          ///< where a switch begins [length]; default: 0.9 cutoff
  bool tail = false;                               ///< add what pairs beyond the cutoff give on the average
  std::optional<double> epsilon = {}, sigma = {};  ///< of all pairs [energy], [length]; default: by types
  mutable std::shared_ptr<const detail::LennardJonesTable> table = {};  ///< made from these and the particles' types

  static constexpr auto describe() {
    return part<LennardJonesForce>(
        "lennard_jones", "Lennard-Jones pairs up to a cutoff",
        formula("U = sum_{i<j} 4 epsilon ((sigma/r_ij)^12 - (sigma/r_ij)^6), r_ij < cutoff"),
        source("LennardJones1931, Verlet1967"),
        field<&LennardJonesForce::cutoff>("cutoff", "length", "pairs feel each other up to here").required("\"1 nm\""),
        field<&LennardJonesForce::cutoff_style>("cutoff_style", "1", "how pairs end at the cutoff"),
        field<&LennardJonesForce::switch_from>("switch_from", "length", "of the switches; default: 0.9 cutoff"),
        field<&LennardJonesForce::tail>("tail", "1", "energy and pressure of pairs beyond the cutoff, g(r) = 1"),
        field<&LennardJonesForce::epsilon>("epsilon", "energy", "depth of all pairs; default: by types"),
        field<&LennardJonesForce::sigma>("sigma", "length", "of all pairs; default: by types"));
  }
  ForceClaims claims() const { return {.periodic = true, .range = cutoff}; }

  /// @throws Error  for a cutoff that is no length, a switch that begins elsewhere, one of epsilon and sigma alone
  void check() const;
  /// @throws Error  for particles whose types have no parameters, or a tail without a periodic box
  template <class Real> void check(const ParticleSystem<Real>& s) const { check_types(s.topology(), s.box()); }

  template <class Real>
    requires(!std::is_same_v<Real, Pack>)  // lanes would have to agree on who is in range
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    if constexpr (std::is_same_v<Real, double>) {
      add_lanes(out, s);
    } else {
      add_pairs(out, s);
    }
  }

 private:
  void check_types(const Topology* topology, const Box& box) const;
  const detail::LennardJonesTable& table_for(const std::shared_ptr<const Topology>& topology, Index n) const;
  void add_lanes(ForceSink<double>& out, const ParticleSystem<double>& s) const;
  template <class Real> void add_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
  template <class Real> void add_scaled(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
  template <class Real> void add_tail(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
};

template <class Real> void LennardJonesForce::add_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  const detail::LennardJonesTable& known = table_for(s.shared_topology(), s.size());
  const Topology* topology = s.topology();
  const auto act = [&](Index i, Index j, const Vec3<Real>& d, const Real& part) {
    const Real r2 = norm2(d);
    const int a = topology != nullptr ? topology->type(i) : 0, b = topology != nullptr ? topology->type(j) : 0;
    const LennardJonesRow& row = known.rows[static_cast<std::size_t>(a * known.types + b)];
    if (!(r2 < Real(row.range2))) return;
    const detail::PairTerms<Real> terms = detail::lennard_jones_terms(r2, row, known.style);
    const Vec3<Real> f = terms.force * d;
    if (i != j && s.masses()[i] != Real(0)) out.accelerations().add(i, f / s.masses()[i]);
    if (i != j && s.masses()[j] != Real(0)) out.accelerations().add(j, -f / s.masses()[j]);
    out.energy(part * terms.energy);
    out.virial(part * f * d.transpose());
  };
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j <= i; ++j) {
      if (i != j && topology != nullptr && topology->is_special(i, j)) continue;
      detail::for_images(s, i, j, cutoff,
                         [&](const Vec3<Real>& d) { act(i, j, d, i == j ? Real(1) / Real(2) : Real(1)); });
    }
  }
  add_scaled(out, s);
  add_tail(out, s);
}

template <class Real> void LennardJonesForce::add_scaled(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  const Topology* topology = s.topology();
  if (topology == nullptr) return;
  const detail::LennardJonesTable& known = table_for(s.shared_topology(), s.size());
  for (const Topology::ScaledPair& scaled : topology->scaled_pairs) {
    const auto [i, j] = scaled.pair;
    const Vec3<Real> d = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
    const Real r2 = norm2(d);
    const LennardJonesRow& row =
        known.rows[static_cast<std::size_t>(topology->type(i) * known.types + topology->type(j))];
    if (!(r2 < Real(row.range2))) continue;
    const detail::PairTerms<Real> terms = detail::lennard_jones_terms(r2, row, known.style);
    out.pair(i, j, Real(scaled.factor) * terms.force * d);
    out.energy(Real(scaled.factor) * terms.energy);
  }
}

template <class Real> void LennardJonesForce::add_tail(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  if (!tail || !s.box().is_periodic()) return;
  const detail::LennardJonesTable& known = table_for(s.shared_topology(), s.size());
  const Real volume(s.box().volume());
  out.energy(Real(known.tail_energy) / volume);
  out.virial(Mat3<Real>::Identity() * (Real(known.tail_virial) / volume / Real(3)));
}

}  // namespace noether
