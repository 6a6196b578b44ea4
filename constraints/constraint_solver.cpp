#include "constraints/constraint_solver.hpp"

#include "constraints/dependent_constraints.hpp"
#include "constraints/distance.hpp"
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
    : equations_(other.equations_),
      lanes_(other.lanes_),
      others_(other.others_ ? std::make_unique<ConstraintEquations<Real>>(*other.others_) : nullptr),
      stages_(other.stages_ ? stages_for(moving()) : nullptr) {}

/// In 113 bits some solvers give way to Newton's method, which is exact there.
template <class Real> double ConstraintSolver<Real>::tolerance() const {
  constexpr MakeConstraintStages<Quad>* newton = newton_constraints<Quad>;
  const bool exact = std::is_same_v<Real, Quad> && info_of(set().options().solver).make_quad == newton;
  return exact ? 0 : set().tolerance();
}

template <class Real> void ConstraintSolver<Real>::save_work(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "iterations", work().iterations);
  save_value(saved, prefix + "measured", work().measured);
  save_value(saved, prefix + "log", work().log);
}

/// Checkpoints of earlier versions have iterations alone.
template <class Real> void ConstraintSolver<Real>::load_work(const SavedState& saved, const std::string& prefix) {
  ConstraintWork work;
  load_value(saved, prefix + "iterations", work.iterations);
  if (saved.contains(prefix + "measured")) {
    load_value(saved, prefix + "measured", work.measured);
    load_value(saved, prefix + "log", work.log);
  }
  restore(work);
}

template <class Real> void ConstraintSolver<Real>::bind(ParticleSystem<Real>& s) {
  if (s.low_words() != nullptr) {
    throw BadConstraints(
        "constraints are solved to the rounding of plain sums; they do not work with compensated = true");
  }
  others_.reset();
  equations_.lay_out(s);
  check_served(s);
  lay_out_lanes(s);
  stages_ = stages_for(moving());
  prepared_ = false;
  if (s.phase().opened) return;  // a run that goes on stands where it stood
  check_start(s);
  check_independent(s);
  start_on_constraints(s);
  moving().restore({});
}

template <class Real> void ConstraintSolver<Real>::check_served(const ParticleSystem<Real>& s) const {
  const ConstraintMethodInfo& info = info_of(set().options().solver);
  Index equation = 0;
  for (const auto& group : set().groups()) {
    if (info.distances_alone && dynamic_cast<const ConstraintsOf<Distance>*>(group.get()) == nullptr) {
      throw BadConstraints(fmt::format("{} is not a distance, which solver = \"{}\" is for; use \"newton\"",
                                       set().words(equation, s), info.name));
    }
    equation += group->size() * group->equations();
  }
}

template <class Real> void ConstraintSolver<Real>::lay_out_lanes(const ParticleSystem<Real>& s) {
  if constexpr (std::is_same_v<Real, double>) {
    ConstraintSet rest = lanes_.lay_out(set(), s);
    if (lanes_.empty()) return;
    others_ = std::make_unique<ConstraintEquations<Real>>(std::move(rest));
    others_->lay_out(s);
  }
}

