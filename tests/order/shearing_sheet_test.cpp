/// Schemes over a shearing sheet: the order that each claims, and how those for near-integrable systems see the masses.

#include "integrators/shearing_sheet.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

constexpr double duration = 3;
constexpr ShearingSheetOptions frame{.Omega = 1, .Omega_z = 1.25};

AnyHamiltonian<Quad> sheet() { return frame.split<Quad>(field_of<Quad>(Gravity{})); }

/// Two bodies that pass each other at a distance of about 1.
ParticleSystem<Quad> pair_of(double mass) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("one", mass, {-0.5, 1.25, 0.125}, {0.125, 0.75, 0});
  s.add("other", 0.5 * mass, {0.75, -0.5, -0.25}, {0, -1.125, 0.25});
  return s.as<Quad>();
}

/// By a method that does not split, over the forces of the frame.
ParticleSystem<Quad> exact(const ParticleSystem<Quad>& start) {
  const auto& [forces] = frame.forces();
  auto gauss = classical_over(field_of<Quad>(forces, Gravity{}), method("gauss_8", {.adaptive = false}));
  return run(gauss, start, duration / 192, 192);
}

/// What the digits of a table may show (order_test.cpp); here those of order 6 are seen to hold further down.
double digits_floor(const Scheme& scheme) {
  const int order = scheme.order.classical;
  return order >= 8 ? 1e-18 : order % 2 == 1 ? 1e-15 : order == 6 ? 1e-14 : 1e-12;
}

}  // namespace

TEST_CASE("every scheme has its order over a shearing sheet", "[order][shearing_sheet][slow]") {
  const auto truth = exact(pair_of(0.5));
  for (const Scheme* scheme : schemes::all()) {
    const auto kicks =
        std::count_if(scheme->word.begin(), scheme->word.end(), [](const Stage& stage) { return stage.letter == 'B'; });
    std::vector<ErrorPoint> points;
    for (const long n : ladder(4, std::max(16L, 6000 / static_cast<long>(kicks)))) {
      const double h = duration / static_cast<double>(n);
      points.push_back({h, distance(run(sheet(), *scheme, pair_of(0.5), h, n), truth)});
      if (points.back().error < digits_floor(*scheme)) break;
    }
    const auto used = finest(points, digits_floor(*scheme), 1e-2);
    INFO(scheme->name << " claims order " << scheme->order.classical << ", measured " << fitted_slope(used) << "\n"
                      << to_text(points));
    CHECK(used.size() == 3);
    CHECK(std::fabs(fitted_slope(used) - scheme->order.classical) < 0.25);
  }
}

TEST_CASE("schemes for near-integrable systems have their first order in the masses over a sheet",
          "[order][shearing_sheet]") {
  const double mass = 1e-13;
  // Beside masses of 1e-13 the truth needs all of 113 bits: a scheme of order 10 in short steps, over the same sheet.
  const auto truth = run(sheet(), schemes::sofroniou_spaletta_10_s35, pair_of(mass), duration / 384, 384);
  int tested = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->scheme_class != SchemeClass::near_integrable || scheme->order.near_integrable[0] == 0) continue;
    ++tested;
    std::vector<ErrorPoint> points;
    for (const long n : ladder(16, 128)) {
      const double h = duration / static_cast<double>(n);
      points.push_back({h, distance(run(sheet(), *scheme, pair_of(mass), h, n), truth) / mass});
    }
    const auto used = finest(points, 3e-18, 1e-2);  // below, the square of the masses shows
    INFO(scheme->name << " claims order " << scheme->order.near_integrable[0] << ", measured " << fitted_slope(used)
                      << "\n"
                      << to_text(points));
    CHECK(used.size() == 3);
    CHECK(std::fabs(fitted_slope(used) - scheme->order.near_integrable[0]) < 0.3);
  }
  CHECK(tested > 5);
}

}  // namespace noether
