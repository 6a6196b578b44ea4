#include "study/linear_stability.hpp"

#include "forces/external_fields.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "study/kick_shares.hpp"
#include "study/multistep_roots.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace noether {

namespace {

using Matrix2 = Eigen::Matrix2d;

/// y' = lambda y in two real variables.
struct LinearMode {
  std::complex<double> lambda;

  static constexpr auto describe() { return part<LinearMode>("linear_mode", "one mode of a linear system"); }
  Index size() const { return 2; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Real a(lambda.real()), b(lambda.imag());
    dy[0] = a * y[0] - b * y[1];
    dy[1] = b * y[0] + a * y[1];
  }
};

/// The same as the motion of one coordinate, for methods over a Lagrangian: q'' = 2 Re(lambda) q' - |lambda|^2 q. Where
/// lambda is real that is critical damping, with lambda as its one rate.
struct ActionMode {
  std::complex<double> lambda;

  static constexpr auto describe() { return part<ActionMode>("action_mode", "one mode of a Lagrangian system"); }
  Index size() const { return 1; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    return (v[0] * v[0] - Real(std::norm(lambda)) * q[0] * q[0]) / Real(2);
  }
  bool forced() const { return lambda.real() != 0; }
  template <class Real>
  void force(const Real& /*t*/, const Vector<Real>& /*q*/, const Vector<Real>& v, Vector<Real>& f) const {
    f[0] = Real(2 * lambda.real()) * v[0];
  }
};

/// The same as a canonical system, for methods over an energy H(q, p): H = omega (q^2 + p^2)/2. Only what oscillates
/// without growing has one.
struct CanonicalMode {
  double omega;

  static constexpr auto describe() { return part<CanonicalMode>("canonical_mode", "one mode of a Hamiltonian system"); }
  Index size() const { return 1; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return Real(omega / 2) * (q[0] * q[0] + p[0] * p[0]);
  }
};

/// The step of a scheme for omega = 1, drag included; columns are what (1, 0) and (0, 1) become.
/// @param shares  what the kicks of each letter have of omega^2
Matrix2 walk_word(const std::vector<Stage>& word, double z, double drag, const std::map<char, double>& shares) {
  Matrix2 step = Matrix2::Identity();
  for (const Stage& stage : word) {
    const double w = static_cast<double>(stage.weight) * z;
    if (stage.letter == 'A') step.row(0) += w * step.row(1);
    if (const auto share = shares.find(stage.letter); share != shares.end())
      step.row(1) -= share->second * w * step.row(0);
    if (stage.letter == 'D') step.row(1) *= std::exp(-drag * w);
  }
  return step;
}

/// The step of a classical method from two unit vectors.
class ClassicalStep {
 public:
  ClassicalStep(const MethodChoice& choice, std::unique_ptr<VectorField<double>> field, ParticleSystem<double> start)
      : method_(make_method<double>(*choice.info, choice.options)), field_(std::move(field)) {
    field_->bind(start);
    second_ = field_->particles() > 0 ? 3 : 1;
    y_.resize(field_->size());
  }
  ClassicalStep(const ClassicalStep& other)
      : method_(other.method_->clone()), field_(other.field_->clone()), second_(other.second_), y_(other.y_) {}

  /// Not finite where no step can be made.
  Matrix2 operator()(double h) {
    Matrix2 step;
    for (int column = 0; column < 2; ++column) {
      y_.setZero();
      y_[column == 0 ? 0 : second_] = 1;
      method_->bind(*field_);
      if (method_->step(*field_, 0, y_, h).failure || !y_.allFinite()) return Matrix2::Constant(NAN);
      step(0, column) = y_[0];
      step(1, column) = y_[second_];
    }
    return step;
  }

