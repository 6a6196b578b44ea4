#pragma once
/// Newtonian gravity by direct summation.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/secant.hpp"
#include "numbers/pack.hpp"
#include "numbers/parallel.hpp"

#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>

namespace noether {

/// Newtonian attraction of all massive bodies on all particles, with Plummer softening.
///
///     U = - sum_{i<j} G m_i m_j / sqrt(|x_i - x_j|^2 + softening^2)
///
/// Tracers feel it and exert none. Below 16 particles each pair is computed once, by the same code at every SIMD level;
/// above, the owner of a particle sums its whole row, doubles in lanes, so that any number of threads gives the same
/// bits.
/// @cost O(n m) with m massive bodies; the first call of a thread allocates 40 bytes per massive body
/// @source Newton1687, Plummer1911
struct Gravity {
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own
  double softening = 0.0;        ///< [length]

  static constexpr auto describe() {
    return part<Gravity>(
        "gravity", "Newtonian gravity by direct summation, with softening and tracers",
        formula("U = - sum_{i<j} G m_i m_j / sqrt(r_ij^2 + softening^2)"), source("Newton1687, Plummer1911"),
        field<&Gravity::G>("G", "length^3/mass/time^2", "default: the unit system's own"),
        field<&Gravity::softening>("softening", "length", "Plummer softening length; 0 is a point mass"));
  }

  /// @throws Error  for a negative softening, or a G that is not above 0
  void check() const {
    check_constant_of_gravitation(G);
    if (!(softening >= 0))
      refuse_field("softening", softening, "is not a valid length; 0 (point masses) or more is expected");
  }

  /// Why it does not stand twice in a scene.
  static constexpr std::string_view only_once = "so every pair would attract twice; take one of them out";
  ForceClaims claims() const {
    return {.sets = true,
            .kepler = true,
            .G = G,
            .softening = softening,
            .charges = false,
            .exclusions = false,
            .tangent = TangentPattern::full};
  }

  template <class Real> Real constant(const ParticleSystem<Real>& s) const { return Real(G ? *G : s.units().G); }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    if constexpr (std::is_same_v<Real, Pack>) {
      if (!out.wants_energy() && !out.wants_virial()) return add_stages(out, s);
    }
    if (s.size() < smallest_in_rows) {
      add_pairs(out, s);
    } else if constexpr (std::is_same_v<Real, double>) {
      add_lanes(out, s);
    } else {
      add_rows(out, s);
    }
  }

  /// Its secants between two states. @cost O(n^2)
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const;

  static constexpr Index smallest_in_rows = 16;

 private:
  void add_lanes(ForceSink<double>& out, const ParticleSystem<double>& s) const;
  void add_stages(ForceSink<Pack>& out, const ParticleSystem<Pack>& s) const;
  template <class Real> void add_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
  template <class Real> void add_rows(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
};

template <class Real> void Gravity::add_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  using std::sqrt;
  const Index n = s.size();
  const Real g = constant(s), soft2 = Real(softening) * Real(softening);
  const Real *x = s.positions().component(0), *y = s.positions().component(1), *z = s.positions().component(2);
  const Real* m = s.masses().data();
  // G and the mass go together: G / r^3 alone would leave the range of doubles sooner.
  Real mu[smallest_in_rows];
  for (Index i = 0; i < n; ++i) mu[i] = g * m[i];
  // Distances, then all roots and quotients side by side, which take longest, then the sums.
  constexpr Index most = smallest_in_rows * (smallest_in_rows - 1) / 2;
  Real dx[most], dy[most], dz[most], r2[most], r[most], k[most];
  Index pairs = 0;
  for (Index i = 1; i < n; pairs += i++) {
    for (Index j = 0; j < i; ++j) {
      const Index p = pairs + j;
      dx[p] = x[i] - x[j];
      dy[p] = y[i] - y[j];
      dz[p] = z[i] - z[j];
      r2[p] = dx[p] * dx[p] + dy[p] * dy[p] + dz[p] * dz[p] + soft2;
    }
  }
  for (Index p = 0; p < pairs; ++p) {
    r[p] = sqrt(r2[p]);
    k[p] = Real(1) / (r2[p] * r[p]);
  }
  VectorColumn<Real>& a = out.accelerations();
  Real *ax = a.component(0), *ay = a.component(1), *az = a.component(2);
  for (Index i = 1, p = 0; i < n; ++i) {
    Real sum_x = ax[i], sum_y = ay[i], sum_z = az[i];
    for (Index j = 0; j < i; ++j, ++p) {
      if (m[i] == Real(0) && m[j] == Real(0)) continue;
      const Real kj = k[p] * mu[j], ki = k[p] * mu[i];
      sum_x -= kj * dx[p];
      sum_y -= kj * dy[p];
      sum_z -= kj * dz[p];
      ax[j] += ki * dx[p];
      ay[j] += ki * dy[p];
      az[j] += ki * dz[p];
    }
    ax[i] = sum_x;
    ay[i] = sum_y;
    az[i] = sum_z;
  }
  if (!out.wants_energy() && !out.wants_virial()) return;
  for (Index p = 0; p < pairs; ++p) r[p] = k[p] * r2[p];  // 1 / r
  WideSum<Real> energy;
  for (Index i = 1, p = 0; i < n; p += i++) {
    if (m[i] == Real(0)) continue;
    Real phi(0);  // a sum for each row: they do not wait for each other
    for (Index j = 0; j < i; ++j) phi += m[j] == Real(0) ? Real(0) : mu[j] * r[p + j];
    energy -= m[i] * phi;
  }
  out.energy(energy);
  if (!out.wants_virial()) return;
  WideTensor<Real> virial;
  for (Index i = 1, p = 0; i < n; ++i) {
    for (Index j = 0; j < i; ++j, ++p) {
      if (m[i] == Real(0) || m[j] == Real(0)) continue;
      const Vec3<Real> d(dx[p], dy[p], dz[p]);
      virial.add_outer(d, -m[i] * (k[p] * mu[j]) * d);
    }
  }
  out.virial(virial);
}

