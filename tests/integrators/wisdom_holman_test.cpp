/// The Wisdom-Holman splitting against closed forms and against other splittings of the same Hamiltonian.

#include "integrators/wisdom_holman.hpp"

#include "engine/orbital_elements.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/oblateness.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <numbers>

namespace noether {
namespace {

using test::outer_G;
constexpr Coordinates each[] = {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds,
                                Coordinates::barycentric};
constexpr Coordinates exact_for_two[] = {Coordinates::jacobi, Coordinates::whds, Coordinates::barycentric};

using Ranks = std::vector<std::int64_t>;

template <class Real = double> AnyHamiltonian<Real> splitting(Coordinates coordinates = Coordinates::jacobi) {
  return test::wisdom_holman<Real>({.G = outer_G, .coordinates = coordinates});
}

/// Largest |x_a - x_b| / |x_a| and |v_a - v_b| / |v_a| over the particles that both have.
template <class Real> double difference(const ParticleSystem<Real>& a, const ParticleSystem<Real>& b) {
  double worst = 0;
  for (Index i = 0; i < std::min(a.size(), b.size()); ++i) {
    const Vec3<Real> dx = a.positions()[i] - b.positions()[i], dv = a.velocities()[i] - b.velocities()[i];
    worst = std::max(worst, std::sqrt(static_cast<double>(norm2(dx) / norm2(a.positions()[i]))));
    worst = std::max(worst, std::sqrt(static_cast<double>(norm2(dv) / norm2(a.velocities()[i]))));
  }
  return worst;
}

template <class Real, class H>
ParticleSystem<Real> run(ParticleSystem<Real> particles, H hamiltonian, const Scheme& scheme, double dt,
                         std::int64_t steps) {
  Simulation<Real> simulation(std::move(particles), compose(std::move(hamiltonian), scheme), dt);
  REQUIRE(simulation.run(steps).kind == Outcome::Kind::completed);
  return simulation.particles();
}

/// The outer planets in the order Sun, Neptune, Jupiter, Uranus, Saturn.
ParticleSystem<double> scrambled() {
  const auto planets = test::outer_planets();
  ParticleSystem<double> s(unit_system("solar"));
  for (const Index i : {0, 4, 1, 3, 2}) {
    s.add(planets.name(i), planets.masses()[i], planets.positions()[i], planets.velocities()[i]);
  }
  return s;
}

/// The outer planets with a comet that falls in from outside on a hyperbola, and a tracer on another one.
ParticleSystem<Quad> with_visitors() {
  auto s = test::outer_planets();
  s.add("Visitor", 1e-6, {14, 6, 5}, {-0.011, 0.002, -0.003});
  s.add("Dust", 0, {3, 0.5, -1}, {-0.001, 0.0105, 0.002});
  s.add("Ice", 0, {-30, 20, 10}, {0.007, -0.004, -0.001});
  return s.as<Quad>();
}

/// Logarithm to base 2 of how much nearer two methods of order 8 come to each other with half the step.
template <class H1, class H2>
double common_order(const ParticleSystem<Quad>& start, const H1& one, const H2& other,
                    const Scheme& scheme = schemes::yoshida_8) {
  std::array<double, 2> errors{};
  for (const int k : {0, 1}) {
    const double dt = 40.0 / (1 << k);
    const std::int64_t n = 16 << k;
    errors[static_cast<std::size_t>(k)] =
        difference(run(start, one, scheme, dt, n), run(start, other, schemes::yoshida_8, dt, n));
  }
  CAPTURE(errors[0], errors[1]);
  CHECK(errors[1] > 1e-28);
  return std::log2(errors[0] / errors[1]);
}

/// Two bodies of 1 and 1/4 about their centre of mass, which moves; semi-major axis 2, eccentricity 0.7, at eccentric
/// anomaly E.
struct TwoBodies {
  Quad a = 2, e = 0.7, total = 1.25, mu = Quad(outer_G) * total;
  Quad motion() const { return sqrt(mu / (a * a * a)); }
  ParticleSystem<Quad> at(const Quad& E, const Quad& t) const {
    const Quad root = sqrt(Quad(1) - e * e), rate = motion() / (Quad(1) - e * cos(E));
    const Vec3<Quad> x(a * (cos(E) - e), a * root * sin(E), Quad(0)),
        v(-a * rate * sin(E), a * rate * root * cos(E), Quad(0));
    const Vec3<Quad> drift(Quad(0.001), Quad(-0.002), Quad(0.003));
    const Quad light = Quad(0.25) / total, heavy = Quad(1) / total;
    ParticleSystem<Quad> s;
    s.add("heavy", 1, t * drift - light * x, drift - light * v);
    s.add("light", 0.25, t * drift + heavy * x, drift + heavy * v);
    return s;
  }
  /// Eccentric anomaly at time t since the pericentre, by Newton's method from above.
  Quad anomaly(const Quad& t) const {
    const Quad M = motion() * t;
    Quad E = M + e;
    for (int k = 0; k < 60; ++k) E -= (E - e * sin(E) - M) / (Quad(1) - e * cos(E));
    return E;
  }
};

}  // namespace

TEMPLATE_TEST_CASE("working coordinates lead back to the inertial ones, to rounding", "[wisdom_holman]", double, Quad) {
  const auto start = test::planets_with_tracers(20).as<TestType>();
  for (const Coordinates coordinates : each) {
    auto hamiltonian = splitting<TestType>(coordinates);
    auto s = start;
    hamiltonian.bind(s);
    hamiltonian.open(s);
    CHECK(s.phase().coordinates == static_cast<std::uint8_t>(coordinates));
    CHECK_FALSE(test::same_bits(s, start));
    hamiltonian.close(s);
    CHECK(s.phase().coordinates == 0);
    // The largest distances, 40 au and 0.02 au/day, are what additions round by.
    const TestType unit = std::numeric_limits<TestType>::epsilon() / TestType(2);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<TestType> dx = std::as_const(s).positions()[i] - start.positions()[i];
      const Vec3<TestType> dv = std::as_const(s).velocities()[i] - start.velocities()[i];
      CHECK(norm2(dx) <= TestType(64 * 1600) * unit * unit);
      CHECK(norm2(dv) <= TestType(64 * 4e-4) * unit * unit);
    }
  }
}