 private:
  std::unique_ptr<Method<double>> method_;
  std::unique_ptr<VectorField<double>> field_;
  Index second_ = 1;
  Vector<double> y_;
};

bool remembers(const MethodInfo& info) {
  return info.family == "multistep" || info.name == "bdf" || info.name.starts_with("tao_");
}

bool is_over_action(const MethodChoice& choice) {
  return make_method<double>(*choice.info, choice.options)->claims().second_order_only;
}

/// Whether a method serves systems by their energy alone, not by any rates.
bool is_over_energy(const MethodChoice& choice) {
  const auto method = make_method<double>(*choice.info, choice.options);
  if (method->claims().second_order_only) return false;
  SystemMotion<LinearMode, double> rates(LinearMode{{0, 1}});
  rates.bind(initial_state(LinearMode{{0, 1}}, {1, 0}));
  try {
    method->bind(rates);
  } catch (const SchemeMismatch&) {
    return true;
  }
  return method->claims().conservative_only;
}

/// Whether theory has a mode of `ActionMode` for a scene and a method over a Lagrangian. A real rate is one of damping;
/// without damping it is one of a saddle, which the solution itself leaves. A discrete Lagrangian of a user knows
/// nothing of modes.
bool has_action_mode(const Scene& scene, const MethodChoice& choice, const std::complex<double>& lambda) {
  const std::span<const MethodInfo> known = methods::variational_list();
  if (std::none_of(known.begin(), known.end(), [&](const MethodInfo& info) { return &info == choice.info; }))
    return false;
  return lambda.imag() != 0 || (lambda.real() < 0 && scene.system && scene.system->field()->claims().dissipative);
}

/// Whether nothing but drifts and kicks, or rates, moves a scene.
bool drifts_and_kicks(const Scene& scene) {
  const SceneSplitting& splitting = scene.hamiltonian.splitting;
  return scene.system || (splitting.only_forces && splitting.own.empty() && !splitting.claims().velocity_forces);
}

StepMatrix classical_step(const MethodChoice& choice, const Mode& mode) {
  const double scale = mode.scale();
  std::unique_ptr<VectorField<double>> field;
  ParticleSystem<double> start(unit_system("reduced"));
  if (mode.lambda && is_over_action(choice)) {
    const ActionMode system{*mode.lambda / scale};
    field = std::make_unique<LagrangianMotion<ActionMode, double>>(system);
    start = initial_state(system, std::vector<double>{1, 0});
  } else if (mode.lambda && is_over_energy(choice)) {
    const CanonicalMode system{std::abs(mode.lambda->imag()) / scale};
    field = std::make_unique<CanonicalMotion<CanonicalMode, double>>(system);
    start = initial_state(system, {1, 0});
  } else if (mode.lambda) {
    const LinearMode system{*mode.lambda / scale};
    field = std::make_unique<SystemMotion<LinearMode, double>>(system);
    start = initial_state(system, {1, 0});
  } else {
    ForceField<double> forces;
    forces.add(HarmonicField{1});
    if (mode.rate > 0) forces.add(DragForce{{mode.rate / scale}});
    field = std::make_unique<ForceMotion<ForceField<double>, double>>(std::move(forces));
    start.add("mode", 1, {1, 0, 0}, {0, 0, 0});
  }
  return [step = ClassicalStep(choice, std::move(field), std::move(start))](double z) mutable { return step(z); };
}

/// How far the eigenvalues of a step are beyond meeting on the unit circle, smoothly in z: above 0 they are real, and
/// one is outside.
double excess(const Matrix2& step) {
  if (!step.allFinite()) return std::numeric_limits<double>::infinity();
  return std::abs(step.trace()) - 1 - step.determinant();
}

/// The z between two others at which a function is largest.
double peak_between(const std::function<double(double)>& f, double low, double high) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
  for (int k = 0; k < 60; ++k) {
    if (fa > fb) {
      high = std::exchange(b, std::exchange(a, b - golden * (b - low)));
      fb = std::exchange(fa, f(a));
    } else {
      low = std::exchange(a, std::exchange(b, a + golden * (high - a)));
      fa = std::exchange(fb, f(b));
    }
    if (high - low < 1e-10) break;
  }
  return (low + high) / 2;
}

