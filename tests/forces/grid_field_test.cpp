/// Fields on grids: cubics between the places, no divergence, and runs that leave them.

#include "forces/grid_field.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/charges.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace noether {
namespace {

template <class Field> GridField grid_of(const Field& field, Index n, double low, double high, bool B_alone = false) {
  const double spacing = (high - low) / static_cast<double>(n - 1);
  FieldGrid grid = FieldGrid::of(field, {n, n, n}, {low, low, low}, {spacing, spacing, spacing});
  if (B_alone) {
    grid.A.clear();
    for (Index i = 0; i < n * n * n; ++i) {
      FieldValues<double> here;
      const auto at = [&](Index k) { return low + static_cast<double>(k) * spacing; };
      field.at(0.0, Vec3<double>(at(i / (n * n)), at(i / n % n), at(i % n)), here);
      for (int c = 0; c < 3; ++c) grid.B.push_back(here.B[c]);
    }
  }
  grid.check();
  return {.file = "", .grid = std::make_shared<const FieldGrid>(std::move(grid))};
}

template <class Field> FieldValues<double> at(const Field& field, const Vec3<double>& x) {
  FieldValues<double> values;
  field.at(0.0, x, values);
  return values;
}

/// div B by differences within a cell.
double divergence_at(const GridField& field, const Vec3<double>& x, double spacing) {
  double sum = 0;
  for (Index k = 0; k < 3; ++k) {
    Vec3<double> up = x, down = x;
    up[k] += 1e-4 * spacing;
    down[k] -= 1e-4 * spacing;
    sum += (at(field, up).B[k] - at(field, down).B[k]) / (2e-4 * spacing);
  }
  return sum;
}

/// A and phi are cubics of x, y and z.
struct CubicField {
  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    field.A = Vec3<Real>(x[1] * x[2] * x[2] * x[2], x[0] * x[0] * x[0] - x[2], x[0] * x[1] * x[1]);
    field.B = Vec3<Real>(Real(2) * x[0] * x[1] + Real(1), Real(3) * x[1] * x[2] * x[2] - x[1] * x[1],
                         Real(3) * x[0] * x[0] - x[2] * x[2] * x[2]);
    field.phi = x[0] * x[0] * x[1] - x[2];
    field.E = Vec3<Real>(Real(-2) * x[0] * x[1], -x[0] * x[0], Real(1));
  }
};

/// Away from its axis.
struct Shifted : Tokamak {
  template <class Real> void at(const Real& t, const Vec3<Real>& x, FieldValues<Real>& field) const {
    Tokamak::at(t, Vec3<Real>(x[0] + Real(2), x[1], x[2]), field);
  }
};

const Vec3<double> banana_x(1.05, 0, 0), banana_v(0, 4.816e-4, -2.059e-3);

}  // namespace

TEST_CASE("cubics are exact, between the places and on them", "[forces][grid_field]") {
  const GridField grid = grid_of(CubicField{}, 9, -2, 2);
  for (const Vec3<double>& x : {Vec3<double>(0.3, -0.7, 0.9), Vec3<double>(0, 0.5, -1), Vec3<double>(-1, 1, 1),
                                Vec3<double>(0.99, 0.01, 0.5)}) {
    CAPTURE(x);
    REQUIRE(grid.covers(x));
    const FieldValues<double> there = at(grid, x), exact = at(CubicField{}, x);
    CHECK((there.A - exact.A).norm() < 1e-14);
    CHECK((there.B - exact.B).norm() < 1e-13);
    CHECK((there.E - exact.E).norm() < 1e-13);
    CHECK(std::abs(there.phi - exact.phi) < 1e-14);
  }
  CHECK_FALSE(grid.covers({1.01, 0, 0}));
  CHECK_FALSE(grid.covers({0, -1.01, 0}));
}

TEST_CASE("a tokamak on a grid: errors fall by order three, and lines have no ends", "[forces][grid_field]") {
  std::vector<Vec3<double>> places;
  for (int k = 1; k <= 60; ++k)
    places.push_back(0.4 * Vec3<double>(std::sin(7.0 * k), std::sin(11.0 * k), std::cos(5.0 * k)));
  const auto error = [&](Index n) {
    const GridField grid = grid_of(Shifted{}, n, -1, 1);
    double worst = 0;
    for (const Vec3<double>& x : places) {
      worst = std::max(worst, (at(grid, x).B - at(Shifted{}, x).B).norm());
      CHECK(std::abs(divergence_at(grid, x, 2.0 / static_cast<double>(n - 1))) < 1e-9);
    }
    return worst;
  };
  const double coarse = error(17), fine = error(33);
  CHECK(std::log2(coarse / fine) > 2.5);
  CHECK(fine < 1e-4);
  // B alone is as near, but has a divergence, which is told.
  const GridField alone = grid_of(Shifted{}, 17, -1, 1, true);
  CHECK((at(alone, places[0]).B - at(Shifted{}, places[0]).B).norm() < 1e-3);
  CHECK(alone.divergence() > 1e-9);
  CHECK(alone.divergence() < 1e-5);
  CHECK(grid_of(Shifted{}, 17, -1, 1).divergence() == 0);
  CHECK(alone.signature() != grid_of(Shifted{}, 17, -1, 1).signature());
}

