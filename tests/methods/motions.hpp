#pragma once
/// Small motions for the tests of classical methods, and the shortest way to walk them.

#include "integrators/all_methods.hpp"
#include "integrators/vector_field.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace noether::test {

/// The energy of a motion of mass 1, and its secants: accelerations between q0 and q1 that do the work of its change.
template <class Real> struct MotionEnergy {
  std::function<Real(const Vector<Real>& y)> potential = {};
  std::function<void(const Vector<Real>& y0, const Vector<Real>& y1, Real* a)> secant = {};
};

/// q'' = a(t, q), or with velocities q'' = a(t, q, v), given by a function that writes a.
template <class Real> class Motion final : public VectorField<Real> {
 public:
  /// a = pull(t, y), y = (q, v).
  using Pull = std::function<void(const Real& t, const Vector<Real>& y, Real* a)>;

  Motion(Index half, Pull pull, bool velocity_dependent = false)
      : half_(half), velocity_dependent_(velocity_dependent), pull_(std::move(pull)) {}
  Motion(Index half, Pull pull, MotionEnergy<Real> energy) : Motion(half, std::move(pull)) {
    energy_ = std::move(energy);
  }

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<Motion>(*this); }
  FieldClaims claims() const override {
    return {
        .name = "motion", .second_order = true, .velocity_dependent = velocity_dependent_, .energy = has_potential()};
  }
  std::string signature() const override { return "motion"; }
  void bind(const ParticleSystem<Real>& /*s*/) override {}
  Index size() const override { return 2 * half_; }
  void gather(const ParticleSystem<Real>& /*s*/, Vector<Real>& /*y*/) const override {}
  void scatter(const Vector<Real>& /*y*/, ParticleSystem<Real>& /*s*/) const override {}
  EnergyTerms<Real> energy(const ParticleSystem<Real>& /*s*/) override { return {}; }
  bool has_potential() const override { return static_cast<bool>(energy_.potential); }
  Real potential(const Real& /*t*/, const Vector<Real>& y) override { return energy_.potential(y); }
  Vector<Real> masses() const override { return Vector<Real>::Ones(half_); }
  bool has_secant() const override { return static_cast<bool>(energy_.secant); }
  void secant(const Real& /*t*/, const Vector<Real>& y0, const Vector<Real>& y1, Vector<Real>& a) override {
    a.resize(half_);
    energy_.secant(y0, y1, a.data());
  }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

 protected:
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override {
    dy.resize(y.size());
    for (Index i = 0; i < half_; ++i) dy[i] = y[half_ + i];
    pull_(t, y, dy.data() + half_);
  }
  void accelerate(const Real& t, const Vector<Real>& y, Vector<Real>& a) override {
    a.resize(half_);
    pull_(t, y, a.data());
  }

 private:
  Index half_;
  bool velocity_dependent_;
  Pull pull_;
  MotionEnergy<Real> energy_;
};

/// q'' = -w^2 q.
template <class Real> Motion<Real> oscillator(double w = 1) {
  return {1, [w](const Real&, const Vector<Real>& y, Real* a) { a[0] = -Real(w) * Real(w) * y[0]; }};
}

/// Henon and Heiles in the plane.
template <class Real> Motion<Real> henon_heiles() {
  return {2, [](const Real&, const Vector<Real>& y, Real* a) {
            a[0] = -y[0] - Real(2) * y[0] * y[1];
            a[1] = -y[1] - y[0] * y[0] + y[1] * y[1];
          }};
}
/// Its start with a known state at t = 20.
template <class Real> Vector<Real> henon_heiles_start() { return Vector<Real>::Constant(4, Real(0.18)); }

