#include "integrators/variational/galerkin.hpp"

#include "integrators/methods/tableau.hpp"
#include "integrators/variational/follow_root.hpp"
#include "integrators/variational/singular_action.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

/// Larger matrices would take minutes a step.
constexpr Index most_rows = 6000;

std::string too_many_unknowns(Index rows) {
  return fmt::format("its {} unknowns are more than the {} for which it makes a matrix", rows, most_rows);
}

}  // namespace

template <class Real>
Galerkin<Real>::Galerkin(const MethodInfo& info, const GalerkinTable& table)
    : name_(info.name),
      wide_(table),
      order_(info.order),
      nodes_(static_cast<std::size_t>(table.nodes())),
      degree_(static_cast<std::size_t>(table.degree())),
      c_(as_real<Real>(table.c)),
      b_(as_real<Real>(table.b)),
      value_(as_real<Real>(table.value)),
      slope_(as_real<Real>(table.slope)),
      inverse_(as_real<Real>(table.inverse)) {
  // Whatever is rounded, the l_k add up to 1 and their slopes to 0: momenta of cyclic coordinates rest on it.
  for (std::size_t i = 0; i < nodes_; ++i) {
    value_[i][0] = Real(1);
    slope_[i][0] = Real(0);
    for (std::size_t k = 1; k <= degree_; ++k) {
      value_[i][0] = value_[i][0] - value_[i][k];
      slope_[i][0] = slope_[i][0] - slope_[i][k];
    }
  }
}

template <class Real> MethodClaims Galerkin<Real>::claims() const {
  return {.name = name_,
          .order = order_,
          .symplectic = true,
          .reversible = true,
          .keeps_angular_momentum = true,
          .second_order_only = true};
}

template <class Real> void Galerkin<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  const auto* lagrangian = LagrangianField<Real>::behind(f);
  if (lagrangian == nullptr && !field.second_order) refuse_without_lagrangian(name_, field.name);
  second_order_ = lagrangian == nullptr;
  velocity_dependent_ = field.velocity_dependent;
  n_ = f.size() / 2;
  const Index rows = static_cast<Index>(degree_) * n_;
  if (!second_order_ && rows > most_rows) {
    throw SchemeMismatch(fmt::format("method '{}' cannot step '{}': {}; use an explicit method for y' = f", name_,
                                     field.name, too_many_unknowns(rows)));
  }
  for (Vector<Real>* v : {&q0_, &p0_, &v0_, &v1_}) v->resize(n_);
  ended_.resize(0);
  for (Vector<Real>* v : {&points_, &guess_, &before_, &residual_, &update_}) v->resize(rows);
  q_.assign(nodes_, Vector<Real>(n_));
  v_.assign(nodes_, Vector<Real>(n_));
  terms_.assign(nodes_, {Vector<Real>(n_), Vector<Real>(n_)});
  state_.resize(2 * n_);
  jacobian_.reset();
  if (second_order_) return;
  matrix_.resize(rows, rows);
  factors_.resize(rows);
}

template <class Real> StepResult Galerkin<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  q0_ = y.head(n_);
  p0_ = y.tail(n_);
  if (second_order_) {
    v0_ = p0_;
  } else if (ended_.size() == y.size() && ended_ == y && ended_at_ == t) {
    v0_ = v1_;
  } else {
    made.failure = LagrangianField<Real>::behind(f)->velocity(t, q0_, p0_, v0_);
    if (made.failure) return made;
  }
  made.failure = find_points(f, t, h);
  if (made.failure) return made;
  const Index last = static_cast<Index>(degree_ - 1) * n_;
  for (Index a = 0; a < n_; ++a) {
    Real impulse(0);
    for (std::size_t i = 0; i < nodes_; ++i) impulse += b_[i] * terms_[i].force[a];
    y[a] = q0_[a] + points_[last + a];
    y[n_ + a] = p0_[a] + Real(h) * impulse;
  }
  h_ = h;
  if (second_order_) return made;
  // A state without a velocity is no end of a step; one that has it begins the next.
  ended_ = y;
  ended_at_ = t + Real(h);
  q_end_ = y.head(n_);
  p_end_ = y.tail(n_);
  made.failure = LagrangianField<Real>::behind(f)->velocity(ended_at_, q_end_, p_end_, v1_);
  return made;
}