TEST_CASE("a banana on a grid: its energy to rounding, its canonical momentum bounded, beside the formula's field",
          "[forces][grid_field]") {
  // A quarter of the torus would do for 1500 steps; the grid has all of it.
  const Index n = 61;
  FieldGrid values = FieldGrid::of(Tokamak{}, {n, n, 17}, {-1.3, -1.3, -0.2}, {2.6 / 60, 2.6 / 60, 0.4 / 16});
  for (double& value : values.A) value = std::isfinite(value) ? value : 0;  // on the axis, where nothing comes
  const GridField grid{.file = "", .grid = std::make_shared<const FieldGrid>(std::move(values))};
  const ChargeMotion motion{.fields = {AnyForce<double>(InField(grid))}, .c = {}};
  CanonicalMomentum around;
  around.watch(motion);
  const auto by = [](auto field) {
    return compose(test::in_field(field, {.rotation = Rotation::boris}), schemes::verlet_aba);
  };
  Simulation sim(test::one_charge(banana_x, banana_v), by(grid), std::acos(-1.0) / 10);
  Simulation exact(test::one_charge(banana_x, banana_v), by(Tokamak{}), std::acos(-1.0) / 10);
  auto& energy = sim.every(10, Energy{});
  auto& p = sim.every(10, around);
  REQUIRE(sim.run(1500).ok());
  REQUIRE(exact.run(1500).ok());
  CHECK(energy.worst() < 1e-13);
  CHECK(p.worst() < 1e-3);
  CHECK((Vec3<double>(sim.particles().positions()[0]) - Vec3<double>(exact.particles().positions()[0])).norm() < 1e-3);
}

TEST_CASE("a charge that leaves the grid ends the run by name", "[forces][grid_field]") {
  const GridField grid = grid_of(UniformElectromagnetic{.E = {1, 0, 0}, .B = {0, 0, 1e-3}}, 9, -2, 2);
  Simulation sim(test::one_charge({0, 0, 0}, {0, 0, 0}), compose(test::in_field(grid), schemes::verlet_aba), 0.01);
  const Outcome outcome = sim.run(1000);
  CHECK_FALSE(outcome.ok());
  CHECK_THAT(to_text(outcome), Catch::Contains("'charge' has left the places where the field is known"));
  CHECK(std::abs(sim.particles().positions()[0][0] - 1) <= 0.03);
}

TEST_CASE("monitors over a grid: beyond its places, and where it has no field", "[forces][grid_field]") {
  const GridField grid = grid_of(UniformElectromagnetic{.E = {1, 0, 0}, .B = {0, 0, 1e-3}}, 9, -2, 2);
  const ChargeMotion motion{.fields = {AnyForce<double>(InField(grid))}, .c = {}};
  Simulation sim(test::one_charge({0, 0, 0}, {2.1, 0, 0}), compose(test::in_field(grid), schemes::verlet_aba), 0.2);
  CanonicalMomentum around;
  MagneticMoment moment;
  around.watch(motion);
  moment.watch(motion);
  auto& p = sim.every(1, around);
  auto& mu = sim.every(1, moment);
  const Outcome outcome = sim.run(100);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);  // the run ends as without them, and they have reports
  CHECK(p.report().samples > 0);
  CHECK(mu.report().samples == 0);  // its gyrocenter is far out
  // No field at all: the gyrocenter is nowhere, and nothing is read there.
  const GridField none = grid_of(UniformElectromagnetic{}, 9, -2, 2);
  FieldValues<double> values;
  none.at(0.0, Vec3<double>(std::nan(""), 0, 0), values);
  CHECK_FALSE(none.covers({std::nan(""), 0, 0}));
  Simulation still(test::one_charge({0, 0, 0}, {0.1, 0, 0}), compose(test::in_field(none), schemes::verlet_aba), 0.1);
  MagneticMoment of_none;
  of_none.watch({.fields = {AnyForce<double>(InField(none))}, .c = {}});
  still.every(1, of_none);
  CHECK(still.run(5).ok());
  CHECK_THROWS_WITH(Simulation(test::one_charge({0, 0, 0}, {0, 0, 0}),
                               compose(test::in_field(GridField{}), schemes::verlet_aba), 0.1),
                    Catch::Contains("has no grid"));
}

TEST_CASE("grids whose shapes do not fit are refused", "[forces][grid_field]") {
  FieldGrid grid;
  grid.counts = {6, 6, 6};
  grid.A.assign(648, 0.0);
  CHECK_NOTHROW(grid.check());
  grid.B = grid.A;
  CHECK_THROWS_WITH(grid.check(), Catch::Contains("either A or B"));
  grid.A.clear();
  grid.B.clear();
  CHECK_THROWS_WITH(grid.check(), Catch::Contains("no values"));
  grid.B.assign(648, 0.0);
  grid.phi = {1};
  CHECK_THROWS_WITH(grid.check(), Catch::Contains("numbers"));
  grid.phi.clear();
  grid.B[7] = std::nan("");
  CHECK_THROWS_WITH(grid.check(), Catch::Contains("not finite"));
  grid.counts = {6, 5, 6};
  CHECK_THROWS_WITH(grid.check(), Catch::Contains("too small"));
}

}  // namespace noether
