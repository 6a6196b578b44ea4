#include "constraints/constraint_solver.hpp"
#include "constraints/dependent_constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// What the particles may violate at the start: tables are printed with some digits.
constexpr double largest_start_violation = 1e-6;
/// A pivot this small beside its diagonal element: at the start one constraint follows from others.
constexpr double dependent_pivot = 1e-10;
/// Chord steps that gain less than this give way to fresh matrices.
constexpr double slow_contraction = 0.05;
constexpr int most_iterations = 30;
/// Parts of a step in which a solution is followed where it is hard to find.
constexpr double shortest_stride = 1.0 / 256;

template <class Real> constexpr double unit_roundoff() {
  return static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
}

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// What the rounding of a particle's coordinates is relative to [length].
template <class Real> Vec3<Real> size_of_position(const ParticleSystem<Real>& s, Index i, bool differences_only) {
  using std::abs;
  const Vec3<double>& edges = s.box().edges();
  const Vec3<Real> x = s.unwrapped(i);
  Vec3<Real> size;
  for (Index k = 0; k < 3; ++k) {
    const Real edge(edges[k]), far = abs(x[k]);
    size[k] = edge > far || (s.box().is_periodic() && differences_only) ? edge : far;
  }
  return size;
}

}  // namespace

// ---- setting up ----------------------------------------------------------------------------------------------------

template <class Real> void ConstraintSolver<Real>::bind(ParticleSystem<Real>& s) {
  if (s.low_words() != nullptr) {
    throw BadConstraints(
        "constraints are solved to the rounding of plain sums; they do not go with compensated = true");
  }
  failure_.reset();
  known_.reset();
  lay_out(s);
  check_reach(s);
  start_ = free_ = moved_ = start_of(s);
  if (s.phase().opened) return;  // a run that goes on stands where it stood
  check_start(s);
  check_independent(s);
  if (!settled()) {
    old_ = here_;
    VectorColumn<Real> x = start_;
    if (!solve_by_newton(s, x, Real(0))) throw BadConstraints(failure_->message);
    move_to(s, x);
    know(s);
    check_independent(s);
  }
  // As often as it gains something: velocities that are along the constraints already must stay what they are.
  double before = std::numeric_limits<double>::infinity();
  while (true) {
    double across = 0;
    for (Index e = 0; e < layout_.equations(); ++e) {
      Real size(0);
      for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
        using std::sqrt;
        size += sqrt(norm2(here_[at(a)]) * norm2(Vec3<Real>(s.velocities()[layout_.particle[at(a)]])));
      }
      if (!(size > Real(0))) continue;
      using std::abs;
      across = std::max(across, static_cast<double>(abs(along(e, s.velocities(), here_)) / size));
    }
    if (across <= 16 * unit_roundoff<Real>() || across > before / 2) break;
    before = across;
    project_by_newton(s);
  }
  iterations_ = 0;
}

template <class Real> void ConstraintSolver<Real>::lay_out(const ParticleSystem<Real>& s) {
  layout_ = {};
  layout_.first.push_back(0);
  scales_.clear();
  for (const auto& group : set_.groups()) {
    for (Index c = 0; c < group->size(); ++c) {
      for (Index e = 0; e < group->equations(); ++e) {
        for (Index k = 0; k < group->particles(); ++k) {
          const Index i = group->particle(c, k);
          if (i >= s.size() || !(s.masses()[i] > Real(0))) {
            throw BadConstraints(fmt::format("{} is tied by '{}', which needs a particle with a mass there",
                                             i < s.size() ? "'" + s.name(i) + "'" : fmt::format("particle {}", i),
                                             group->name()));
          }
          layout_.particle.push_back(i);
          layout_.inverse_mass.push_back(Real(1) / s.masses()[i]);
        }
        layout_.first.push_back(static_cast<Index>(layout_.particle.size()));
        scales_.push_back(group->scale(c));
        if (!(scales_.back() > 0)) {
          throw BadConstraints(fmt::format("the scale of {} is {}; a number above 0 is expected",
                                           set_.words(static_cast<Index>(scales_.size()) - 1, s), scales_.back()));
        }
      }
    }
  }
  matrix_.lay_out(layout_);
  std::size_t equations = 0, gradients = 0;
  for (const auto& group : set_.groups()) {
    equations = std::max(equations, at(group->equations()));
    gradients = std::max(gradients, at(group->equations() * group->particles()));
  }
  sweep_values_.resize(equations);
  sweep_gradients_.resize(gradients);
  const std::size_t entries = layout_.particle.size(), n = at(layout_.equations());
  for (ConstraintGradients<Real>* g : {&here_, &old_, &new_}) g->assign(entries, Vec3<Real>::Zero());
  g_.setZero(static_cast<Index>(n));
  lambda_.setZero(static_cast<Index>(n));
  floors_.assign(n, 0);
}

