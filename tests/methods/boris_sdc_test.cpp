/// Deferred corrections of Boris's step: the recorded errors of the Penning trap (docs/theory/fields.md), orders by
/// nodes and sweeps, and the collocation method that sweeps end in.

#include "integrators/methods/boris_sdc.hpp"
#include "engine/simulation.hpp"
#include "forces/henon_heiles.hpp"
#include "integrators/classical.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"
#include "tests/support/drivers.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace noether {
namespace {

using test::classical_over;
using test::one_charge;

const PenningTrap trap{.B0 = 25, .gradient = 4.9 * 4.9};
const Vec3<double> trap_x(10, 0, 0), trap_v(100, 0, 100);
const Vec3<double> trap_end(-2.1480882398033808477, -9.6822103837776453613, 8.69258487535745569082);

struct Friction {
  static std::string_view name() { return "friction"; }
  static ForceClaims claims() { return {.energy = false, .velocity_dependent = true, .dissipative = true}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) out.acceleration(i, Vec3<Real>(-s.velocities()[i]));
  }
};

template <class Field>
Vec3<double> end_of(const Field& field, const Vec3<double>& x, const Vec3<double>& v, const MethodChoice& by, double h,
                    std::int64_t steps) {
  ForceField<double> forces;
  forces.add(InField(field));
  Simulation sim(one_charge(x, v), classical(forces, by), h);
  REQUIRE(sim.run(steps).ok());
  return sim.particles().positions()[0];
}
double apart(const Vec3<double>& a, const Vec3<double>& b) { return (a - b).cwiseAbs().maxCoeff(); }
double trap_error(std::int64_t nodes, std::int64_t sweeps, int steps) {
  const MethodChoice by = method("boris_sdc", BorisSdcOptions{.nodes = nodes, .sweeps = sweeps});
  return apart(end_of(trap, trap_x, trap_v, by, 1.0 / steps, steps), trap_end);
}

TEST_CASE("deferred corrections of Boris's step: the errors of the Penning trap as recorded", "[charges]") {
  struct Row {
    std::int64_t nodes, sweeps;
    double error, slope;
  };
  for (const Row& row : {Row{3, 1, 9.976e-5, 3.99}, Row{3, 2, 6.949e-5, 4.0}, Row{3, 6, 6.947e-5, 4.0},
                         Row{5, 1, 6.625e-6, 3.99}, Row{5, 2, 1.564e-7, 4.02}, Row{5, 3, 2.16e-10, 5.96}}) {
    INFO(row.nodes << " nodes, " << row.sweeps << " sweeps");
    const double coarse = trap_error(row.nodes, row.sweeps, 160), fine = trap_error(row.nodes, row.sweeps, 320);
    CHECK(std::abs(coarse / row.error - 1) <= 2e-3);
    CHECK(std::abs(std::log2(coarse / fine) - row.slope) <= 0.1);
  }
}

TEST_CASE("two sweeps of deferred corrections give two orders in a magnetic field, up to those of the nodes",
          "[charges]") {
  // A field that no direction is uniform in, over one turn and a half; truth by Gauss's method.
  const test::RingField field;
  const Vec3<double> x(0, -1, 0), v(0.1, 0.01, 0);
  const Vec3<double> truth = end_of(field, x, v, method("gauss_8", {.adaptive = false}), 0.01, 1000);
  struct Row {
    std::int64_t nodes, sweeps;
    int order;
    double h;
  };
  for (const Row& row :
       {Row{5, 1, 4, 0.25}, Row{5, 3, 6, 0.5}, Row{5, 5, 8, 1.0}, Row{4, 6, 6, 0.5}, Row{3, 4, 4, 0.5}}) {
    INFO(row.nodes << " nodes, " << row.sweeps << " sweeps");
    const MethodChoice by = method("boris_sdc", BorisSdcOptions{.nodes = row.nodes, .sweeps = row.sweeps});
    auto method_over_field = classical_over(InField(field), by);
    auto charge = one_charge(x, v);
    method_over_field.bind(charge);
    CHECK(method_over_field.claims().order == row.order);
    const auto error = [&](double h) { return apart(end_of(field, x, v, by, h, std::llround(10 / h)), truth); };
    const double slope = std::log2(error(row.h / 2) / error(row.h / 4));
    CHECK(std::abs(slope - row.order) <= 0.35);
  }
}

