#include "integrators/sheared_box.hpp"

#include "numbers/parallel.hpp"

#include <utility>

namespace noether {

template <class Real> void ShearedBox<Real>::begin(const ParticleSystem<Real>& s, const SheetRates& rates) {
  rates_ = rates;
  pulls_ = false;
  a_ = VectorColumn<Real>(s.size());
}

template <class Real> void ShearedBox<Real>::take(const ParticleSystem<Real>& s, const ForceClaims& force) {
  if (!force.kepler || pulls_) {
    throw Error(
        "in the box of a shearing sheet images slide, which gravity alone knows of the forces; take the others out, or "
        "the box");
  }
  pulls_ = true;
  gravity_.G = Real(force.G.value_or(s.units().G));
  gravity_.softening = Real(force.softening);
}

template <class Real> ShearedCell<Real> ShearedBox<Real>::cell(const ParticleSystem<Real>& s, const Real& time) const {
  const Vec3<double>& edges = s.box().edges();
  return {Real(edges[0]), Real(edges[1]), Real(edges[2]), slope(time)};
}

template <class Real> void ShearedBox<Real>::open(ParticleSystem<Real>& s) const {
  const Real slope = this->slope(s.time()), drift = Real(1.5) * Real(rates_.Omega);
  for (Index i = 0; i < s.size(); ++i) {
    const Real x = std::as_const(s).positions()[i][0], never_wrapped = s.unwrapped(i)[0];
    s.shift(i, Vec3<Real>(Real(0), slope * x, Real(0)), Vec3<Real>(Real(0), drift * never_wrapped, Real(0)));
  }
  s.moved();
  s.phase().coordinates = unsheared;
}

template <class Real> void ShearedBox<Real>::close(ParticleSystem<Real>& s) const {
  const Real slope = this->slope(s.time()), drift = Real(1.5) * Real(rates_.Omega);
  for (Index i = 0; i < s.size(); ++i) {
    const Real x = std::as_const(s).positions()[i][0], never_wrapped = s.unwrapped(i)[0];
    s.shift(i, Vec3<Real>(Real(0), -slope * x, Real(0)), Vec3<Real>(Real(0), -drift * never_wrapped, Real(0)));
  }
  s.moved();
  s.phase().coordinates = 0;
}

template <class Real>
void ShearedBox<Real>::move(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle, const Real& end) const {
  const Real slope = this->slope(end);
  for_blocks(s.size(), [&](Index begin, Index end_of_block) {
    for (Index i = begin; i < end_of_block; ++i) {
      // The middle of the box in z is its corner.
      auto change = epicycle.change_in_shear(s.unwrapped(i)[2], std::as_const(s).velocities()[i]);
      if constexpr (std::is_same_v<Real, double>) change.x[0] = s.box().on_grid(0, change.x[0]);
      change.x[1] += slope * change.x[0];
      s.shift(i, change.x, change.v);
    }
  });
  s.moved();
}

template <class Real> void ShearedBox<Real>::kick(ParticleSystem<Real>& s, const Real& h) {
  if (!pulls_) return;
  gravity_.sum(cell(s, s.time()), std::as_const(s).positions(), s.masses(), a_, false);
  s.advance_velocities(h, a_);
}

template <class Real> Real ShearedBox<Real>::settled_sum(const ParticleSystem<Real>& s, bool energy) {
  if (!pulls_) {
    a_.set_zero();
    return Real(0);
  }
  ParticleSystem<Real> there = s;
  open(there);
  return gravity_.sum(cell(there, there.time()), std::as_const(there).positions(), there.masses(), a_, energy);
}

template <class Real> void ShearedBox<Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  settled_sum(s, false);
  a = a_;
}

template class ShearedBox<double>;
template class ShearedBox<Quad>;

}  // namespace noether