/// From half of an edge on another image may be as near as the one that is meant.
template <class Real> void ConstraintSolver<Real>::check_reach(const ParticleSystem<Real>& s) const {
  if (!s.box().is_periodic()) return;
  const double half = s.box().edges().minCoeff() / 2;
  Index equation = 0;
  for (const auto& group : set_.groups()) {
    for (Index c = 0; c < group->size(); ++c, equation += group->equations()) {
      if (group->reach(c) < half) continue;
      throw BadConstraints(fmt::format(
          "{}, {:.6g} apart, reaches half of an edge of the periodic box, {:.6g}: nearest images are no longer those "
          "that are tied; enlarge the box",
          set_.words(equation, s), group->reach(c), half));
    }
  }
}

template <class Real> void ConstraintSolver<Real>::check_start(const ParticleSystem<Real>& s) {
  know(s);
  find_floors(s);
  values(Positions(s));
  Index worst_equation = -1;
  double worst_residual = 0;
  for (Index e = 0; e < layout_.equations(); ++e) {
    const ConstraintPlace place = set_.place(e);
    const double residual = place.group->residual(place.constraint, static_cast<double>(g_[e]));
    // Positions far from where the constraint acts are known to fewer digits.
    const double allowed =
        largest_start_violation * std::max(1.0, floors_[at(e)] / (4 * unit_roundoff<Real>() * scales_[at(e)]));
    if (!std::isfinite(residual)) {
      throw BadConstraints(set_.words(e, s) + " has no finite value where its particles start");
    }
    if (residual <= allowed || residual <= worst_residual) continue;
    worst_equation = e;
    worst_residual = residual;
  }
  if (worst_equation < 0) return;
  throw BadConstraints(fmt::format("{} is violated at the start, by {:.3g} of its scale; up to {} is moved into place",
                                   set_.words(worst_equation, s), worst_residual, largest_start_violation));
}

template <class Real> void ConstraintSolver<Real>::check_independent(const ParticleSystem<Real>& s) {
  const Index dependent = matrix_.factorize(here_, Real(dependent_pivot));
  if (dependent >= 0) throw BadConstraints(dependent_words(set_, s, layout_, here_, dependent));
}

// ---- positions -----------------------------------------------------------------------------------------------------

template <class Real> bool ConstraintSolver<Real>::know(const ParticleSystem<Real>& s) {
  if (!known_ || *known_ != s.version()) {
    gradients(Positions(s), here_);
    known_ = s.version();
    matrix_.forget_factors();
  }
  if (matrix_.has_factors() || set_.options().solver == ConstraintMethod::rattle) return true;
  const Index dependent = matrix_.factorize(here_, Real(1000) * std::numeric_limits<Real>::epsilon());
  if (dependent >= 0) fail(s, dependent, "has become dependent on others (a singular set)");
  return dependent < 0;
}

