#include "study/spectrum.hpp"

#include "engine/bodies.hpp"
#include "forces/sum.hpp"
#include "integrators/eigenvalues.hpp"
#include "integrators/force_motion.hpp"
#include "integrators/stiffness.hpp"
#include "numbers/error.hpp"
#include "study/candidate.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace noether {

namespace {

constexpr Index most_dense = 64;

/// Numbers between -1 and 1 that are the same in every run.
Vector<double> scattered(Index n, std::uint64_t seed) {
  Vector<double> v(n);
  for (Index i = 0; i < n; ++i) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    v[i] = static_cast<double>(seed >> 11U) / 4503599627370496.0 - 1;
  }
  return v;
}

std::vector<double> masses_of(const ParticleSystem<double>& s) {
  std::vector<double> masses;
  for (Index i = 0; i < s.size(); ++i) masses.push_back(s.masses()[i]);
  return masses;
}

/// out = da/dx in, shape (3 n): what a displacement does to the accelerations.
void displace(VectorField<double>& f, double t, const Vector<double>& y, const Vector<double>& in,
              Vector<double>& out) {
  const Index half = y.size() / 2;
  Vector<double> direction = Vector<double>::Zero(y.size()), above, below;
  direction.head(half) = in;
  if (f.has_derivative()) {
    f.derivative(t, y, 0, direction, above);
    out = above.tail(half);
    return;
  }
  const double size = std::max(y.head(half).cwiseAbs().maxCoeff(), 1e-300), length = in.cwiseAbs().maxCoeff();
  out.setZero(half);
  if (length == 0) return;
  const double step = 1e-5 * size / length;
  Vector<double> shifted = y + step * direction;
  f.acceleration(t, shifted, above);
  shifted = y - step * direction;
  f.acceleration(t, shifted, below);
  out = (above - below) / (2 * step);
}

void check_finite(const Vector<double>& v) {
  if (!v.allFinite()) throw Error("the forces are not finite in this state, so it has no frequencies");
}

/// Of few particles: every eigenvalue of - da/dx, tracers included.
Spectrum dense(VectorField<double>& f, double t, const Vector<double>& y) {
  const Index half = y.size() / 2;
  Matrix<double> A(half, half);
  Vector<double> unit = Vector<double>::Zero(half), column;
  for (Index j = 0; j < half; ++j) {
    unit[j] = 1;
    displace(f, t, y, unit, column);
    check_finite(column);
    A.col(j) = -column;
    unit[j] = 0;
  }
  const auto values = eigenvalues_of(A);
  if (!values) throw Error("the eigenvalues of the Hessian could not be found");
  Spectrum found;
  double size = 0;
  for (const std::complex<double>& lambda : *values) size = std::max(size, std::abs(lambda));
  for (const std::complex<double>& lambda : *values) {
    const double value = lambda.real();
    if (value > 1e-12 * size) found.fastest = std::max(found.fastest, std::sqrt(value));
    if (value < -1e-12 * size) found.steepest = std::max(found.steepest, std::sqrt(-value));
  }
  found.products = static_cast<int>(half);
  return found;
}

Spectrum of_system(VectorField<double>& f, double t, const Vector<double>& y) {
  Spectrum found;
  found.products = static_cast<int>(y.size());
  for (const std::complex<double>& value : eigenvalues_of(f, t, y)) {
    if (std::abs(value) > std::abs(found.stiffest)) found.stiffest = {value.real(), std::abs(value.imag())};
    if (std::abs(value.imag()) > 1e-9 * std::abs(value)) {
      found.fastest = std::max(found.fastest, std::abs(value.imag()));
    }
    found.steepest = std::max(found.steepest, value.real());
  }
  return found;
}