/// The points of the root that continues the motion.
template <class Real>
std::optional<Failure> Galerkin<Real>::find_points(VectorField<Real>& f, const Real& t, double h) {
  guess(h);
  bool near = true;
  const std::optional<Failure> failure = solve(f, t, h, near);
  if (!failure && near) return {};
  if (points_.size() > most_rows) return failure;
  const Vector<Real> found = points_;
  const FollowedRoot followed = follow_root([&](double to, double from) {
    const Vector<Real> kept = points_;
    if (from == 0) {
      guess(to * h);
    } else {
      stretch(to / from);
    }
    bool near_piece = true;
    if (!solve(f, t, to * h, near_piece) && near_piece) return true;
    points_ = kept;
    return false;
  });
  if (followed.reached == 1) return {};
  if (followed.lost) {
    if (followed.reached == 0) points_.setZero();
    return singular_action(h, followed.reached, Vector<Real>(q0_ + points_.tail(n_)));
  }
  points_ = found;  // stiff motion that takes too long to follow: what Newton's iteration has found
  if (!failure) evaluate(f, t, h);
  return failure;
}

/// Free motion.
template <class Real> void Galerkin<Real>::guess(double h) {
  for (std::size_t k = 0; k < degree_; ++k) {
    points_.segment(static_cast<Index>(k) * n_, n_) = static_cast<Real>(Quad(h) * wide_.points[k + 1]) * v0_;
  }
}

/// Goes on along the polynomial of the points to points of a step longer by a factor.
template <class Real> void Galerkin<Real>::stretch(double by) {
  const Vector<Real> old = points_;
  for (std::size_t k = 0; k < degree_; ++k) {
    const std::vector<Quad> weights = lagrange_values(wide_.points, Quad(by) * wide_.points[k + 1]);
    auto point = points_.segment(static_cast<Index>(k) * n_, n_);
    point.setZero();
    for (std::size_t m = 0; m < degree_; ++m) {
      point += static_cast<Real>(weights[m + 1]) * old.segment(static_cast<Index>(m) * n_, n_);
    }
  }
}

/// The points of a root, from those at hand. @param near  set to false where one matrix, that of the guess, did not
/// lead there: it may be another root than that near the guess
template <class Real>
std::optional<Failure> Galerkin<Real>::solve(VectorField<Real>& f, const Real& t, double h, bool& near) {
  guess_ = points_;
  const auto correct = [&]() -> std::optional<UpdateSize> {
    evaluate(f, t, h);
    form_residual(h);
    form_update(h);
    before_ = points_;
    points_ += update_;
    return update_size(update_.data(), 1, before_.data(), points_.data(), points_.size());
  };
  by_sweeps_ = second_order_;
  if (by_sweeps_) {
    if (!newton_to_rounding<Real>(
            correct, [] {}, [] { return false; }))
      return {};
    points_ = guess_;
  }
  if (points_.size() > most_rows) {
    return Failure{Outcome::Kind::solver_failure, -1, "step",
                   fmt::format("sweeps over the implicit step of {:.9g} do not converge, and {}; take a smaller step",
                               h, too_many_unknowns(points_.size()))};
  }
  if (!renew_matrix(f, t, h)) return singular_action(h, 0, q0_);
  const auto restart = [&] {
    points_ = guess_;
    near = false;
  };
  return newton_to_rounding<Real>(correct, restart, [&] { return renew_matrix(f, t, h); });
}

/// q and q' at all nodes, from the points.
template <class Real> void Galerkin<Real>::form_states(double h) {
  for (std::size_t i = 0; i < nodes_; ++i) {
    q_[i].setZero();
    v_[i].setZero();
    for (std::size_t k = 0; k < degree_; ++k) {
      const auto point = points_.segment(static_cast<Index>(k) * n_, n_);
      q_[i] += value_[i][k + 1] * point;
      v_[i] += slope_[i][k + 1] * point;
    }
    q_[i] += q0_;
    v_[i] /= Real(h);
  }
}

template <class Real> void Galerkin<Real>::evaluate(VectorField<Real>& f, const Real& t, double h) {
  form_states(h);
  for (std::size_t i = 0; i < nodes_; ++i) {
    const Real at = t + c_[i] * Real(h);
    if (!second_order_) {
      LagrangianField<Real>::behind(f)->terms(at, q_[i], v_[i], terms_[i]);
      continue;
    }
    state_.head(n_) = q_[i];
    state_.tail(n_) = v_[i];
    f.acceleration(at, state_, terms_[i].force);
    terms_[i].momentum = v_[i];
  }
}

