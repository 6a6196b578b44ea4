#pragma once
/// The loop over bonded terms: what each does to its particles.

#include "engine/particle_system.hpp"
#include "forces/angle_potentials.hpp"
#include "forces/bond_potentials.hpp"
#include "forces/bonded_terms.hpp"
#include "forces/dihedral_potentials.hpp"
#include "numbers/pack.hpp"
#include "numbers/wide_sum.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <type_traits>

namespace noether::detail {

/// What one evaluation sums beside the forces.
template <class Real> struct BondedTotals {
  WideSum<Real> energy;
  WideTensor<Real> virial;

  BondedTotals& operator+=(const BondedTotals& other) {
    energy += other.energy;
    virial += other.virial;
    return *this;
  }
};

/// Calls `body(potential)` with the potential of a kind.
template <class Real, class Body> auto with_potential(const BondedKind<BondPotential>& kind, const Body& body) {
  if (kind.potential == BondPotential::harmonic) return body(bond_potential::Harmonic<Real>(kind.parameters));
  if (kind.potential == BondPotential::morse) return body(bond_potential::Morse<Real>(kind.parameters));
  return body(bond_potential::Fene<Real>(kind.parameters));
}
template <class Real, class Body> auto with_potential(const BondedKind<AnglePotential>& kind, const Body& body) {
  if (kind.potential == AnglePotential::harmonic) return body(angle_potential::Harmonic<Real>(kind.parameters));
  if (kind.potential == AnglePotential::cosine) return body(angle_potential::Cosine<Real>(kind.parameters));
  if (kind.potential == AnglePotential::urey_bradley) return body(angle_potential::UreyBradley<Real>(kind.parameters));
  return body(angle_potential::CosineSquared<Real>(kind.parameters));
}
template <class Real, class Body> auto with_potential(const BondedKind<DihedralPotential>& kind, const Body& body) {
  using namespace dihedral_potential;
  if (kind.potential == DihedralPotential::periodic) return body(Periodic<Real>(kind.parameters));
  if (kind.potential == DihedralPotential::ryckaert_bellemans) return body(RyckaertBellemans<Real>(kind.parameters));
  if (kind.potential == DihedralPotential::one_four) return body(OneFour<Real>(kind.parameters));
  return body(HarmonicImproper<Real>(kind.parameters));
}

/// The forces on the particles of a term, and its energy where it is wanted.
template <class Real, std::size_t n> struct BondedResult {
  std::array<Vec3<Real>, n> force;
  Real energy = Real(0);
  bool overstretched = false;
};

/// Forces on the first particles of up to `block_size` bonds of doubles, in lanes and with the bits that they have one
/// by one.
/// @param in_step  as `BondedTerms` has it  @param edges  of the box, 0 in open space  @param force  where they go
/// @return  whether all of them hold; the forces of those that do not mean nothing
bool bond_forces(const BondedKind<BondPotential>& kind, const BondedTerm<2>* bonds, const std::uint8_t* in_step,
                 Index count, const Vec3<double>& edges, const std::array<const double*, 3>& positions,
                 const std::array<double*, 3>& force);

/// Adds to the accelerations of the particles of a block what stands in their slots, in the order of these.
template <class Real>
inline void add_slots(const BondedTerms::Places& places, const std::array<const Real*, 3>& slots, const Real* mass,
                      Index begin, Index end, const std::array<Real*, 3>& acceleration) {
  constexpr double signs[2] = {1, -1};
  Real force[3][block_size], inverse[block_size];
  for (Index i = begin; i < end;) {
    const Index count = std::min<Index>(places.in_step[i], end - i);
    if (count == 1) {  // by itself, without loops over lanes
      Real x(0), y(0), z(0);
      for (std::uint32_t k = places.first[i]; k < places.first[i + 1]; ++k) {
        const std::uint32_t at = places.slot[k] / 2;
        const Real sign(signs[places.slot[k] % 2]);
        x += sign * slots[0][at];
        y += sign * slots[1][at];
        z += sign * slots[2][at];
      }
      force[0][i - begin] = x;
      force[1][i - begin] = y;
      force[2][i - begin] = z;
    } else {
      for (auto& column : force) std::fill_n(column + (i - begin), count, Real(0));
      for (std::uint32_t k = places.first[i]; k < places.first[i + 1]; ++k) {
        const Real sign(signs[places.slot[k] % 2]);
        for (std::size_t c = 0; c < 3; ++c) {
          const Real* const from = slots[c] + places.slot[k] / 2;
          Real* const to = force[c] + (i - begin);
          for (Index j = 0; j < count; ++j) to[j] += sign * from[j];
        }
      }
    }
    i += count;
  }
  for (Index i = begin; i < end; ++i) inverse[i - begin] = Real(1) / mass[i];
  for (std::size_t c = 0; c < 3; ++c) {
    Real* const a = acceleration[c];
    for (Index i = begin; i < end; ++i) {
      a[i] = mass[i] == Real(0) ? a[i] : Real(a[i] + inverse[i - begin] * force[c][i - begin]);
    }
  }
}

/// A bond along d = x_1 - x_2.
template <class Real, class Potential>
BondedResult<Real, 2> bonded_forces(const Potential& potential, const std::array<Vec3<Real>, 1>& d, bool with_energy) {
  BondedResult<Real, 2> result;
  const Real r2 = norm2(d[0]);
  if constexpr (requires { potential.holds(r2); }) result.overstretched = !potential.holds(r2);
  const Real none(std::numeric_limits<double>::quiet_NaN());
  result.force[0] = (result.overstretched ? none : potential.force_over_r(r2)) * d[0];
  result.force[1] = -result.force[0];
  if (with_energy) result.energy = result.overstretched ? none : potential.energy(r2);
  return result;
}

/// An angle between the arms d = {x_1 - x_2, x_3 - x_2}.
template <class Real, class Potential>
BondedResult<Real, 3> bonded_forces(const Potential& potential, const std::array<Vec3<Real>, 2>& d, bool with_energy) {
  const angle_potential::Bend<Real> bend(d[0], d[1]);
  BondedResult<Real, 3> result;
  const Real slope = potential.slope(bend) / bend.lengths;
  result.force[0] = (slope / bend.a2) * cross(bend.a, bend.normal);
  result.force[2] = (slope / bend.b2) * cross(bend.normal, bend.b);
  result.force[1] = -(result.force[0] + result.force[2]);
  if (with_energy) result.energy = potential.energy(bend);
  if constexpr (requires { potential.ends; }) {
    const Vec3<Real> between = d[0] - d[1];
    const Real r2 = norm2(between);
    const Vec3<Real> pull = potential.ends.force_over_r(r2) * between;
    result.force[0] += pull;
    result.force[2] -= pull;
    if (with_energy) result.energy += potential.ends.energy(r2);
  }
  return result;
}

/// A dihedral or improper with d = {x_1 - x_2, x_2 - x_3, x_4 - x_3}. @source BlondelKarplus1996
template <class Real, class Potential>
BondedResult<Real, 4> bonded_forces(const Potential& potential, const std::array<Vec3<Real>, 3>& d, bool with_energy) {
  BondedResult<Real, 4> result;
  if constexpr (requires { potential.force_over_r(Real(1)); }) {  // between the ends alone
    const Vec3<Real> between = d[0] + d[1] - d[2];
    const Real r2 = norm2(between);
    result.force.fill(Vec3<Real>::Zero());
    result.force[0] = potential.force_over_r(r2) * between;
    result.force[3] = -result.force[0];
    if (with_energy) result.energy = potential.energy(r2);
    return result;
  } else {
    const dihedral_potential::Twist<Real> twist(d[0], d[1], d[2]);
    if (!twist.is_defined()) {
      result.force.fill(Vec3<Real>::Zero());
      return result;
    }
    const Real slope = potential.slope(twist);
    const Vec3<Real> one = (slope / twist.A2) * twist.A, other = (slope / twist.B2) * twist.B;
    const Vec3<Real> axis = (dot(twist.f, twist.g) * one - dot(twist.h, twist.g) * other) / twist.length;
    result.force[0] = twist.length * one;
    result.force[3] = -twist.length * other;
    result.force[1] = -(result.force[0] + axis);
    result.force[2] = axis - result.force[3];
    if (with_energy) result.energy = potential.energy(twist);
    return result;
  }
}

/// The same in eight lanes, each with the bits of double.
template <class Potential, std::size_t m>
BondedResult<Pack, m + 1> bonded_forces_in_lanes(const Potential& potential, const std::array<Vec3<Pack>, m>& d,
                                                 bool with_energy) {
  BondedResult<Pack, m + 1> result;
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    std::array<Vec3<double>, m> one;
    for (std::size_t k = 0; k < m; ++k) {
      for (int c = 0; c < 3; ++c) one[k][c] = d[k][c].lane[lane];
    }
    const BondedResult<double, m + 1> in_lane = bonded_forces<double>(potential, one, with_energy);
    for (std::size_t k = 0; k <= m; ++k) {
      for (int c = 0; c < 3; ++c) result.force[k][c].lane[lane] = in_lane.force[k][c];
    }
    result.energy.lane[lane] = in_lane.energy;
    result.overstretched = result.overstretched || in_lane.overstretched;
  }
  return result;
}

