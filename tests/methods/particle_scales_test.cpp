/// Errors of adaptive methods count by particle, relative to who attracts it most: whoever else is there, wherever it
/// stands, in whatever units. Steps do not jump over encounters.

#include "integrators/particle_scales.hpp"

#include "engine/orbital_elements.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/step_control.hpp"
#include "neighbors/neighbor_list.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"

#include <cmath>

using namespace noether;

namespace {

double relative_error(double found, double right) { return std::abs(found - right) / std::abs(right); }

std::vector<const MethodInfo*> adaptive_methods() {
  std::vector<const MethodInfo*> all;
  for (const MethodInfo* info : methods::all()) {
    if (info->adaptive) all.push_back(info);
  }
  return all;
}

Simulation<double> under_gravity(ParticleSystem<double> s, const MethodInfo& info, MethodOptions options = {}) {
  return Simulation<double>(std::move(s), classical(Gravity{}, MethodChoice{&info, options}));
}

/// A comet of a = 1 and e = 0.9 at its apocenter, and others that go round far away.
ParticleSystem<double> comet(int bystanders) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("comet", 0, {1.9, 0, 0}, {0, std::sqrt(0.1 / 1.9), 0});
  for (int k = 0; k < bystanders; ++k) {
    const double r = 20 + 0.5 * k, angle = 2.4 * k, v = 1 / std::sqrt(r);
    s.add("", 0, {r * std::cos(angle), r * std::sin(angle), 0}, {-v * std::sin(angle), v * std::cos(angle), 0});
  }
  return s;
}

/// How far the comet is from its apocenter after three periods; the step before may end elsewhere.
double comet_error(const MethodInfo& info, int bystanders) {
  Simulation<double> sim = under_gravity(comet(bystanders), info);
  REQUIRE(sim.run_until(6 * std::acos(-1.0)).ok());
  return (Vec3<double>(sim.particles().positions()[1]) - Vec3<double>(1.9, 0, 0)).norm();
}

/// Two asteroids of 5.2e11 and 4.3e9 kg, 1190 m apart in the mean, with e = 0.02, in a unit system; with the Sun they
/// stand 1 au from it.
struct Asteroids {
  const UnitSystem& units;
  bool with_sun = false;

  double unit(std::string_view symbol) const { return units::value(symbol, *units.scale); }
  double length(double meters) const { return meters * unit("m"); }
  ParticleSystem<double> start() const {
    ParticleSystem<double> s(units);
    const double m1 = 5.2e11 * unit("kg"), m2 = 4.3e9 * unit("kg"), mu = units.G * (m1 + m2);
    const auto [d, w] = state_from_elements<double>({length(1190), 0.02, 0, 0, 0, 0}, mu);
    Vec3<double> x = Vec3<double>::Zero(), v = Vec3<double>::Zero();
    if (with_sun) {
      const double M = unit("Msun"), au = unit("au");
      s.add("sun", M, {0, 0, 0}, {0, 0, 0});
      x = {au, 0, 0};
      v = {0, std::sqrt(units.G * M / au), 0};
    }
    s.add("A", m1, Vec3<double>(x - m2 / (m1 + m2) * d), Vec3<double>(v - m2 / (m1 + m2) * w));
    s.add("B", m2, Vec3<double>(x + m1 / (m1 + m2) * d), Vec3<double>(v + m1 / (m1 + m2) * w));
    return s;
  }
  /// Of B about A; a in meters.
  OrbitalElements<double> orbit(const ParticleSystem<double>& s) const {
    const Index a = s.size() - 2, b = s.size() - 1;
    OrbitalElements<double> found = elements_from_state<double>(Vec3<double>(s.positions()[b] - s.positions()[a]),
                                                                Vec3<double>(s.velocities()[b] - s.velocities()[a]),
                                                                units.G * (s.masses()[a] + s.masses()[b]));
    found.a /= length(1);
    return found;
  }
};

/// Whether it goes to rounding.
bool is_reference(const MethodInfo& info) { return info.rtol < 1e-15; }

}  // namespace

