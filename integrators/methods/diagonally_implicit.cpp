#include "integrators/methods/diagonally_implicit.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/diagonally_implicit_tableaus.hpp"
#include "integrators/methods/newton.hpp"

#include <limits>

namespace noether {

template <class Real>
DiagonallyImplicit<Real>::DiagonallyImplicit(const MethodInfo& info, const MethodOptions& options, const Tableau& table,
                                             Keeps keeps)
    : name_(info.name),
      order_(table.order),
      keeps_(keeps),
      form_(options.jacobian),
      a_(as_real<Real>(table.a)),
      b_(as_real<Real>(table.b)),
      c_(as_real<Real>(table.c)),
      diagonal_(a_.back().back()),
      explicit_first_(a_.front().empty()),
      ends_at_last_(table.a.back() == table.b) {}

template <class Real> MethodClaims DiagonallyImplicit<Real>::claims() const {
  return {.name = name_, .order = order_, .reversible = keeps_.reversible};
}

template <class Real> void DiagonallyImplicit<Real>::bind(const VectorField<Real>& f) {
  jacobian_.bind(f, {.form = form_});
  second_order_ = f.claims().second_order;
  k_.assign(b_.size(), Vector<Real>(f.size()));
  for (Vector<Real>* v : {&base_, &z_, &guess_, &stage_, &update_}) v->setZero(f.size());
}

template <class Real>
void DiagonallyImplicit<Real>::combine(const std::vector<Real>& w, std::size_t count, double h, const Vector<Real>& y,
                                       Vector<Real>& out) const {
  for (Index i = 0; i < y.size(); ++i) {
    Real sum(0);
    for (std::size_t j = 0; j < count; ++j) sum += w[j] * k_[j][i];
    out[i] = y[i] + Real(h) * sum;
  }
}

/// Leaves z of the stage in `z_`, which holds a guess, and its point in `stage_`.
template <class Real>
std::optional<Failure> DiagonallyImplicit<Real>::solve_stage(VectorField<Real>& f, const Real& t, std::size_t stage,
                                                             double h) {
  const Real weight = Real(h) * diagonal_, time = t + c_[stage] * Real(h);
  const Index n = base_.size();
  const auto correct = [&]() -> std::optional<UpdateSize> {
    for (Index i = 0; i < n; ++i) stage_[i] = base_[i] + z_[i];
    f.rate(time, stage_, update_);
    for (Index i = 0; i < n; ++i) update_[i] = weight * update_[i] - z_[i];
    if (!jacobian_.solve(f, update_)) return {};
    for (Index i = 0; i < n; ++i) z_[i] += update_[i];
    for (Index i = 0; i < n; ++i) stage_[i] = base_[i] + z_[i];
    return update_size(update_, base_, stage_, second_order_);
  };
  guess_ = z_;
  const auto restart = [&] {
    z_ = guess_;
    for (Index i = 0; i < n; ++i) stage_[i] = base_[i] + z_[i];
  };
  const auto renew = [&] {
    jacobian_.evaluate(f, time, stage_);
    return jacobian_.factorize(Real(1), weight);
  };
  return newton_to_rounding<Real>(correct, restart, renew);
}

template <class Real>
StepResult DiagonallyImplicit<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  const Real weight = Real(h) * diagonal_;
  jacobian_.evaluate(f, t, y);
  if (!jacobian_.factorize(Real(1), weight)) {
    made.failure = singular_matrix(h);
    return made;
  }
  for (std::size_t s = 0; s < b_.size(); ++s) {
    if (s == 0 && explicit_first_) {
      f.rate(t, y, k_[0]);
      continue;
    }
    combine(a_[s], s, h, y, base_);
    for (Index i = 0; i < y.size(); ++i) z_[i] = s == 0 ? Real(0) : weight * k_[s - 1][i];
    made.failure = solve_stage(f, t, s, h);
    if (made.failure) return made;
    // Not from f, which would multiply rounding errors of the stage by its stiffness.
    for (Index i = 0; i < y.size(); ++i) k_[s][i] = z_[i] / weight;
  }
  if (ends_at_last_) {
    y = stage_;
  } else {
    combine(b_, b_.size(), h, y, stage_);
    y = stage_;
  }
  return made;
}

template class DiagonallyImplicit<double>;
template class DiagonallyImplicit<Quad>;

namespace {

const Tableau& diagonally_implicit_table(std::string_view name) {
  if (name == "backward_euler") return tableaus::backward_euler();
  if (name == "trapezoidal") return tableaus::trapezoidal();
  if (name == "sdirk_2") return tableaus::sdirk_2();
  return name == "sdirk_3" ? tableaus::sdirk_3() : tableaus::sdirk_4();
}

template <class Real>
std::unique_ptr<Method<Real>> make_diagonally_implicit(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<DiagonallyImplicit<Real>>(
      info, options, diagonally_implicit_table(info.name),
      typename DiagonallyImplicit<Real>::Keeps{.reversible = info.name == "trapezoidal"});
}

}  // namespace

std::span<const MethodInfo> methods::diagonally_implicit_list() {
  static const MethodInfo list[] = {
      {.name = "backward_euler",
       .aliases = "implicit_euler bdf_1",
       .summary = "backward Euler: L-stable, damps every oscillation by (1 + z^2)^(-1/2) per step",
       .use = "stiff decay to a rest state, at any step",
       .source = "HairerWanner1996",
       .family = "implicit",
       .options = {linear_solver},
       .order = 1,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_diagonally_implicit<double>,
       .make_quad = make_diagonally_implicit<Quad>},
      {.name = "trapezoidal",
       .aliases = "crank_nicolson implicit_trapezoidal",
       .summary = "trapezoidal rule: A-stable, reversible, R = -1 at infinity; conjugate to the implicit midpoint rule",
       .use = "heat and circuits at moderate accuracy; stiff modes ring",
       .source = "CrankNicolson1947",
       .family = "implicit",
       .options = {linear_solver},
       .order = 2,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_diagonally_implicit<double>,
       .make_quad = make_diagonally_implicit<Quad>},
      {.name = "sdirk_2",
       .aliases = "alexander_2",
       .summary = "singly diagonally implicit, 2 stages, L-stable",
       .use = "stiff systems at low accuracy, steps of one length",
       .source = "Alexander1977",
       .family = "implicit",
       .options = {linear_solver},
       .order = 2,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_diagonally_implicit<double>,
       .make_quad = make_diagonally_implicit<Quad>},
      {.name = "sdirk_3",
       .aliases = "alexander_3",
       .summary = "singly diagonally implicit, 3 stages, L-stable",
       .use = "stiff systems at moderate accuracy, steps of one length",
       .source = "Alexander1977",
       .family = "implicit",
       .options = {linear_solver},
       .order = 3,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_diagonally_implicit<double>,
       .make_quad = make_diagonally_implicit<Quad>},
      {.name = "sdirk_4",
       .aliases = "hairer_wanner_sdirk_4",
       .summary = "singly diagonally implicit, 5 stages, L-stable",
       .use = "stiff systems at moderate accuracy, steps of one length",
       .source = "HairerWanner1996",
       .family = "implicit",
       .options = {linear_solver},
       .order = 4,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_diagonally_implicit<double>,
       .make_quad = make_diagonally_implicit<Quad>},
  };
  return list;
}

}  // namespace noether
