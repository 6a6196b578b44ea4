#pragma once
/// Coulomb's law between all pairs of charges in open space.

#include "engine/any_force.hpp"
#include "engine/charge.hpp"
#include "engine/description.hpp"
#include "forces/secant.hpp"
#include "numbers/parallel.hpp"

#include <string_view>
#include <vector>

namespace noether {

namespace detail {

/// Why forces between charges do not stand beside each other in a scene.
inline constexpr std::string_view charges_once = "so every pair of charges would act twice; take one of them out";

/// A block of charges that feel others: where they are, and sums over the others, shape (count).
template <class Real> struct ChargedRows {
  const Real *x, *y, *z;
  Real* field[3];   ///< sum q_j d / r^3
  Real* potential;  ///< sum q_j / r
  Real* virial[6];  ///< sum q_j d (x) d / r^3: xx, yy, zz, xy, xz, yz
};

/// What the charges [from, to) do to the rows [begin, end), which are none of them.
template <class Real, bool sums>
inline void add_fields_of(const ChargedRows<Real>& rows, Index begin, Index end, const Real* const* positions,
                          const Real* charges, Index from, Index to) {
  using std::sqrt;
  const ChargedRows<Real> own = rows;
  for (Index j = from; j < to; ++j) {
    const Real xj = positions[0][j], yj = positions[1][j], zj = positions[2][j], q = charges[j];
    if (q == Real(0)) continue;
#if !defined(__clang__)
#pragma GCC ivdep
#endif
    for (Index i = begin; i < end; ++i) {
      const Real dx = own.x[i] - xj, dy = own.y[i] - yj, dz = own.z[i] - zj;
      const Real r2 = dx * dx + dy * dy + dz * dz;
      const Real potential = q / sqrt(r2), k = potential / r2;
      own.field[0][i] += k * dx;
      own.field[1][i] += k * dy;
      own.field[2][i] += k * dz;
      if constexpr (sums) {
        own.potential[i] += potential;
        own.virial[0][i] += k * dx * dx;
        own.virial[1][i] += k * dy * dy;
        own.virial[2][i] += k * dz * dz;
        own.virial[3][i] += k * dx * dy;
        own.virial[4][i] += k * dx * dz;
        own.virial[5][i] += k * dy * dz;
      }
    }
  }
}

template <class Real>
using AddFields = void (*)(const ChargedRows<Real>&, Index, Index, const Real* const*, const Real*, Index, Index);
/// The loop for this number type, of doubles in lanes.
template <class Real> AddFields<Real> fields_loop(bool sums) {
  return sums ? &add_fields_of<Real, true> : &add_fields_of<Real, false>;
}
template <> AddFields<double> fields_loop(bool sums);

/// A charge that is not to act on one of the rows: the row itself, or one that the topology excludes or scales.
struct ChargeLeftOut {
  Index charge, row;
  auto operator<=>(const ChargeLeftOut&) const = default;
};
/// Those of the rows [begin, end), sorted. Kept until this thread asks again.
const std::vector<ChargeLeftOut>& charges_left_out(const Topology* topology, Index begin, Index end);

}  // namespace detail

/// Coulomb's law between all pairs of charges, in open space.
///
///     U = sum_{i<j} f_ij C q_i q_j / |x_i - x_j|
///
/// C is the factor of Coulomb's law in the units of the particles, f_ij what the topology leaves of a pair: 0 of an
/// excluded one. The owner of a particle sums its whole row, doubles in lanes, so that any number of threads gives the
/// same bits. A tracer exerts its force, and moves freely.
/// @cost O(n^2)
/// @source Coulomb1785
struct Coulomb {
  static constexpr auto describe() {
    return part<Coulomb>("coulomb", "Coulomb's law between all pairs of charges, in open space",
                         formula("U = sum_{i<j} f_ij C q_i q_j / r_ij; f_ij: 1, less for scaled and excluded pairs"),
                         source("Coulomb1785"));
  }
  static constexpr std::string_view only_once = detail::charges_once;
  ForceClaims claims() const { return {.charges = true, .exclusions = true, .tangent = TangentPattern::full}; }

  /// @throws Error  for particles without charges
  template <class Real> void check(const ParticleSystem<Real>& s) const { check_there(s.template has<Charge>()); }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
  /// Its secants between two states. @cost O(n^2)
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const;

 private:
  static void check_there(bool charges);
  template <class Real> static void add_scaled_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s);
};