template <class Real> void ConstraintSolver<Real>::advance_positions(ParticleSystem<Real>& s, const Real& h) {
  if (failure_ || !know(s)) return;
  std::swap(old_, here_);
  known_.reset();
  const bool in_box = s.box().is_periodic(), newton = set_.options().solver == ConstraintMethod::newton;
  if (in_box) {
    moved_ = start_;
    moved_.add_scaled(h, s.velocities());
  } else {
    start_ = s.positions();
    s.advance_positions(h);
  }
  VectorColumn<Real>& x = in_box ? moved_ : s.positions();
  if (newton ? solve_by_newton(s, x, h) : solve_by_sweeps(s, x)) {
    if (in_box) move_to(s, x);
    push(s.velocities(), old_, lambda_, Real(1) / h);
    gradients(Positions(s), here_);
    known_ = s.version();
    matrix_.forget_factors();
    Index turned = -1;
    if (on_this_side(&turned)) return;
    fail(s, turned, "would turn over: the step is too large");
  }
  if (!in_box) s.positions() = start_;
  known_.reset();
}

template <class Real> VectorColumn<Real> ConstraintSolver<Real>::start_of(const ParticleSystem<Real>& s) const {
  return s.box().is_periodic() ? VectorColumn<Real>(s.size()) : s.positions();
}
template <class Real>
ConstraintPositions<Real> ConstraintSolver<Real>::seen(const ParticleSystem<Real>& s,
                                                       const VectorColumn<Real>& x) const {
  return s.box().is_periodic() ? Positions(s, &x) : Positions(x);
}
template <class Real> void ConstraintSolver<Real>::move_to(ParticleSystem<Real>& s, const VectorColumn<Real>& x) const {
  if (!s.box().is_periodic()) {
    s.positions() = x;
    return;
  }
  for (Index i = 0; i < s.size(); ++i) s.shift(i, x[i], Vec3<Real>::Zero());
  s.moved();
}
/// What is solved for is what will be stored.
template <class Real> void ConstraintSolver<Real>::round_to_grid(const Box& box, VectorColumn<Real>& x) const {
  if constexpr (std::is_same_v<Real, double>) {
    if (!box.is_periodic()) return;
    for (const Index i : layout_.particle) {
      for (int k = 0; k < 3; ++k) x.component(k)[i] = box.on_grid(k, x.component(k)[i]);
    }
  }
}

/// The solution that goes on from a step of 0 has G(x) M^-1 G(x0)^T > 0 for each constraint by itself.
template <class Real> bool ConstraintSolver<Real>::on_this_side(Index* equation) const {
  for (Index e = 0; e < layout_.equations(); ++e) {
    Real sum(0);
    for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
      sum += layout_.inverse_mass[at(a)] * dot(here_[at(a)], old_[at(a)]);
    }
    if (sum > Real(0)) continue;
    *equation = e;
    return false;
  }
  return true;
}

template <class Real>
bool ConstraintSolver<Real>::solve_by_newton(const ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h) {
  lambda_.setZero();
  free_ = x;
  round_to_grid(s.box(), x);
  find_floors(s);
  if (iterate(s, x, false)) return true;
  double reached = 0;
  if (h != Real(0) && follow(s, x, h, &reached)) return true;
  free_ = start_;
  free_.add_scaled(h, s.velocities());
  values(seen(s, free_));
  Index equation = 0;
  const double stretched = worst(&equation);
  const std::string why =
      stretched > 0.5 ? "has no solution" : fmt::format("has no solution beyond {:.2g} of the step", reached);
  fail(s, equation, fmt::format("{}: free motion violates it by {:.3g}, so the step is too large", why, stretched));
  return false;
}