TEST_CASE("bystanders do not dilute the tolerance", "[particle_scales]") {
  for (const MethodInfo* info : adaptive_methods()) {
    CAPTURE(info->name);
    const double alone = comet_error(*info, 0), beside = comet_error(*info, 12);
    CHECK(alone > 0);
    CHECK(beside <= 2 * alone + 1e-10);
    CHECK(alone < (is_reference(*info) ? 1e-10 : 0.05));
  }
}

TEST_CASE("a pair of asteroids keeps its orbit at default tolerances in all units", "[particle_scales]") {
  for (const MethodInfo* info : adaptive_methods()) {
    CAPTURE(info->name);
    std::vector<std::pair<std::int64_t, double>> steps;
    for (const std::string_view units : {"si", "solar"}) {
      CAPTURE(units);
      const Asteroids pair{unit_system(units)};
      Simulation<double> sim = under_gravity(pair.start(), *info);
      REQUIRE(sim.run(60).ok());
      const double day = pair.unit("day");
      steps.emplace_back(60, sim.time() / day);
      REQUIRE(sim.run_until(10 * day).ok());
      const OrbitalElements<double> found = pair.orbit(sim.particles());
      // Some make errors of their whole tolerance in every step, to one side.
      const double slack = info->name == "bdf" ? 40 : info->order < 6 ? 2 : 1;
      CHECK(std::abs(found.a - 1190.0) < 0.05 * slack);
      CHECK(std::abs(found.e - 0.02) < 5e-5 * slack);
    }
    CHECK(relative_error(steps[0].second, steps[1].second) < 1e-6);
  }
}

TEST_CASE("a pair of asteroids keeps its orbit beside the Sun", "[particle_scales]") {
  for (const char* name : {"dop853", "dormand_prince_5", "adams_pece", "gragg_bulirsch_stoer", "dprkn_12", "gauss_8"}) {
    CAPTURE(name);
    const Asteroids pair{unit_system("solar"), true};
    Simulation<double> sim = under_gravity(pair.start(), *methods::find(name));
    REQUIRE(sim.run_until(10).ok());
    const OrbitalElements<double> found = pair.orbit(sim.particles());
    // The Sun's tide moves the elements by (M_sun / m) (d / au)^3 = 2e-6 of themselves.
    CHECK(std::abs(found.a - 1190.0) < 0.05);
    CHECK(std::abs(found.e - 0.02) < 5e-5);
  }
}

TEST_CASE("no short encounter is jumped over", "[particle_scales]") {
  // Rutherford: tan(angle / 2) = G m / (b v^2), from and to infinity; 1e4 away 1e-7 of the speed is missing.
  const double m = 1e-3, b = 0.05, v = 1;
  const double half = std::atan(m / (b * v * v)), right = -v * std::sin(2 * half);
  for (const MethodInfo* info : adaptive_methods()) {
    for (const int way : {1, -1}) {
      CAPTURE(info->name, way);
      ParticleSystem<double> s(unit_system("reduced"));
      s.add("M", m, {0, 0, 0}, {0, 0, 0});
      s.add("t", 0, {-1e4, b, 0}, {way * v, 0, 0});
      const auto direction = way > 0 ? Direction::forward : Direction::backward;
      Simulation<double> sim(std::move(s), classical(Gravity{}, MethodChoice{info, {}}),
                             Clock<double>::free(0, direction));
      REQUIRE(sim.run_until(way * 2e4).ok());
      CHECK(relative_error(sim.particles().velocities()[1][1], way * right) < (is_reference(*info) ? 1e-6 : 1e-3));
      CHECK(sim.step() < 50000);
    }
  }
}

TEST_CASE("a fall to 1e-9 of a body, about the origin and elsewhere", "[particle_scales]") {
  // a = 0.01, q = 1e-9, for one period: the tracer is back at its apocenter. At x = 1 doubles tell distances to 2e-16,
  // which is the orbit's energy at r = 1e-8.
  const double period = 0.19869176531592206;
  for (const MethodInfo* info : adaptive_methods()) {
    for (const double at : {0.0, 1.0}) {
      CAPTURE(info->name, at);
      ParticleSystem<double> s(unit_system("reduced"));
      s.add("p", 1e-3, {at, 0, 0}, {0, 0, 0});
      s.add("t", 0, {at + 0.019999999, 0, 0}, {0, 7.071067986781228e-05, 0});
      Simulation<double> sim = under_gravity(std::move(s), *info);
      const Outcome ended = sim.run_until(period);
      CHECK(sim.step() < 100000);
      if (at == 0 || is_reference(*info)) {
        REQUIRE(ended.ok());
        const double r = (Vec3<double>(sim.particles().positions()[1]) - Vec3<double>(at, 0, 0)).norm();
        CHECK(std::abs(r - 0.02) < 0.001);
      } else {
        REQUIRE(ended.kind == Outcome::Kind::step_underflow);
        CHECK(ended.message.find("use 'gauss_8', which keeps such distances") != std::string::npos);
        CHECK(relative_error(sim.time(), 0.0993459) < 1e-4);
      }
    }
  }
}

