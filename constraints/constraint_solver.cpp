#include "constraints/constraint_solver.hpp"

#include "constraints/dependent_constraints.hpp"
#include "constraints/newton_constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace noether {

namespace {

/// What the particles may violate at the start: tables are printed with some digits.
constexpr double largest_start_violation = 1e-6;
/// A pivot this small beside its diagonal element: at the start one constraint follows from others.
constexpr double dependent_pivot = 1e-10;

/// The solver that a set asks for.
template <class Real> std::unique_ptr<ConstraintStages<Real>> stages_for(const ConstraintEquations<Real>& equations) {
  const ConstraintMethodInfo& info = info_of(equations.options().solver);
  if constexpr (std::is_same_v<Real, double>) {
    return info.make(equations);
  } else {
    return info.make_quad(equations);
  }
}

}  // namespace

// ---- setting up ----------------------------------------------------------------------------------------------------

template <class Real>
ConstraintSolver<Real>::ConstraintSolver(const ConstraintSolver& other)
    : equations_(other.equations_), stages_(other.stages_ ? stages_for(equations_) : nullptr) {}

template <class Real> void ConstraintSolver<Real>::bind(ParticleSystem<Real>& s) {
  if (s.low_words() != nullptr) {
    throw BadConstraints(
        "constraints are solved to the rounding of plain sums; they do not work with compensated = true");
  }
  equations_.lay_out(s);
  stages_ = stages_for(equations_);
  prepared_ = false;
  if (s.phase().opened) return;  // a run that goes on stands where it stood
  check_start(s);
  check_independent(s);
  start_on_constraints(s);
  equations_.restore_iterations(0);
}

/// Whatever the solver: to rounding.
template <class Real> void ConstraintSolver<Real>::start_on_constraints(ParticleSystem<Real>& s) {
  NewtonConstraints<Real> exact(equations_);
  if (!equations_.settled()) {
    equations_.start_here();
    VectorColumn<Real> x = equations_.start();
    if (!exact.solve_positions(equations_, s, x, Real(0))) throw BadConstraints(failure()->message);
    equations_.move_to(s, x);
    equations_.know(s);
    check_independent(s);
  }
  // As often as it gains something: velocities that are along the constraints already must stay what they are.
  double before = std::numeric_limits<double>::infinity();
  while (true) {
    const double across = velocity_across(s);
    if (across <= 16 * ConstraintEquations<Real>::unit_roundoff || across > before / 2) break;
    before = across;
    exact.project_velocities(equations_, s, Real(0));
  }
}

/// Largest |G v| / sum |G_i| |v_i|.
template <class Real> double ConstraintSolver<Real>::velocity_across(const ParticleSystem<Real>& s) const {
  using std::abs, std::sqrt;
  const ConstraintLayout<Real>& layout = equations_.layout();
  const ConstraintGradients<Real>& here = equations_.gradients();
  double across = 0;
  for (Index e = 0; e < layout.equations(); ++e) {
    Real size(0);
    for (Index a = layout.first[at(e)]; a < layout.first[at(e) + 1]; ++a) {
      size += sqrt(norm2(here[at(a)]) * norm2(s.velocities()[layout.particle[at(a)]]));
    }
    if (!(size > Real(0))) continue;
    across = std::max(across, static_cast<double>(abs(equations_.along(e, s.velocities(), here)) / size));
  }
  return across;
}

template <class Real> void ConstraintSolver<Real>::check_start(const ParticleSystem<Real>& s) {
  equations_.know(s);
  equations_.find_floors(s);
  equations_.find_values(ConstraintPositions<Real>(s));
  Index worst_equation = -1;
  double worst_residual = 0;
  for (Index e = 0; e < equations_.size(); ++e) {
    const ConstraintPlace place = set().place(e);
    const double residual = place.group->residual(place.constraint, static_cast<double>(equations_.values()[e]));
    // Positions far from where the constraint acts are known to fewer digits.
    const double allowed =
        largest_start_violation *
        std::max(1.0, equations_.floor(e) / (4 * ConstraintEquations<Real>::unit_roundoff * equations_.scale(e)));
    if (!std::isfinite(residual)) {
      throw BadConstraints(set().words(e, s) + " has no finite value where its particles start");
    }
    if (residual <= allowed || residual <= worst_residual) continue;
    worst_equation = e;
    worst_residual = residual;
  }
  if (worst_equation < 0) return;
  throw BadConstraints(fmt::format("{} is violated at the start, by {:.3g} of its scale; only up to {} is corrected",
                                   set().words(worst_equation, s), worst_residual, largest_start_violation));
}