TEST_CASE("the center of mass is row 0 of the working coordinates and moves straight", "[wisdom_holman]") {
  for (const Coordinates coordinates : each) {
    auto s = scrambled();
    auto composition = compose(splitting(coordinates), schemes::verlet);
    s.clock() = Clock<double>::fixed(0, 40);
    composition.bind(s);
    ParticleSystem<double> opened = s;
    composition.hamiltonian().open(opened);
    Vec3<Quad> x = Vec3<Quad>::Zero(), v = Vec3<Quad>::Zero();
    Quad total = 0;
    for (Index i = 0; i < s.size(); ++i) {
      const Quad m = s.masses()[i];
      for (int k = 0; k < 3; ++k) {
        x[k] += m * Quad(std::as_const(s).positions()[i][k]);
        v[k] += m * Quad(std::as_const(s).velocities()[i][k]);
      }
      total += m;
    }
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(std::as_const(opened).positions()[0][k] - static_cast<double>(x[k] / total)) < 0x1p-53);
      CHECK(std::abs(std::as_const(opened).velocities()[0][k] - static_cast<double>(v[k] / total)) < 0x1p-60);
    }
    composition.advance(s, {.steps = 100});
    CHECK(std::as_const(s).velocities()[0] == std::as_const(opened).velocities()[0]);
  }
}

