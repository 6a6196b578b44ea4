#include "integrators/methods/newmark.hpp"

#include "integrators/all_methods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Unknowns from which sweeps are tried before a matrix is found, and how much each of them has to shrink the updates.
constexpr Index least_swept_accelerations = 5;
constexpr double least_shrinkage = 0.1;

}  // namespace

void NewmarkOptions::check() const {
  if (!(beta >= 0 && std::isfinite(beta)))
    refuse_field("beta", beta, "is not valid in Newmark's method; 0 or more is expected, 0.25 by default");
  if (!std::isfinite(gamma))
    refuse_field("gamma", gamma, "is not valid in Newmark's method; a number is expected, 0.5 by default");
}

template <class Real>
Newmark<Real>::Newmark(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      beta_(options.own.as<NewmarkOptions>().beta),
      gamma_(options.own.as<NewmarkOptions>().gamma),
      form_(options.jacobian) {}

template <class Real> MethodClaims Newmark<Real>::claims() const {
  const bool verlet = beta_ == 0 && gamma_ == 0.5;
  return {.name = name_,
          .order = gamma_ == 0.5 ? 2 : 1,
          .symplectic = verlet,
          .reversible = gamma_ == 0.5,
          .keeps_angular_momentum = verlet,
          .second_order_only = true};
}

template <class Real> void Newmark<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  if (!field.second_order) {
    throw SchemeMismatch(
        fmt::format("method '{}' is for q'' = a only, but '{}' is a first-order system; use "
                    "'trapezoidal' instead",
                    name_, field.name));
  }
  explicit_ = beta_ == 0 && (gamma_ == 0 || !field.velocity_dependent);
  if (!explicit_) jacobian_.bind(f, {.form = form_});
  y1_.resize(f.size());
  for (Vector<Real>* v : {&a0_, &a1_, &update_}) v->resize(f.size() / 2);
}

/// q1 and v1 that belong to a1.
template <class Real> void Newmark<Real>::place(const Vector<Real>& y, double h) {
  const Index n = a1_.size();
  const Real step(h), late_q = step * step * Real(beta_), early_q = step * step * (Real(0.5) - Real(beta_));
  const Real late_v = step * Real(gamma_), early_v = step * (Real(1) - Real(gamma_));
  for (Index i = 0; i < n; ++i) {
    y1_[i] = y[i] + (step * y[n + i] + (early_q * a0_[i] + late_q * a1_[i]));
    y1_[n + i] = y[n + i] + (early_v * a0_[i] + late_v * a1_[i]);
  }
}

/// What an update of the accelerations does to positions and velocities, and how long it is in them.
template <class Real> UpdateSize Newmark<Real>::take(const Vector<Real>& y, double h) {
  const Index n = a1_.size();
  for (Index i = 0; i < n; ++i) a1_[i] += update_[i];
  const UpdateSize q = update_size(update_.data(), h * h * beta_, y.data(), y1_.data(), n);
  const UpdateSize v = update_size(update_.data(), h * gamma_, y.data() + n, y1_.data() + n, n);
  return {std::max(q.whole, v.whole), std::max(q.each, v.each)};
}

/// Sweeps a1 <- a(q1, v1), without a matrix, to rounding. @return whether they shrink fast enough to be worth it
template <class Real> bool Newmark<Real>::sweep(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  constexpr int most = 40;
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  double before = 0;
  for (int iteration = 0; iteration < most; ++iteration) {
    place(y, h);
    f.acceleration(t + Real(h), y1_, update_);
    update_ -= a1_;
    const double now = take(y, h).whole;
    if (!std::isfinite(now)) return false;
    const double shrinks = iteration == 0 ? 0 : now / before;
    if (now == 0 || (iteration > 0 && now * shrinks <= rounding / 64)) return true;
    if (shrinks > least_shrinkage) return now <= 64 * rounding;
    before = now;
  }
  return false;
}

template <class Real>
std::optional<Failure> Newmark<Real>::solve(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const Index n = a1_.size();
  const Real end = t + Real(h);
  const auto renew = [&] {
    place(y, h);
    jacobian_.evaluate(f, end, y1_);
    return jacobian_.factorize_half(Real(1), Real(h) * Real(gamma_), Real(h) * Real(h) * Real(beta_));
  };
  const auto correct = [&]() -> std::optional<UpdateSize> {
    place(y, h);
    f.acceleration(end, y1_, update_);
    update_ -= a1_;
    if (!jacobian_.solve_half(f, update_)) return {};
    return take(y, h);
  };
  // Where steps are long beside the fastest motion, its acceleration has turned: from q1 = q + h v it is nearer.
  const auto restart = [&] {
    const Real turned = beta_ > 0 ? Real((beta_ - 0.5) / beta_) : Real(1);
    for (Index i = 0; i < n; ++i) a1_[i] = turned * a0_[i];
  };
  if (n >= least_swept_accelerations) {
    if (sweep(f, t, y, h)) return {};
    a1_ = a0_;
  }
  if (!renew()) return singular_matrix(h);
  return newton_to_rounding<Real>(correct, restart, renew);
}

template <class Real> StepResult Newmark<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  f.acceleration(t, y, a0_);
  a1_ = a0_;
  if (explicit_) {
    place(y, h);
    f.acceleration(t + Real(h), y1_, a1_);
  } else {
    made.failure = solve(f, t, y, h);
  }
  if (made.failure) return made;
  place(y, h);
  y = y1_;
  return made;
}

template class Newmark<double>;
template class Newmark<Quad>;

namespace {
template <class Real> std::unique_ptr<Method<Real>> make_newmark(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Newmark<Real>>(info, options);
}
}  // namespace

std::span<const MethodInfo> methods::newmark_list() {
  static const MethodInfo list[] = {
      {.name = "newmark",
       .aliases = "newmark_beta",
       .summary = "Newmark's method for q'' = a: average acceleration unless beta and gamma are given",
       .use = "structures: stiff springs with steps chosen for the slow motion of interest",
       .source = "Newmark1959",
       .family = "implicit",
       .options = {&own_options<NewmarkOptions>, linear_solver},
       .order = 2,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_newmark<double>,
       .make_quad = make_newmark<Quad>},
  };
  return list;
}

}  // namespace noether
