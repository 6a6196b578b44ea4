#include "integrators/projected.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// Distances up to this, in units of rounding, may be all that rounding of the state leaves to be gained.
constexpr double rounding_floor = 64;
/// A state that is no farther off, where rounding is what is tolerated, is there already: a method that keeps an
/// invariant drifts so far by its own rounding in some thousand steps.
constexpr double untouched = 8;

/// The relative error that counts as rounding.
template <class Real> Real rounding() { return Real(4) * std::numeric_limits<Real>::epsilon(); }

}  // namespace

template <class Real>
Projected<Real>::Projected(AnyIntegrator<Real> integrator, ProjectionOptions options,
                           std::vector<std::unique_ptr<Equations<Real>>> own)
    : Wrapped<AnyIntegrator<Real>>(std::move(integrator)), manifold_(std::move(options), std::move(own)) {
  manifold_.options().check_directions();
}

template <class Real> IntegratorClaims Projected<Real>::claims() const {
  IntegratorClaims claims = this->integrator_.claims();
  const ProjectionOptions& options = manifold_.options();
  claims.symplectic = false;
  claims.no_action = "a projection moves the state after every step, so the motion has no action";
  claims.reversible = claims.reversible && options.how == Projection::symmetric;
  claims.energy_exact = options.has(Invariant::energy);
  claims.keeps_momentum = options.has(Invariant::momentum);
  claims.keeps_angular_momentum = options.has(Invariant::angular_momentum);
  claims.steps_at_once = 1;
  return claims;
}

template <class Real> void Projected<Real>::bind(ParticleSystem<Real>& s) {
  this->integrator_.bind(s);
  manifold_.bind(s, this->integrator_.claims());
  now_ = s;
  aims_.clear();
}

template <class Real> Evaluations Projected<Real>::evaluations() const {
  Evaluations done = this->integrator_.evaluations();
  done.projection.steps += steps_;
  done.projection.iterations += iterations_;
  return done;
}

template <class Real> void Projected<Real>::take_aim(const ParticleSystem<Real>& raw) {
  if (!aims_.empty()) return;
  this->integrator_.settle(raw, *now_, {}, std::nullopt, true);
  manifold_.values(this->integrator_, *now_, g_, scale_);
  aims_ = manifold_.aims(g_);
}

template <class Real> Advance Projected<Real>::advance(ParticleSystem<Real>& s, const Span& span) {
  take_aim(s);
  Span one = span;
  one.steps = 1;
  Advance done;
  while (done.steps < span.steps) {
    const bool symmetric = manifold_.options().how == Projection::symmetric;
    const Advance made = symmetric ? symmetric_step(s, one) : step_and_project(s, one);
    done.steps += made.steps;
    done.at_limit = made.at_limit;
    done.failure = made.failure;
    if (made.failure != nullptr || made.steps == 0 || span.asked_to_stop()) break;
  }
  return done;
}

template <class Real> Advance Projected<Real>::step_and_project(ParticleSystem<Real>& s, const Span& one) {
  Advance made = this->integrator_.advance(s, one);
  if (made.failure != nullptr || made.steps == 0) return made;
  this->integrator_.settle(s, *now_, {}, std::nullopt, true);
  ++steps_;
  const std::int64_t before = iterations_;
  const std::optional<bool> moved = project(*now_);
  if (!moved) {
    iterations_ = before;
    made.failure = &*failure_;
  } else if (*moved) {
    this->integrator_.go_on_from(*now_, s);
  }
  return made;
}

/// A state between two steps is brought back by itself; one that cannot be is no state.
template <class Real>
Real Projected<Real>::settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,
                             const std::optional<double>& at, bool corrected) {
  take_aim(raw);
  const Real action = this->integrator_.settle(raw, out, wanted, at, corrected);
  if (!at) return action;
  const std::int64_t before = iterations_;
  if (!project(out)) {
    moved_.setConstant(Real(std::numeric_limits<double>::quiet_NaN()));
    manifold_.scatter(moved_, out);
  }
  iterations_ = before;
  return action;
}