TEST_CASE("Jacobi coordinates take the bodies by semi-major axis, however they are given", "[wisdom_holman]") {
  auto s = scrambled();
  WisdomHolman hamiltonian({.G = outer_G});
  hamiltonian.bind(s);
  CHECK(hamiltonian.order() == Ranks{0, 2, 4, 3, 1});

  auto visited = with_visitors().as<double>();
  hamiltonian.bind(visited);
  // Unbound bodies after bound ones, tracers after massive bodies.
  CHECK(hamiltonian.order() == Ranks{0, 1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE("in what order the bodies are given matters to rounding only", "[wisdom_holman]") {
  auto ordered = test::outer_planets();
  ordered.remove(5);
  const auto a = run(ordered, splitting(), schemes::aba_10_6_4, 100.0, 200);
  const auto b = run(scrambled(), splitting(), schemes::aba_10_6_4, 100.0, 200);
  const Index place[] = {0, 2, 4, 3, 1};
  for (Index i = 0; i < 5; ++i) {
    const Vec3<double> d = a.positions()[i] - b.positions()[place[i]];
    CHECK(std::sqrt(norm2(d) / norm2(a.positions()[i])) < 1e-12);
  }
}

TEST_CASE("the order of Jacobi coordinates is state: it is saved and comes back", "[wisdom_holman]") {
  auto s = scrambled();
  WisdomHolman first({.G = outer_G});
  first.bind(s);
  SavedState saved;
  first.save(saved, "");
  // The same particles later, Jupiter now outermost.
  s.positions().set(2, {300, 0, 0});
  s.velocities().set(2, {0, 0.0005, 0});
  WisdomHolman second({.G = outer_G});
  second.bind(s);
  CHECK(second.order() == Ranks{0, 4, 3, 1, 2});
  second.load(saved, "");
  CHECK(second.order() == Ranks{0, 2, 4, 3, 1});
}

TEST_CASE("massless primaries and tracers before massive bodies are refused", "[wisdom_holman]") {
  auto massless = test::outer_planets();
  massless.masses()[0] = 0;
  CHECK_THROWS_WITH(Simulation(massless, compose(splitting(), schemes::verlet), 40.0),
                    "'Sun' comes first, so it is the primary of wisdom_holman, but its mass is 0; put the most massive "
                    "body first");
  auto mixed = test::outer_planets();
  mixed.masses()[2] = 0;
  CHECK_THROWS_WITH(Simulation(mixed, compose(splitting(), schemes::verlet), 40.0),
                    "'Uranus' has mass but comes after the tracer 'Saturn'; put tracers after all massive bodies");
  auto tracers = test::outer_planets();
  for (Index i = 1; i < tracers.size(); ++i) tracers.masses()[i] = 0;
  CHECK(Simulation(tracers, compose(splitting(), schemes::verlet), 40.0).run(1).ok());
}

/// A headwind, and a field that turns velocities about an axis.
struct Wind {
  double rate = 0, turn = 0;
  static ForceClaims claims() { return {.energy = false, .velocity_dependent = true}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> v = s.velocities()[i];
      out.acceleration(i, Real(-rate) * v + Real(turn) * Vec3<Real>(v[1], -v[0], Real(0)));
    }
  }
};

TEST_CASE("kicks by forces that depend on velocities are steps of the implicit midpoint rule", "[wisdom_holman]") {
  ParticleSystem<double> start;
  start.add("star", 1, {0, 0, 0}, {0.1, -0.2, 0});
  start.add("planet", 1e-3, {1, 0, 0}, {0, 1, 0.1});
  start.add("tracer", 0, {0, 2, 0}, {-0.7, 0, 0.2});
  const double h = 0.3;
  for (const Coordinates coordinates : each) {
    CAPTURE(static_cast<int>(coordinates));
    const auto after = [&](const Wind& wind) {
      auto s = start;
      s.clock() = Clock<double>::fixed(0, h);
      WisdomHolman<double, Wind> arcs({.coordinates = coordinates}, wind);
      arcs.bind(s);
      arcs.open(s);
      arcs.flow('B', s, h);
      CHECK_FALSE(arcs.failure().has_value());
      const auto there = s.velocities();
      arcs.flow('B', s, -h);
      arcs.close(s);
      for (Index i = 0; i < s.size(); ++i)  // a symmetric map: back again
        CHECK(std::sqrt(norm2(Vec3<double>(s.velocities()[i] - start.velocities()[i]))) < 1e-14);
      return there;
    };
    // Linear drag multiplies whatever else the kick adds; both are linear in h to the first order, exactly so here.
    const auto still = after({}), slow = after({.rate = 0.5});
    auto opened = start;
    WisdomHolman<double> plain({.coordinates = coordinates});
    plain.bind(opened);
    plain.open(opened);
    for (Index i = 0; i < start.size(); ++i) {
      const Vec3<double> v = std::as_const(opened).velocities()[i], kick = std::as_const(still)[i] - v;
      const Vec3<double> expected = ((1 - 0.075) * v + kick) / (1 + 0.075);
      CAPTURE(i);
      if (coordinates == Coordinates::jacobi)  // elsewhere jumps stand around the kick, which move positions
        CHECK(std::sqrt(norm2(Vec3<double>(std::as_const(slow)[i] - expected))) < 1e-14);
    }
    // A field that turns velocities keeps their length about the centre of mass, for a tracer that nothing pulls.
    ParticleSystem<double> alone;
    alone.add("star", 1, {0, 0, 0}, {0.1, -0.2, 0});
    alone.clock() = Clock<double>::fixed(0, h);
    WisdomHolman<double, Wind> field({.coordinates = coordinates}, {.turn = 3});
    field.bind(alone);
    field.open(alone);
    field.flow('B', alone, h);
    field.close(alone);
    CHECK(std::abs(norm2(Vec3<double>(alone.velocities()[0])) - 0.05) < 1e-16);
    CHECK(std::abs(alone.velocities()[0][0] - 0.1) > 0.05);
  }
}

TEST_CASE("a kick that does not converge ends a run with what to do", "[wisdom_holman]") {
  const WisdomHolman<double, Wind> arcs({.G = outer_G}, Wind{.rate = 1});
  for (const double dt : {40.0, 200.0, 1e5}) {  // from 200 on the rounds leave the range of doubles
    CAPTURE(dt);
    Simulation<double> run(test::outer_planets(), compose(arcs, schemes::verlet), dt);
    const Outcome outcome = run.run(3);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK(outcome.step == 0);
    CHECK(outcome.message == "a kick by forces that depend on velocities did not converge; take a smaller step");
  }
}

TEST_CASE("two bodies alone move on their exact orbit, whatever the step", "[wisdom_holman]") {
  const Coordinates coordinates = GENERATE(from_range(std::begin(exact_for_two), std::end(exact_for_two)));
  const TwoBodies two;
  const double period = static_cast<double>(Quad(2) * 3.14159265358979323846264338327950288_q / two.motion());
  for (const double dt : {0.01, 0.37, 1.0, 7.3, -0.6}) {
    for (const char* name : {"verlet", "verlet_aba", "abah_10_6_4"}) {
      const std::int64_t n = 12;
      CAPTURE(dt, name, static_cast<int>(coordinates));
      const auto end = run(two.at(0, 0), splitting<Quad>(coordinates), *schemes::find(name), dt * period, n);
      const Quad t = Quad(n) * Quad(dt * period);
      const auto exact = two.at(two.anomaly(t), t);
      CHECK(difference(exact, end) < 1e-28);
    }
  }
}

TEST_CASE("a primary alone moves straight, and tracers about it on exact orbits", "[wisdom_holman]") {
  ParticleSystem<double> alone;
  alone.add("Sun", 1, {1, 2, 3}, {0.5, 0, -0.25});
  const auto moved = run(alone, splitting(), schemes::verlet, 0.5, 8);
  CHECK(moved.positions()[0] == Vec3<double>(3, 2, 2));

  // A tracer is the second of two bodies whose mass has gone.
  auto start = test::planets_with_tracers(1);
  ParticleSystem<Quad> s;
  s.add("Sun", 1, Vec3<Quad>::Zero(), Vec3<Quad>::Zero());
  s.add("tracer", 0, {Quad(2), Quad(0), Quad(0)}, {Quad(0), sqrt(Quad(outer_G) / Quad(2)), Quad(0)});
  for (const Coordinates coordinates : each) {
    const std::int64_t n = 10;
    const double dt = 333;
    const auto end = run(s, splitting<Quad>(coordinates), schemes::verlet, dt, n);
    const Quad angle = sqrt(Quad(outer_G) / Quad(8)) * Quad(n) * Quad(dt);
    CHECK(abs(std::as_const(end).positions()[1][0] - Quad(2) * cos(angle)) < Quad(1e-29));
    CHECK(abs(std::as_const(end).positions()[1][1] - Quad(2) * sin(angle)) < Quad(1e-29));
  }
}

TEST_CASE("a tracer is the limit of a body whose mass goes to zero", "[wisdom_holman]") {
  // Pluto on its own orbit about the Sun, outside of all planets, and on smaller ones among them and within.
  const auto final_state = [](Coordinates coordinates, double size, double of_pluto) {
    auto s = test::outer_planets<Quad>();
    const auto& c = std::as_const(s);
    const Vec3<Quad> x = c.positions()[5] - c.positions()[0], v = c.velocities()[5] - c.velocities()[0];
    s.positions().set(5, c.positions()[0] + Quad(size) * x);
    s.velocities().set(5, c.velocities()[0] + v / sqrt(Quad(size)));
    s.masses()[5] = of_pluto;
    return run(s, splitting<Quad>(coordinates), schemes::verlet_aba, 100.0 * size, 30);
  };
  for (const Coordinates coordinates : each) {
    for (const double size : {1.0, 0.6, 0.35, 0.2, 0.1, 0.02}) {
      const auto tracer = final_state(coordinates, size, 0);
      const double coarse = difference(tracer, final_state(coordinates, size, 1e-8));
      const double fine = difference(tracer, final_state(coordinates, size, 1e-9));
      CAPTURE(size, coarse, fine);
      CHECK(fine > 1e-20);
      CHECK(fine < 1e-5);  // of the Sun, which the body carries with it, the way is short
      CHECK(std::abs(std::log10(coarse / fine) - 1) < 1e-3);
    }
  }
}

TEST_CASE("a tracer near the primary stays on its orbit, however far out the massive bodies are", "[wisdom_holman]") {
  // Within Jupiter's tide, 1e-3 (0.02 / 5)^3 = 6e-11 of the attraction.
  const double mu = outer_G;
  const auto at = [&](double M) { return state_from_elements<double>({0.02, 0.1, 0.3, 0.2, 0.1, M}, mu); };
  ParticleSystem<double> s(unit_system("solar"));
  s.add("Star", 1, {0, 0, 0}, {0, 0, 0});
  const auto [far, slow] = state_from_elements<double>({5.2, 0.05, 0, 0, 0, 0.4}, outer_G * 1.001);
  s.add("Companion", 0.001, far, slow);
  const auto [x, v] = at(1);
  s.add("small", 0, x, v);
  const double days = 40, motion = std::sqrt(mu / (0.02 * 0.02 * 0.02));
  const Vec3<double> expected = at(std::fmod(1 + motion * days, 2 * std::numbers::pi)).first;
  const auto end = run(s, splitting(Coordinates::jacobi), schemes::verlet, 0.05, 800);
  CHECK(std::sqrt(norm2(Vec3<double>(end.positions()[2] - end.positions()[0] - expected))) < 1e-6 * 0.02);
}

TEST_CASE("what a tracer goes round is state; runs saved without it go on as they began", "[wisdom_holman]") {
  auto s = test::planets_with_tracers(3);  // within Jupiter's orbit
  const auto places = [](const SavedState& saved) { return std::get<Ranks>(saved.at("within")); };
  WisdomHolman first({.G = outer_G}), second({.G = outer_G});
  SavedState saved, again;
  first.bind(s);
  first.save(saved, "");
  CHECK(places(saved) == Ranks{0, 1, 2, 3, 4, 5, 0, 0, 0});
  second.bind(s);
  std::get<Ranks>(saved.at("within"))[6] = 3;
  second.load(saved, "");
  second.save(again, "");
  CHECK(places(again) == Ranks{0, 1, 2, 3, 4, 5, 3, 0, 0});
  saved.erase("within");  // as when tracers went round all bodies
  second.load(saved, "");
  second.save(again, "");
  CHECK(places(again) == Ranks{0, 1, 2, 3, 4, 5, 5, 5, 5});
  for (const Ranks& wrong : {Ranks{0, 1, 2, 3, 4, 5, 0, 0}, Ranks{0, 1, 2, 3, 4, 5, 0, 0, 6},
                             Ranks{0, 1, 2, 3, 4, 5, 0, -1, 0}, Ranks{0, 2, 1, 3, 4, 5, 0, 0, 0}}) {
    saved["within"] = wrong;
    CHECK_THROWS_WITH(second.load(saved, ""),
                      "the saved places of tracers among the bodies do not match these particles");
  }
}

TEST_CASE("tracers leave the massive bodies alone, bit for bit", "[wisdom_holman]") {
  for (const Coordinates coordinates : each) {
    const auto bare = run(test::outer_planets(), splitting(coordinates), schemes::verlet, 40.0, 50);
    const auto followed = run(test::planets_with_tracers(20), splitting(coordinates), schemes::verlet, 40.0, 50);
    for (Index i = 0; i < bare.size(); ++i) {
      CHECK(bare.positions()[i] == followed.positions()[i]);
      CHECK(bare.velocities()[i] == followed.velocities()[i]);
    }
  }
}

TEST_CASE("splittings in all coordinates and the inertial one agree ever better, with the order of the scheme",
          "[wisdom_holman]") {
  // Planets, a massive visitor on a hyperbola, tracers bound and unbound.
  const auto start = with_visitors();
  const auto inertial = test::kinetic_potential<Quad>(Gravity{.G = outer_G});
  for (const Coordinates coordinates : each) {
    CAPTURE(static_cast<int>(coordinates));
    CHECK(std::abs(common_order(start, splitting<Quad>(coordinates), inertial) - 8) < 0.4);
  }
  CHECK(std::abs(common_order(start, splitting<Quad>(), splitting<Quad>(Coordinates::democratic)) - 8) < 0.4);
}

TEST_CASE("other forces join the kicks in all coordinates, with the time of their stage", "[wisdom_holman]") {
  const UniformField field{.acceleration = {2e-7, -1e-7, 3e-7}};
  const OscillatingField tide{.acceleration = {1e-6, 2e-6, -1e-6}, .omega = 0.02};
  const Oblateness flat{.J2 = 0.01, .J4 = -0.001, .radius = 0.5, .axis = {0.1, 0.3, 1}, .G = outer_G};
  const auto start = with_visitors();
  const auto inertial = test::kinetic_potential<Quad>(Gravity{.G = outer_G}, field, tide, flat);
  for (const Coordinates coordinates : each) {
    const auto split = test::wisdom_holman<Quad>({.G = outer_G, .coordinates = coordinates}, field, tide, flat);
    // In the others J does not commute with them, so that kicks are exact to order 2 only; these forces
    // are as weak as the interaction, so the error is that of abah_8_6_4 in the first power of it.
    const bool exact = coordinates == Coordinates::jacobi;
    const Scheme& scheme = exact ? schemes::yoshida_8 : schemes::abah_8_6_4;
    CHECK(std::abs(common_order(start, split, inertial, scheme) - 8) < 0.4);
  }
}

TEST_CASE("a uniform field accelerates the center of mass as it does one body", "[wisdom_holman]") {
  const double g = 1e-6, dt = 40;
  const std::int64_t n = 50;
  for (const Coordinates coordinates : each) {
    const auto split =
        test::wisdom_holman<Quad>({.G = outer_G, .coordinates = coordinates}, UniformField{.acceleration = {g, 0, 0}});
    const auto start = test::outer_planets<Quad>();
    const auto end = run(start, split, schemes::verlet, dt, n);
    Quad moved = 0, speed = 0, total = 0;
    for (Index i = 0; i < end.size(); ++i) {
      moved += end.masses()[i] * (end.positions()[i][0] - start.positions()[i][0]);
      speed += start.masses()[i] * start.velocities()[i][0];
      total += end.masses()[i];
    }
    const Quad t = Quad(n) * Quad(dt);
    const Quad expected = t * speed / total + Quad(g) * t * t / Quad(2);
    CHECK(abs(moved / total - expected) < Quad(1e-30));
  }
}

TEST_CASE("energy and accelerations are those of inertial bodies", "[wisdom_holman]") {
  const auto s = with_visitors();
  auto inertial = test::kinetic_potential<Quad>(Gravity{.G = outer_G});
  auto bound = s;
  inertial.bind(bound);
  VectorColumn<Quad> expected(s.size()), found(s.size());
  inertial.accelerations(s, expected);
  for (const Coordinates coordinates : each) {
    auto split = splitting<Quad>(coordinates);
    split.bind(bound);
    CHECK(split.energy(s).total() == inertial.energy(s).total());
    split.accelerations(s, found);
    for (Index i = 0; i < s.size(); ++i) CHECK((std::as_const(found)[i] == std::as_const(expected)[i]));
  }
}

TEST_CASE("a body in the primary ends the run by name", "[wisdom_holman]") {
  auto s = test::outer_planets();
  s.add("Sundiver", 0, s.positions()[0], s.velocities()[0]);
  Simulation simulation(std::move(s), compose(splitting(Coordinates::democratic), schemes::verlet_aba), 40.0);
  const Outcome outcome = simulation.run(10);
  CHECK(to_text(outcome) == "solver_failure at step 0: the Kepler solver did not converge for Sundiver");
  REQUIRE(outcome.particle.has_value());
  CHECK(outcome.particle->name == "Sundiver");
}

TEST_CASE("claims of the splitting follow its coordinates and its forces", "[wisdom_holman]") {
  const auto jacobi = splitting().claims(), democratic = splitting(Coordinates::democratic).claims();
  CHECK(jacobi.inexact.empty());
  CHECK(democratic.inexact.empty());
  for (const Coordinates coordinates : {Coordinates::whds, Coordinates::barycentric}) {
    const HamiltonianClaims claims = splitting(coordinates).claims();
    CHECK(claims.inexact == "B");
    CHECK(!claims.quadratic_kinetic);
    CHECK(claims.symplectic);
    CHECK(claims.keeps_momentum);
    CHECK(claims.keeps_angular_momentum);
  }
  CHECK(!democratic.quadratic_kinetic);
  const auto in_field = test::wisdom_holman({.coordinates = Coordinates::democratic}, HarmonicField{.k = 0.3});
  CHECK(in_field.claims().inexact == "B");
  CHECK(jacobi.keeps_momentum);
  const auto driven = test::wisdom_holman({.G = outer_G}, OscillatingField{});
  CHECK(driven.claims().time_dependent);
  CHECK_FALSE(driven.claims().keeps_momentum);
}

}  // namespace noether