/// Evaluates terms one after the other and puts their forces into slots.
template <class Real> class BondedLoop {
 public:
  BondedLoop(const BondedTerms& terms, const ParticleSystem<Real>& s, VectorColumn<Real>& slots, bool energy,
             bool virial)
      : terms_(terms), s_(s), slots_(slots), energy_(energy), virial_(virial) {}

  /// Terms [begin, end) of all families in a row.
  BondedTotals<Real> operator()(Index begin, Index end) {
    BondedTotals<Real> totals;
    const Topology& t = terms_.topology();
    Index first = 0;
    Index slot = 0;
    const auto family = [&](const auto& terms, const auto& kinds) {
      const auto size = static_cast<Index>(terms.size());
      const Index to = std::min(end, first + size);
      Index k = std::max(begin, first);
      while (k < to) {
        // Terms of one kind stand side by side more often than not, and ask for their potential once.
        const auto type = terms[static_cast<std::size_t>(k - first)].type;
        Index next = k + 1;
        while (next < to && terms[static_cast<std::size_t>(next - first)].type == type) ++next;
        const auto* const run = &terms[static_cast<std::size_t>(k - first)];
        evaluate_run(run, next - k, kinds[static_cast<std::size_t>(type)], k,
                     slot + (k - first) * BondedTerms::slots_of(*run), totals);
        k = next;
      }
      first += size;
      slot += size * BondedTerms::slots_of(std::decay_t<decltype(terms[0])>{});
    };
    family(t.bonds, terms_.bonds);
    family(t.angles, terms_.angles);
    family(t.dihedrals, terms_.dihedrals);
    family(t.impropers, terms_.impropers);
    return totals;
  }

  /// The first bond that is too long; none: -1.
  Index overstretched() const {
    const Index bond = overstretched_.load();
    return bond == none ? -1 : bond;
  }

 private:
  static constexpr Index none = std::numeric_limits<Index>::max();
  using InLane = std::conditional_t<std::is_same_v<Real, Pack>, double, Real>;

  Vec3<Real> between(Index i, Index j) const {
    return s_.box().minimum_image(Vec3<Real>(s_.positions()[i] - s_.positions()[j]));
  }
  std::array<Vec3<Real>, 1> differences(const std::array<Index, 2>& p) const { return {between(p[0], p[1])}; }
  std::array<Vec3<Real>, 2> differences(const std::array<Index, 3>& p) const {
    return {between(p[0], p[1]), between(p[2], p[1])};
  }
  std::array<Vec3<Real>, 3> differences(const std::array<Index, 4>& p) const {
    return {between(p[0], p[1]), between(p[1], p[2]), between(p[3], p[2])};
  }

  /// `count` terms of one kind, the first of which is term `k` and has its forces from `slot` on.
  template <std::size_t n, class Kind>
  void evaluate_run(const BondedTerm<n>* terms, Index count, const Kind& kind, Index k, Index slot,
                    BondedTotals<Real>& totals) {
    with_potential<InLane>(kind, [&](const auto& potential) {
      for (Index i = 0; i < count; ++i) {
        evaluate(terms[i], potential, k + i, slot + i * BondedTerms::slots_of(terms[i]), totals);
      }
    });
  }

  /// Of bonds of doubles the forces alone, many at a time.
  void evaluate_run(const BondedTerm<2>* bonds, Index count, const BondedKind<BondPotential>& kind, Index k, Index slot,
                    BondedTotals<Real>& totals) requires std::is_same_v<Real, double> {
    const auto one_by_one = [&](Index begin, Index size) {
      evaluate_run<2, BondedKind<BondPotential>>(bonds + begin, size, kind, k + begin, slot + begin, totals);
    };
    if (energy_ || virial_) return one_by_one(0, count);
    for (Index begin = 0; begin < count; begin += block_size) {
      const Index size = std::min(block_size, count - begin);
      std::array<const double*, 3> positions;
      std::array<double*, 3> force;
      for (int c = 0; c < 3; ++c) {
        positions[static_cast<std::size_t>(c)] = s_.positions().component(c);
        force[static_cast<std::size_t>(c)] = slots_.component(c) + slot + begin;
      }
      const bool hold =
          bond_forces(kind, bonds + begin, terms_.in_step(k + begin), size, s_.box().edges(), positions, force);
      if (!hold) one_by_one(begin, size);
    }
  }

  template <std::size_t n, class Potential>
  void evaluate(const BondedTerm<n>& term, const Potential& potential, Index k, Index slot,
                BondedTotals<Real>& totals) {
    const auto d = differences(term.particles);
    const BondedResult<Real, n> result = [&] {
      if constexpr (std::is_same_v<Real, Pack>) {
        return bonded_forces_in_lanes(potential, d, energy_);
      } else {
        return bonded_forces<Real>(potential, d, energy_);
      }
    }();
    for (Index i = 0; i < BondedTerms::slots_of(term); ++i) {
      slots_.set(slot + i, result.force[static_cast<std::size_t>(i)]);
    }
    if (result.overstretched) {
      Index known = overstretched_.load();
      while (k < known && !overstretched_.compare_exchange_weak(known, k)) {
      }
    }
    if (energy_) totals.energy += result.energy;
    if (virial_) add_virial(d, result.force, totals);
  }
  /// By the places of the particles about the second one.
  static void add_virial(const std::array<Vec3<Real>, 1>& d, const std::array<Vec3<Real>, 2>& f,
                         BondedTotals<Real>& totals) {
    totals.virial.add_outer(d[0], f[0]);
  }
  static void add_virial(const std::array<Vec3<Real>, 2>& d, const std::array<Vec3<Real>, 3>& f,
                         BondedTotals<Real>& totals) {
    totals.virial.add_outer(d[0], f[0]);
    totals.virial.add_outer(d[1], f[2]);
  }
  static void add_virial(const std::array<Vec3<Real>, 3>& d, const std::array<Vec3<Real>, 4>& f,
                         BondedTotals<Real>& totals) {
    totals.virial.add_outer(d[0], f[0]);
    totals.virial.add_outer(-d[1], f[2]);
    totals.virial.add_outer(d[2] - d[1], f[3]);
  }

  const BondedTerms& terms_;
  const ParticleSystem<Real>& s_;
  VectorColumn<Real>& slots_;
  bool energy_, virial_;
  std::atomic<Index> overstretched_ = none;
};

}  // namespace noether::detail