template <class Real> void ConstraintSolver<Real>::check_independent(const ParticleSystem<Real>& s) {
  const Index dependent = equations_.matrix().factorize(equations_.gradients(), Real(dependent_pivot));
  if (dependent >= 0)
    throw BadConstraints(dependent_words(set(), s, equations_.layout(), equations_.gradients(), dependent));
}

// ---- stages --------------------------------------------------------------------------------------------------------

template <class Real> bool ConstraintSolver<Real>::prepare(const ParticleSystem<Real>& s) {
  if (equations_.know(s)) prepared_ = false;
  if (!prepared_) prepared_ = stages_->prepare(equations_, s);
  return prepared_;
}

template <class Real> void ConstraintSolver<Real>::advance_positions(ParticleSystem<Real>& s, const Real& h) {
  if (failure() || !prepare(s)) return;
  VectorColumn<Real>& x = equations_.move_freely(s, h);
  prepared_ = false;
  if (stages_->solve_positions(equations_, s, x, h)) {
    equations_.arrive(s, x, h);
    Index turned = -1;
    if (equations_.on_this_side(&turned)) return;
    equations_.fail(s, turned, "would turn over: the step is too large");
  }
  equations_.turn_back(s);
}

template <class Real> void ConstraintSolver<Real>::project_velocities(ParticleSystem<Real>& s, const Real& h) {
  if (failure() || !prepare(s)) return;
  stages_->project_velocities(equations_, s, h);
}

// ---- forces of constraints -----------------------------------------------------------------------------------------

template <class Real>
std::optional<typename ConstraintSolver<Real>::Vector> ConstraintSolver<Real>::holding(const ParticleSystem<Real>& s,
                                                                                       const VectorColumn<Real>& a) {
  if (!prepare(s)) return {};
  ConstraintMatrix<Real>& matrix = equations_.matrix();
  if (!matrix.has_factors() && matrix.factorize(equations_.gradients(), Real(0)) >= 0) return {};
  Vector rhs(equations_.size());
  Index e = 0;
  for (const auto& group : set().groups()) {
    group->curvatures(ConstraintPositions<Real>(s), s.velocities(), rhs.data() + e);
    e += group->size() * group->equations();
  }
  for (e = 0; e < equations_.size(); ++e) rhs[e] += equations_.along(e, a, equations_.gradients());
  matrix.solve(rhs);
  return rhs;
}

template <class Real> void ConstraintSolver<Real>::constrain(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  if (const auto multipliers = holding(s, a)) equations_.push(a, equations_.gradients(), *multipliers, Real(1));
}

template <class Real>
Mat3<Real> ConstraintSolver<Real>::virial(const ParticleSystem<Real>& s, const VectorColumn<Real>& a) {
  const auto multipliers = holding(s, a);
  if (!multipliers) return Mat3<Real>::Constant(std::numeric_limits<Real>::quiet_NaN());
  Mat3<Real> virial = Mat3<Real>::Zero();
  std::vector<Vec3<Real>> points;
  Index e = 0;
  for (const auto& group : set().groups()) {
    points.resize(at(group->size() * group->particles()));
    group->points(ConstraintPositions<Real>(s), points.data());
    for (Index c = 0; c < group->size(); ++c) {
      for (Index k = 0; k < group->equations(); ++k, ++e) {
        for (Index p = 0; p < group->particles(); ++p) {
          const Vec3<Real> force =
              -(*multipliers)[e] * equations_.gradients()[at(equations_.layout().first[at(e)] + p)];
          virial += points[at(c * group->particles() + p)] * force.transpose();
        }
      }
    }
  }
  return virial;
}

template class ConstraintSolver<double>;
template class ConstraintSolver<Quad>;

}  // namespace noether
