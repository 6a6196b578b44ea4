#pragma once
/// Systems that the implicit methods are tested on, and the shortest way to let a method go.

#include "integrators/all_methods.hpp"
#include "integrators/first_order_system.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether::test {

/// y' = y^2 cos t, z' = -3 (z - y^2) + 2 y y': y = 1 / (2 - sin t), z = y^2. Smooth, nonlinear, time-dependent.
struct Smooth {
  static std::string_view name() { return "smooth"; }
  static Index size() { return 2; }
  template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
    using std::cos;
    const Real square = y[0] * y[0];
    dy[0] = square * cos(t);
    dy[1] = Real(-3) * (y[1] - square) + Real(2) * y[0] * dy[0];
  }
  template <class Real> static Vector<Real> solution(const Real& t) {
    using std::sin;
    Vector<Real> y(2);
    y[0] = Real(1) / (Real(2) - sin(t));
    y[1] = y[0] * y[0];
    return y;
  }
};

/// The same for doubles only: its Jacobian has to be found by differences.
struct SmoothInDouble {
  static std::string_view name() { return "smooth_in_double"; }
  static Index size() { return 2; }
  void rates(const double& t, const Vector<double>& y, Vector<double>& dy) const { Smooth{}.rates(t, y, dy); }
};

/// y' = lambda y.
struct Linear {
  double lambda = -1;
  static std::string_view name() { return "linear"; }
  static Index size() { return 1; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = Real(lambda) * y[0];
  }
};

/// y'' = -omega^2 y as a system of first order, y = (q, v / omega).
struct Rotation {
  double omega = 1;
  static std::string_view name() { return "rotation"; }
  static Index size() { return 2; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = Real(omega) * y[1];
    dy[1] = -Real(omega) * y[0];
  }
};

/// Robertson's kinetics: three rates that are eleven decades apart.
/// @source Robertson1966
struct Kinetics {
  static std::string_view name() { return "kinetics"; }
  static Index size() { return 3; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Real slow = Real(0.04) * y[0], middle = Real(1e4) * y[1] * y[2], fast = Real(3e7) * y[1] * y[1];
    dy[0] = middle - slow;
    dy[1] = slow - middle - fast;
    dy[2] = fast;
  }
};

/// Prothero and Robinson's y' = lambda (y - phi) + phi', phi = sin(t + 1/4): the solution is phi, however stiff.
struct StiffPull {
  double lambda = -1e6;
  static std::string_view name() { return "stiff_pull"; }
  static Index size() { return 1; }
  template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
    using std::cos, std::sin;
    dy[0] = Real(lambda) * (y[0] - sin(t + Real(0.25))) + cos(t + Real(0.25));
  }
};

/// Heat on a line of length 1 that is cold at both ends, y_i at x = i dx, dx = 1 / (n + 1), in second differences.
struct Heat {
  Index n = 10;
  bool tell_sparsity = true;
  static std::string_view name() { return "heat"; }
  Index size() const { return n; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Real per = Real(static_cast<double>((n + 1) * (n + 1)));
    for (Index i = 0; i < n; ++i) {
      const Real left = i > 0 ? y[i - 1] : Real(0), right = i + 1 < n ? y[i + 1] : Real(0);
      dy[i] = per * (left - Real(2) * y[i] + right);
    }
  }
  Sparsity sparsity() const {
    Sparsity rows(tell_sparsity ? static_cast<std::size_t>(n) : 0);
    for (std::size_t j = 0; j < rows.size(); ++j) {
      for (Index i = std::max<Index>(static_cast<Index>(j) - 1, 0); i < std::min<Index>(static_cast<Index>(j) + 2, n);
           ++i) {
        rows[j].push_back(i);
      }
    }
    return rows;
  }
  /// sin(pi x) + sin(3 pi x) / 2: two of its modes.
  Vector<double> start() const {
    Vector<double> y(n);
    const double pi = std::acos(-1.0), dx = 1 / static_cast<double>(n + 1);
    for (Index i = 0; i < n; ++i) {
      const double x = static_cast<double>(i + 1) * dx;
      y[i] = std::sin(pi * x) + 0.5 * std::sin(3 * pi * x);
    }
    return y;
  }
};

/// The method of a name, with steps of one length.
inline MethodChoice with_fixed_steps(const std::string& name) {
  const MethodInfo* info = methods::find(name);
  MethodOptions options;
  if (info != nullptr && info->adaptive) options.adaptive = false;
  if (info != nullptr && info->family == "collocation") options.jacobian = JacobianForm::dense;  // sweeps do not get on
  return method(name, options);
}

/// Where a method got to, and what it took.
template <class Real> struct Reached {
  Vector<Real> y;
  double t = 0;
  std::int64_t steps = 0, rejected = 0;
  Evaluations evaluations = {};
  std::optional<Failure> failure = {};
};

/// A field that serves a system, bound.
template <class Real, class S> std::unique_ptr<VectorField<Real>> field_of(const S& system, const Vector<Real>& y) {
  ParticleSystem<Real> carrier;
  for (Index i = 0; i < y.size(); ++i) carrier.variables().push_back(y[i]);
  auto field = std::make_unique<SystemMotion<S, Real>>(system);
  field->bind(carrier);
  return field;
}

/// `steps` steps of `h` [time] from t = 0.
template <class Real>
Reached<Real> march(VectorField<Real>& field, const MethodChoice& choice, const Vector<Real>& y, double h,
                    std::int64_t steps) {
  const auto method = make_method<Real>(*choice.info, choice.options);
  method->bind(field);
  Reached<Real> reached{.y = y};
  for (; reached.steps < steps && !reached.failure; ++reached.steps) {
    reached.failure = method->step(field, Real(static_cast<double>(reached.steps)) * Real(h), reached.y, h).failure;
  }
  reached.evaluations = field.evaluations();
  return reached;
}
template <class Real, class S>
  requires FirstOrderSystem<S, Real> Reached<Real> march(const S& system, const MethodChoice& choice,
                                                         const Vector<Real>& y, double h, std::int64_t steps) {
    return march(*field_of<Real>(system, y), choice, y, h, steps);
  }

/// Steps of the method's own choice from t = 0 to t = `end`, the last of them shortened.
template <class Real, class S>
Reached<Real> march_to(const S& system, const MethodChoice& choice, const Vector<Real>& y, double end) {
  const auto field = field_of<Real>(system, y);
  const auto method = make_method<Real>(*choice.info, choice.options);
  method->bind(*field);
  Reached<Real> reached{.y = y};
  Real t(0);
  while (t < Real(end) && !reached.failure) {
    const double left = static_cast<double>(Real(end) - t);
    method->next_step(*field, t, reached.y, left);
    const StepResult made = method->step(*field, t, reached.y, left);
    t = made.h < left ? t + Real(made.h) : Real(end);
    ++reached.steps;
    reached.rejected += made.rejected;
    reached.failure = made.failure;
  }
  reached.t = static_cast<double>(t);
  reached.evaluations = field->evaluations();
  return reached;
}

/// Largest difference of a component.
template <class Real> double apart(const Vector<Real>& a, const Vector<Real>& b) {
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(static_cast<double>(a[i] - b[i])));
  return worst;
}

}  // namespace noether::test