Spectrum spectrum_of(VectorField<double>& f, const ParticleSystem<double>& s, double t) {
  Vector<double> y;
  f.gather(s, y);
  if (f.particles() == 0) return of_system(f, t, y);
  if (f.particles() <= most_dense) return dense(f, t, y);
  const Extremes ends = lanczos(weighted_hessian(f, t, y, masses_of(s)), 3 * s.size());
  Spectrum found;
  found.fastest = ends.largest > 0 ? std::sqrt(ends.largest) : 0;
  found.steepest = ends.least < 0 ? std::sqrt(-ends.least) : 0;
  found.products = ends.products;
  found.converged = ends.converged;
  return found;
}

/// Fixed points hold their bodies: the last one of the forces, which takes back what those before it gave.
struct FixedPoints {
  static std::string name() { return "fixed_points"; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      if (s.bodies()->is_held(i)) out.accelerations().set(i, Vec3<Real>::Zero());
    }
  }
};

/// All that moves a scene as y' = f(t, y); of rigid bodies the motion of their centres, whatever turns them.
std::unique_ptr<VectorField<double>> motion_of(const Scene& scene) {
  if (!scene.hamiltonian.rotating) return field_of(scene);
  ForceField<double> forces = scene.hamiltonian.all_on_bodies(forces_of(scene));
  if (scene.particles.bodies()->any_held()) forces.add(FixedPoints{});
  return std::make_unique<ForceMotion<ForceField<double>, double>>(std::move(forces));
}

/// What goes along the way of a scene: its own method where that makes whole steps, else one that chooses them.
std::pair<Candidate, Setting> walker_of(const Scene& scene, bool whole_steps) {
  constexpr double tolerance = 1e-8;
  if (whole_steps) return {candidate(scene, scene.integrator.method), {.step = scene.integrator.step}};
  const bool turns = has_bodies(scene.particles);  // what moves points does not turn them
  return {candidate(scene, turns ? scene.integrator.method : "dop853"), {.tolerance = tolerance}};
}

/// How far a run looks ahead for frequencies [time]; 0: not at all.
double look_ahead(const Scene& scene) {
  const SceneIntegrator& own = scene.integrator;
  double end = own.until ? *own.until - own.start : 0;
  if (own.steps && own.step != 0) end = static_cast<double>(*own.steps) * own.step;
  if (own.step != 0) end = std::min(end > 0 ? end : 1000 * own.step, 1000 * own.step);
  return std::isfinite(end) && end > 0 ? end : 0;
}

}  // namespace

double Spectrum::shortest_period() const { return fastest > 0 ? 2 * M_PI / fastest : 0; }

Extremes lanczos(const Operator& A, Index n, double tolerance, int most) {
  Extremes found;
  const int longest = static_cast<int>(std::min<Index>(n, most));
  std::vector<Vector<double>> basis;
  std::vector<double> diagonal, beside;
  Vector<double> v = scattered(n, 20240229), w(n);
  v.normalize();
  while (found.products < longest) {
    basis.push_back(v);
    A(v, w);
    ++found.products;
    check_finite(w);
    diagonal.push_back(v.dot(w));
    for (int again = 0; again < 2; ++again) {
      for (const Vector<double>& one : basis) w -= one.dot(w) * one;
    }
    const double left = w.norm();
    const auto k = static_cast<Index>(diagonal.size());
    Eigen::SelfAdjointEigenSolver<Matrix<double>> solver;
    solver.computeFromTridiagonal(Eigen::Map<const Vector<double>>(diagonal.data(), k),
                                  Eigen::Map<const Vector<double>>(beside.data(), k - 1));
    found.least = solver.eigenvalues()[0];
    found.largest = solver.eigenvalues()[k - 1];
    const double size = std::max(std::abs(found.least), std::abs(found.largest));
    const auto residual = [&](Index j) { return left * std::abs(solver.eigenvectors()(k - 1, j)); };
    found.converged = std::max(residual(0), residual(k - 1)) <= tolerance * size || k == n;
    if (found.converged || left <= 1e-300) break;
    beside.push_back(left);
    v = w / left;
  }
  return found;
}

