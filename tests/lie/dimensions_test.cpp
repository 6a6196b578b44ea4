/// Rotations of 2 to 8 dimensions: the inverse of the differential of the exponential, and orders of methods.

#include "integrators/first_order_system.hpp"
#include "integrators/lie/dexp.hpp"
#include "integrators/lie/linear_rotation.hpp"
#include "integrators/lie/rkmk.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

/// A frame of n dimensions whose rates at two times do not commute, but for n = 2.
template <Index n> struct SwayingFrame : RotationMatrix<n> {
  static constexpr std::string_view name() { return "swaying_frame"; }
  template <class Real> void rates(const Real& t, SmallMatrix<Real>& A) const {
    using std::cos, std::sin;
    for (Index i = 0; i < n; ++i) {
      for (Index k = i + 1; k < n; ++k) {
        const auto row = static_cast<double>(i + 1), column = static_cast<double>(k + 1);
        A(i, k) = sin(Real(row) * t) / Real(column) - Real(0.3) * cos(Real(column - row) * t);
      }
    }
  }
};

template <Index n> std::vector<double> swayed(Simulation<double> sim) {
  REQUIRE(sim.run_until(1).ok());
  return sim.particles().variables();
}
double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

template <Index n> void check_orders() {
  CAPTURE(n);
  const SwayingFrame<n> frame;
  // Of no group: extrapolation of the numbers of the matrix.
  const auto truth = swayed<n>(Simulation<double>(
      initial_state(frame, frame.start()), lie(frame, method("gragg_bulirsch_stoer", {.rtol = 1e-14, .atol = 1e-15}))));
  struct Row {
    const char* name;
    int order;
    double h;
  };
  for (const auto& [name, order, h] : {Row{"magnus_2", 2, 0.125},
                                       {"magnus_4", 4, 0.125},
                                       {"magnus_cf_4", 4, 0.125},
                                       {"magnus_6", 6, 0.125},
                                       {"rkmk_rk4", 4, 0.0625},
                                       {"rkmk_dormand_prince_5", 5, 0.0625},
                                       {"commutator_free_4", 4, 0.0625}}) {
    CAPTURE(name);
    MethodOptions options;
    if (methods::find(name)->adaptive) options.adaptive = false;
    const auto error = [&, which = std::string(name)](double step) {
      return farthest(
          swayed<n>(Simulation<double>(initial_state(frame, frame.start()), lie(frame, method(which, options)), step)),
          truth);
    };
    CHECK(std::abs(std::log2(error(h) / error(h / 2)) - order) < 0.35);
  }
}

template <std::size_t... k> void check_all_orders(std::index_sequence<k...> /*dimensions*/) {
  (check_orders<static_cast<Index>(k + 2)>(), ...);
}

/// Numbers between -1/2 and 1/2, the same every time.
Vector<Quad> some_element(Index count, unsigned seed) {
  Vector<Quad> u(count);
  for (Index i = 0; i < count; ++i) {
    seed = seed * 1664525U + 1013904223U;
    u[i] = Quad(static_cast<double>(seed >> 8U) / 16777216.0 - 0.5);
  }
  return u;
}

/// How far d/ds exp(u + s w) exp(-u) is from v at s = 0, with w = dexp^-1_u v to so many brackets.
template <Index n> double off_by_dexp(int terms, const Quad& size) {
  LinearRotationField<SwayingFrame<n>, Quad> group(SwayingFrame<n>{});
  const Index count = group.algebra();
  const Vector<Quad> u = size * some_element(count, 3), v = some_element(count, 17);
  InverseDexp<Quad> inverse(terms);
  inverse.bind(count);
  Vector<Quad> w(count), unit = Vector<Quad>::Zero(n * n), up, down, turned;
  inverse.apply(group, u, v, w);
  for (Index i = 0; i < n; ++i) unit[i * (n + 1)] = Quad(1);
  const Quad s(1e-9);
  group.act(Vector<Quad>(u + s * w), unit, up);
  group.act(Vector<Quad>(u - s * w), unit, down);
  group.act(u, unit, turned);
  double worst = 0;
  Index at = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index k = i + 1; k < n; ++k, ++at) {
      Quad found(0);
      for (Index j = 0; j < n; ++j) found += (up[n * i + j] - down[n * i + j]) / (Quad(2) * s) * turned[n * k + j];
      worst = std::max(worst, std::abs(static_cast<double>(found - v[at])));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("frames of every number of dimensions from 2 to 8 have the orders of their methods", "[lie]") {
  check_all_orders(std::make_index_sequence<7>());
}

TEST_CASE("dexp^-1 is the inverse of the differential of the exponential on SO(n), term by term", "[lie]") {
  CHECK(off_by_dexp<3>(20, Quad(0.5)) < 1e-15);
  CHECK(off_by_dexp<5>(20, Quad(0.5)) < 1e-15);
  CHECK(off_by_dexp<8>(20, Quad(0.25)) < 1e-15);
  // A series of so many brackets is off by the next one that is not 0.
  for (const auto& [terms, power] : {std::pair{0, 1}, {1, 2}, {2, 4}, {3, 4}, {4, 6}}) {
    CAPTURE(terms);
    const double coarse = off_by_dexp<5>(terms, Quad(0.125)), fine = off_by_dexp<5>(terms, Quad(0.0625));
    CHECK(std::abs(std::log2(coarse / fine) - power) < 0.1);
  }
}

TEST_CASE("on SO(5) Kutta's method needs its two brackets", "[lie]") {
  const SwayingFrame<5> frame;
  const auto end = [&](int terms, int steps) {
    LinearRotationField<SwayingFrame<5>, Quad> group(frame);
    Rkmk<Quad> kutta(*methods::find("rkmk_rk4"), {}, {"rk4", tableaus::rk4}, terms);
    kutta.bind(group);
    Vector<Quad> y = Vector<Quad>::Zero(25);
    for (Index i = 0; i < 5; ++i) y[6 * i] = Quad(1);
    const double h = 1. / steps;
    for (int k = 0; k < steps; ++k) kutta.step(group, Quad(k) * Quad(h), y, h);
    return y;
  };
  const Vector<Quad> truth = end(2, 256);
  for (const auto& [terms, order] : {std::pair{1, 3}, {2, 4}, {4, 4}}) {
    CAPTURE(terms);
    const auto error = [&, brackets = terms](int steps) {
      return static_cast<double>((end(brackets, steps) - truth).cwiseAbs().maxCoeff());
    };
    CHECK(std::abs(std::log2(error(32) / error(64)) - order) < 0.1);
  }
}

}  // namespace noether
