/// Charges moved along one direction after the other: symplectic in x and m v + q A, and what the energy does.

#include "integrators/k_symplectic.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace noether {
namespace {

const double pi = std::acos(-1.0);
const Vec3<double> ring_x(0, -1, 0), ring_v(0.1, 0.01, 0);

template <class Real, class Field> ForceField<Real> forces_of(const Field& field) {
  ForceField<Real> forces;
  forces.add(InField(field));
  return forces;
}

using State = Eigen::Matrix<Quad, 6, 1>;

/// A step in x and p = v + A(x), in 113 bits.
template <class Field> State step(const AnyIntegrator<Quad>& by, const Field& field, const State& from, double h) {
  const auto A = [&](const Vec3<Quad>& x) {
    FieldValues<Quad> values;
    field.at(Quad(0), x, values);
    return values.A;
  };
  ParticleSystem<Quad> s = test::one_charge<Quad>({0, 0, 0}, {0, 0, 0});
  s.positions().set(0, from.head<3>());
  s.velocities().set(0, Vec3<Quad>(from.tail<3>() - A(from.head<3>())));
  Simulation<Quad> sim(std::move(s), by, Clock<Quad>::fixed(0, h));
  REQUIRE(sim.run(1).ok());
  State to;
  const Vec3<Quad> x = sim.particles().positions()[0], v = sim.particles().velocities()[0];
  to << x, Vec3<Quad>(v + A(x));
  return to;
}

/// Largest element of J^T W J - W of a step in canonical coordinates.
template <class Field> double defect(const AnyIntegrator<Quad>& by, const Field& field, double h) {
  State at;
  at << Quad(1.1), Quad(0.2), Quad(-0.1), Quad(0.3), Quad(0.5), Quad(0.2);
  const Quad e(1e-11);
  Eigen::Matrix<double, 6, 6> J, W = Eigen::Matrix<double, 6, 6>::Zero();
  for (int k = 0; k < 6; ++k) {
    State up = at, down = at;
    up[k] += e;
    down[k] -= e;
    const State slope = (step(by, field, up, h) - step(by, field, down, h)) / (Quad(2) * e);
    for (int i = 0; i < 6; ++i) J(i, k) = static_cast<double>(slope[i]);
  }
  for (int k = 0; k < 3; ++k) {
    W(k, k + 3) = 1;
    W(k + 3, k) = -1;
  }
  return (J.transpose() * W * J - W).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("its steps are symplectic in x and m v + q A, and those that turn are not", "[integrators][charges]") {
  const auto lines = [](const auto& field, std::int64_t nodes) {
    return AnyIntegrator<Quad>(
        compose(AnyHamiltonian<Quad>(KSymplectic<ForceField<Quad>, Quad>(forces_of<Quad>(field), {.nodes = nodes})),
                schemes::yoshida_4));
  };
  CHECK(defect(lines(Tokamak{}, 8), Tokamak{}, 0.2) < 1e-14);
  CHECK(defect(lines(test::RingField{}, 8), test::RingField{}, 0.2) < 1e-14);
  CHECK(defect(lines(Tokamak{}, 1), Tokamak{}, 0.2) > 1e-7);  // a quadrature that is too coarse shows
  const AnyIntegrator<Quad> turns = compose(
      AnyHamiltonian<Quad>(ChargedParticles<ForceField<Quad>, Quad>(forces_of<Quad>(Tokamak{}))), schemes::verlet_aba);
  CHECK(defect(turns, Tokamak{}, 0.2) > 1e-4);
}

TEST_CASE("energies in a ring field, first and last tenth of 20 000 steps", "[integrators][charges]") {
  const auto worst = [&](const Scheme& scheme) {
    std::array<double, 2> tenths{};
    const AnyHamiltonian<double> h = KSymplectic<ForceField<double>>(forces_of<double>(test::RingField{}));
    Simulation sim(test::one_charge(ring_x, ring_v), compose(h, scheme), pi / 10);
    auto& energy = sim.every(1, Energy{});
    for (int k = 1; k <= 20'000; ++k) {
      REQUIRE(sim.run(1).ok());
      const MonitorReport report = energy.report();
      const double error = std::abs(*report.last / *report.first - 1);
      if (k <= 2000) tenths[0] = std::max(tenths[0], error);
      if (k > 18'000) tenths[1] = std::max(tenths[1], error);
    }
    return tenths;
  };
  // In a plane Z does nothing; independent figures (docs/theory/fields.md), whose last tenth is that of 20 000 steps
  // too.
  const auto second = worst(schemes::verlet), fourth = worst(schemes::yoshida_4);
  CHECK(std::abs(second[0] / 0.012553 - 1) <= 0.02);
  CHECK(std::abs(second[1] / 0.012617 - 1) <= 0.02);
  CHECK(std::abs(fourth[0] / 8.8492e-4 - 1) <= 0.02);
  CHECK(std::abs(fourth[1] / 8.6652e-4 - 1) <= 0.02);
}

TEST_CASE("fields that depend on time: compositions keep their order, and nodes are counted",
          "[integrators][charges]") {
  const PlaneWave wave{.E0 = {0.6, 0, 0}, .direction = {0, 0, 1}, .omega = 2, .c = 1};
  const auto end = [&](const AnyIntegrator<Quad>& by, double h) {
    Simulation<Quad> sim(test::one_charge<Quad>({0.1, 0, 0.2}, {0.1, 0.2, 0.4}), by, Clock<Quad>::fixed(0, h));
    REQUIRE(sim.run_until(4).ok());
    return Vec3<Quad>(sim.particles().positions()[0]);
  };
  const auto lines = [&](const char* scheme) {
    return AnyIntegrator<Quad>(compose(AnyHamiltonian<Quad>(KSymplectic<ForceField<Quad>, Quad>(forces_of<Quad>(wave))),
                                       *schemes::find(scheme)));
  };
  const AnyIntegrator<Quad> turns =
      compose(AnyHamiltonian<Quad>(ChargedParticles<ForceField<Quad>, Quad>(forces_of<Quad>(wave))),
              *schemes::find("kahan_li_8_s17"));
  const Vec3<Quad> exact = end(turns, 0.02);
  for (const auto& [scheme, order] : {std::pair{"verlet", 2.0}, std::pair{"yoshida_4", 4.0}}) {
    CAPTURE(scheme);
    const auto error = [&](double h) { return static_cast<double>((end(lines(scheme), h) - exact).norm()); };
    CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - order) <= 0.2);
  }
  const AnyHamiltonian<double> h = KSymplectic<ForceField<double>>(forces_of<double>(wave));
  Simulation sim(test::one_charge(ring_x, ring_v), compose(h, schemes::verlet), 0.1);
  REQUIRE(sim.run(10).ok());
  const std::int64_t before = sim.evaluations().force;
  REQUIRE(sim.run(100).ok());
  CHECK(sim.evaluations().force - before == 100 * (5 * 8 + 1));  // X is joined to that of the next step
}

TEST_CASE("what is no word over its letters is refused", "[integrators][charges]") {
  const AnyHamiltonian<double> h = KSymplectic<ForceField<double>>(forces_of<double>(Tokamak{}));
  CHECK_THROWS_AS(compose(h, schemes::verlet_aba), SchemeMismatch);
  CHECK_THROWS_AS(compose(h, *schemes::find("blanes_moan_s6")), SchemeMismatch);
  CHECK_THROWS_WITH((KSymplecticOptions{.nodes = 0}.check()), Catch::Contains("count of nodes"));
  CHECK(AnyIntegrator<double>(compose(h, schemes::yoshida_4)).claims().symplectic);
}

}  // namespace noether
