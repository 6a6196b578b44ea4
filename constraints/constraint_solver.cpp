#include "constraints/constraint_solver.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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
  start_ = free_ = s.positions();
  if (s.phase().opened) return;  // a run that goes on stands where it stood
  check_start(s);
  check_independent(s);
  if (!settled()) {
    old_ = here_;
    VectorColumn<Real> x = s.positions();
    if (!solve_by_newton(s, x, Real(0))) throw BadConstraints(failure_->message);
    s.positions() = x;
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

template <class Real> void ConstraintSolver<Real>::check_start(const ParticleSystem<Real>& s) {
  know(s);
  find_floors(s.positions());
  values(s.positions());
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
  if (dependent >= 0) throw BadConstraints(dependent_words(s, dependent));
}

/// Names the constraints whose gradients depend on each other: those in the null space of the matrix.
template <class Real>
std::string ConstraintSolver<Real>::dependent_words(const ParticleSystem<Real>& s, Index equation) const {
  constexpr Index most = 600;  // equations; of more the one that was found
  constexpr std::size_t most_named = 4;
  std::vector<std::string> named = {set_.words(equation, s)};
  if (layout_.equations() <= most) {
    const Eigen::MatrixXd matrix = coupling();
    for (Index e = 0; e < matrix.rows(); ++e) {
      if (matrix(e, e) > 0) continue;
      return set_.words(e, s) +
             " has no direction to act in there: its gradient vanishes; particles in line on a "
             "rigid_bar are held otherwise";
    }
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scale.asDiagonal() * matrix * scale.asDiagonal());
    named = most_involved(s, modes.eigenvectors().col(0).cwiseAbs());
  }
  const std::size_t left_out = named.size() > most_named ? named.size() - most_named : 0;
  named.resize(named.size() - left_out);
  return fmt::format("constraints depend on each other: {}{}; take one out", fmt::join(named, ", "),
                     left_out > 0 ? fmt::format(" and {} more", left_out) : "");
}

/// G M^-1 G^T at the known positions, every element.
template <class Real> Eigen::MatrixXd ConstraintSolver<Real>::coupling() const {
  const Index n = layout_.equations();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Index e = 0; e < n; ++e) {
    for (Index f = 0; f < n; ++f) {
      for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
        for (Index b = layout_.first[at(f)]; b < layout_.first[at(f) + 1]; ++b) {
          if (layout_.particle[at(a)] != layout_.particle[at(b)]) continue;
          matrix(e, f) += static_cast<double>(layout_.inverse_mass[at(a)] * dot(here_[at(a)], here_[at(b)]));
        }
      }
    }
  }
  return matrix;
}

/// Constraints with a share in a mode, the largest first; but one of each kind before all others: of a chain between
/// two fixed ends the many links say less than the ends.
template <class Real>
std::vector<std::string> ConstraintSolver<Real>::most_involved(const ParticleSystem<Real>& s,
                                                               const Eigen::VectorXd& share) const {
  std::vector<Index> order(at(share.size()));
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index e, Index f) { return share[e] > share[f] + 1e-9; });
  std::vector<std::string> named, kinds, others;
  const auto has = [](const std::vector<std::string>& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
  };
  for (const Index e : order) {
    const std::string words = set_.words(e, s), kind = set_.place(e).group->name();
    if (share[e] < 0.01 * share.maxCoeff()) break;
    if (has(named, words) || has(others, words)) continue;
    (has(kinds, kind) ? others : named).push_back(words);
    kinds.push_back(kind);
  }
  named.insert(named.end(), others.begin(), others.end());
  return named;
}

// ---- positions -----------------------------------------------------------------------------------------------------