template <class Real> double Projected<Real>::distance(const ParticleSystem<Real>& s) {
  using std::abs, std::max;
  manifold_.values(this->integrator_, s, g_, scale_);
  missing_.resize(g_.size());
  double farthest = 0;
  for (Index k = 0; k < g_.size(); ++k) {
    missing_[k] = aims_[static_cast<std::size_t>(k)] - g_[k];
    const Real tolerated = max(Real(manifold_.options().tolerance), rounding<Real>()) * scale_[k];
    if (missing_[k] == Real(0)) continue;
    const double one = static_cast<double>(Real(abs(missing_[k])) / tolerated);
    if (!(one <= farthest)) farthest = one;
    if (std::isnan(one)) return one;
  }
  return farthest;
}

template <class Real> double Projected<Real>::near_enough() const {
  return manifold_.options().tolerance > 0 ? 1 : untouched;
}

/// What is tolerated, or what rounding may leave where that is more.
template <class Real> double Projected<Real>::floor() const {
  using std::max;
  const Real least = rounding<Real>();
  return max(1.0, rounding_floor * static_cast<double>(least / max(Real(manifold_.options().tolerance), least)));
}

/// Newton's matrix G^T D, each row and column by its own size, so that no unit counts.
template <class Real> void Projected<Real>::factorize(const Matrix<Real>& G) {
  using std::sqrt;
  const Index n = G.cols();
  sizes_.resize(n);
  lengths_.resize(n);
  Matrix<Real> A(n, n);
  for (Index k = 0; k < n; ++k) {
    for (Index l = 0; l < n; ++l) A(k, l) = G.col(k).dot(D_.col(l));
    sizes_[k] = Real(sqrt(G.col(k).squaredNorm()));
    lengths_[k] = Real(sqrt(D_.col(k).squaredNorm()));
  }
  for (Index k = 0; k < n; ++k) {
    for (Index l = 0; l < n; ++l) {
      const Real unit = sizes_[k] * lengths_[l];
      A(k, l) = unit > Real(0) ? A(k, l) / unit : Real(0);
    }
  }
  newton_.factorize(std::move(A));
}

template <class Real> void Projected<Real>::solve(Vector<Real>& multiplier) const {
  for (Index k = 0; k < multiplier.size(); ++k) {
    if (sizes_[k] > Real(0)) multiplier[k] /= sizes_[k];
  }
  newton_.solve(multiplier);
  for (Index k = 0; k < multiplier.size(); ++k) {
    if (lengths_[k] > Real(0)) multiplier[k] /= lengths_[k];
  }
}

template <class Real> std::optional<bool> Projected<Real>::project(ParticleSystem<Real>& s) {
  double far = distance(s);
  if (!(far > near_enough()) || std::isinf(far)) return false;  // what is not finite is told elsewhere
  manifold_.gather(s, y_);
  manifold_.gradients(this->integrator_, s, G_);
  manifold_.directions(G_, D_);
  factorize(G_);
  lambda_.setZero(D_.cols());
  bool renewed = false;
  std::int64_t tried = 0;
  while (tried < manifold_.options().iterations) {
    ++tried;
    step_ = missing_;
    solve(step_);
    moved_ = y_ + D_ * (lambda_ + step_);
    manifold_.scatter(moved_, s);
    ++iterations_;
    const double near = distance(s);
    if (near > far && far <= floor()) {
      moved_ = y_ + D_ * lambda_;
      manifold_.scatter(moved_, s);
      return moved_ != y_;
    }
    lambda_ += step_;
    if (near <= 1) return true;
    if (!(near < far / 2)) {
      if (near <= floor()) return true;
      if (renewed || !std::isfinite(near)) break;
      manifold_.gradients(this->integrator_, s, G_);
      factorize(G_);
      renewed = true;
    }
    far = near;
  }
  fail(s, tried);
  return std::nullopt;
}

