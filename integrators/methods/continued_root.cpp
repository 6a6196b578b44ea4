#include "integrators/methods/continued_root.hpp"

#include "integrators/methods/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Unknowns up to which the matrix is dense by default, and those up to which it is although its tangent is sparse.
constexpr Index most_dense_unknowns = 300, most_dense_of_sparse = 100;
/// Unknowns up to which factors of blocks in three dimensions take less time than products (docs/limits.md).
constexpr Index most_sparse_unknowns = 1500;
/// Unknowns from which sweeps are tried before a matrix is found, and how much each of them has to shrink the updates.
constexpr Index least_swept = 5;
constexpr double worth_a_sweep = 0.1;
/// Updates, relative to the solution, below which a root of a part of a step serves as the guess of the next part.
constexpr double near_enough = 1e-3;

/// Relative length of differences to one side: above the square root of rounding, since a secant is a quotient of small
/// numbers.
template <class Real> double secant_difference() {
  return std::pow(static_cast<double>(std::numeric_limits<Real>::epsilon()), 0.45);
}
/// And of central ones: in stiff systems their error is seen times the condition of the matrix.
template <class Real> double central_difference() {
  return std::cbrt(static_cast<double>(std::numeric_limits<Real>::epsilon()));
}

/// How matrices are kept unless the user says so.
JacobianForm usual_form(Index unknowns, TangentPattern tangent) {
  const bool is_between = unknowns > most_dense_of_sparse && unknowns <= most_sparse_unknowns;
  if (tangent == TangentPattern::sparse && is_between) return JacobianForm::sparse;
  return unknowns > most_dense_unknowns ? JacobianForm::matrix_free : JacobianForm::dense;
}

}  // namespace

template <class Real>
void ContinuedRoot<Real>::bind(Index unknowns, std::optional<JacobianForm> form, TangentPattern tangent) {
  has_tangent_ = tangent != TangentPattern::none;
  if (form == JacobianForm::sparse && !has_tangent_) {
    throw SchemeMismatch(
        "jacobian = \"sparse\" needs the tangent of a step, whose elements this method does not know; use jacobian = "
        "\"matrix_free\" or \"dense\"",
        {.key = "jacobian"});
  }
  form_ = form.value_or(usual_form(unknowns, tangent));
  // Small ones are quickly differenced, and keep their bits.
  has_tangent_ = has_tangent_ && (form_ == JacobianForm::sparse || unknowns > most_dense_of_sparse);
  for (Vector<Real>* v : {&value_, &residual_, &update_, &moved_, &moved_value_, &trial_, &root_, &before_})
    v->setZero(unknowns);
  if (form_ != JacobianForm::dense) return;
  matrix_.resize(unknowns, unknowns);
  factors_.resize(unknowns);
}

/// Factors of I - dg/dx at x. @return whether the matrix is regular
template <class Real>
bool ContinuedRoot<Real>::renew(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x) {
  if (form_ == JacobianForm::matrix_free) return true;
  if (form_ == JacobianForm::sparse) return renew_sparse(equations.tangent(part, x));
  return has_tangent_ ? renew_dense(equations.tangent(part, x)) : renew_by_differences(equations, part, x);
}

template <class Real> bool ContinuedRoot<Real>::renew_sparse(const ScaledMatrix<Real>& tangent) {
  using std::abs;
  if (!have_same_pattern(sparse_matrix_, *tangent.matrix)) {
    sparse_matrix_ = *tangent.matrix;
    sparse_factors_.forget();
  }
  const int* const first = sparse_matrix_.outerIndexPtr();
  Real largest(0);
  for (Index j = 0; j < sparse_matrix_.cols(); ++j) {
    for (int at = first[j]; at < first[j + 1]; ++at) {
      Real& element = sparse_matrix_.valuePtr()[at];
      element = -tangent.factor * tangent.matrix->valuePtr()[at];
      if (sparse_matrix_.innerIndexPtr()[at] == j) element += Real(1);
      if (abs(element) > largest) largest = abs(element);
    }
  }
  stiff_ = largest > Real(2);
  return sparse_factors_.compute(sparse_matrix_);
}

template <class Real> bool ContinuedRoot<Real>::renew_dense(const ScaledMatrix<Real>& tangent) {
  matrix_.setIdentity();
  const int* const first = tangent.matrix->outerIndexPtr();
  for (Index j = 0; j < matrix_.cols(); ++j) {
    for (int at = first[j]; at < first[j + 1]; ++at) {
      matrix_(tangent.matrix->innerIndexPtr()[at], j) -= tangent.factor * tangent.matrix->valuePtr()[at];
    }
  }
  stiff_ = matrix_.cwiseAbs().maxCoeff() > Real(2);
  return factors_.compute(matrix_);
}

template <class Real>
bool ContinuedRoot<Real>::renew_by_differences(StepEquations<Real>& equations, const Real& part,
                                               const Vector<Real>& x) {
  const Real reach = Real(central_difference<Real>()) * equations.reach(part, x);
  moved_ = x;
  for (Index j = 0; j < x.size(); ++j) {
    const Real up = x[j] + reach, down = x[j] - reach;
    moved_[j] = up;
    equations.map(part, moved_, moved_value_);
    moved_[j] = down;
    equations.map(part, moved_, update_);
    moved_[j] = x[j];
    matrix_.col(j) = (update_ - moved_value_) / (up - down);
    matrix_(j, j) += Real(1);
  }
  stiff_ = matrix_.cwiseAbs().maxCoeff() > Real(2);
  return factors_.compute(matrix_);
}