TEST_CASE("the neighbor that counts is the one that a particle would fall into first", "[particle_scales]") {
  const UnitSystem& units = unit_system("solar");
  const double au = units::solar::au, moon = 384400 * units::solar::km, M = units::solar::Msun, earth = 3.0e-6 * M;
  ParticleSystem<double> s(units);
  s.add("sun", M, {0, 0, 0}, {0, 0, 0});
  s.add("earth", earth, {au, 0, 0}, {0, std::sqrt(units.G * M), 0});
  s.add("moon", 0, {au + moon, 0, 0}, {0, std::sqrt(units.G * M) + std::sqrt(units.G * earth / moon), 0});
  ParticleScales scales;
  measure(s, {.gravity = true, .G = units.G}, nullptr, 1e-6, scales);
  REQUIRE(scales.particles() == 3);
  CHECK(relative_error(scales.length[2], moon) < 1e-12);  // although the Sun pulls 2.2 times as hard
  CHECK(relative_error(scales.length[1], moon) < 1e-12);  // what goes round it may have no mass
  CHECK(relative_error(scales.length[0], au) < 0.01);
  CHECK(relative_error(scales.speed[2], std::sqrt(units.G * earth / moon)) < 1e-12);
  CHECK(relative_error(scales.speed[0], std::sqrt(units.G * M)) < 0.1);

  SECTION("a softened pair is no nearer than its softening") {
    measure(s, {.gravity = true, .G = units.G, .softening = moon}, nullptr, 1e-6, scales);
    CHECK(relative_error(scales.length[2], std::sqrt(2.0) * moon) < 1e-12);
  }
  SECTION("tracers alone have no neighbors") {
    ParticleSystem<double> dust(units);
    for (int k = 0; k < 3; ++k) dust.add("", 0, {1.0 * k, 0, 0}, {0, 0, 0});
    measure(dust, {.gravity = true, .G = units.G}, nullptr, 1e-6, scales);
    CHECK(scales.length == std::vector<double>(3, 0.0));
    CHECK(scales.size == 2);
  }
}

TEST_CASE("neighbors in a liquid are the same by list and by pairs", "[particle_scales]") {
  // In a box, and in open space so dilute that some have nobody in range.
  const auto gas = GENERATE(false, true);
  ParticleSystem<double> s = gas ? test::liquid(3, 0.01, 1, 1) : test::liquid(5, 0.8, 1, 0.1);
  if (gas) s.set_box(Box());
  const Coupling coupling{.range = 2.5};
  NeighborList list(2.5);
  ParticleScales by_list, by_pairs;
  measure(s, coupling, &list, 1e-6, by_list);
  measure(s, coupling, nullptr, 1e-6, by_pairs);
  const double least = *std::min_element(by_pairs.length.begin(), by_pairs.length.end());
  CHECK((gas ? least == 0 : least > 0));
  CHECK(*std::max_element(by_pairs.length.begin(), by_pairs.length.end()) <= 2.5);
  // An older list, with a skin that somebody has wandered in, tells the same.
  NeighborList wide(2.5, {.skin = 1.5});
  ParticleScales by_wide;
  measure(s, coupling, &wide, 1e-6, by_wide);
  CHECK(by_wide.length == by_list.length);
  CHECK(by_wide.speed == by_list.speed);
  CHECK(by_wide.neighbor == by_list.neighbor);
  for (std::size_t i = 0; i < by_pairs.length.size(); ++i) {
    CHECK(by_list.length[i] == by_pairs.length[i]);
    CHECK(by_list.speed[i] == by_pairs.speed[i]);
  }
}

