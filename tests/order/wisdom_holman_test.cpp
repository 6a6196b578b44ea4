#include "integrators/wisdom_holman.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/damped.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <string_view>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

constexpr double arcs_duration = 1.5;

/// Errors below which the digits of a table may show: kernels of order 8 and more have 19, near-integrable ones 15.
double table_floor(const Scheme& scheme) {
  if (scheme.scheme_class == SchemeClass::near_integrable) return 1e-14;
  return scheme.order.classical < 8 ? 1e-12 : 1e-17;
}

/// Measured order of a scheme over a Wisdom-Holman splitting of a star with two heavy planets; `exact` comes from the
/// other splitting of the same Hamiltonian, into kinetic and potential energy.
template <class H> void check_order(const Scheme& scheme, const H& hamiltonian, const ParticleSystem<Quad>& exact) {
  const auto start = planets(0.2, 2).as<Quad>();
  std::vector<ErrorPoint> points;
  for (const long n : ladder(4, scheme.order.classical < 4 ? 256 : scheme.order.classical < 6 ? 128 : 48)) {
    const double dt = arcs_duration / static_cast<double>(n);
    points.push_back({dt, distance(run(hamiltonian, scheme, start, dt, n), exact)});
    if (points.back().error < table_floor(scheme)) break;
  }
  const auto used = finest(points, table_floor(scheme), 1e-2);
  INFO(scheme.name << " claims order " << scheme.order.classical << ", measured " << fitted_slope(used) << "\n"
                   << to_text(points));
  CHECK(used.size() == 3);
  CHECK(std::fabs(fitted_slope(used) - scheme.order.classical) < 0.2);
}

template <class... Fs> ParticleSystem<Quad> reference(const Fs&... forces) {
  const auto hamiltonian = kinetic_potential<Quad>(forces...);
  return run(hamiltonian, schemes::sofroniou_spaletta_10_s35, planets(0.2, 2).as<Quad>(), arcs_duration / 384, 384);
}

TEST_CASE("every scheme has its order over Kepler arcs in Jacobi coordinates", "[order][slow]") {
  const auto exact = reference(Gravity{});
  for (const Scheme* scheme : schemes::all()) check_order(*scheme, wisdom_holman<Quad>({}), exact);
}

TEST_CASE("every scheme but Nystroem's has its order over Kepler arcs in democratic coordinates", "[order][slow]") {
  const auto exact = reference(Gravity{});
  const auto democratic = wisdom_holman<Quad>({.coordinates = Coordinates::democratic});
  int tested = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->scheme_class == SchemeClass::rkn) continue;
    check_order(*scheme, democratic, exact);
    ++tested;
  }
  CHECK(tested > 40);
}

TEST_CASE("every scheme that takes kicks of order 2 has its order where velocities are scaled", "[order][slow]") {
  const auto exact = reference(Gravity{});
  for (const Coordinates coordinates : {Coordinates::whds, Coordinates::barycentric}) {
    CAPTURE(static_cast<int>(coordinates));
    const auto scaled = wisdom_holman<Quad>({.coordinates = coordinates});
    int tested = 0;
    for (const Scheme* scheme : schemes::all()) {
      // Tables of order 8 have such long sub-steps that their order shows at errors of other sizes only.
      if (scheme->scheme_class == SchemeClass::rkn || scheme->order.classical > 6) continue;
      if (!scheme->is_composition() && scheme->exact.find('B') != std::string_view::npos) continue;
      check_order(*scheme, scaled, exact);
      ++tested;
    }
    CHECK(tested > 15);
  }
}

TEST_CASE("a strong field beside the arcs leaves every scheme that is not refused its order", "[order][slow]") {
  const HarmonicField field{.k = 0.05};
  const auto exact = reference(Gravity{}, field);
  const auto jacobi = wisdom_holman<Quad>({}, field),
             democratic = wisdom_holman<Quad>({.coordinates = Coordinates::democratic}, field);
  int inexact = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->order.classical > 8) continue;  // at the digits of their tables before the order shows
    check_order(*scheme, jacobi, exact);
    const bool takes_kicks = scheme->is_composition() || scheme->exact.find('B') == std::string_view::npos;
    if (!takes_kicks || scheme->scheme_class == SchemeClass::rkn) continue;
    check_order(*scheme, democratic, exact);
    ++inexact;
  }
  CHECK(inexact > 15);
}

TEST_CASE("drag beside Kepler arcs leaves schemes with forward steps their order, to the two of a split drag",
          "[order]") {
  // There is no closed form: the other splitting with 64 times smaller steps stands in for it.
  const LinearDrag drag{.rate = 0.2};
  for (const Scheme* scheme : {&schemes::verlet, &schemes::saba_4, &schemes::symplectic_euler_a}) {
    const int order = scheme == &schemes::symplectic_euler_a ? 1 : 2;
    const auto jacobi = damped(wisdom_holman<Quad>({}), drag);
    const auto inertial = damped(kinetic_potential<Quad>(Gravity{}), drag);
    std::vector<ErrorPoint> points;
    for (const long n : {32, 64, 128, 256}) {
      const double dt = arcs_duration / static_cast<double>(n);
      const auto start = planets(0.2, 2).as<Quad>();
      const auto fine = run(inertial, schemes::verlet, start, dt / 64, 64 * n);
      points.push_back({dt, distance(run(jacobi, *scheme, start, dt, n), fine)});
    }
    INFO(scheme->name << "\n" << to_text(points));
    CHECK(std::fabs(fitted_slope(points) - order) < 0.2);
  }
}

TEST_CASE("a symmetric composition keeps its order over kicks that are not exact, whose halves it does not join",
          "[order]") {
  const HarmonicField field{.k = 0.3};
  const auto exact = reference(Gravity{}, field);
  const auto democratic = wisdom_holman<Quad>({.coordinates = Coordinates::democratic}, field);
  const auto slope = [&](const Scheme& scheme) {
    std::vector<ErrorPoint> points;
    for (const long n : {64, 128}) {
      const double dt = arcs_duration / static_cast<double>(n);
      points.push_back({dt, distance(run(democratic, scheme, planets(0.2, 2).as<Quad>(), dt, n), exact)});
    }
    return fitted_slope(points);
  };
  CHECK(std::fabs(slope(schemes::yoshida_4) - 4) < 0.2);
  Scheme joined = schemes::yoshida_4;  // as a word of its own, in which the kicks of its steps are one
  joined.substep_count = 0;
  joined.exact = "";
  CHECK(std::fabs(slope(joined) - 2) < 0.2);
}

}  // namespace
}  // namespace noether