TEST_CASE("sweeps of deferred corrections end in the method that collocates", "[charges]") {
  // Three nodes of Lobatto: weights by hand, the equations solved by plain iteration.
  const double h = 0.3;
  const test::RingField field;
  const Vec3<double> x(0.2, -0.9, 0.1), v(0.3, -0.2, 0.4);
  const MethodChoice by = method("boris_sdc", BorisSdcOptions{.nodes = 3, .sweeps = 32});
  ForceField<double> forces;
  forces.add(InField(field));
  const auto at = [&](const Vec3<double>& place, const Vec3<double>& speed) {
    const auto s = one_charge(place, speed);
    VectorColumn<double> a(1);
    ForceSink<double> sink(a, s, {});
    forces.add_to(sink, s);
    return Vec3<double>(a[0]);
  };
  Vec3<double> middle_x = x, middle_v = v, end_x = x, end_v = v;
  const Vec3<double> first = at(x, v);
  for (int k = 0; k < 200; ++k) {
    const Vec3<double> second = at(middle_x, middle_v), third = at(end_x, end_v);
    middle_x = x + h / 2 * v + h * h * (3 * first + 4 * second - third) / 48;
    middle_v = v + h * (5 * first + 8 * second - third) / 24;
    end_x = x + h * v + h * h * (first + 2 * second) / 6;
    end_v = v + h * (first + 4 * second + third) / 6;
  }
  CHECK(apart(end_of(field, x, v, by, h, 1), end_x) < 1e-14);
}

TEST_CASE("each sweep of deferred corrections gives two orders where no field turns", "[charges]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("point", 1, {0.18, 0.18, 0}, {0.18, 0.18, 0});
  const auto end = [&](const MethodChoice& by, double h, std::int64_t steps) {
    Simulation sim(s, classical_over(HenonHeiles{}, by), h);
    REQUIRE(sim.run(steps).ok());
    return Vec3<double>(sim.particles().positions()[0]);
  };
  const Vec3<double> truth = end(method("gauss_8", {.adaptive = false}), 0.02, 1000);
  for (const std::int64_t sweeps : {1, 2, 3}) {
    INFO(sweeps << " sweeps");
    const MethodChoice by = method("boris_sdc", BorisSdcOptions{.sweeps = sweeps});
    const auto order = static_cast<double>(classical_over(HenonHeiles{}, by).claims().order);
    CHECK(order == 2 + 2 * static_cast<double>(sweeps));
    CHECK(std::abs(std::log2(apart(end(by, 0.5, 40), truth) / apart(end(by, 0.25, 80), truth)) - order) <= 0.35);
  }
  auto counted = classical_over(HenonHeiles{}, method("boris_sdc"));
  test::run(counted, s, 0.1, 10);
  CHECK(counted.evaluations().force == 170);
}

TEST_CASE("deferred corrections refuse what they do not serve", "[charges]") {
  const auto make = [](BorisSdcOptions options) { return classical_over(HenonHeiles{}, method("boris_sdc", options)); };
  CHECK_THROWS_WITH(make({.nodes = 2}), "nodes = 2 is not a valid number of nodes; 3 to 9 are expected");
  CHECK_THROWS_WITH(make({.sweeps = 0}), "sweeps = 0 is not a valid number of sweeps; 1 to 32 are expected");
  auto s = one_charge({1, 0, 0}, {0, 1, 0});
  CHECK_THROWS_WITH(classical_over(Friction{}, method("boris_sdc")).bind(s),
                    "method 'boris_sdc' needs forces that depend on velocities by magnetic fields alone; use 'gauss_6' "
                    "instead");
}

}  // namespace
}  // namespace noether