/// p0 [j = 0] + sum_i b_i (h f_i l_j(c_i) + m_i l_j'(c_i)), j = 0 to s - 1: what is left of the equations.
template <class Real> void Galerkin<Real>::form_residual(double h) {
  for (std::size_t j = 0; j < degree_; ++j) {
    auto row = residual_.segment(static_cast<Index>(j) * n_, n_);
    row.setZero();
    for (std::size_t i = 0; i < nodes_; ++i) {
      const Real of_force = Real(h) * b_[i] * value_[i][j], of_momentum = b_[i] * slope_[i][j];
      row += of_force * terms_[i].force + of_momentum * terms_[i].momentum;
    }
    if (j == 0) row += p0_;
  }
}

template <class Real> void Galerkin<Real>::form_update(double h) {
  if (!by_sweeps_) {
    factors_.solve(residual_, update_);
    update_ = -update_;
    return;
  }
  for (std::size_t k = 0; k < degree_; ++k) {
    auto row = update_.segment(static_cast<Index>(k) * n_, n_);
    row.setZero();
    for (std::size_t j = 0; j < degree_; ++j) {
      row -= Real(h) * inverse_[k][j] * residual_.segment(static_cast<Index>(j) * n_, n_);
    }
  }
}

/// The matrix of the equations at the present points. @return whether it is regular
template <class Real> bool Galerkin<Real>::renew_matrix(VectorField<Real>& f, const Real& t, double h) {
  const Index rows = points_.size();
  by_sweeps_ = false;
  form_states(h);
  matrix_.setZero(rows, rows);
  for (std::size_t i = 0; i < nodes_; ++i) {
    find_tangent(f, t + c_[i] * Real(h), i);
    add_tangent(i, h);
  }
  return factors_.compute(matrix_);
}

template <class Real> void Galerkin<Real>::find_tangent(VectorField<Real>& f, const Real& at, std::size_t node) {
  if (!second_order_) return LagrangianField<Real>::behind(f)->tangent(at, q_[node], v_[node], tangent_);
  if (!jacobian_) {
    jacobian_.emplace();
    jacobian_->bind(f, {.form = JacobianForm::dense});
  }
  state_.head(n_) = q_[node];
  state_.tail(n_) = v_[node];
  jacobian_->evaluate(f, at, state_);
  tangent_.momentum_q.setZero(n_, n_);
  tangent_.momentum_v.setIdentity(n_, n_);
  tangent_.force_q.resize(n_, n_);
  tangent_.force_v.setZero(n_, n_);
  for (Index j = 0; j < n_; ++j) {
    for (Index i = 0; i < n_; ++i) {
      tangent_.force_q(i, j) = (*jacobian_)(n_ + i, j);
      if (velocity_dependent_) tangent_.force_v(i, j) = (*jacobian_)(n_ + i, n_ + j);
    }
  }
}

template <class Real> void Galerkin<Real>::add_tangent(std::size_t node, double h) {
  const std::vector<Real>&l = value_[node], &d = slope_[node];
  const Real step(h), b = b_[node];
  for (std::size_t j = 0; j < degree_; ++j) {
    for (std::size_t k = 0; k < degree_; ++k) {
      auto block = matrix_.block(static_cast<Index>(j) * n_, static_cast<Index>(k) * n_, n_, n_);
      block += (b * step * l[j] * l[k + 1]) * tangent_.force_q + (b * l[j] * d[k + 1]) * tangent_.force_v;
      block += (b * d[j] * l[k + 1]) * tangent_.momentum_q + (b * d[j] * d[k + 1] / step) * tangent_.momentum_v;
    }
  }
}

template <class Real> Real Galerkin<Real>::action(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  q0_ = y.head(n_);
  form_states(h_);
  Real sum(0);
  for (std::size_t i = 0; i < nodes_; ++i) {
    const Real at = t + c_[i] * Real(h_);
    if (second_order_) {
      state_.head(n_) = q_[i];
      state_.tail(n_) = v_[i];
      sum += b_[i] * f.lagrangian(at, state_);
    } else {
      sum += b_[i] * LagrangianField<Real>::behind(f)->action_density(at, q_[i], v_[i]);
    }
  }
  return Real(h_) * sum;
}

template class Galerkin<double>;
template class Galerkin<Quad>;

}  // namespace noether