/// Chord steps with the factors at hand, then Newton's, from `x` on. @return whether they end at rounding
template <class Real>
bool ConstraintSolver<Real>::iterate(const ParticleSystem<Real>& s, VectorColumn<Real>& x, bool fresh) {
  double previous = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_iterations; ++k) {
    values(seen(s, x));
    if (settled()) return true;
    Index worst_equation = 0;
    const double violation = worst(&worst_equation);
    const double floor = floors_[at(worst_equation)] / scales_[at(worst_equation)];
    if (violation < 64 * floor && violation > previous / 2) return true;  // rounding itself
    if (!std::isfinite(violation) || (fresh && violation > 4 * previous)) return false;
    fresh = fresh || (k > 0 && violation > slow_contraction * previous && violation > 1000 * floor);
    previous = violation;
    if (fresh) {
      gradients(seen(s, x), new_);
      if (!matrix_.factorize_mixed(new_, old_)) return false;
      matrix_.solve_mixed(g_);
    } else {
      matrix_.solve(g_);
    }
    lambda_ += g_;
    place(s.box(), x);
    ++iterations_;
  }
  return false;
}

/// Where all of the multipliers put the particles: added to positions one by one, corrections below half an ulp would
/// be lost there, but not for the velocities.
template <class Real> void ConstraintSolver<Real>::place(const Box& box, VectorColumn<Real>& x) const {
  x = free_;
  push(x, old_, lambda_, Real(1));
  round_to_grid(box, x);
}

/// Goes to the solution along those of shorter steps: where Newton's method loses its way, and to tell whether there is
/// one at all that goes on from a step of 0.
template <class Real>
bool ConstraintSolver<Real>::follow(const ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h,
                                    double* reached) {
  Vector solved = Vector::Zero(layout_.equations());
  for (double stride = 0.5; *reached < 1;) {
    const double next = std::min(1.0, *reached + stride), growth = *reached > 0 ? next / *reached : 0;
    lambda_ = Real(growth * growth) * solved;
    free_ = start_;
    free_.add_scaled(Real(next) * h, s.velocities());
    place(s.box(), x);
    if (iterate(s, x, true)) {
      solved = lambda_;
      *reached = next;
      stride *= 2;
    } else if ((stride /= 2) < shortest_stride) {
      return false;
    }
  }
  return true;
}

template <class Real>
bool ConstraintSolver<Real>::solve_by_sweeps(const ParticleSystem<Real>& s, VectorColumn<Real>& x) {
  using std::abs;
  lambda_.setZero();
  free_ = x;
  const ConstraintOptions& options = set_.options();
  double violation = 0;
  Index worst_equation = 0;
  std::vector<Real>& value = sweep_values_;
  std::vector<Vec3<Real>>& gradient = sweep_gradients_;
  for (Index sweep = 0; sweep <= options.iterations; ++sweep) {
    violation = 0;
    Index e = 0;
    for (const auto& group : set_.groups()) {
      const Index each = group->equations(), tied = group->particles();
      for (Index c = 0; c < group->size(); ++c) {
        for (Index k = 0; k < each; ++k, ++e) {
          group->values(seen(s, x), c, c + 1, value.data());
          const Real g = value[at(k)];
          const double relative = static_cast<double>(abs(g)) / scales_[at(e)];
          if (!(relative <= violation)) worst_equation = e;
          violation = relative <= violation ? violation : relative;
          if (relative <= options.tolerance) continue;
          group->gradients(seen(s, x), c, c + 1, gradient.data());
          Real slope(0);
          const std::size_t first = at(layout_.first[at(e)]);
          for (std::size_t a = 0; a < at(tied); ++a) {
            slope += layout_.inverse_mass[first + a] * dot(gradient[at(k * tied) + a], old_[first + a]);
          }
          const Real step = g / slope;
          lambda_[e] += step;
          for (std::size_t a = 0; a < at(tied); ++a) {
            x.add(layout_.particle[first + a], -(layout_.inverse_mass[first + a] * step) * old_[first + a]);
          }
        }
      }
    }
    if (violation <= options.tolerance) return true;
    ++iterations_;
    if (!std::isfinite(violation)) break;
  }
  values(seen(s, free_));
  const double stretched = static_cast<double>(abs(g_[worst_equation])) / scales_[at(worst_equation)];
  if (stretched > 0.5) {
    fail(s, worst_equation,
         fmt::format("has no solution: free motion violates it by {:.3g}, so the step is too large", stretched));
  } else {
    fail(s, worst_equation,
         fmt::format("is not solved after {} sweeps: violation {:.3g}, {} asked", options.iterations, violation,
                     options.tolerance));
  }
  return false;
}