/// Whatever the solver: to rounding.
template <class Real> void ConstraintSolver<Real>::start_on_constraints(ParticleSystem<Real>& s) {
  NewtonConstraints<Real> exact(equations_);
  if (!equations_.settled()) {
    equations_.start_here();
    VectorColumn<Real> x = equations_.start();
    if (!exact.solve_positions(equations_, s, x, Real(0))) throw BadConstraints(equations_.failure()->message);
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
  if (moving().know(s)) prepared_ = false;
  if (!prepared_) prepared_ = stages_->prepare(moving(), s);
  return prepared_;
}

template <class Real> void ConstraintSolver<Real>::advance_positions(ParticleSystem<Real>& s, const Real& h) {
  if (failure() || !prepare(s)) return;
  ConstraintEquations<Real>& equations = moving();
  VectorColumn<Real>& x = equations.move_freely(s, h);
  prepared_ = false;
  const bool none = equations.size() == 0;  // all are in lanes
  if ((none || stages_->solve_positions(equations, s, x, h)) && solve_in_lanes(s, x, h)) {
    equations.arrive(s, x, h);
    Index turned = -1;
    if (equations.on_this_side(&turned)) return;
    equations.fail(s, turned, "would turn over: the step is too large");
  }
  equations.turn_back(s);
}

template <class Real>
bool ConstraintSolver<Real>::solve_in_lanes(ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h) {
  if constexpr (std::is_same_v<Real, double>) {
    if (lanes_.empty() || h == 0) return true;
    const VectorColumn<double>& start = s.box().is_periodic() ? std::as_const(s).positions() : moving().start();
    const MoleculeLanes::Solved solved = lanes_.solve_positions(s, start, x, s.velocities(), h, moving().looks());
    moving().count_iterations(solved.sweeps);
    moving().measure(solved.before, solved.after, solved.sweeps);
    return std::all_of(solved.open.begin(), solved.open.end(),
                       [&](Index molecule) { return solve_alone(molecule, s, x, h); });
  } else {
    return true;
  }
}

namespace {

/// A molecule of a system by itself, and the solver of all cases for it.
struct MoleculeAlone {
  ParticleSystem<double> particles;
  ConstraintEquations<double> equations;
  std::unique_ptr<ConstraintStages<double>> stages;

  MoleculeAlone(const MoleculeLanes& lanes, Index molecule, const ParticleSystem<double>& s,
                const VectorColumn<double>& start)
      : particles(those_of(lanes.particles(molecule), s, start)), equations(lanes.constraints(molecule, particles)) {
    equations.lay_out(particles);
    stages = stages_for(equations);
    equations.know(particles);
  }

  static ParticleSystem<double> those_of(const std::vector<Index>& molecule, const ParticleSystem<double>& s,
                                         const VectorColumn<double>& start) {
    ParticleSystem<double> alone(s.units());
    if (s.box().is_periodic()) alone.set_box(s.box());
    for (const Index i : molecule) alone.add(s.name(i), s.masses()[i], start[i], s.velocities()[i]);
    return alone;
  }
  /// Velocities go back, and a failure, under the numbers of the system. @return whether there is none
  bool end(const std::vector<Index>& molecule, ParticleSystem<double>& s, ConstraintEquations<double>& all) const {
    all.count_iterations(equations.work().iterations);
    if (!equations.failure()) {
      for (std::size_t k = 0; k < molecule.size(); ++k)
        s.velocities().set(molecule[k], particles.velocities()[static_cast<Index>(k)]);
      return true;
    }
    Failure failure = *equations.failure();
    failure.particle = molecule[static_cast<std::size_t>(failure.particle)];
    all.fail(failure);
    return false;
  }
};

}  // namespace

template <class Real>
bool ConstraintSolver<Real>::solve_alone(Index molecule, ParticleSystem<Real>& s, VectorColumn<Real>& x,
                                         const Real& h) {
  if constexpr (std::is_same_v<Real, double>) {
    const std::vector<Index>& of = lanes_.particles(molecule);
    MoleculeAlone alone(lanes_, molecule, s, s.box().is_periodic() ? std::as_const(s).positions() : moving().start());
    if (alone.stages->prepare(alone.equations, alone.particles)) {
      VectorColumn<double>& end = alone.equations.move_freely(alone.particles, h);
      if (alone.stages->solve_positions(alone.equations, alone.particles, end, h)) {
        for (Index k = 0; k < alone.particles.size(); ++k) x.set(of[at(k)], end[k]);
        alone.equations.arrive(alone.particles, end, h);
        Index turned = -1;
        if (!alone.equations.on_this_side(&turned))
          alone.equations.fail(alone.particles, turned, "would turn over: the step is too large");
      }
    }
    return alone.end(of, s, moving());
  } else {
    return true;
  }
}

template <class Real>
bool ConstraintSolver<Real>::project_alone(Index molecule, ParticleSystem<Real>& s, const Real& h) {
  if constexpr (std::is_same_v<Real, double>) {
    MoleculeAlone alone(lanes_, molecule, s, std::as_const(s).positions());
    if (alone.stages->prepare(alone.equations, alone.particles))
      alone.stages->project_velocities(alone.equations, alone.particles, h);
    return alone.end(lanes_.particles(molecule), s, moving());
  } else {
    return true;
  }
}

template <class Real> bool ConstraintSolver<Real>::project_in_lanes(ParticleSystem<Real>& s, const Real& h) {
  if constexpr (std::is_same_v<Real, double>) {
    if (lanes_.empty()) return true;
    const MoleculeLanes::Solved solved = lanes_.project_velocities(s, h);
    moving().count_iterations(solved.sweeps);
    return std::all_of(solved.open.begin(), solved.open.end(),
                       [&](Index molecule) { return project_alone(molecule, s, h); });
  } else {
    return true;
  }
}

template <class Real> void ConstraintSolver<Real>::project_velocities(ParticleSystem<Real>& s, const Real& h) {
  if (failure() || !prepare(s)) return;
  if (project_in_lanes(s, h) && moving().size() > 0) stages_->project_velocities(moving(), s, h);
}

// ---- forces of constraints -----------------------------------------------------------------------------------------

template <class Real>
std::optional<typename ConstraintSolver<Real>::Vector> ConstraintSolver<Real>::holding(const ParticleSystem<Real>& s,
                                                                                       const VectorColumn<Real>& a) {
  equations_.know(s);
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
