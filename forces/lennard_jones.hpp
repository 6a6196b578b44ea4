#pragma once
/// The Lennard-Jones potential between all pairs up to a cutoff.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/lennard_jones_row.hpp"
#include "forces/pair_force.hpp"
#include "forces/pair_precision.hpp"
#include "forces/pairs.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/pack.hpp"

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

namespace detail {

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
  const Switch<Real> end(style == LennardJonesStyle::switch_c2 ? Cutoff::switch_c2 : Cutoff::switch_c4, t);
  return {energy * end.value, end.value * force - Real(2) * b * energy * end.slope};
}

/// A pair of types by its row, for the styles that the kernels of Lennard-Jones do not have.
struct LennardJonesOfRow {
  double force12 = 0, force6 = 0, energy12 = 0, energy6 = 0;

  double scale() const { return force6; }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    const Real inverse2 = Real(1) / r2, inverse6 = inverse2 * inverse2 * inverse2;
    return {inverse6 * (inverse6 * Real(energy12) - Real(energy6)),
            inverse2 * (inverse6 * (inverse6 * Real(force12) - Real(force6)))};
  }
};

/// How it acts with one of these styles.
struct EndedLennardJones {
  LennardJonesOfRow pair;
  PairEnd end;
};

/// The rows of all pairs of types, and what they were made for.
struct LennardJonesTable {
  std::vector<LennardJonesRow> rows;     ///< shape (types, types)
  std::vector<EndedLennardJones> ended;  ///< the same, for styles of other programs; empty for all other styles
  int types = 1;
  std::ptrdiff_t only_row = 0;  ///< by which all pairs act that act at all; -1: there are more
  LennardJonesStyle style = LennardJonesStyle::shifted;
  double force_unit = 1, energy_unit = 1;
  double tail_energy = 0, tail_virial = 0;  ///< times 1 / volume
  std::array<double, 7> key{};
  std::shared_ptr<const Topology> topology;
};

/// The same rows for lengths in whole numbers of `spacing` and forces in whole numbers of `force_unit`.
struct LennardJonesMixedTable {
  std::vector<LennardJonesRow> rows;
  double spacing = 0, force_unit = 1;
  double inverse2_unit = 1;  ///< rows are for 1/r^2 times this number
  std::shared_ptr<const LennardJonesTable> of;
};
}  // namespace detail

/// Lennard-Jones pairs, cut off in one of eight ways.
///
///     U = sum over pairs with r < cutoff of 4 epsilon ((sigma/r)^12 - (sigma/r)^6), as `cutoff_style` ends it
///
/// Parameters are those of the types of the particles (engine/topology.hpp), mixed or explicit, or one epsilon and
/// sigma for all. Pairs that the topology excludes are left out, scaled ones are scaled. In a box whose edges are
/// shorter than twice the cutoff all images in range count, a particle's own among them, and of excluded and scaled
/// pairs all but the nearest, whole: what is bound is one image of a pair.
///
/// Doubles are summed in whole units of 2^-47 of the strongest attraction's scale, so that a sum depends on no order:
/// forces have the same bits for any neighbor list and any number of threads, and add up to nothing exactly. A pair
/// stronger than 2^61 units ends the run as `overlap`.
///
/// A tail is, for N particles in a volume V,
///
///     E = 2 pi N^2 / V (int_rc^inf U r^2 dr + int_rs^rc (1 - S) U r^2 dr)
///
/// with S the switch from rs to rc, where there is one. Its virial is 3 E then: the energy of pairs has no jump.
///
/// In mixed precision distances are differences of whole numbers, of 2^-28 of half the longest edge and two cutoffs or
/// finer, and the force of a pair is right to 1e-6 of itself and 2^-21 of the strongest attraction's scale; the sums
/// are as exact as the others, so that all that is said of bits and of momentum holds. Energies and virials are those
/// of doubles. Periodic boxes only.
/// @cost doubles O(n); other number types O(n^2)
/// @source LennardJones1931, Verlet1967
struct LennardJonesForce {
  double cutoff = 0;                               ///< [length]
  Cutoff cutoff_style = Cutoff::shifted_force;     ///<
  std::optional<double> switch_from = {};          ///< where a switch begins [length]; default: 0.9 cutoff
  bool tail = false;                               ///< add what the cutoff or a switch leaves out, on the average
  std::optional<double> epsilon = {}, sigma = {};  ///< of all pairs [energy], [length]; default: by types
  PairPrecision precision = PairPrecision::full;   ///<
  mutable std::shared_ptr<const detail::LennardJonesTable> table = {};  ///< made from these and the particles' types
  mutable std::shared_ptr<const detail::LennardJonesMixedTable> mixed_table = {};  ///< the same

