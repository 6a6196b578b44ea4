#include "integrators/methods/mean_force_step.hpp"

#include <algorithm>
#include <cmath>

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

 private:
  /// The state at the end of the part.
  void place(const Real& part, const Vector<Real>& u) {
    const Index n = u.size();
    const Real step = part * Real(h_);
    for (Index i = 0; i < n; ++i) {
      end_[i] = y_[i] + step * (y_[n + i] + u[i]);
      end_[n + i] = y_[n + i] + Real(2) * u[i];
    }
  }

  MeanForce<Real>& force_;
  const Vector<Real>& y_;
  double h_;
  Vector<Real>& end_;
};

}  // namespace

template <class Real>
void MeanForceStep<Real>::bind(const VectorField<Real>& f, std::optional<JacobianForm> form, TangentPattern tangent) {
  root_.bind(f.size() / 2, form, tangent);
  u_.resize(f.size() / 2);
  end_.resize(f.size());
}

template <class Real>
std::optional<Failure> MeanForceStep<Real>::make(MeanForce<Real>& force, Vector<Real>& y, double h,
                                                 Evaluations& count) {
  MeanForceEquations<Real> equations(force, y, h, end_);
  u_.setZero();
  if (auto failure = root_.solve(equations, u_, h, count)) return failure;
  const Index n = u_.size();
  for (Index i = 0; i < n; ++i) {
    y[i] += Real(h) * (y[n + i] + u_[i]);
    y[n + i] += Real(2) * u_[i];
  }
  return {};
}

template class MeanForceStep<double>;
template class MeanForceStep<Quad>;

}  // namespace noether
