#pragma once
/// What methods on Lie groups share: fields with a group and without one, and the errors of elements.

#include "integrators/lie/lie_field.hpp"
#include "integrators/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace noether::detail {

/// A vector field as methods on groups see it: where there is no group, elements are changes of y itself.
template <class Real> class OnGroup {
 public:
  explicit OnGroup(VectorField<Real>& f) : field_(&f), group_(f.on_group()) {}

  LieField<Real>* group() const { return group_; }
  Index algebra() const { return group_ != nullptr ? group_->algebra() : field_->size(); }
  void velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) const {
    group_ != nullptr ? group_->velocity(t, y, a) : field_->rate(t, y, a);
  }
  /// out = exp(u) y, or y + u; `out` is not y.
  void act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) const {
    if (group_ != nullptr) return group_->act(u, y, out);
    for (Index i = 0; i < y.size(); ++i) out[i] = y[i] + u[i];
  }

 private:
  VectorField<Real>* field_;
  LieField<Real>* group_;
};

/// Whether a number of an element has `ParticleSystem` scales: the first six of each particle.
inline Index scaled_by_particles(const ParticleScales& scales) { return 6 * scales.particles(); }

/// Norm of an error `e` in a step of `h` from y to y1: of particles and of angles and spins the worst one counts,
/// |e_i| / (atol + rtol size_i).
/// @param sizes  work
template <class Real>
double error_on_group(const Tolerance& tolerance, VectorField<Real>& f, double h, const Vector<Real>& e,
                      const Vector<Real>& y, const Vector<Real>& y1, Vector<double>& sizes) {
  const ParticleScales& scales = f.scales(y, tolerance.rtol);
  LieField<Real>* const group = f.on_group();
  if (group == nullptr) return tolerance.norm(scales, e, y, y1);
  const double least = tolerance.absolute(scales.particles() > 0);
  double worst = scales.particles() > 0 ? tolerance.norm(scales, e, y, y1) : 0;
  group->sizes(y, y1, h, sizes);
  for (Index i = scaled_by_particles(scales); i < e.size(); ++i) {
    const double error = std::abs(static_cast<double>(e[i]));
    const double one = error > 0 ? error / (least + tolerance.rtol * sizes[i]) : error;
    if (one > worst || std::isnan(one)) worst = one;
  }
  return worst;
}

/// A first step: a part of the shortest time in which anything moves by its size, or turns by an angle of 1.
/// @cost two evaluations
template <class Real>
double first_step_on_group(VectorField<Real>& f, const Real& t, const Vector<Real>& y, int order,
                           const Tolerance& tolerance, double towards) {
  const double plain = first_step(f, t, y, order, tolerance, towards);
  LieField<Real>* const group = f.on_group();
  if (group == nullptr) return plain;
  const ParticleScales& scales = f.scales(y, tolerance.rtol);
  Vector<Real> a(group->algebra());
  Vector<double> sizes(group->algebra());
  group->velocity(t, y, a);
  group->sizes(y, y, 1, sizes);
  double fastest = 0;
  for (Index i = scaled_by_particles(scales); i < a.size(); ++i) {
    if (sizes[i] > 0) fastest = std::max(fastest, std::abs(static_cast<double>(a[i])) / sizes[i]);
  }
  const double h = std::pow(std::clamp(tolerance.rtol, 1e-30, 1.0) / 100, 1.0 / (order + 1)) / fastest;
  if (!std::isfinite(h) || !(h > 0)) return plain;
  // Of bodies that a point holds nothing but their turns tells.
  const bool blind = scales.particles() > 0 && std::abs(plain) <= 1e-6;
  return std::copysign(blind ? h : std::min(h, std::abs(plain)), towards);
}

}  // namespace noether::detail
