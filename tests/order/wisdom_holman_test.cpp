#include "integrators/wisdom_holman.hpp"
#include "integrators/schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <string_view>
#include <vector>

namespace noether {
namespace {

using namespace noether::testing;

constexpr double duration = 1.5;

/// Errors below which the digits of a table may show: kernels of order 8 and more have 19, near-integrable ones 15.
double table_floor(const Scheme& scheme) {
  if (scheme.scheme_class == SchemeClass::near_integrable) return 1e-14;
  return scheme.order.classical < 8 ? 1e-12 : 1e-17;
}

/// Measured order of a scheme over a Wisdom-Holman splitting of a star with two heavy planets; `exact` comes from the
/// other splitting of the same Hamiltonian, into kinetic and potential energy.
void check_order(const Scheme& scheme, Coordinates coordinates, const ParticleSystem<Quad>& exact) {
  const auto start = planets(0.2, 2).as<Quad>();
  std::vector<ErrorPoint> points;
  for (const long n : ladder(4, scheme.order.classical < 4 ? 256 : scheme.order.classical < 6 ? 128 : 48)) {
    const double dt = duration / static_cast<double>(n);
    const WisdomHolman<Quad> hamiltonian({.coordinates = coordinates});
    points.push_back({dt, distance(run(hamiltonian, scheme, start, dt, n), exact)});
    if (points.back().error < table_floor(scheme)) break;
  }
  const auto used = finest(points, table_floor(scheme), 1e-2);
  INFO(scheme.name << " claims order " << scheme.order.classical << ", measured " << fitted_slope(used) << "\n"
                   << to_text(points));
  CHECK(used.size() == 3);
  CHECK(std::fabs(fitted_slope(used) - scheme.order.classical) < 0.2);
}

ParticleSystem<Quad> reference() {
  const KineticPotential<Gravity, Quad> hamiltonian(Gravity{});
  return run(hamiltonian, schemes::sofroniou_spaletta_10_s35, planets(0.2, 2).as<Quad>(), duration / 384, 384);
}

TEST_CASE("every scheme has its order over Kepler arcs in Jacobi coordinates", "[order][slow]") {
  const auto exact = reference();
  for (const Scheme* scheme : schemes::all()) check_order(*scheme, Coordinates::jacobi, exact);
}

TEST_CASE("every scheme that takes inexact kicks has its order over Kepler arcs in democratic coordinates",
          "[order][slow]") {
  const auto exact = reference();
  int tested = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->exact.find('B') != std::string_view::npos || scheme->scheme_class == SchemeClass::rkn) continue;
    check_order(*scheme, Coordinates::democratic, exact);
    ++tested;
  }
  CHECK(tested > 20);
}

}  // namespace
}  // namespace noether