template <class Real> bool ConstraintSolver<Real>::know(const ParticleSystem<Real>& s) {
  if (!known_ || *known_ != s.version()) {
    gradients(s.positions(), here_);
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
  start_ = s.positions();
  s.advance_positions(h);
  VectorColumn<Real>& x = s.positions();
  const bool newton = set_.options().solver == ConstraintMethod::newton;
  if (newton ? solve_by_newton(s, x, h) : solve_by_sweeps(s, x)) {
    push(s.velocities(), old_, lambda_, Real(1) / h);
    gradients(s.positions(), here_);
    known_ = s.version();
    matrix_.forget_factors();
    Index turned = -1;
    if (on_this_side(&turned)) return;
    fail(s, turned, "would turn over: the step is too large");
  }
  s.positions() = start_;
  known_.reset();
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
  find_floors(x);
  if (iterate(x, false)) return true;
  double reached = 0;
  if (h != Real(0) && follow(x, h, s.velocities(), &reached)) return true;
  free_ = start_;
  free_.add_scaled(h, s.velocities());
  values(free_);
  Index equation = 0;
  const double stretched = worst(&equation);
  const std::string why =
      stretched > 0.5 ? "has no solution" : fmt::format("has no solution beyond {:.2g} of the step", reached);
  fail(s, equation, fmt::format("{}: free motion violates it by {:.3g}, so the step is too large", why, stretched));
  return false;
}

/// Chord steps with the factors at hand, then Newton's, from `x` on. @return whether they end at rounding
template <class Real> bool ConstraintSolver<Real>::iterate(VectorColumn<Real>& x, bool fresh) {
  double previous = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_iterations; ++k) {
    values(x);
    if (settled()) return true;
    Index worst_equation = 0;
    const double violation = worst(&worst_equation);
    const double floor = floors_[at(worst_equation)] / scales_[at(worst_equation)];
    if (violation < 64 * floor && violation > previous / 2) return true;  // rounding itself
    if (!std::isfinite(violation) || (fresh && violation > 4 * previous)) return false;
    fresh = fresh || (k > 0 && violation > slow_contraction * previous && violation > 1000 * floor);
    previous = violation;
    if (fresh) {
      gradients(x, new_);
      if (!matrix_.factorize_mixed(new_, old_)) return false;
      matrix_.solve_mixed(g_);
    } else {
      matrix_.solve(g_);
    }
    lambda_ += g_;
    place(x);
    ++iterations_;
  }
  return false;
}

/// Where all of the multipliers put the particles: added to positions one by one, corrections below half an ulp would
/// be lost there, but not for the velocities.
template <class Real> void ConstraintSolver<Real>::place(VectorColumn<Real>& x) const {
  x = free_;
  push(x, old_, lambda_, Real(1));
}

/// Goes to the solution along those of shorter steps: where Newton's method loses its way, and to tell whether there is
/// one at all that goes on from a step of 0.
template <class Real>
bool ConstraintSolver<Real>::follow(VectorColumn<Real>& x, const Real& h, const VectorColumn<Real>& v,
                                    double* reached) {
  Vector solved = Vector::Zero(layout_.equations());
  for (double stride = 0.5; *reached < 1;) {
    const double next = std::min(1.0, *reached + stride), growth = *reached > 0 ? next / *reached : 0;
    lambda_ = Real(growth * growth) * solved;
    free_ = start_;
    free_.add_scaled(Real(next) * h, v);
    place(x);
    if (iterate(x, true)) {
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
          group->values(x, c, c + 1, value.data());
          const Real g = value[at(k)];
          const double relative = static_cast<double>(abs(g)) / scales_[at(e)];
          if (!(relative <= violation)) worst_equation = e;
          violation = relative <= violation ? violation : relative;
          if (relative <= options.tolerance) continue;
          group->gradients(x, c, c + 1, gradient.data());
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
  values(free_);
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

template <class Real> void ConstraintSolver<Real>::constrain(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  if (!know(s)) return;
  if (!matrix_.has_factors() && matrix_.factorize(here_, Real(0)) >= 0) return;
  Vector rhs(layout_.equations());
  Index e = 0;
  for (const auto& group : set_.groups()) {
    group->curvatures(s.positions(), s.velocities(), rhs.data() + e);
    e += group->size() * group->equations();
  }
  for (e = 0; e < layout_.equations(); ++e) rhs[e] += along(e, a, here_);
  matrix_.solve(rhs);
  push(a, here_, rhs, Real(1));
}

// ---- pieces --------------------------------------------------------------------------------------------------------

template <class Real>
void ConstraintSolver<Real>::gradients(const VectorColumn<Real>& x, ConstraintGradients<Real>& out) const {
  Vec3<Real>* next = out.data();
  for (const auto& group : set_.groups()) {
    group->gradients(x, 0, group->size(), next);
    next += group->size() * group->equations() * group->particles();
  }
}

template <class Real> void ConstraintSolver<Real>::values(const VectorColumn<Real>& x) {
  Real* next = g_.data();
  for (const auto& group : set_.groups()) {
    group->values(x, 0, group->size(), next);
    next += group->size() * group->equations();
  }
}

/// What rounding leaves of g: positions are stored to half an ulp, and g itself is a difference of numbers of its
/// scale.
template <class Real> void ConstraintSolver<Real>::find_floors(const VectorColumn<Real>& x) {
  using std::abs;
  const ConstraintGradients<Real>& g = known_ ? here_ : old_;
  for (Index e = 0; e < layout_.equations(); ++e) {
    double sum = 2 * scales_[at(e)];
    for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
      const Vec3<Real> position = x[layout_.particle[at(a)]];
      for (Index k = 0; k < 3; ++k) sum += static_cast<double>(abs(g[at(a)][k] * position[k]));
    }
    floors_[at(e)] = unit_roundoff<Real>() * sum;
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