TEST_CASE("without neighbors a particle's own coordinates count, in any units", "[particle_scales]") {
  // A harmonic trap: 1 m or 1e-9 m wide, the same steps.
  std::vector<std::int64_t> steps;
  for (const double width : {1.0, 1e-9}) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("ion", 1, {width, 0, 0}, {0, 0, 0});
    Simulation<double> sim(std::move(s), classical(HarmonicField{.k = 1}, method("dop853")));
    REQUIRE(sim.run_until(40 * std::acos(-1.0)).ok());
    CHECK(relative_error(sim.particles().positions()[0][0], width) < 1e-4);
    steps.push_back(sim.step());
  }
  CHECK(steps[0] == steps[1]);
}

TEST_CASE("an error that is no number rejects a step, whoever makes it", "[particle_scales]") {
  const Index n = 3;
  ParticleScales scales;
  scales.length.assign(n, 1.0);
  scales.speed.assign(n, 1.0);
  scales.part.assign(n, 1.0);
  const Tolerance tolerance(1e-6, 0);
  Vector<double> y = Vector<double>::Ones(6 * n), e = Vector<double>::Zero(6 * n);
  CHECK(tolerance.norm(scales, e, y, y) == 0);
  for (Index i = 0; i < 6 * n; ++i) {
    e.setConstant(1e-9);
    e[i] = std::nan("");
    CHECK(std::isnan(tolerance.norm(scales, e, y, y)));
  }
}

TEST_CASE("runs begin where nothing tells how long a step is", "[particle_scales]") {
  for (const MethodInfo* info : adaptive_methods()) {
    CAPTURE(info->name);
    // A ball at rest at the origin, and one that passes the middle of a spring.
    ParticleSystem<double> ball(unit_system("reduced")), swing(unit_system("reduced"));
    ball.add("ball", 1, {0, 0, 0}, {0, 0, 0});
    swing.add("swing", 1, {0, 0, 0}, {1, 0, 0});
    Simulation<double> falls(std::move(ball),
                             classical(UniformField{.acceleration = {0, 0, -1}}, MethodChoice{info, {}}));
    Simulation<double> swings(std::move(swing), classical(HarmonicField{.k = 1}, MethodChoice{info, {}}));
    REQUIRE(falls.run_until(2).ok());
    CHECK(relative_error(falls.particles().positions()[0][2], -2) < 1e-3);
    // From rest at the origin everything is relative to next to nothing: at order 1 steps are rtol^(1/2) of the time.
    CHECK(falls.step() < (info->name == "bdf" ? 50000 : 1000));
    REQUIRE(swings.run_until(10).ok());
    CHECK(relative_error(swings.particles().positions()[0][0], std::sin(10.0)) < 0.01);
    CHECK(swings.step() < (is_reference(*info) ? 30000 : 3000));
  }
}

TEST_CASE("a body that escapes far from the origin is not lost", "[particle_scales]") {
  // At the speed of escape, from a rock at 1 au: binding energy 0, positions known to 3e-7 of the distance.
  const UnitSystem& units = unit_system("si");
  const double M = 5e11, r = 500, speed = std::sqrt(2 * units.G * M / r);
  ParticleSystem<double> s(units);
  s.add("rock", M, {1.5e11, 0, 0}, {0, 0, 0});
  s.add("dust", 0, {1.5e11 + r, 0, 0}, {0.6 * speed, 0.8 * speed, 0});
  Simulation<double> sim = under_gravity(std::move(s), *methods::find("dop853"));
  REQUIRE(sim.run_until(86400).ok());
  const Vec3<double> d = sim.particles().positions()[1] - sim.particles().positions()[0];
  // Barker's equation, t - t_p = sqrt(p^3 / mu) (D + D^3 / 3) / 2 with r = p (1 + D^2) / 2, solved in closed form.
  const double mu = units.G * M, h = r * 0.8 * speed, p = h * h / mu, D = std::sqrt(2 * r / p - 1);
  const double W = D + D * D * D / 3 + 2 * 86400 / std::sqrt(p * p * p / mu);
  const double later = 2 * std::sinh(std::asinh(1.5 * W) / 3);
  CHECK(relative_error(d.norm(), p * (1 + later * later) / 2) < 1e-4);
}