template <class Real> void Gravity::add_rows(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  using std::sqrt;
  struct Totals {
    WideSum<Real> energy;
    WideTensor<Real> virial;
    Totals& operator+=(const Totals& other) {
      energy += other.energy;
      virial += other.virial;
      return *this;
    }
  };
  const Real g = constant(s), soft2 = Real(softening) * Real(softening);
  const Real *x = s.positions().component(0), *y = s.positions().component(1), *z = s.positions().component(2);
  const Real* m = s.masses().data();
  VectorColumn<Real>& a = out.accelerations();
  const bool sums = out.wants_energy() || out.wants_virial();
  const auto rows = [&](Index begin, Index end) {
    Totals totals;
    for (Index i = begin; i < end; ++i) {
      Vec3<Real> pull = Vec3<Real>::Zero();
      for (Index j = 0; j < s.size(); ++j) {
        if (m[j] == Real(0) || j == i) continue;
        const Real dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
        const Real r2 = dx * dx + dy * dy + dz * dz + soft2;
        const Real r = sqrt(r2);
        const Real k = g * m[j] / (r2 * r);
        pull[0] -= k * dx;
        pull[1] -= k * dy;
        pull[2] -= k * dz;
        if (!sums) continue;
        totals.energy -= g * m[i] * m[j] / r / Real(2);
        const Vec3<Real> d(dx, dy, dz);
        totals.virial.add_outer(d, -m[i] * k / Real(2) * d);
      }
      a.add(i, pull);
    }
    return totals;
  };
  if (!sums) {
    for_blocks(s.size(), [&](Index begin, Index end) { rows(begin, end); });
    return;
  }
  const Totals totals = reduce(s.size(), Totals{}, rows);
  out.energy(totals.energy);
  out.virial(totals.virial);
}

template <class Real>
void Gravity::add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from,
                            const ParticleSystem<Real>& to) const {
  using std::sqrt;
  const Real g = constant(to), soft2 = Real(softening) * Real(softening);
  const auto terms = [&](const Real& r2) {  // of two unit masses
    const Real r = sqrt(r2 + soft2);
    return PairTerms<Real>{-g / r, -g / (r * (r2 + soft2))};
  };
  Secants<Real> secants(out, from, to);
  const ScalarColumn<Real>& m = to.masses();
  for (Index i = 0; i < to.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      if (m[i] == Real(0) && m[j] == Real(0)) continue;
      secants.pair({.i = i, .j = j, .of_masses = true}, terms);
    }
  }
}

extern template void Gravity::add_pairs(ForceSink<double>&, const ParticleSystem<double>&) const;

namespace detail {  // compiled once, in gravity.cpp

extern template struct ForceModel<Gravity, double>;
extern template struct ForceModel<Gravity, Quad>;

}  // namespace detail

}  // namespace noether