// ---- velocities ----------------------------------------------------------------------------------------------------

template <class Real> void ConstraintSolver<Real>::project_velocities(ParticleSystem<Real>& s, const Real& h) {
  if (failure_ || !know(s)) return;
  if (set_.options().solver == ConstraintMethod::newton) {
    project_by_newton(s);
  } else {
    project_by_sweeps(s, h);
  }
}

template <class Real> void ConstraintSolver<Real>::project_by_newton(ParticleSystem<Real>& s) {
  for (int pass = 0; pass < 2; ++pass) {  // the second takes away what rounding has left of the first
    for (Index e = 0; e < layout_.equations(); ++e) g_[e] = along(e, s.velocities(), here_);
    matrix_.solve(g_);
    push(s.velocities(), here_, g_, Real(1));
  }
}

template <class Real> bool ConstraintSolver<Real>::project_by_sweeps(ParticleSystem<Real>& s, const Real& h) {
  using std::abs;
  const ConstraintOptions& options = set_.options();
  double violation = 0;
  Index worst_equation = 0;
  for (Index sweep = 0; sweep <= options.iterations; ++sweep) {
    violation = 0;
    for (Index e = 0; e < layout_.equations(); ++e) {
      const Real rate = along(e, s.velocities(), here_);
      const double relative = static_cast<double>(abs(rate * h)) / scales_[at(e)];
      if (!(relative <= violation)) worst_equation = e;
      violation = relative <= violation ? violation : relative;
      if (relative <= options.tolerance) continue;
      Real slope(0);
      for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
        slope += layout_.inverse_mass[at(a)] * norm2(here_[at(a)]);
      }
      for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
        s.velocities().add(layout_.particle[at(a)], -(layout_.inverse_mass[at(a)] * (rate / slope)) * here_[at(a)]);
      }
    }
    if (violation <= options.tolerance) return true;
    ++iterations_;
    if (!std::isfinite(violation)) break;
  }
  fail(s, worst_equation,
       fmt::format("keeps a velocity across it after {} sweeps: {:.3g} of its scale in a step, {} asked",
                   options.iterations, violation, options.tolerance));
  return false;
}

template <class Real>
std::optional<typename ConstraintSolver<Real>::Vector> ConstraintSolver<Real>::holding(const ParticleSystem<Real>& s,
                                                                                       const VectorColumn<Real>& a) {
  if (!know(s)) return {};
  if (!matrix_.has_factors() && matrix_.factorize(here_, Real(0)) >= 0) return {};
  Vector rhs(layout_.equations());
  Index e = 0;
  for (const auto& group : set_.groups()) {
    group->curvatures(Positions(s), s.velocities(), rhs.data() + e);
    e += group->size() * group->equations();
  }
  for (e = 0; e < layout_.equations(); ++e) rhs[e] += along(e, a, here_);
  matrix_.solve(rhs);
  return rhs;
}

template <class Real> void ConstraintSolver<Real>::constrain(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  if (const auto multipliers = holding(s, a)) push(a, here_, *multipliers, Real(1));
}

template <class Real>
Mat3<Real> ConstraintSolver<Real>::virial(const ParticleSystem<Real>& s, const VectorColumn<Real>& a) {
  const auto multipliers = holding(s, a);
  if (!multipliers) return Mat3<Real>::Constant(std::numeric_limits<Real>::quiet_NaN());
  Mat3<Real> virial = Mat3<Real>::Zero();
  std::vector<Vec3<Real>> points;
  Index e = 0;
  for (const auto& group : set_.groups()) {
    points.resize(at(group->size() * group->particles()));
    group->points(Positions(s), points.data());
    for (Index c = 0; c < group->size(); ++c) {
      for (Index k = 0; k < group->equations(); ++k, ++e) {
        for (Index p = 0; p < group->particles(); ++p) {
          const Vec3<Real> force = -(*multipliers)[e] * here_[at(layout_.first[at(e)] + p)];
          virial += points[at(c * group->particles() + p)] * force.transpose();
        }
      }
    }
  }
  return virial;
}

