#include "integrators/methods/mean_force_step.hpp"

#include "engine/sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// The equations of u in a part of a step from y.
template <class Real> class MeanForceEquations final : public StepEquations<Real> {
 public:
  MeanForceEquations(MeanForce<Real>& force, const Vector<Real>& y, double h, Vector<Real>& end)
      : force_(force), y_(y), h_(h), end_(end) {}

  void map(const Real& part, const Vector<Real>& u, Vector<Real>& out) override {
    place(part, u);
    force_.between(y_, end_, out);
    const Real half = part * Real(h_) / Real(2);
    for (Index i = 0; i < u.size(); ++i) out[i] = half * out[i];
  }
  /// What the update does to positions and velocities counts.
  UpdateSize size_of(const Real& part, const Vector<Real>& update, const Vector<Real>& u) override {
    const Index n = u.size();
    place(part, u);
    const double q = static_cast<double>(part) * h_;
    const UpdateSize moved = update_size(update.data(), q, y_.data(), end_.data(), n);
    const UpdateSize sped = update_size(update.data(), 2, y_.data() + n, end_.data() + n, n);
    return {std::max(moved.whole, sped.whole), std::max(moved.each, sped.each)};
  }
  Real reach(const Real& part, const Vector<Real>& u) const override {
    const Index n = u.size();
    using std::abs;
    const Real most = y_.head(n).cwiseAbs().maxCoeff();
    return (most > Real(0) ? most : Real(1)) / abs(part * Real(h_));
  }
  ScaledMatrix<Real> tangent(const Real& part, const Vector<Real>& u) override {
    place(part, u);
    const Real step = part * Real(h_);
    return {step * step / Real(2), &force_.tangent(y_, end_)};
  }
  /// The state at the end of the part.
  void place(const Real& part, const Vector<Real>& u) {
    const Index n = u.size();
    const Real step = part * Real(h_);
    for (Index i = 0; i < n; ++i) {
      end_[i] = y_[i] + step * (y_[n + i] + u[i]);
      end_[n + i] = y_[n + i] + Real(2) * u[i];
    }
  }

 private:
  MeanForce<Real>& force_;
  const Vector<Real>& y_;
  double h_;
  Vector<Real>& end_;
};

}  // namespace

template <class Real>
void MeanForceStep<Real>::bind(const VectorField<Real>& f, std::optional<JacobianForm> form, TangentPattern tangent) {
  root_.bind(f.size() / 2, form, tangent);
  for (Vector<Real>* v : {&u_, &a_, &way_}) v->resize(f.size() / 2);
  end_.resize(f.size());
  const FieldClaims field = f.claims();
  particles_ = f.particles();
  keeps_momentum_ = particles_ > 0 && field.keeps_momentum;
  keeps_angular_momentum_ = particles_ > 0 && field.keeps_angular_momentum;
  masses_ = f.masses();
}

/// The motion of the particles at the end without that which has the momentum, and the angular momentum, of all.
template <class Real> void MeanForceStep<Real>::take_rigid_motion_out() {
  const Index n = particles_, half = u_.size();
  const auto place = [&](Index i) { return Vec3<Real>(end_[i], end_[n + i], end_[2 * n + i]); };
  const auto velocity = [&](Index i) { return Vec3<Real>(way_[i], way_[n + i], way_[2 * n + i]); };
  for (Index i = 0; i < half; ++i) way_[i] = end_[half + i];
  Vec3<Real> center = Vec3<Real>::Zero(), mean = Vec3<Real>::Zero(), rate = Vec3<Real>::Zero();
  if (keeps_momentum_) {
    const auto [mass, x, y, z, px, py, pz] = sums_over<Real, 7>(n, [&](Index i) {
      const Vec3<Real> q = masses_[i] * place(i), p = masses_[i] * velocity(i);
      return std::array<Real, 7>{masses_[i], q[0], q[1], q[2], p[0], p[1], p[2]};
    });
    if (!(mass > Real(0))) return;
    center = Vec3<Real>(x, y, z) / mass;
    mean = Vec3<Real>(px, py, pz) / mass;
  }
  if (keeps_angular_momentum_) {
    const auto [xx, yy, zz, xy, xz, yz, lx, ly, lz] = sums_over<Real, 9>(n, [&](Index i) {
      const Vec3<Real> r = place(i) - center, v = velocity(i) - mean, l = masses_[i] * cross(r, v);
      const Vec3<Real> mr = masses_[i] * r;
      return std::array<Real, 9>{mr[0] * r[0], mr[1] * r[1], mr[2] * r[2], mr[0] * r[1], mr[0] * r[2],
                                 mr[1] * r[2], l[0],         l[1],         l[2]};
    });
    // A line has no inertia about itself, and nothing of it turns there.
    const Real spread = xx + yy + zz, least = Real(0x1p-40) * spread;
    const Vec3<Real> of_x(yy + zz + least, -xy, -xz), of_y(-xy, xx + zz + least, -yz), of_z(-xz, -yz, xx + yy + least);
    const Vec3<Real> l(lx, ly, lz), over_x = cross(of_y, of_z), over_y = cross(of_z, of_x), over_z = cross(of_x, of_y);
    const Real determinant = dot(of_x, over_x);
    if (determinant > Real(0)) rate = Vec3<Real>(dot(over_x, l), dot(over_y, l), dot(over_z, l)) / determinant;
  }
  for (Index i = 0; i < n; ++i) {
    const Vec3<Real> rigid = mean + cross(rate, Vec3<Real>(place(i) - center));
    for (Index k = 0; k < 3; ++k) way_[k * n + i] -= rigid[k];
  }
}

/// Gives the velocities at the end the kinetic energy that the work between the places at both ends makes of that of y.
template <class Real> void MeanForceStep<Real>::balance(MeanForce<Real>& force, const Vector<Real>& y) {
  using std::abs;
  const Index n = u_.size();
  force.between(y, end_, a_);
  take_rigid_motion_out();
  const auto [missing, along] = sums_over<Real, 2>(n, [&](Index i) {
    const Real work = a_[i] * (end_[i] - y[i]), gain = Real(2) * u_[i] * (y[n + i] + u_[i]);
    return std::array<Real, 2>{masses_[i] * (work - gain), masses_[i] * way_[i] * end_[n + i]};
  });
  // Where hardly anything moves, as where a spring turns, rounding would have to change too much of it.
  const Real most = Real(0x1p22) * Real(std::numeric_limits<Real>::epsilon());
  if (!(along > Real(0) && abs(missing) <= most * along)) return;
  const Real part = missing / along;
  for (Index i = 0; i < n; ++i) {
    if (masses_[i] > Real(0)) end_[n + i] = y[n + i] + (Real(2) * u_[i] + part * way_[i]);  // rounded once
  }
}

template <class Real>
std::optional<Failure> MeanForceStep<Real>::make(MeanForce<Real>& force, Vector<Real>& y, double h,
                                                 Evaluations& count) {
  MeanForceEquations<Real> equations(force, y, h, end_);
  u_.setZero();
  if (auto failure = root_.solve(equations, u_, h, count)) return failure;
  equations.place(Real(1), u_);
  if (!root_.swept()) balance(force, y);
  y = end_;
  return {};
}

template class MeanForceStep<double>;
template class MeanForceStep<Quad>;

}  // namespace noether
