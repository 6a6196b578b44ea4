#pragma once
/// A shearing sheet in a box: particles whose images in x slide along y.

#include "engine/force_sink.hpp"
#include "engine/particle_system.hpp"
#include "forces/sheared_gravity.hpp"
#include "integrators/epicycle.hpp"

#include <cstdint>
#include <optional>

namespace noether {

/// `Phase::coordinates` of particles in places and velocities that do not shear.
inline constexpr std::uint8_t unsheared = 10;

/// A box that repeats in x and y under the shear of a sheet: the image beyond an edge in x moves along y with 3/2 Omega
/// times the width, and has slid by that times t.
///
/// While a run goes on, places are (x, y + 3 Omega x t/2, z) and velocities (x', w, z'), w = y' + 3 Omega x/2: in these
/// the box repeats without sliding, a particle that crosses an edge changes nothing but the whole numbers that count
/// crossings, and no flow knows where the box is cut. Users see places in the box at that time, and velocities of the
/// path as if never wrapped. z repeats as well, for particles far from the middle.
/// @cost 9 n m square roots a kick
template <class Real> class ShearedBox {
 public:
  /// Takes what the forces in the box are: gravity, or none. @throws Error  for others
  template <class F> void bind(const ParticleSystem<Real>& s, const SheetRates& rates, const F& forces) {
    begin(s, rates);
    if constexpr (requires { forces.terms(); }) {
      for (const auto& force : forces.terms()) take(s, force.claims());
    } else if constexpr (requires { forces.for_each([](const auto&) {}); }) {
      forces.for_each([&](const auto& force) { take(s, claims_of(force)); });
    } else {
      take(s, claims_of(forces));
    }
  }
  bool pulls() const { return pulls_; }

  /// Into these coordinates and back, at the time of the clock.
  void open(ParticleSystem<Real>& s) const;
  void close(ParticleSystem<Real>& s) const;
  /// An epicycle that ends at time `end`.
  void move(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle, const Real& end) const;
  /// v -> v + h F/m; known forces are used again.
  void kick(ParticleSystem<Real>& s, const Real& h);
  /// Of a settled state.
  Real potential(const ParticleSystem<Real>& s) { return settled_sum(s, true); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a);

 private:
  void begin(const ParticleSystem<Real>& s, const SheetRates& rates);
  void take(const ParticleSystem<Real>& s, const ForceClaims& force);
  Real slope(const Real& time) const { return Real(1.5) * Real(rates_.Omega) * time; }
  ShearedCell<Real> cell(const ParticleSystem<Real>& s, const Real& time) const;
  Real settled_sum(const ParticleSystem<Real>& s, bool energy);

  SheetRates rates_;
  bool pulls_ = false;
  ShearedGravity<Real> gravity_;
  VectorColumn<Real> a_;
};

extern template class ShearedBox<double>;
extern template class ShearedBox<Quad>;

}  // namespace noether