// ---- pieces --------------------------------------------------------------------------------------------------------

template <class Real> void ConstraintSolver<Real>::gradients(const Positions& x, ConstraintGradients<Real>& out) const {
  Vec3<Real>* next = out.data();
  for (const auto& group : set_.groups()) {
    group->gradients(x, 0, group->size(), next);
    next += group->size() * group->equations() * group->particles();
  }
}

template <class Real> void ConstraintSolver<Real>::values(const Positions& x) {
  Real* next = g_.data();
  for (const auto& group : set_.groups()) {
    group->values(x, 0, group->size(), next);
    next += group->size() * group->equations();
  }
}

/// What rounding leaves of g: positions are stored to half an ulp, in a periodic box to that of its edge, and g itself
/// is a difference of numbers of its scale.
template <class Real> void ConstraintSolver<Real>::find_floors(const ParticleSystem<Real>& s) {
  using std::abs;
  const ConstraintGradients<Real>& g = known_ ? here_ : old_;
  for (Index e = 0; const auto& group : set_.groups()) {
    for (const Index end = e + group->size() * group->equations(); e < end; ++e) {
      double sum = 2 * scales_[at(e)];
      for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
        const Vec3<Real> size = size_of_position(s, layout_.particle[at(a)], group->keeps_momentum());
        for (Index k = 0; k < 3; ++k) sum += static_cast<double>(abs(g[at(a)][k] * size[k]));
      }
      floors_[at(e)] = unit_roundoff<Real>() * sum;
    }
  }
}

template <class Real> double ConstraintSolver<Real>::worst(Index* equation) const {
  using std::abs;
  double worst = -1;
  for (Index e = 0; e < layout_.equations(); ++e) {
    const double violation = static_cast<double>(abs(g_[e])) / scales_[at(e)];
    if (violation <= worst) continue;
    worst = violation;
    *equation = e;
    if (!std::isfinite(violation)) break;
  }
  return worst;
}

template <class Real> bool ConstraintSolver<Real>::settled() const {
  using std::abs;
  for (Index e = 0; e < layout_.equations(); ++e) {
    if (!(static_cast<double>(abs(g_[e])) <= floors_[at(e)])) return false;
  }
  return true;
}

template <class Real>
void ConstraintSolver<Real>::push(VectorColumn<Real>& column, const ConstraintGradients<Real>& g,
                                  const Vector& multipliers, const Real& factor) const {
  for (Index e = 0; e < layout_.equations(); ++e) {
    const Real strength = factor * multipliers[e];
    for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
      column.add(layout_.particle[at(a)], -(layout_.inverse_mass[at(a)] * strength) * g[at(a)]);
    }
  }
}

template <class Real>
Real ConstraintSolver<Real>::along(Index equation, const VectorColumn<Real>& v,
                                   const ConstraintGradients<Real>& g) const {
  Real sum(0);
  for (Index a = layout_.first[at(equation)]; a < layout_.first[at(equation) + 1]; ++a) {
    sum += dot(g[at(a)], v[layout_.particle[at(a)]]);
  }
  return sum;
}

template <class Real>
void ConstraintSolver<Real>::fail(const ParticleSystem<Real>& s, Index equation, const std::string& what) {
  const ConstraintPlace place = set_.place(equation);
  failure_ = Failure{Outcome::Kind::constraint_failure, place.group->particle(place.constraint, 0), "constraint",
                     set_.words(equation, s) + " " + what};
}

template class ConstraintSolver<double>;
template class ConstraintSolver<Quad>;

}  // namespace noether