namespace detail {

/// Energy and virial of Coulomb's law.
template <class Real> struct CoulombTotals {
  WideSum<Real> energy;
  WideTensor<Real> virial;
  CoulombTotals& operator+=(const CoulombTotals& other) {
    energy += other.energy;
    virial += other.virial;
    return *this;
  }
};

/// A block of particles, and all that acts on them.
template <class Real>
CoulombTotals<Real> add_coulomb_block(ForceSink<Real>& out, const ParticleSystem<Real>& s, Index begin, Index end) {
  alignas(64) Real sums[10][block_size];
  for (auto& one : sums) std::fill(one, one + block_size, Real(0));
  const VectorColumn<Real>& x = s.positions();
  const Real* const positions[3] = {x.component(0), x.component(1), x.component(2)};
  const Real* const q = s.template column<Charge>().data();
  ChargedRows<Real> rows{positions[0] + begin, positions[1] + begin, positions[2] + begin, {}, sums[3], {}};
  for (int k = 0; k < 3; ++k) rows.field[k] = sums[k];
  for (int k = 0; k < 6; ++k) rows.virial[k] = sums[4 + k];
  const bool all = out.wants_energy() || out.wants_virial();
  const AddFields<Real> add = fields_loop<Real>(all);
  const Index count = end - begin;
  const std::vector<ChargeLeftOut>& left_out = charges_left_out(s.topology(), begin, end);
  Index next = 0;
  for (std::size_t k = 0; k < left_out.size();) {
    const Index j = left_out[k].charge;
    add(rows, 0, count, positions, q, next, j);
    Index row = 0;
    for (; k < left_out.size() && left_out[k].charge == j; ++k) {
      add(rows, row, left_out[k].row - begin, positions, q, j, j + 1);
      row = left_out[k].row - begin + 1;
    }
    add(rows, row, count, positions, q, j, j + 1);
    next = j + 1;
  }
  add(rows, 0, count, positions, q, next, s.size());
  CoulombTotals<Real> totals;
  for (Index i = begin; i < end; ++i) {
    if (q[i] == Real(0)) continue;
    const Real by = Real(s.units().coulomb_constant) * q[i];
    const auto sum = [&](int which) { return by * sums[which][i - begin]; };
    const Vec3<Real> f(sum(0), sum(1), sum(2));
    if (s.masses()[i] != Real(0)) out.accelerations().add(i, f / s.masses()[i]);
    if (!all) continue;
    totals.energy += sum(3) / Real(2);
    Mat3<Real> w;
    w << sum(4), sum(7), sum(8), sum(7), sum(5), sum(9), sum(8), sum(9), sum(6);
    totals.virial += w / Real(2);
  }
  return totals;
}

}  // namespace detail

template <class Real> void Coulomb::add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  const auto block = [&](Index begin, Index end) { return detail::add_coulomb_block(out, s, begin, end); };
  if (out.wants_energy() || out.wants_virial()) {
    const detail::CoulombTotals<Real> totals = reduce(s.size(), detail::CoulombTotals<Real>{}, block);
    out.energy(totals.energy);
    out.virial(totals.virial);
  } else {
    for_blocks(s.size(), block);
  }
  add_scaled_pairs(out, s);
}

template <class Real> void Coulomb::add_scaled_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s) {
  using std::sqrt;
  if (s.topology() == nullptr) return;
  const auto& q = s.template column<Charge>();
  for (const Topology::ScaledPair& scaled : s.topology()->scaled_pairs) {
    const auto [i, j] = scaled.pair;
    const Vec3<Real> d = s.positions()[i] - s.positions()[j];
    const Real r2 = norm2(d), energy = Real(scaled.factor * s.units().coulomb_constant) * q[i] * q[j] / sqrt(r2);
    out.pair(i, j, energy / r2 * d);
    out.energy(energy);
  }
}

template <class Real>
void Coulomb::add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from,
                            const ParticleSystem<Real>& to) const {
  using std::sqrt;
  Secants<Real> secants(out, from, to);
  const auto& q = to.template column<Charge>();
  for (Index i = 0; i < to.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const double part = to.topology() != nullptr ? to.topology()->pair_factor(i, j) : 1;
      const Real product = Real(part * to.units().coulomb_constant) * q[i] * q[j];
      if (product == Real(0)) continue;
      secants.pair({.i = i, .j = j}, [&](const Real& r2) {
        const Real energy = product / sqrt(r2);
        return PairTerms<Real>{energy, energy / r2};
      });
    }
  }
}

namespace detail {  // compiled once, in coulomb.cpp

extern template struct ForceModel<Coulomb, double>;
extern template struct ForceModel<Coulomb, Quad>;

}  // namespace detail

}  // namespace noether