Operator weighted_hessian(VectorField<double>& f, double t, const Vector<double>& y,
                          const std::vector<double>& masses) {
  const auto n = static_cast<Index>(masses.size());
  Vector<double> root(3 * n);
  for (Index k = 0; k < 3; ++k) {
    for (Index i = 0; i < n; ++i) root[k * n + i] = std::sqrt(masses[static_cast<std::size_t>(i)]);
  }
  return [&f, t, y, root](const Vector<double>& in, Vector<double>& out) {
    Vector<double> displacement = in;
    for (Index i = 0; i < root.size(); ++i) displacement[i] = root[i] > 0 ? in[i] / root[i] : 0;
    displace(f, t, y, displacement, out);
    out = -out.cwiseProduct(root);
  };
}

/// Whether forces tell all of the motion, so that their frequencies are its own.
bool forces_tell_all(const Scene& scene) { return scene.system || scene.hamiltonian.splitting.only_forces; }

Spectrum spectrum_at(const Scene& scene, const ParticleSystem<double>& s) {
  if (!forces_tell_all(scene)) return {};
  const auto field = motion_of(scene);
  field->bind(s);
  return spectrum_of(*field, s, scene.integrator.start);
}

double drag_of(const Scene& scene) {
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (const double rate = force.force.claims().drag; rate != 0) return rate;
  }
  return 0;
}

bool is_linear(const Scene& scene) {
  if (!forces_tell_all(scene)) return false;
  const auto field = motion_of(scene);
  field->bind(scene.particles);
  const double t = scene.integrator.start;
  Vector<double> y, start, one, two;
  field->gather(scene.particles, y);
  field->rate(t, y, start);
  const double size = std::max(y.cwiseAbs().maxCoeff(), 1e-3);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Vector<double> d = 0.7 * size * scattered(y.size(), seed);
    field->rate(t, y + d, one);
    field->rate(t, y + 2 * d, two);
    const double change = (one - start).cwiseAbs().maxCoeff(), bend = (two - 2 * one + start).cwiseAbs().maxCoeff();
    if (!(bend <= 1e-10 * (change + start.cwiseAbs().maxCoeff()))) return false;
  }
  return true;
}

Spectrum spectrum_along(const Scene& scene) {
  if (!forces_tell_all(scene)) return {};
  const auto field = motion_of(scene);
  field->bind(scene.particles);
  Spectrum found = spectrum_of(*field, scene.particles, scene.integrator.start);
  const double end = look_ahead(scene);
  if (end == 0 || is_linear(scene) || !scene.hamiltonian.constraints.empty() || scene.system) return found;
  constexpr int looks = 64;
  try {
    const bool turns = has_bodies(scene.particles), whole_steps = turns && !scene.integrator.adaptive();
    const auto [who, setting] = walker_of(scene, whole_steps);
    Simulation<double> sim = assemble(variant(scene, who, setting));
    std::atomic<bool> over{false};
    sim.stop_on(&over);
    sim.on_progress([&](const Progress& now) { over = now.seconds > 1; });
    const double steps = whole_steps ? std::max(std::round(end / looks / setting.step), 1.0) : 0;
    for (int k = 1; k <= looks && !(k * steps * setting.step > end + setting.step / 2); ++k) {
      const Outcome came = whole_steps ? sim.run(static_cast<std::int64_t>(steps))
                                       : sim.run_until(scene.integrator.start + end * k / looks);
      if (!came.ok()) break;
      if (turns) field->bind(sim.particles());
      const Spectrum one = spectrum_of(*field, sim.particles(), sim.time());
      found.fastest = std::max(found.fastest, one.fastest);
      found.steepest = std::max(found.steepest, one.steepest);
      found.products += one.products;
      found.converged = found.converged && one.converged;
    }
  } catch (const Error&) {
    return found;  // frequencies of the start are all there is
  }
  return found;
}

}  // namespace noether
