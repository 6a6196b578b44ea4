#include "integrators/stiffness.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/eigenvalues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Where explicit methods become unstable on the negative real axis, |h lambda|: that of `rk4`.
constexpr double explicit_limit = 2.785;
constexpr double mild = 1e3, stiff = 1e5;
/// A decay so much faster than what else goes on makes a run stiff.
constexpr double apart = 100;

Matrix<double> jacobian_by_differences(VectorField<double>& f, double t, const Vector<double>& y) {
  const Index n = y.size();
  Matrix<double> J(n, n);
  Vector<double> shifted = y, above(n), below(n);
  double size = 0;
  for (Index i = 0; i < n; ++i) size = std::max(size, std::abs(y[i]));
  if (size == 0) size = 1;
  for (Index j = 0; j < n; ++j) {
    // A variable that is 0 has no size of its own: it takes the part of the others that a difference can tell.
    const double step = 1e-5 * std::max(std::abs(y[j]), 1e-3 * size);
    shifted[j] = y[j] + step;
    f.rate(t, shifted, above);
    const double up = shifted[j];
    shifted[j] = y[j] - step;
    f.rate(t, shifted, below);
    const double width = up - shifted[j];
    for (Index i = 0; i < n; ++i) J(i, j) = (above[i] - below[i]) / width;
    shifted[j] = y[j];
  }
  return J;
}

}  // namespace

std::vector<std::complex<double>> eigenvalues_of(VectorField<double>& f, double t, const Vector<double>& y) {
  const Index n = y.size();
  if (n > most_eigenvalues) {
    throw Error(
        fmt::format("{} variables are too many for their eigenvalues; at most {} are expected", n, most_eigenvalues));
  }
  Matrix<double> J;
  if (!f.jacobian(t, y, J)) J = jacobian_by_differences(f, t, y);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      if (!std::isfinite(J(i, j))) throw Error(fmt::format("df[{}]/dy[{}] is not finite", i, j));
    }
  }
  const auto all = eigenvalues_of(J);
  if (!all) throw Error("the eigenvalues of the Jacobian could not be found");
  return *all;
}

Stiffness stiffness_of(const std::vector<std::complex<double>>& eigenvalues, double length) {
  Stiffness result;
  double size = 0;
  for (const auto& lambda : eigenvalues) size = std::max(size, std::abs(lambda));
  for (const auto& lambda : eigenvalues) {
    // What rounding leaves of an eigenvalue 0 is none.
    const double real = std::abs(lambda.real()) > 1e-10 * size ? lambda.real() : 0;
    result.fastest = std::max(result.fastest, std::abs(real));
    result.growth = std::max(result.growth, real);
    result.turning = std::max(result.turning, std::abs(lambda.imag()));
    if (real != 0) result.slowest = result.slowest == 0 ? std::abs(real) : std::min(result.slowest, std::abs(real));
  }
  result.ratio = std::isfinite(length) ? result.fastest * std::abs(length) : std::numeric_limits<double>::quiet_NaN();
  return result;
}

namespace {

/// Where a run comes by.
struct Place {
  double t;
  Vector<double> y;
};

/// The steps of a run, the start among them, as far as so many steps lead.
std::vector<Place> steps_of(VectorField<double>& f, const Vector<double>& start, double length, double begin,
                            std::int64_t most) {
  double size = 0;
  for (Index i = 0; i < start.size(); ++i) size = std::max(size, std::abs(start[i]));
  const MethodChoice choice = method("rodas_5p", {.rtol = 1e-4, .atol = 1e-9 * (size > 0 ? size : 1)});
  const auto stepper = make_method<double>(*choice.info, choice.options);
  stepper->bind(f);
  std::vector<Place> places = {{begin, start}};
  Vector<double> y = start;
  double t = begin;
  const double end = begin + length;
  while (std::abs(end - t) > 1e-12 * std::abs(length) && static_cast<std::int64_t>(places.size()) <= most) {
    const StepResult made = stepper->step(f, t, y, end - t);
    if (made.failure || !(std::abs(made.h) > 0)) break;
    t += made.h;
    places.push_back({t, y});
  }
  return places;
}

}  // namespace

StiffnessAlong stiffness_along(VectorField<double>& f, const Vector<double>& start, double length, double begin) {
  const double cube = std::pow(static_cast<double>(start.size()), 3);
  const auto most_steps = static_cast<std::int64_t>(std::clamp(3e9 / cube, 40.0, 2000.0));
  const auto most_places = static_cast<std::size_t>(std::clamp(2e8 / cube, 3.0, 64.0));
  const std::vector<Place> all = steps_of(f, start, length, begin, most_steps);
  const std::size_t last = all.size() - 1, parts = std::min(most_places - 1, last);
  StiffnessAlong found;
  Stiffness before, sums;
  double t = begin;
  for (std::size_t k = 0; k <= parts; ++k) {
    const Place& place = all[parts > 0 ? k * last / parts : 0];
    std::vector<std::complex<double>> eigenvalues = eigenvalues_of(f, place.t, place.y);
    if (length < 0) {
      for (auto& one : eigenvalues) one = -one;  // back in time what decays grows
    }
    const Stiffness now = stiffness_of(eigenvalues, std::abs(length));
    const double half = std::abs(place.t - t) / 2;  // trapezoids
    sums.fastest += half * (before.fastest + now.fastest);
    sums.growth += half * (before.growth + now.growth);
    sums.turning += half * (before.turning + now.turning);
    if (now.slowest > 0) sums.slowest = sums.slowest > 0 ? std::min(sums.slowest, now.slowest) : now.slowest;
    if (k == 0 || now.fastest > found.fastest) {
      found.fastest = now.fastest;
      found.at = place.t;
    }
    before = now;
    t = place.t;
    ++found.places;
  }
  found.reached = t;
  const double seen = std::abs(t - begin);
  found.mean = seen > 0 ? Stiffness{.fastest = sums.fastest / seen,
                                    .slowest = sums.slowest,
                                    .growth = sums.growth / seen,
                                    .turning = sums.turning / seen}
                        : before;
  found.mean.ratio = found.mean.fastest * std::abs(length);
  return found;
}

std::string Stiffness::verdict() const {
  if (fastest == 0)
    return turning > 0 ? "not stiff: nothing decays, the system oscillates" : "not stiff: nothing decays";
  if (std::isnan(ratio)) {
    return fmt::format("the fastest rate is {:.3g}; how stiff a run is depends on its length, which is not given",
                       fastest);
  }
  const std::string s = fmt::format("S = {:.3g}", ratio);
  if (fastest < apart * std::max(growth, turning)) {
    return fmt::format("not stiff: {}, but what {} is about as fast, and needs as many steps", s,
                       growth > turning ? "grows" : "oscillates");
  }
  const double steps = ratio / explicit_limit;
  if (ratio < mild) return fmt::format("not stiff: {}; an explicit method such as dop853 is enough", s);
  if (ratio < stiff) {
    return fmt::format(
        "mildly stiff: {}; an explicit method needs at least about {:.2g} steps; compare dop853 with "
        "rodas_5p",
        s, steps);
  }
  return fmt::format("stiff: {}; an explicit method needs about {:.2g} steps; use rodas_5p or bdf", s, steps);
}

}  // namespace noether
