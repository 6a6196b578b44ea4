#include "integrators/variational/lagrangian_field.hpp"

#include "integrators/methods/inertia.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

namespace noether {

template <class Real> std::string place_text(const Vector<Real>& q) {
  std::vector<std::string> shown;
  for (Index i = 0; i < q.size() && i < 4; ++i) shown.push_back(fmt::format("{:.6g}", static_cast<double>(q[i])));
  if (q.size() > 4) shown.emplace_back("...");
  return fmt::format("q = ({})", fmt::join(shown, ", "));
}

template std::string place_text(const Vector<double>& q);
template std::string place_text(const Vector<Quad>& q);

namespace {
template <class Real> double size_of(const Vector<Real>& d) {
  double largest = 0;
  for (Index i = 0; i < d.size(); ++i) {
    const double one = std::abs(static_cast<double>(d[i]));
    if (!std::isfinite(one)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, one);
  }
  return largest;
}

/// What the smallest numbers of all are rounded to; among them no update is small beside a velocity.
constexpr double smallest_rounding = 64 * std::numeric_limits<double>::denorm_min();

/// Whether rounding of each component of p is all that is left of it.
template <class Real> bool is_rounding(const Vector<Real>& left, const Vector<Real>& p) {
  const double most = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  for (Index i = 0; i < p.size(); ++i) {
    const double rounding = most * std::abs(static_cast<double>(p[i])) + smallest_rounding;
    if (!(std::abs(static_cast<double>(left[i])) <= rounding)) return false;
  }
  return true;
}
}  // namespace

/// One update by Newton; where it leaves more of p than before, a shorter one. @return whether there is one
template <class Real>
bool LagrangianField<Real>::correct_velocity(const Real& t, const Vector<Real>& q, const Vector<Real>& p, bool renew,
                                             Vector<Real>& v) {
  if (renew) {
    find_tangent(t, q, v, tangent_);
    if (!factors_.compute(tangent_.momentum_v)) return false;
  }
  const double left = size_of(off_);
  factors_.solve(off_, update_);
  for (int halved = 0; halved < 60; ++halved) {
    tried_ = v + update_;
    find_terms(t, q, tried_, terms_);
    off_ = p - terms_.momentum;
    // Rounding of p itself is no reason to go back.
    if (size_of(off_) <= std::max(left, 8 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * size_of(p))) {
      v = tried_;
      return true;
    }
    update_ *= Real(0.5);
  }
  return false;
}

/// Of the tangent that was found last.
template <class Real> bool LagrangianField<Real>::keeps_signs() {
  const std::optional<Index> negative = negative_eigenvalues(tangent_.momentum_v, eliminated_);
  if (!negative) return true;  // no numbers have a failure of their own
  if (!negative_) negative_ = negative;
  return *negative_ == *negative;
}

template <class Real> Failure LagrangianField<Real>::changed_signs(const Vector<Real>& q) const {
  return {Outcome::Kind::solver_failure, -1, "velocity",
          fmt::format("the determinant of d^2L/dq'^2 has changed its sign before {}: masses that depend on "
                      "the coordinates have become negative, and no motion goes there",
                      place_text(q))};
}

namespace {
Failure no_inverse(const std::string& what, const std::string& place) {
  return {Outcome::Kind::solver_failure, -1, "velocity",
          fmt::format("the Lagrangian gives no {} at {}: d^2L/dq'^2 has no inverse there", what, place)};
}
}  // namespace

template <class Real>
std::optional<Failure> LagrangianField<Real>::velocity(const Real& t, const Vector<Real>& q, const Vector<Real>& p,
                                                       Vector<Real>& v) {
  const bool known = known_v_.size() == q.size() && known_t_ == t && known_q_ == q && known_p_ == p;
  if (known) {
    v = known_v_;
    return {};
  }
  std::optional<Failure> failure = find_velocity(t, q, p, v);
  if (failure) return failure;
  known_t_ = t;
  known_q_ = q;
  known_p_ = p;
  known_v_ = v;
  return {};
}

template <class Real>
std::optional<Failure> LagrangianField<Real>::check_velocity(const Real& t, const Vector<Real>& y) {
  const Index n = coordinates();
  q_ = y.head(n);
  p_ = y.tail(n);
  return velocity(t, q_, p_, v_);
}

template <class Real>
std::optional<Failure> LagrangianField<Real>::find_velocity(const Real& t, const Vector<Real>& q, const Vector<Real>& p,
                                                            Vector<Real>& v) {
  constexpr int most = 200;
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  v.setZero(q.size());
  find_terms(t, q, v, terms_);
  off_ = p - terms_.momentum;
  double before = std::numeric_limits<double>::infinity();
  bool renew = true;
  for (int made = 0; made < most; ++made) {
    const bool corrected = correct_velocity(t, q, p, renew, v);
    if (made == 0 && !keeps_signs()) return changed_signs(q);
    if (!corrected) break;
    const double change = size_of(update_), size = size_of(v);
    if (change == 0 || is_rounding(off_, p)) return {};
    if (change <= 64 * rounding * size + smallest_rounding && !(change < 0.5 * before)) return {};
    if (!std::isfinite(change)) break;
    renew = !(change < 0.01 * before);  // else the same matrix does what is left
    before = change;
  }
  return no_inverse("velocity for the momentum", place_text(q));
}

template <class Real>
std::optional<Failure> LagrangianField<Real>::solve_acceleration(const Real& t, const Vector<Real>& q,
                                                                 const Vector<Real>& v, bool renew, Vector<Real>& a) {
  if (renew) {
    find_tangent(t, q, v, tangent_);
    if (!keeps_signs()) return changed_signs(q);
    if (!factors_.compute(tangent_.momentum_v)) return no_inverse("acceleration", place_text(q));
  }
  terms(t, q, v, terms_);
  off_ = terms_.force;
  still_.setZero(q.size());
  terms_along(t, q, v, Real(1), v, still_, terms_);
  off_ -= terms_.momentum;
  factors_.solve(off_, a);
  return {};
}

template <class Real>
void LagrangianField<Real>::find_second_rates(const Vector<Real>& /*q*/, const Vector<Real>& /*v*/,
                                              const Vector<Real>& /*a*/, Vector<Real>& /*w*/) {
  throw LogicError("second derivatives in a force were requested from a Lagrangian that has none");
}

template <class Real>
void LagrangianField<Real>::acceleration_with(const Real& /*t*/, const Vector<Real>& /*q*/, const Vector<Real>& /*v*/,
                                              const Vector<Real>& /*w*/, Vector<Real>& /*a*/) {
  throw LogicError("a force with second derivatives was requested from a Lagrangian that has none");
}

template <class Real> void LagrangianField<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  const Index n = coordinates();
  q_ = y.head(n);
  p_ = y.tail(n);
  dy.resize(2 * n);
  if (const std::optional<Failure> failure = velocity(t, q_, p_, v_)) {
    this->note(failure);
    dy.setConstant(Real(std::numeric_limits<double>::quiet_NaN()));
    return;
  }
  find_terms(t, q_, v_, terms_);
  dy.head(n) = v_;
  dy.tail(n) = terms_.force;
}

template class LagrangianField<double>;
template class LagrangianField<Quad>;

}  // namespace noether
