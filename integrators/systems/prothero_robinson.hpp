#pragma once
/// The problem of Prothero and Robinson: how much order a stiff method loses.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace noether {

/// A smooth solution that everything beside it falls onto at once, where methods lose order.
///
///     y' = lambda (y - g(t)) + g'(t),   g(t) = sin(omega t + pi/4);   y = g where it begins there
/// @source ProtheroRobinson1974
struct ProtheroRobinson {
  double lambda = -1e6;  ///< how fast others fall onto the solution [1/time]
  double omega = 1;      ///< of the solution [1/time]

  static constexpr auto describe() {
    return part<ProtheroRobinson>(
        "prothero_robinson", "one variable that follows a sine, pulled to it at a stiff rate",
        formula("y' = lambda (y - g(t)) + g'(t),  g(t) = sin(omega t + pi/4)"), source("ProtheroRobinson1974"),
        quantities("y [1]"), field<&ProtheroRobinson::lambda>("lambda", "1/time", "below 0: stable"),
        field<&ProtheroRobinson::omega>("omega", "1/time", "angular frequency of the solution"));
  }

  Index size() const { return 1; }
  std::vector<double> start() const { return exact(0); }
  /// On the solution, at whatever time a run begins.
  std::vector<double> start_at(double t) const { return exact(t); }
  /// The solution that begins at `start()`.
  std::vector<double> exact(double t) const { return {std::sin(omega * t + phase)}; }

  template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
    using std::cos, std::sin;
    const Real angle = Real(omega) * t + Real(phase);
    dy[0] = Real(lambda) * (y[0] - sin(angle)) + Real(omega) * cos(angle);
  }

 private:
  static constexpr double phase = std::numbers::pi / 4;
};

}  // namespace noether