  static constexpr auto describe() {
    return part<LennardJonesForce>(
        "lennard_jones", "Lennard-Jones pairs up to a cutoff",
        formula("U = sum_{i<j} 4 epsilon ((sigma/r_ij)^12 - (sigma/r_ij)^6), r_ij < cutoff"),
        source("LennardJones1931, Verlet1967"),
        field<&LennardJonesForce::cutoff>("cutoff", "length", "largest distance at which pairs interact")
            .required("\"1 nm\""),
        field<&LennardJonesForce::cutoff_style>("cutoff_style", "1", "how the potential ends at the cutoff"),
        field<&LennardJonesForce::switch_from>("switch_from", "length", "where a switch begins; default: 0.9 cutoff"),
        field<&LennardJonesForce::tail>(
            "tail", "1", "adds the energy and pressure that a cutoff or a switch leaves out, for g(r) = 1"),
        field<&LennardJonesForce::epsilon>("epsilon", "energy", "depth for all pairs; default: by types"),
        field<&LennardJonesForce::sigma>("sigma", "length", "length for all pairs; default: by types"),
        field<&LennardJonesForce::precision>("precision", "1", "mixed: forces of pairs in single precision"));
  }
  ForceClaims claims() const {
    return {.periodic = true,
            .pair_coefficients = true,
            .charges = false,
            .exclusions = true,
            .range = cutoff,
            .tangent = TangentPattern::full};
  }

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
      detail::add_pairs_in_turn(out, s, cutoff, terms_of(s));
      detail::add_special_pairs(out, s, terms_of(s), {.range = cutoff});
      add_tail(out, s);
    }
  }

  /// Its secants between two states, of doubles in mixed precision too. @cost O(n^2)
  template <class Real>
    requires(!std::is_same_v<Real, Pack>)
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_pair_secants(out, from, to, cutoff, 0, terms_of(to));
  }

 private:
  void check_types(const Topology* topology, const Box& box) const;
  const detail::LennardJonesTable& table_for(const std::shared_ptr<const Topology>& topology, Index n) const;
  const detail::LennardJonesMixedTable& mixed_table_for(double spacing) const;
  void add_ended(ForceSink<double>& out, const ParticleSystem<double>& s, const detail::LennardJonesTable& known) const;
  void add_lanes(ForceSink<double>& out, const ParticleSystem<double>& s) const;
  template <class Real> auto terms_of(const ParticleSystem<Real>& s) const;
  template <class Real> void add_tail(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
};

/// What a pair does, for the loops over pairs.
template <class Real> auto LennardJonesForce::terms_of(const ParticleSystem<Real>& s) const {
  return [&known = table_for(s.shared_topology(), s.size()), topology = s.topology()](Index i, Index j, const Real& r2,
                                                                                      const auto& add) {
    const int a = topology != nullptr ? topology->type(i) : 0, b = topology != nullptr ? topology->type(j) : 0;
    const auto place = static_cast<std::size_t>(a * known.types + b);
    const LennardJonesRow& row = known.rows[place];
    if (!(r2 < Real(row.range2))) return;
    if (known.ended.empty())
      add(detail::lennard_jones_terms(r2, row, known.style));
    else
      add(detail::ended<Real>(known.ended[place].pair, known.ended[place].end, r2, Real(0)));
  };
}

template <class Real> void LennardJonesForce::add_tail(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  if (!tail || !s.box().is_periodic()) return;
  const detail::LennardJonesTable& known = table_for(s.shared_topology(), s.size());
  const Real volume(s.box().volume());
  out.energy(Real(known.tail_energy) / volume);
  out.virial(Mat3<Real>::Identity() * (Real(known.tail_virial) / volume / Real(3)));
}

namespace detail {  // compiled once, in lennard_jones.cpp

extern template struct ForceModel<LennardJonesForce, double>;
extern template struct ForceModel<LennardJonesForce, Quad>;

}  // namespace detail

}  // namespace noether
