#include "constraints/constraint_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace noether {

namespace {

/// Constraint after constraint in sweeps, to a tolerance: SHAKE for positions, RATTLE for velocities.
/// @source RyckaertCiccottiBerendsen1977, Andersen1983
template <class Real> class SweepConstraints final : public ConstraintStages<Real> {
 public:
  explicit SweepConstraints(const ConstraintEquations<Real>& equations);

  bool prepare(ConstraintEquations<Real>& /*equations*/, const ParticleSystem<Real>& /*s*/) override { return true; }
  bool solve_positions(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s, VectorColumn<Real>& x,
                       const Real& h) override;
  void project_velocities(ConstraintEquations<Real>& equations, ParticleSystem<Real>& s, const Real& h) override;

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  /// The equation that a sweep finds violated most.
  struct Worst {
    double violation = 0;
    Index equation = 0;

    /// Whether a violation is above a tolerance; NaN is.
    bool takes(Index e, double relative, double tolerance) {
      if (!(relative <= violation)) equation = e;
      violation = relative <= violation ? violation : relative;
      return !(relative <= tolerance);
    }
  };

  void sweep(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s, VectorColumn<Real>& x, Worst& worst);
  void fail(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s, const Worst& worst) const;

  VectorColumn<Real> free_;   ///< where free motion alone would end
  std::vector<Real> values_;  ///< of one constraint
  std::vector<Vec3<Real>> gradients_;
};

template <class Real>
SweepConstraints<Real>::SweepConstraints(const ConstraintEquations<Real>& equations) : free_(equations.start()) {
  std::size_t values = 0, gradients = 0;
  for (const auto& group : equations.set().groups()) {
    values = std::max(values, at(group->equations()));
    gradients = std::max(gradients, at(group->equations() * group->particles()));
  }
  values_.resize(values);
  gradients_.resize(gradients);
}

template <class Real>
bool SweepConstraints<Real>::solve_positions(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                                             VectorColumn<Real>& x, const Real& /*h*/) {
  equations.multipliers().setZero();
  free_ = x;
  const ConstraintOptions& options = equations.options();
  Worst worst;
  double first = 0;
  for (Index k = 0; k <= options.most_iterations(); ++k) {
    worst.violation = 0;
    sweep(equations, s, x, worst);
    if (k == 0) first = worst.violation;
    if (worst.violation <= options.tolerance) {
      equations.measure(first, worst.violation, k);
      return true;
    }
    equations.count_iteration();
    if (!std::isfinite(worst.violation)) break;
  }
  fail(equations, s, worst);
  return false;
}

template <class Real>
void SweepConstraints<Real>::sweep(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                                   VectorColumn<Real>& x, Worst& worst) {
  using std::abs;
  const ConstraintLayout<Real>& layout = equations.layout();
  const ConstraintGradients<Real>& start = equations.start_gradients();
  const double tolerance = equations.options().tolerance;
  Index e = 0;
  for (const auto& group : equations.set().groups()) {
    const Index each = group->equations(), tied = group->particles();
    for (Index c = 0; c < group->size(); ++c) {
      for (Index k = 0; k < each; ++k, ++e) {
        group->values(equations.seen(s, x), c, c + 1, values_.data());
        const Real g = values_[at(k)];
        if (!worst.takes(e, static_cast<double>(abs(g)) / equations.scale(e), tolerance)) continue;
        group->gradients(equations.seen(s, x), c, c + 1, gradients_.data());
        Real slope(0);
        const std::size_t first = at(layout.first[at(e)]);
        for (std::size_t a = 0; a < at(tied); ++a) {
          slope += layout.inverse_mass[first + a] * dot(gradients_[at(k * tied) + a], start[first + a]);
        }
        const Real step = g / slope;
        equations.multipliers()[e] += step;
        for (std::size_t a = 0; a < at(tied); ++a) {
          x.add(layout.particle[first + a], -(layout.inverse_mass[first + a] * step) * start[first + a]);
        }
      }
    }
  }
}

template <class Real>
void SweepConstraints<Real>::fail(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                                  const Worst& worst) const {
  using std::abs;
  equations.find_values(equations.seen(s, free_));
  const double stretched =
      static_cast<double>(abs(equations.values()[worst.equation])) / equations.scale(worst.equation);
  if (stretched > 0.5) {
    equations.fail(
        s, worst.equation,
        fmt::format("has no solution: free motion violates it by {:.3g}, so the step is too large", stretched));
  } else {
    const ConstraintOptions& options = equations.options();
    equations.fail(s, worst.equation,
                   fmt::format("is not solved after {} sweeps: its violation is {:.3g}, but at most {} is allowed",
                               options.most_iterations(), worst.violation, options.tolerance));
  }
}

template <class Real>
void SweepConstraints<Real>::project_velocities(ConstraintEquations<Real>& equations, ParticleSystem<Real>& s,
                                                const Real& h) {
  using std::abs;
  const ConstraintOptions& options = equations.options();
  const ConstraintLayout<Real>& layout = equations.layout();
  const ConstraintGradients<Real>& here = equations.gradients();
  VectorColumn<Real>& v = s.velocities();
  Worst worst;
  for (Index sweep = 0; sweep <= options.most_iterations(); ++sweep) {
    worst.violation = 0;
    for (Index e = 0; e < layout.equations(); ++e) {
      const Real rate = equations.along(e, v, here);
      if (!worst.takes(e, static_cast<double>(abs(rate * h)) / equations.scale(e), options.tolerance)) continue;
      const std::size_t first = at(layout.first[at(e)]), end = at(layout.first[at(e) + 1]);
      Real slope(0);
      for (std::size_t a = first; a < end; ++a) slope += layout.inverse_mass[a] * norm2(here[a]);
      for (std::size_t a = first; a < end; ++a) {
        v.add(layout.particle[a], -(layout.inverse_mass[a] * (rate / slope)) * here[a]);
      }
    }
    if (worst.violation <= options.tolerance) return;
    equations.count_iteration();
    if (!std::isfinite(worst.violation)) break;
  }
  equations.fail(
      s, worst.equation,
      fmt::format(
          "still has a velocity across it after {} sweeps: {:.3g} of its scale in a step, but at most {} is allowed",
          options.most_iterations(), worst.violation, options.tolerance));
}

}  // namespace

template <class Real>
std::unique_ptr<ConstraintStages<Real>> sweep_constraints(const ConstraintEquations<Real>& equations) {
  return std::make_unique<SweepConstraints<Real>>(equations);
}

template std::unique_ptr<ConstraintStages<double>> sweep_constraints(const ConstraintEquations<double>&);
template std::unique_ptr<ConstraintStages<Quad>> sweep_constraints(const ConstraintEquations<Quad>&);

}  // namespace noether
