/// Planted faults: each is found and named.

#include "tests/shadow/support.hpp"
#include "tests/support/drivers.hpp"

#include <cmath>

using namespace noether;
using Catch::Matchers::StartsWith;

namespace {

/// The force of Henon and Heiles and a swirl that no potential has.
struct Swirl {
  double strength = 0;
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    test::HenonHeilesField{}.add_to(out, s);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> q = s.positions()[i];
      out.acceleration(i, Vec3<Real>(-Real(strength) * q[1], Real(strength) * q[0], Real(0)));
    }
  }
};

/// q'' = -q - q^2.
struct Quadratic {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      const Real q = x[0];
      out.acceleration(i, Vec3<Real>(-q - q * q, Real(0), Real(0)));
      out.energy(s.masses()[i] * (q * q / Real(2) + q * q * q / Real(3)));
    }
  }
};

}  // namespace

TEST_CASE("a method that only poses as symplectic is named", "[shadow]") {
  const test::PosingRungeKutta method(test::HenonHeilesField{});
  const auto shadow = test::shadow_of(method, test::henon_heiles_start(), 0.2, 5000, test::shadow_orders);
  CHECK_THAT(shadow.verdict(), StartsWith("not symplectic: no order fluctuates less than "));
  // It loses energy, and the shadow sees it long before the energy's oscillation would be left behind.
  CHECK(shadow.slope() < 0);
}

TEST_CASE("a force that is no gradient is named, a gradient is not", "[shadow]") {
  for (const double strength : {1e-2, 1e-4}) {
    const auto shadow = test::shadow_of(compose(test::kinetic_potential(Swirl{strength}), schemes::verlet),
                                        test::henon_heiles_start(), 0.1, 2000, test::shadow_orders);
    CAPTURE(strength, shadow.verdict());
    CHECK_THAT(shadow.verdict(), StartsWith("force is not a gradient: it differs from that of its energy by "));
  }
  const auto straight = test::shadow_of(compose(test::kinetic_potential(Swirl{0}), schemes::verlet),
                                        test::henon_heiles_start(), 0.1, 2000, test::shadow_orders);
  CHECK_THAT(straight.verdict(), StartsWith("kept to rounding"));
}

TEST_CASE("a step too large is named: a plateau, then growth with the order", "[shadow]") {
  // Near the largest bounded start of q'' = -q - q^2 at h omega = 1.72.
  ParticleSystem<double> start;
  start.add("", 1.0, {0.027, 0, 0}, {0, 0, 0});
  const auto shadow = test::shadow_of(compose(test::kinetic_potential(Quadratic{}), schemes::verlet), start, 1.72, 5000,
                                      test::shadow_orders);
  for (std::size_t k = 1; k < test::shadow_orders.size(); ++k) CHECK(shadow.fluctuation(k) > shadow.fluctuation(k - 1));
  CHECK_THAT(shadow.verdict(), StartsWith("step too large: order "));
}

TEST_CASE("a run that leaves all bounds has no shadow, and the verdict does not praise it", "[shadow]") {
  Simulation simulation(test::henon_heiles_start(),
                        compose(test::kinetic_potential(test::HenonHeilesField{}), schemes::verlet), 1.2);
  auto& shadow = simulation.every(1, ShadowHamiltonian<>());
  CHECK(simulation.run(1000).kind == Outcome::Kind::diverged);
  CHECK_THAT(shadow.verdict(), StartsWith("step too large: "));
}

TEST_CASE("a wrong digit in a scheme leaves the shadow flat; its distance from the energy tells the order",
          "[shadow]") {
  // A composition with wrong weights is symplectic still, but its shadow differs from H at a lower order of h.
  Scheme wrong = schemes::blanes_moan_s6;
  REQUIRE(wrong.word[0].letter == wrong.word[2].letter);
  wrong.word = {};
  const Word& word = schemes::blanes_moan_s6.word;
  for (std::size_t k = 0; k < word.size(); ++k) {
    const std::size_t from_end = std::min(k, word.size() - 1 - k);
    const Quad slip = from_end == 0 ? Quad(1e-3) : from_end == 2 ? Quad(-1e-3) : Quad(0);
    wrong.word.push_back({word[k].letter, word[k].weight + slip});
  }
  const auto slope = [](const Scheme& scheme) {
    std::vector<double> distances;
    for (const double h : {0.2, 0.1}) {
      const auto field = test::kinetic_potential<Quad>(test::HenonHeilesField{});
      const auto steps = static_cast<std::int64_t>(std::round(8 / h)) + 6;  // the window ends 6 steps after its middle
      const auto shadow = test::shadow_of(compose(field, scheme), test::henon_heiles_start(), h, steps, {24});
      CHECK(shadow.fluctuation(0) < 1e-15);
      auto energy_of = field;
      auto middle = test::run(field, scheme, test::henon_heiles_start().as<Quad>(), h, steps - 6);
      energy_of.bind(middle);
      distances.push_back(std::fabs(static_cast<double>(shadow.values()[0] - energy_of.energy(middle).total())));
    }
    return std::log2(distances[0] / distances[1]);
  };
  CHECK(std::fabs(slope(schemes::blanes_moan_s6) - 4) < 0.3);
  CHECK(std::fabs(slope(wrong) - 2) < 0.3);
}
