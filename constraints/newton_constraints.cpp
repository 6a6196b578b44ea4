#include "constraints/newton_constraints.hpp"

#include "constraints/velocity_passes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace noether {

namespace {

/// Chord steps that gain less than this give way to fresh matrices.
constexpr double slow_contraction = 0.05;
constexpr int most_iterations = 30;
/// Parts of a step in which a solution is followed where it is hard to find.
constexpr double shortest_stride = 1.0 / 256;

}  // namespace

template <class Real>
NewtonConstraints<Real>::NewtonConstraints(const ConstraintEquations<Real>& equations)
    : new_(equations.layout().particle.size(), Vec3<Real>::Zero()), free_(equations.start()) {
  const auto& inverse = equations.layout().inverse_mass;
  if (inverse.empty()) return;
  const auto [least, most] = std::minmax_element(inverse.begin(), inverse.end());
  passes_ = velocity_passes(static_cast<double>(*most / *least));
}

template <class Real>
bool NewtonConstraints<Real>::prepare(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s) {
  ConstraintMatrix<Real>& matrix = equations.matrix();
  if (matrix.has_factors()) return true;
  const Index dependent = matrix.factorize(equations.gradients(), Real(1000) * std::numeric_limits<Real>::epsilon());
  if (dependent >= 0) equations.fail(s, dependent, "has become dependent on others (a singular set)");
  return dependent < 0;
}

template <class Real>
bool NewtonConstraints<Real>::solve_positions(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                                              VectorColumn<Real>& x, const Real& h) {
  equations.multipliers().setZero();
  free_ = x;
  equations.round_to_grid(s.box(), x);
  equations.find_floors(s);
  if (iterate(equations, s, x, false)) return true;
  double reached = 0;
  if (h != Real(0) && follow(equations, s, x, h, &reached)) return true;
  free_ = equations.start();
  free_.add_scaled(h, s.velocities());
  equations.find_values(equations.seen(s, free_));
  Index equation = 0;
  const double stretched = equations.worst(&equation);
  const std::string why =
      stretched > 0.5 ? "has no solution" : fmt::format("has no solution beyond {:.2g} of the step", reached);
  equations.fail(s, equation,
                 fmt::format("{}: free motion violates it by {:.3g}, so the step is too large", why, stretched));
  return false;
}

/// Chord steps with the factors at hand, then Newton's, from `x` on. @return whether they end at rounding
template <class Real>
bool NewtonConstraints<Real>::iterate(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                                      VectorColumn<Real>& x, bool fresh) {
  double previous = std::numeric_limits<double>::infinity(), first = 0;
  for (int k = 0; k < most_iterations; ++k) {
    equations.find_values(equations.seen(s, x));
    Index worst_equation = 0;
    const double violation = equations.worst(&worst_equation);
    const double floor = equations.floor(worst_equation) / equations.scale(worst_equation);
    if (k == 0) first = violation;
    if (equations.settled() || (violation < 64 * floor && violation > previous / 2)) {  // rounding itself
      equations.measure(first, violation, k);
      return true;
    }
    if (!std::isfinite(violation) || (fresh && violation > 4 * previous)) return false;
    fresh = fresh || (k > 0 && violation > slow_contraction * previous && violation > 1000 * floor);
    previous = violation;
    if (fresh) {
      equations.find_gradients(equations.seen(s, x), new_);
      if (!equations.matrix().factorize_mixed(new_, equations.start_gradients())) return false;
      equations.matrix().solve_mixed(equations.values());
    } else {
      equations.matrix().solve(equations.values());
    }
    equations.multipliers() += equations.values();
    place(equations, s.box(), x);
    equations.count_iteration();
  }
  return false;
}

/// Where all of the multipliers put the particles: added to positions one by one, corrections below half an ulp would
/// be lost there, but not for the velocities.
template <class Real>
void NewtonConstraints<Real>::place(ConstraintEquations<Real>& equations, const Box& box, VectorColumn<Real>& x) const {
  x = free_;
  equations.push(x, equations.start_gradients(), equations.multipliers(), Real(1));
  equations.round_to_grid(box, x);
}

/// Goes to the solution along those of shorter steps: where Newton's method loses its way, and to tell whether there is
/// one at all that goes on from a step of 0.
template <class Real>
bool NewtonConstraints<Real>::follow(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                                     VectorColumn<Real>& x, const Real& h, double* reached) {
  Vector solved = Vector::Zero(equations.size());
  for (double stride = 0.5; *reached < 1;) {
    const double next = std::min(1.0, *reached + stride), growth = *reached > 0 ? next / *reached : 0;
    equations.multipliers() = Real(growth * growth) * solved;
    free_ = equations.start();
    free_.add_scaled(Real(next) * h, s.velocities());
    place(equations, s.box(), x);
    if (iterate(equations, s, x, true)) {
      solved = equations.multipliers();
      *reached = next;
      stride *= 2;
    } else if ((stride /= 2) < shortest_stride) {
      return false;
    }
  }
  return true;
}

template <class Real>
bool NewtonConstraints<Real>::has_lost(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s) const {
  using std::isfinite;
  for (Index e = 0; e < equations.size(); ++e) {
    if (isfinite(equations.values()[e])) continue;
    equations.fail(s, e, "has a relative velocity that is not a number");
    return true;
  }
  return false;
}

template <class Real>
void NewtonConstraints<Real>::project_velocities(ConstraintEquations<Real>& equations, ParticleSystem<Real>& s,
                                                 const Real& /*h*/) {
  Vector& multipliers = equations.values();
  const ConstraintGradients<Real>& here = equations.gradients();
  for (int pass = 0; pass < passes_; ++pass) {  // each takes away what rounding has left of the one before
    for (Index e = 0; e < equations.size(); ++e) multipliers[e] = equations.along(e, s.velocities(), here);
    if (pass == 0 && has_lost(equations, s)) return;
    equations.matrix().solve(multipliers);
    equations.push(s.velocities(), here, multipliers, Real(1));
  }
}

template <class Real>
std::unique_ptr<ConstraintStages<Real>> newton_constraints(const ConstraintEquations<Real>& equations) {
  return std::make_unique<NewtonConstraints<Real>>(equations);
}

template class NewtonConstraints<double>;
template class NewtonConstraints<Quad>;
template std::unique_ptr<ConstraintStages<double>> newton_constraints(const ConstraintEquations<double>&);
template std::unique_ptr<ConstraintStages<Quad>> newton_constraints(const ConstraintEquations<Quad>&);

}  // namespace noether