/// Leaves in `update_` what the matrix makes of `residual_`. @return whether its system was solved
template <class Real>
bool ContinuedRoot<Real>::correct(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x) {
  if (form_ == JacobianForm::dense) factors_.solve(residual_, update_);
  if (form_ == JacobianForm::sparse) sparse_factors_.solve(residual_, update_);
  if (form_ != JacobianForm::matrix_free) return true;
  const double product = 10 * secant_difference<Real>();
  const Real reach = Real(secant_difference<Real>()) * equations.reach(part, x);
  const LinearMap<Real> map = [&](const Vector<Real>& v, Vector<Real>& out) {
    const Real most = v.cwiseAbs().maxCoeff();
    out = v;
    if (!(most > Real(0))) return;
    const Real factor = reach / most;
    moved_ = x + factor * v;
    equations.map(part, moved_, moved_value_);
    out += (value_ - moved_value_) / factor;
  };
  // The next update corrects what this one leaves.
  return solve_by_krylov(map, residual_, {.residual = 100 * product, .product = product}, update_);
}

/// Sweeps x <- g(x) over the whole step, without a matrix. @return whether they shrink fast enough to be worth it
template <class Real> bool ContinuedRoot<Real>::sweep(StepEquations<Real>& equations, Vector<Real>& x) {
  constexpr int most = 40;
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  const Real whole(1);
  double before = 0;
  for (int iteration = 0; iteration < most; ++iteration) {
    equations.map(whole, x, value_);
    update_ = value_ - x;
    x.swap(value_);
    const double now = equations.size_of(whole, update_, x).whole;
    if (!std::isfinite(now)) return false;
    const double shrinks = iteration == 0 ? 0 : now / before;
    if (now == 0 || (iteration > 0 && now * shrinks <= rounding / 64)) return true;
    if (shrinks > worth_a_sweep) return now <= 64 * rounding;
    before = now;
  }
  return false;
}

/// Newton's iteration from x, whose updates have to shrink to a quarter or less from the first one on.
///
/// A matrix serves on while updates shrink to a fiftieth. Of a stiff system it has to be that of the root to half of
/// all digits: an older one turns rounding in a stiff direction into errors in a soft one, which look like no error.
template <class Real>
typename ContinuedRoot<Real>::Found ContinuedRoot<Real>::contract(StepEquations<Real>& equations, const Real& part,
                                                                  Vector<Real>& x, Evaluations& count) {
  constexpr int most = 60;
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  const double smooth = 64 * rounding, rough = 1e6 * rounding;
  double before = 0, away = 0;  // update before this one, and the one that followed on the matrix
  bool renews = true;
  int idle = 0;
  for (int iteration = 0; iteration < most; ++iteration) {
    equations.map(part, x, value_);
    residual_ = value_ - x;
    if (!residual_.allFinite()) return Found::no;
    if (renews) {
      ++count.jacobian;
      if (!renew(equations, part, x)) return Found::no;
    }
    if (!correct(equations, part, x)) return Found::unsolved;
    x += update_;
    const double now = equations.size_of(part, update_, x).whole, shrinks = iteration == 0 ? 0 : now / before;
    if (!std::isfinite(now)) return Found::no;
    if (renews) away = now;
    const bool fresh = renews, slow = shrinks > 0.25, serves = !stiff_ || away * away <= rounding;
    const bool is_guess = has_tangent_ && part < Real(1) && iteration > 0;
    if (now == 0 || (is_guess && !slow && now <= near_enough)) return Found::yes;
    if (serves && iteration > 0 && (now * shrinks <= rounding / 64 || (slow && now <= smooth))) return Found::yes;
    if (slow && now > rough && (fresh || iteration == 1)) return Found::no;
    // Rounding of stiff equations lies above that of the numbers: updates that shrink no more with new matrices are it.
    if (slow && fresh && ++idle == 3) return Found::yes;
    renews = form_ == JacobianForm::matrix_free || !serves || shrinks > 0.02;
    before = now;
  }
  return Found::no;
}

/// Follows the root from no step at all; each one and the one before it tell where the next one may be.
template <class Real>
std::optional<Failure> ContinuedRoot<Real>::follow(StepEquations<Real>& equations, Vector<Real>& x, double h,
                                                   Evaluations& count) {
  constexpr double shortest = 0x1p-12;
  double part = 0, last = 0, length = 0.5;
  root_ = before_ = x;
  while (part < 1) {
    const double next = std::min(1.0, part + length);
    trial_ = root_;
    if (part > 0) trial_ += Real((next - part) / (part - last)) * (root_ - before_);
    const Found found = contract(equations, Real(next), trial_, count);
    if (found == Found::yes) {
      before_ = root_;
      root_ = trial_;
      last = part;
      part = next;
      length *= 2;
    } else if (length > shortest) {
      length = (next - part) / 2;
    } else if (found == Found::unsolved) {
      return unsolved_system();
    } else {
      return Failure{
          Outcome::Kind::solver_failure, -1, "step",
          fmt::format("the equations of the step of {:.9g} have no solution that continues the motion beyond "
                      "{:.3g} of it; take a smaller step",
                      h, part)};
    }
  }
  x = root_;
  return {};
}

template <class Real>
std::optional<Failure> ContinuedRoot<Real>::solve(StepEquations<Real>& equations, Vector<Real>& x, double h,
                                                  Evaluations& count) {
  trial_ = x;
  swept_ = x.size() >= least_swept && sweep(equations, trial_);
  if (swept_) {
    x = trial_;
    return {};
  }
  trial_ = x;
  if (contract(equations, Real(1), trial_, count) == Found::yes) {
    x = trial_;
    return {};
  }
  return follow(equations, x, h, count);
}

template class ContinuedRoot<double>;
template class ContinuedRoot<Quad>;

}  // namespace noether