/// q'' = -q / |q|^3 in the plane. With `velocity_dependent` it claims to depend on velocities, too.
template <class Real> Motion<Real> kepler(bool velocity_dependent = false) {
  const auto distance = [](const Vector<Real>& y) -> Real {
    using std::sqrt;
    return sqrt(y[0] * y[0] + y[1] * y[1]);
  };
  const auto pull = [](const Real&, const Vector<Real>& y, Real* a) {
    using std::sqrt;
    const Real r2 = y[0] * y[0] + y[1] * y[1], r3 = r2 * sqrt(r2);
    a[0] = -y[0] / r3;
    a[1] = -y[1] / r3;
  };
  if (velocity_dependent) return {2, pull, true};
  // 1/r1 - 1/r0 over r1^2 - r0^2 in closed form.
  const auto secant = [distance](const Vector<Real>& y0, const Vector<Real>& y1, Real* a) {
    const Real r0 = distance(y0), r1 = distance(y1), weight = Real(1) / (r0 * r1 * (r0 + r1));
    a[0] = -weight * (y0[0] + y1[0]);
    a[1] = -weight * (y0[1] + y1[1]);
  };
  return {2, pull,
          MotionEnergy<Real>{[distance](const Vector<Real>& y) -> Real { return Real(-1) / distance(y); }, secant}};
}
/// A pendulum, q'' = -sin q.
template <class Real> Motion<Real> pendulum() {
  const auto pull = [](const Real&, const Vector<Real>& y, Real* a) {
    using std::sin;
    a[0] = -sin(y[0]);
  };
  const auto secant = [](const Vector<Real>& y0, const Vector<Real>& y1, Real* a) {
    using std::sin;
    const Real half = (y1[0] - y0[0]) / Real(2);
    a[0] = -sin((y0[0] + y1[0]) / Real(2)) * (half == Real(0) ? Real(1) : Real(sin(half) / half));
  };
  const auto potential = [](const Vector<Real>& y) -> Real {
    using std::cos;
    return -cos(y[0]);
  };
  return {1, pull, MotionEnergy<Real>{potential, secant}};
}
/// At the pericenter of an orbit of semi-major axis 1.
template <class Real> Vector<Real> kepler_start(const Real& e) {
  using std::sqrt;
  Vector<Real> y(4);
  y << Real(1) - e, Real(0), Real(0), sqrt((Real(1) + e) / (Real(1) - e));
  return y;
}

/// Largest difference of a component.
template <class Real> double distance(const Vector<Real>& a, const Vector<Real>& b) {
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(static_cast<double>(a[i] - b[i])));
  return worst;
}

/// y after `steps` steps of h, from t = 0. The method is bound here.
template <class Real>
Vector<Real> walk(Method<Real>& method, VectorField<Real>& f, Vector<Real> y, double h, long steps) {
  method.bind(f);
  for (long n = 0; n < steps; ++n) {
    const StepResult made = method.step(f, Real(h) * Real(n), y, h);
    if (made.failure) throw Error(made.failure->message);
  }
  return y;
}

/// y at `end`, which may be below 0, by steps of the method's choice; the last one is cut. The method is bound here.
template <class Real> Vector<Real> travel(Method<Real>& method, VectorField<Real>& f, Vector<Real> y, const Real& end) {
  method.bind(f);
  Real t(0);
  while (std::abs(static_cast<double>(end - t)) > 1e-14 * std::abs(static_cast<double>(end))) {
    const StepResult made = method.step(f, t, y, static_cast<double>(end - t));
    if (made.failure) throw Error(made.failure->message);
    f.evaluations().rejected += made.rejected;
    t += Real(made.h);
  }
  // Steps are doubles: in Quad less than an ulp of them is left, and the tangent is as good as any method.
  Vector<Real> slope(y.size());
  f.rate(t, y, slope);
  for (Index i = 0; i < y.size(); ++i) y[i] += (end - t) * slope[i];
  return y;
}

/// What came of a journey: the error at its end, and the work.
struct Travelled {
  double error = 0;
  std::int64_t evaluations = 0, rejected = 0;
};

/// Kepler's ellipse of e = 0.6 (the double), from the pericenter once around to it.
/// @param velocity_dependent  whether the method is told that the force depends on velocities
template <class Real> Travelled once_around(Method<Real>& method, bool velocity_dependent = false) {
  using std::atan2;
  auto f = kepler<Real>(velocity_dependent);
  const auto start = kepler_start<Real>(Real(0.6));
  const auto end = travel<Real>(method, f, start, Real(8) * atan2(Real(1), Real(1)));
  return {distance(start, end), f.evaluations().force, f.evaluations().rejected};
}

/// A method by name, over `Real`.
template <class Real> std::unique_ptr<Method<Real>> make(const char* name, const MethodOptions& options = {}) {
  const MethodChoice choice = method(name, options);
  return make_method<Real>(*choice.info, choice.options);
}

}  // namespace noether::test
