#pragma once
/// The coordinates of integrators/wisdom_holman.hpp; included by it.

#include "integrators/wisdom_holman.hpp"

namespace noether {

template <class Real, class F> void WisdomHolman<Real, F>::open(ParticleSystem<Real>& s) {
  if (jacobi()) {
    to_jacobi(s.positions());
    to_jacobi(s.velocities());
  } else if (barycentric()) {
    to_barycentric(s);
  } else {
    to_democratic(s);
  }
  if (scaled()) scale(s.velocities(), false);
  if constexpr (may_have_lanes) {
    if (!observing_) lanes_.forget();
  }
  s.phase().coordinates = static_cast<std::uint8_t>(options_.coordinates);
}

template <class Real, class F> void WisdomHolman<Real, F>::close(ParticleSystem<Real>& s) {
  if (scaled()) scale(s.velocities(), true);
  if (jacobi()) {
    from_jacobi(s.positions(), s.positions(), std::as_const(s).positions()[0]);
    from_jacobi(s.velocities(), s.velocities(), std::as_const(s).velocities()[0]);
  } else if (barycentric()) {
    from_barycentric(s);
  } else {
    from_democratic(s);
  }
  s.phase().coordinates = 0;
}

/// x'_k = x_k - X_{k-1},  X_k = X_{k-1} + (m_k/M_k) x'_k, of a tracer x - X of the bodies within its orbit; row 0
/// becomes X of all.
template <class Real, class F> void WisdomHolman<Real, F>::to_jacobi(VectorColumn<Real>& column) const {
  const auto& read = std::as_const(column);
  Vec3<Real> center = read[0];
  centers_[0] = center;
  for (std::size_t k = 1; k < massive(); ++k) {
    const Vec3<Real> relative = read[at(k)] - center;
    column.set(at(k), relative);
    centers_[k] = center += masses_[static_cast<std::size_t>(at(k))] / interior_[k] * relative;
  }
  for (std::size_t k = massive(); k < order_.size(); ++k) column.set(at(k), read[at(k)] - centers_[within(at(k))]);
  column.set(0, center);
}

/// The inverse, from the outermost body inwards; `from` and `to` may be the same column.
template <class Real, class F>
void WisdomHolman<Real, F>::from_jacobi(const VectorColumn<Real>& from, VectorColumn<Real>& to,
                                        const Vec3<Real>& center_of_all) const {
  Vec3<Real> center = center_of_all;
  for (std::size_t k = massive() - 1; k > 0; --k) {
    const Vec3<Real> relative = from[at(k)];
    centers_[k] = center;
    center -= masses_[static_cast<std::size_t>(at(k))] / interior_[k] * relative;
    to.set(at(k), center + relative);
  }
  centers_[0] = center;
  for (std::size_t k = massive(); k < order_.size(); ++k) to.set(at(k), centers_[within(at(k))] + from[at(k)]);
  to.set(0, center);
}

/// Of the massive bodies, by mass.
template <class Real, class F> Vec3<Real> WisdomHolman<Real, F>::mean_of(const VectorColumn<Real>& column) const {
  Vec3<Real> sum = Vec3<Real>::Zero();
  for (std::size_t k = 0; k < massive(); ++k) sum += masses_[k] * column[static_cast<Index>(k)];
  return sum / interior_.back();
}

template <class Real, class F> void WisdomHolman<Real, F>::to_democratic(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  const Vec3<Real> x = mean_of(c.positions()), v = mean_of(c.velocities());
  const Vec3<Real> primary = c.positions()[0];
  for (Index i = 1; i < s.size(); ++i) {
    s.positions().set(i, c.positions()[i] - primary);
    s.velocities().set(i, c.velocities()[i] - v);
  }
  s.positions().set(0, x);
  s.velocities().set(0, v);
}

template <class Real, class F> void WisdomHolman<Real, F>::from_democratic(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  Vec3<Real> x = Vec3<Real>::Zero(), v = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) {
    x += masses_[k] * c.positions()[static_cast<Index>(k)];
    v += masses_[k] * c.velocities()[static_cast<Index>(k)];
  }
  const Vec3<Real> center_v = c.velocities()[0];
  const Vec3<Real> primary_x = c.positions()[0] - x / interior_.back();
  for (Index i = 1; i < s.size(); ++i) {
    s.positions().set(i, primary_x + c.positions()[i]);
    s.velocities().set(i, center_v + c.velocities()[i]);
  }
  s.positions().set(0, primary_x);
  s.velocities().set(0, center_v - v / masses_[0]);
}

/// R_i = x_i - X and v_i - v_0, which are scaled afterwards.
template <class Real, class F> void WisdomHolman<Real, F>::to_barycentric(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  const Vec3<Real> x = mean_of(c.positions()), v = mean_of(c.velocities());
  const Vec3<Real> of_primary = c.velocities()[0];
  for (Index i = 1; i < s.size(); ++i) {
    s.positions().set(i, c.positions()[i] - x);
    s.velocities().set(i, c.velocities()[i] - of_primary);
  }
  s.positions().set(0, x);
  s.velocities().set(0, v);
}

template <class Real, class F> void WisdomHolman<Real, F>::from_barycentric(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  Vec3<Real> v = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) v += masses_[k] * c.velocities()[static_cast<Index>(k)];
  const Vec3<Real> of_primary = c.velocities()[0] - v / interior_.back();
  inertial_positions(c.positions(), c.positions()[0], s.positions());
  for (Index i = 1; i < s.size(); ++i) s.velocities().set(i, of_primary + c.velocities()[i]);
  s.velocities().set(0, of_primary);
}

/// Velocities, or accelerations, times `scale_`, or back.
template <class Real, class F> void WisdomHolman<Real, F>::scale(VectorColumn<Real>& column, bool back) const {
  for (std::size_t k = 1; k < massive(); ++k) {
    const auto i = static_cast<Index>(k);
    const Vec3<Real> v = std::as_const(column)[i];
    column.set(i, back ? Vec3<Real>(v / scale_[k]) : Vec3<Real>(scale_[k] * v));
  }
}

/// Inertial positions of all, for a centre of mass at `center`; `to` may be the positions themselves.
template <class Real, class F>
void WisdomHolman<Real, F>::inertial_positions(const VectorColumn<Real>& from, const Vec3<Real>& center,
                                               VectorColumn<Real>& to) const {
  if (jacobi()) {
    from_jacobi(from, to, center);
    return;
  }
  Vec3<Real> x = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) x += masses_[k] * from[static_cast<Index>(k)];
  const Vec3<Real> primary = center - x / (barycentric() ? masses_[0] : interior_.back());
  const Vec3<Real> origin = barycentric() ? center : primary;
  for (Index i = 1; i < from.size(); ++i) to.set(i, origin + from[i]);
  to.set(0, primary);
}

}  // namespace noether