template <class Real> const Failure* Projected<Real>::fail(const ParticleSystem<Real>& s, std::int64_t tried) {
  using std::abs;
  Index worst = 0;
  double most = -1;
  for (Index k = 0; k < missing_.size(); ++k) {
    const double one = static_cast<double>(Real(abs(missing_[k])) / scale_[k]);
    if (one <= most) continue;
    most = one, worst = k;
    if (std::isnan(one)) break;
  }
  const std::string what =
      std::isfinite(most) ? fmt::format("{} is off by {:.2g} of its size after {} iterations, and its gradients {}",
                                        manifold_.name(worst), most, tried,
                                        newton_.rank() < missing_.size() ? "depend on others" : "lead nowhere")
                          : fmt::format("{} is not finite after {} iterations", manifold_.name(worst), tried);
  failure_ = Failure{
      Outcome::Kind::solver_failure, -1, "projection",
      fmt::format("no state was found on the invariants at time {:.9g}: {}; take a shorter step, or fewer invariants",
                  static_cast<double>(s.clock().time()), what)};
  return &*failure_;
}

/// Solves for mu and the end of the step together, from mu = 0: with z = Phi(y_0 + D(y_0) mu) and r = z + D(y) mu - y,
/// Newton's corrections, Phi' taken for 1, are
///
///     2 G^T D dmu = g(start) - g(y) - G^T r,   dy = r + 2 D dmu.
template <class Real> Advance Projected<Real>::symmetric_step(ParticleSystem<Real>& s, const Span& one) {
  this->integrator_.settle(s, *now_, {}, std::nullopt, true);
  begin_ = *now_;
  manifold_.gather(*begin_, y_);
  manifold_.gradients(this->integrator_, *begin_, G_);
  manifold_.directions(G_, D_begin_);
  lambda_.setZero(G_.cols());
  Off before{std::numeric_limits<double>::infinity(), 0};
  for (std::int64_t k = 0;; ++k) {
    if (k > 0) {
      now_->assign_state(*begin_);
      reached_ = y_ + D_begin_ * lambda_;
      manifold_.scatter(reached_, *now_);
      this->integrator_.go_on_from(*now_, s);
    }
    Advance made = this->integrator_.advance(s, one);
    if (made.failure != nullptr || made.steps == 0) return made;
    this->integrator_.settle(s, *now_, {}, std::nullopt, true);
    manifold_.gather(*now_, reached_);
    if (k == 0) moved_ = reached_;
    const Off far = improve(*now_);
    const bool here = far.invariants <= (k == 0 ? near_enough() : 1) && far.state <= 1,
               no_nearer = far.most() >= before.most() && far.invariants <= floor() && far.state <= rounding_floor;
    const bool stands =
        here || no_nearer || (k == 0 && !far.finite());  // what a step makes not finite is told elsewhere
    if (!stands && (k == manifold_.options().iterations || !far.finite())) made.failure = fail(*now_, k);
    if (stands && k > 0) this->integrator_.go_on_from(*now_, s);
    if (stands) ++steps_;
    if (stands) iterations_ += k;
    if (stands || made.failure != nullptr) return made;
    before = far;
    moved_ += step_;
  }
}

/// Puts the end of a symmetric step as it stands into particles, and finds its next correction and that of mu.
template <class Real> auto Projected<Real>::improve(ParticleSystem<Real>& s) -> Off {
  manifold_.scatter(moved_, s);
  Off far{distance(s), 0};
  manifold_.gradients(this->integrator_, s, G_);
  manifold_.directions(G_, D_);
  const Vector<Real> r = reached_ + D_ * lambda_ - moved_;
  const Index half = manifold_.half(r.size());
  for (const Index begin : {Index(0), half}) {
    const Index count = begin == 0 ? half : r.size() - half;
    if (count == 0) continue;
    const Real size = moved_.segment(begin, count).template lpNorm<Eigen::Infinity>();
    const Real off = r.segment(begin, count).template lpNorm<Eigen::Infinity>();
    if (off == Real(0)) continue;
    const double here = static_cast<double>(off / (rounding<Real>() * size));
    if (!(here <= far.state)) far.state = here;
  }
  factorize(G_);
  Vector<Real> change = missing_ - G_.transpose() * r;
  solve(change);
  change /= Real(2);
  lambda_ += change;
  step_ = r + Real(2) * (D_ * change);
  return far;
}

template class Projected<double>;
template class Projected<Quad>;
template struct detail::IntegratorModel<Projected<double>>;
template struct detail::IntegratorModel<Projected<Quad>>;

}  // namespace noether