/// Where a condition that fails at `low` begins to hold, by halving.
double first_true(const std::function<bool(double)>& holds, double low, double high) {
  for (int k = 0; k < 50 && high - low > 1e-9; ++k) {
    const double middle = (low + high) / 2;
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

/// Relative error of the mode's frequency and damping in one step.
double mode_error(const Matrix2& step, const Mode& mode, double z) {
  const std::complex<double> half = step.trace() / 2;
  const std::complex<double> root = std::sqrt(half * half - step.determinant());
  std::complex<double> exact = mode.lambda ? *mode.lambda / mode.scale() : std::complex<double>(0, 1);
  if (!mode.lambda && mode.rate > 0) {
    const double g = mode.rate / mode.omega / 2;
    exact = std::complex<double>(-g, 0) + std::sqrt(std::complex<double>(g * g - 1, 0));
  }
  double least = 1e300;
  for (const std::complex<double>& mu : {half + root, half - root}) {
    least = std::min(least, std::abs(std::log(mu) / (exact * z) - 1.0));
  }
  return least;
}

/// Phases of a step at which it comes back after n of them.
void find_resonances(const StepMatrix& step, double below, LinearTheory& found) {
  const auto phase = [&](double z) {
    const Matrix2 m = step(z);
    return std::acos(std::clamp(m.trace() / 2 / std::sqrt(std::max(m.determinant(), 1e-300)), -1.0, 1.0));
  };
  for (int n = 3; n <= 6; ++n) {
    const double angle = 2 * M_PI / n;
    double z = z_step;
    while (z < below && phase(z) < angle) z = next_z(z);
    if (z >= below) continue;
    found.resonances[n] = first_true([&](double at) { return phase(at) >= angle; }, z - z_step, z);
  }
}

void search(const StepMatrix& step, LinearTheory& found) {
  const auto unstable = [&](double z) { return growth_of(step(z)) > growth_threshold; };
  const auto beyond = [&](double z) { return excess(step(z)); };
  double before = 0, middle = 0, f0 = -1, f1 = -1;
  for (double z = z_step; z < largest_z && !found.limit; z = next_z(z)) {
    const double f2 = beyond(z);
    if (!std::isfinite(f2)) {
      found.solver = z;
      return;
    }
    std::optional<double> inside;
    if (unstable(z)) inside = z;
    if (f1 > f0 && f1 >= f2 && f1 > -0.05) {  // a peak the search may have stepped over
      const double peak = peak_between(beyond, before, z);
      if (unstable(peak) && (!inside || peak < *inside)) inside = peak;
    }
    if (inside) {
      double stable = *inside > middle && !unstable(middle) ? middle : before;
      if (stable > 0 && unstable(stable)) stable = 0;
      found.limit = first_true(unstable, stable, *inside);
      double end = *inside;
      while (end < largest_z && unstable(end)) end = next_z(end) - (z_step - 1e-4) * (end < 10 ? 1 : 0);
      if (end < largest_z) found.gap_end = first_true([&](double at) { return !unstable(at); }, *inside, end);
    }
    before = std::exchange(middle, z);
    f0 = std::exchange(f1, f2);
  }
}

/// Relative error of leapfrog's frequency with 20 steps a period.
double accuracy_of_twenty_steps() { return std::pow(M_PI / 10, 2) / 24 * (1 + 1e-3); }

/// The same for a multistep method: upward, with the end of the first gap.
LinearTheory theory_of(const MultistepRoots& roots) {
  LinearTheory found{.known = true, .limit = {}, .gap_end = {}, .accurate = 0, .solver = {}, .resonances = {}};
  if (roots.solver && *roots.solver < largest_z) found.solver = roots.solver;
  const double end = found.solver.value_or(largest_z), allowed = accuracy_of_twenty_steps();
  const auto unstable = [&](double z) { return roots.growth(z) > growth_threshold; };
  bool accurate = true;
  for (double before = 0, z = z_step; z < end && !found.gap_end; before = z, z = next_z(z)) {
    const bool grows = unstable(z);
    if (grows && !found.limit) found.limit = first_true(unstable, before, z);
    if (!grows && found.limit) found.gap_end = first_true([&](double at) { return !unstable(at); }, before, z);
    accurate = accurate && !grows && z < 3 && roots.error(z) <= allowed;
    if (accurate) found.accurate = z;
  }
  return found;
}

}  // namespace

double growth_of(const Matrix2& step) {
  const double half = step.trace() / 2, det = step.determinant(), square = half * half - det;
  if (square <= 1e-12 * std::max(1.0, half * half)) return std::sqrt(std::max(det, 0.0)) - 1;
  return std::abs(half) + std::sqrt(square) - 1;
}

int LinearTheory::resonance_at(double z) const {
  int nearest = 0;
  double closest = 0.1;
  for (const auto& [n, at] : resonances) {
    const double apart = std::abs(z / at - 1);
    if (apart < closest) nearest = n;
    closest = std::min(closest, apart);
  }
  return nearest;
}

std::optional<StepMatrix> step_matrix(const Scene& scene, const Candidate& who, const Mode& mode) {
  // Of a splitting of its own nobody knows what it makes of a mode.
  const bool drifts = who.joined || drifts_and_kicks(scene);
  if (!(mode.scale() > 0) || !drifts || !scene.integrator.decorators.empty()) return {};
  const Scene made = variant(scene, who, {.step = 1, .tolerance = 0});
  if (made.integrator.classical) {
    const MethodChoice& choice = *made.integrator.classical;
    if (remembers(*choice.info) || choice.info->gravity_only) return {};
    if (mode.lambda && is_over_action(choice) && !has_action_mode(made, choice, *mode.lambda)) return {};
    const bool grows = mode.lambda && std::abs(mode.lambda->real()) > 1e-6 * std::abs(mode.lambda->imag());
    if (grows && is_over_energy(choice)) return {};
    return classical_step(choice, mode);
  }
  HamiltonianClaims claims{.alphabet = "AB"};
  if (mode.rate > 0) {
    claims.alphabet = "ABD";
    claims.irreversible = "D";
    claims.dissipative = true;
  }
  const Scheme scheme = scheme_of(made.integrator);
  const bool several = std::any_of(made.hamiltonian.forces.begin(), made.hamiltonian.forces.end(),
                                   [](const SceneForce& force) { return force.force.claims().kicks != "B"; });
  std::map<char, double> shares = {{'B', 1}};
  if (several && (!scheme.is_composition() || scheme.nested)) {  // else all kicks stand at the same places
    shares = kick_shares(made);
    if (shares.empty()) return {};
    claims.kicks.clear();
    for (const auto& [letter, share] : shares) claims.kicks += letter;
    claims.alphabet = "A" + claims.kicks + claims.irreversible;
    claims.basic = std::string(claims.kicks.rbegin(), claims.kicks.rend()) + "A" + claims.kicks;
  }
  const CompositionOptions inner{.inner_steps = made.integrator.composition.inner_steps};
  const std::vector<Stage> word = fitted_word(scheme, claims, "mode", inner).stages;
  return [word, shares, drag = mode.rate / mode.omega](double z) { return walk_word(word, z, drag, shares); };
}

bool first_step_fails(const Scene& scene, const Candidate& who, const Mode& mode, double z) {
  // Its coupling is a frequency: the mode must have that of the scene.
  if (std::abs(mode.scale() - 1) > 1e-12 || mode.rate > 0 || !drifts_and_kicks(scene) ||
      !scene.integrator.decorators.empty())
    return false;
  const Scene made = variant(scene, who, {.step = 1, .tolerance = 0});
  if (!made.integrator.classical || !remembers(*made.integrator.classical->info)) return false;
  return !classical_step(*made.integrator.classical, mode)(z).allFinite();
}

LinearTheory linear_theory(const Scene& scene, const Candidate& who, const Mode& mode) {
  LinearTheory found;
  const std::optional<StepMatrix> step = step_matrix(scene, who, mode);
  if (!step) {
    const auto roots = multistep_roots(scene, who, mode);
    return roots ? theory_of(*roots) : found;
  }
  found.known = true;
  search(*step, found);
  const double below = std::min(found.limit.value_or(largest_z), found.solver.value_or(largest_z));
  find_resonances(*step, below, found);
  const double allowed = accuracy_of_twenty_steps();
  for (double z = z_step; z < std::min(below, 3.0) && mode_error((*step)(z), mode, z) <= allowed; z = next_z(z)) {
    found.accurate = z;
  }
  return found;
}

}  // namespace noether
