/// Gauss and Gauss-Radau collocation: tables, orders, what they keep, and how they find their steps.

#include "integrators/methods/collocation.hpp"

#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/linear_drag.hpp"
#include "forces/springs.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/motions.hpp"
#include "tests/methods/restarts.hpp"
#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"

#include <Eigen/LU>

#include <cmath>

using namespace noether;

namespace {

const Gravity outer_gravity{.G = test::outer_G};

std::string gauss_name(int stages) { return stages == 1 ? "implicit_midpoint" : "gauss_" + std::to_string(stages); }

MethodOptions fixed_steps(const std::string& name) {
  MethodOptions options;
  if (methods::find(name)->adaptive) options.adaptive = false;
  return options;
}

double worst_sum(const CollocationTable& t, const std::vector<Quad>& weights, int power, Quad expected) {
  Quad sum = 0;
  for (std::size_t j = 0; j < t.stages(); ++j) {
    Quad x = weights[j];
    for (int p = 0; p < power; ++p) x *= t.c[j];
    sum += x;
  }
  return std::abs(static_cast<double>(sum - expected));
}

/// Relative state of a planet on an ellipse, from the pericenter, in any number of bodies.
ParticleSystem<double> ellipse(double e) {
  ParticleSystem<double> s;
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 0, {1 - e, 0, 0}, {0, std::sqrt((1 + e) / (1 - e)), 0});
  return s;
}

double energy_of(const ParticleSystem<double>& s) {
  const Vec3<double> x = s.positions()[1], v = s.velocities()[1];
  return norm2(v) / 2 - 1 / std::sqrt(norm2(x));
}

/// The angle of one step on an oscillator, h omega = z: the phase of Pade's approximation of exp(i z) with s stages,
/// twice that of its numerator sum_j (2 s - j)! / (j! (s - j)!) (i z)^j.
Quad turn_of(int s, const Quad& z) {
  using std::atan2;
  Quad re(0), im(0), power(1), weight(1);
  for (int j = 0; j <= s; ++j) {
    (j % 2 == 0 ? re : im) += (j % 4 < 2 ? weight : -weight) * power;
    power *= z;
    weight *= Quad(s - j) / (Quad(2 * s - j) * Quad(j + 1));
  }
  return Quad(2) * atan2(im, re);
}

/// Gravity for doubles alone, and so evaluated stage by stage.
struct InTurn {
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const { outer_gravity.add_to(out, s); }
};

}  // namespace

TEST_CASE("tables of collocation are those in print, and integrate polynomials exactly", "[tables]") {
  // integrators.md 2.6, 25 digits.
  const CollocationTable& four = gauss_table(4);
  CHECK(std::abs(static_cast<double>(four.c[0] - 0.06943184420297371238802676_q)) < 1e-25);
  CHECK(std::abs(static_cast<double>(four.a[1][2] + 0.02788042860247089522415_q)) < 1e-22);
  CHECK(std::abs(static_cast<double>(four.b[0] - 0.173927422568726928686532_q)) < 1e-23);
  const CollocationTable& radau = radau_left_table();
  CHECK(radau.c[0] == Quad(0));
  CHECK(std::abs(static_cast<double>(radau.c[1] - 0.0562625605369221464656521910318_q)) < 1e-24);
  // The last of these and the weight are from mpmath with 40 digits: digits in print, of IAS15 too, end at 1e-24.
  CHECK(std::abs(static_cast<double>(radau.c[7] - 0.9775206135612875018911745004291549_q)) < 1e-30);
  CHECK(std::abs(static_cast<double>(radau.b[4] * Quad(2) - 0.3915721674524935930824995340041291_q)) < 1e-30);
  for (int s = 1; s <= 9; ++s) {
    const CollocationTable& t = s == 9 ? radau : gauss_table(s);
    const int stages = static_cast<int>(t.stages());
    REQUIRE(stages == (s == 9 ? 8 : s));
    for (int k = 1; k <= t.order; ++k) CHECK(worst_sum(t, t.b, k - 1, Quad(1) / Quad(k)) < 1e-30);
    CHECK(worst_sum(t, t.b, t.order, Quad(1) / Quad(t.order + 1)) > 1e-12);
    for (std::size_t i = 0; i < t.stages(); ++i) {
      Quad power = t.c[i];
      for (int k = 1; k <= stages; ++k) {
        CHECK(worst_sum(t, t.a[i], k - 1, power / Quad(k)) < 1e-28);
        power *= t.c[i];
      }
    }
  }
}

TEST_CASE("every collocation method has its order", "[order]") {
  for (int s = 1; s <= 9; ++s) {
    const std::string name = s == 9 ? "gauss_radau_15" : gauss_name(s);
    auto f = test::kepler<Quad>();
    const auto method = test::make<Quad>(name.c_str(), fixed_steps(name));
    const auto start = test::kepler_start<Quad>(Quad(0.25));
    const auto reference = test::make<Quad>("gauss_8", {.adaptive = false});
    const auto exact = test::walk(*reference, f, start, 1.0 / 128, 512);
    std::vector<test::ErrorPoint> points;
    for (const long n : {long{16}, long{32}, long{64}}) {  // powers of two: steps are doubles
      const long steps = s <= 2 ? 8 * n : s <= 4 ? 2 * n : n;
      const double h = 4.0 / static_cast<double>(steps);
      points.push_back({h, test::distance(test::walk(*method, f, start, h, steps), exact)});
    }
    CAPTURE(name, test::to_text(points));
    CHECK(std::abs(test::fitted_slope(points) - methods::find(name)->order) < 0.35);
  }
}

TEST_CASE("velocity-dependent forces and systems of first order have the order too", "[order]") {
  // A damped oscillator, told as q'' = a(q, v).
  for (const char* name : {"implicit_midpoint", "gauss_2", "gauss_3", "gauss_radau_15"}) {
    test::Motion<Quad> f(
        1, [](const Quad&, const Vector<Quad>& y, Quad* a) { a[0] = -y[0] - Quad(0.5) * y[1] - y[0] * y[0] * y[1]; },
        true);
    const auto method = test::make<Quad>(name, fixed_steps(name));
    const auto reference = test::make<Quad>("dop853", {.adaptive = false});
    Vector<Quad> start(2);
    start << Quad(1), Quad(0.25);
    const auto exact = test::walk(*reference, f, start, 1.0 / 2048, 4096);
    const int order = methods::find(name)->order;
    std::vector<test::ErrorPoint> points;
    for (const long n : {long{8}, long{16}, long{32}}) {
      const long steps = order < 5 ? 4 * n : order > 9 ? n / 4 : n;
      const double h = 2.0 / static_cast<double>(steps);
      points.push_back({h, test::distance(test::walk(*method, f, start, h, steps), exact)});
    }
    CAPTURE(name, test::to_text(points));
    CHECK(std::abs(test::fitted_slope(points) - order) < (order > 9 ? 1.0 : 0.3));
  }
}

TEST_CASE("energy of the outer planets stays at rounding, with fixed steps and with the method's own", "[kept]") {
  constexpr double century = 36525;
  for (const char* name : {"gauss_8", "gauss_radau_15"}) {
    CAPTURE(name);
    Simulation adaptive(test::outer_planets(), test::classical_over(outer_gravity, method(name)));
    auto& energy = adaptive.every(5, Energy{});
    REQUIRE(adaptive.run_until(10 * century).ok());
    CHECK(energy.worst() < 4e-15);
    Simulation fixed(test::outer_planets(), test::classical_over(outer_gravity, method(name, {.adaptive = false})),
                     250.0);
    auto& other = fixed.every(5, Energy{});
    REQUIRE(fixed.run(1461).ok());
    CHECK(other.worst() < 4e-15);
    Vec3<double> far = fixed.particles().positions()[1] - adaptive.particles().positions()[1];
    CHECK(std::sqrt(norm2(far)) < 1e-10);
  }
}

TEST_CASE("stages at rest are not evaluated again where each is evaluated by itself, and nothing is lost", "[stages]") {
  struct Way {
    const char* name;
    double step;  ///< 0: its own
  };
  for (const Way& way :
       {Way{"gauss_8", 0}, Way{"gauss_radau_15", 0}, Way{"gauss_8", 400}, Way{"gauss_5", 50}, Way{"gauss_6", 100}}) {
    CAPTURE(way.name, way.step);
    const auto run = [&](const auto& force) {
      const auto integrator = test::classical_over(force, method(way.name, {.adaptive = way.step == 0}));
      Simulation sim = way.step > 0 ? Simulation(test::outer_planets(), integrator, way.step)
                                    : Simulation(test::outer_planets(), integrator);
      auto& energy = sim.every(5, Energy{});
      REQUIRE(sim.run_until(400'000).ok());
      CHECK(energy.worst() < 4e-15);
      return sim;
    };
    // Softening that is not felt: gauss_8 has another form for points of mass.
    auto lanes = run(Gravity{.G = test::outer_G, .softening = 1e-30}), in_turn = run(InTurn{});
    const double all = static_cast<double>(lanes.evaluations().force) / static_cast<double>(lanes.step());
    const double asked = static_cast<double>(in_turn.evaluations().force) / static_cast<double>(in_turn.step());
    CHECK(asked < 0.98 * all);
    CHECK(asked > 0.5 * all);
    const Vec3<double> far = in_turn.particles().positions()[1] - lanes.particles().positions()[1];
    CHECK(std::sqrt(norm2(far)) < 2e-11);
  }
}

TEST_CASE("an oscillator keeps its energy to rounding with any number of stages", "[stages]") {
  test::Motion<double> f(1, [](const double&, const Vector<double>& y, double* a) { a[0] = -y[0]; });
  for (const char* name : {"gauss_2", "gauss_3", "gauss_4", "gauss_5", "gauss_6", "gauss_7", "gauss_8"}) {
    const auto method = test::make<double>(name, fixed_steps(name));
    for (const double h : {0.025, 0.05, 0.1, 0.2, 0.4}) {
      Vector<double> y(2);
      y << 1, 0.5;
      const double before = y.squaredNorm();
      y = test::walk(*method, f, y, h, 10'000);
      CAPTURE(name, h, y.squaredNorm() / before - 1);
      CHECK(std::abs(y.squaredNorm() / before - 1) < 3e-14);
    }
  }
}

TEST_CASE("stages are found on a stiff spring, at turning points too, where only rounding moves", "[stages]") {
  // omega = 100, h omega = 1: forces cancel to 1e-4 of what their parts are.
  ParticleSystem<double> s;
  s.add("bob", 1, {1.001, 0, 0}, {0, 0, 0});
  const auto forces =
      test::field_of(Tether{.k = 1e4, .length = 1, .tied = {{0}}}, UniformField{.acceleration = {0, -1, 0}});
  for (const char* name : {"implicit_midpoint", "gauss_2", "gauss_4"}) {
    CAPTURE(name);
    Simulation run(s, test::classical_over(forces, method(name, fixed_steps(name))), 0.01);
    auto& energy = run.every(10, Energy{});
    const Outcome outcome = run.run(20'000);
    CAPTURE(to_text(outcome));
    CHECK(outcome.ok());
    CHECK(energy.worst() < 1);
  }
}

TEST_CASE("the same bits whatever looks on, and after a restart in the middle", "[restart]") {
  const auto make = [](bool adaptive) {
    return test::classical_over(test::field_of(outer_gravity, DragForce{{.rate = 1e-9}}),
                                method("gauss_8", {.adaptive = adaptive}));
  };
  Simulation whole(test::outer_planets(), make(true));
  whole.every_time(321.0, Energy{});
  REQUIRE(whole.run_until(40000).ok());
  Simulation first(test::outer_planets(), make(true)), second(test::outer_planets(), make(true));
  first.every_time(321.0, Energy{});
  second.every_time(321.0, Energy{});
  REQUIRE(first.run_until(17001).ok());
  second.restore(first.save());
  REQUIRE(second.run_until(40000).ok());
  CHECK(test::same_bits(whole.particles(), second.particles()));
  CHECK(whole.evaluations().force == second.evaluations().force);
  Simulation bare(test::outer_planets(), make(true));
  REQUIRE(bare.run_until(40000).ok());
  CHECK(test::same_bits(whole.particles(), bare.particles()));
}

TEST_CASE("a nearly straight fall and back needs no hint", "[extreme]") {
  for (const char* name : {"gauss_8", "gauss_radau_15"}) {
    const double e = 0.999999;
    const auto start = ellipse(e);
    Simulation run(start, test::classical_over(Gravity{.G = 1}, method(name)));
    REQUIRE(run.run_until(20 * 3.141592653589793).ok());
    CAPTURE(name, run.step(), run.evaluations().rejected);
    // Rounding of the start, where speeds are 1400, is 1e6 times that of the energy.
    CHECK(std::abs(energy_of(run.particles()) / energy_of(start) - 1) < 1e-9);
    CHECK(run.step() > 100);
    CHECK(run.step() < 10000);
  }
}

TEST_CASE("a step without solution is a named failure, and adaptive steps need no Newton", "[failure]") {
  // At the center of a force without softening nothing is a number.
  auto center = test::kepler<double>();
  for (const char* name : {"implicit_midpoint", "gauss_8"}) {
    const auto fixed = test::make<double>(name, fixed_steps(name));
    fixed->bind(center);
    Vector<double> start(4);
    start << 0, 0, 0, 0;
    const StepResult failed = fixed->step(center, 0, start, 1.0);
    REQUIRE(failed.failure);
    CHECK(failed.failure->kind == Outcome::Kind::solver_failure);
    CHECK(failed.failure->message == "the stages of '" + std::string(name) +
                                         "' do not converge with a step of 1; give a shorter one" +
                                         (fixed_steps(name).adaptive ? ", or adaptive steps" : ""));
  }
  auto f = test::oscillator<double>(1000.0);
  const auto adaptive = test::make<double>("gauss_8", {.first = 1.0});
  Vector<double> again(2);
  again << 1, 0;
  const auto end = test::travel(*adaptive, f, again, 1.0);
  CHECK(std::abs(end[0] - std::cos(1000.0)) < 1e-12);
  CHECK(f.evaluations().rejected > 5);
  CHECK(f.evaluations().jacobian == 0);
}

TEST_CASE("steps do not shrink without end where a force fades away and ends", "[adaptive]") {
  // Two atoms on top of each other: thrown apart, beyond the cutoff they feel nothing, near it rounding of forces.
  ParticleSystem<double> pair;
  pair.add("left", 1, {-0.25, 0, 0}, {0, 0, 0});
  pair.add("right", 1, {0.25, 0, 0}, {0, 0, 0});
  const LennardJonesForce force{.cutoff = 2.5, .cutoff_style = Cutoff::shifted_force, .epsilon = 1.0, .sigma = 1.0};
  for (const char* name : {"gauss_4", "gauss_8", "gauss_radau_15"}) {
    MethodOptions options;
    options.adaptive = true;
    Simulation run(pair, test::classical_over(force, method(name, options)));
    const Energy& energy = run.every_time(0.0001, Energy{});
    REQUIRE(run.run_until(0.02).ok());
    CAPTURE(name, run.step(), run.evaluations().rejected);
    CHECK(energy.worst() < 1e-12);
    CHECK(run.step() < 2000);
    CHECK(run.evaluations().rejected < 100);
  }
}

TEST_CASE("a looser tolerance costs less", "[adaptive]") {
  std::int64_t before = std::numeric_limits<std::int64_t>::max();
  for (const double rtol : {1e-16, 1e-13, 1e-10, 1e-7}) {
    const auto method = test::make<double>("gauss_6", {.rtol = rtol});
    const test::Travelled done = test::once_around(*method);
    CAPTURE(rtol, done.error);
    CHECK(done.evaluations < before);
    CHECK(done.error < std::max(1e-12, 100 * rtol));
    before = done.evaluations;
  }
}

TEST_CASE("rates that vanish in one sweep are not taken for a solution", "[stages]") {
  // From (1, 0) with h omega = 2 the first midpoint is 0, and so is the force there; the step itself is (0, -1).
  ParticleSystem<double> s;
  s.add("ball", 1, {1, 0, 0}, {0, 0, 0});
  Simulation<double> run(s, test::classical_over(HarmonicField{1}, method("implicit_midpoint")), 2);
  REQUIRE(run.run(1).ok());
  CHECK(std::abs(run.particles().positions()[0][0]) < 1e-15);
  CHECK(std::abs(run.particles().velocities()[0][0] + 1) < 1e-15);
  CHECK(run.evaluations().jacobian > 0);
}

TEST_CASE("far beyond the reach of sweeps an oscillator takes the steps of Pade's approximation, and keeps its energy",
          "[stiff]") {
  constexpr int steps = 100;
  for (int s = 1; s <= 8; ++s) {
    for (const double z : {2.0, 10.0, 100.0}) {
      const std::string name = gauss_name(s);
      const MethodChoice choice = method(name, fixed_steps(name));
      const Quad angle = Quad(steps) * turn_of(s, Quad(z));
      const double q = static_cast<double>(cos(angle)), v = static_cast<double>(-sin(angle));
      const auto check = [&](const Vector<double>& end, double scale) {
        CAPTURE(name, z, end[0] - q, end[1] / scale - v);
        CHECK(std::abs(end[0] - q) < 1e-11);
        CHECK(std::abs(end[1] / scale - v) < 1e-11);
        CHECK(std::abs(end[0] * end[0] + end[1] * end[1] / (scale * scale) - 1) < 2e-12);  // rounding of coefficients
      };
      auto f = test::oscillator<double>(z);
      Vector<double> y(2);
      y << 1, 0;
      check(test::walk(*make_method<double>(*choice.info, choice.options), f, y, 1, steps), z);
      // As a system of first order, (q, v / omega).
      const auto first = test::march<double>(test::Rotation{.omega = z}, choice, y, 1, steps);
      REQUIRE_FALSE(first.failure);
      check(first.y, 1);
    }
  }
}

TEST_CASE("a drag that no sweep can follow is solved too, stiff systems of first order by all forms of J", "[stiff]") {
  // v' = -q - 500 v with h = 1: the midpoint rule is Cayley's map.
  test::Motion<double> f(
      1, [](const double&, const Vector<double>& y, double* a) { a[0] = -y[0] - 500 * y[1]; }, true);
  Vector<double> y(2);
  y << 1, 1;
  Eigen::Matrix2d J;
  J << 0, 1, -1, -500;
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  const Eigen::Vector2d expected = (one - J / 2).inverse() * (one + J / 2) * Eigen::Vector2d(1, 1);
  const Vector<double> end = test::walk(*test::make<double>("implicit_midpoint"), f, y, 1, 1);
  CHECK((end - expected).norm() < 1e-14);
  const test::Heat heat{.n = 40};
  for (const char* name : {"implicit_midpoint", "gauss_2", "gauss_3", "gauss_8"}) {
    CAPTURE(name);
    MethodOptions options = fixed_steps(name);
    std::vector<Vector<double>> ends;
    for (const JacobianForm form : {JacobianForm::dense, JacobianForm::sparse, JacobianForm::matrix_free}) {
      options.jacobian = form;
      const auto reached = test::march<double>(heat, method(name, options), heat.start(), 0.02, 4);
      REQUIRE_FALSE(reached.failure);
      CHECK(reached.evaluations.jacobian >= 4);
      ends.push_back(reached.y);
    }
    CHECK((ends[1] - ends[0]).norm() < 1e-13);
    CHECK((ends[2] - ends[0]).norm() < 1e-12);
  }
}

TEST_CASE("steps by Newton's iteration go on with the same bits after a restart", "[restart][stiff]") {
  ParticleSystem<double> s;
  s.add("bob", 1, {1.001, 0, 0}, {0, 0, 0});
  s.add("ball", 1, {0, 1.002, 0}, {0.1, 0, 0.1});
  const auto forces =
      test::field_of(Tether{.k = 1e4, .length = 1, .tied = {{0}, {1}}}, UniformField{.acceleration = {0, -1, 0}});
  for (const char* name : {"implicit_midpoint", "gauss_2", "gauss_8"}) {
    for (const double h : {0.06, 0.1}) {
      CAPTURE(name, h);
      const auto used = test::classical_over(forces, method(name, fixed_steps(name)));
      for (const std::int64_t n : {1, 7, 20}) test::check_goes_on(used, s, n, h);
      Simulation<double> run(s, used, h);
      REQUIRE(run.run(20).ok());
      CHECK(run.evaluations().jacobian >= 10);
    }
  }
}

TEST_CASE("implicit midpoint keeps angular momentum on a stiff spring where the energy suffers", "[kept]") {
  // Claim C24: spring k (r - 1)^2 / 2, m = 1, q = (1.02, 0), v = (0, 1), h = 0.05, 2000 steps: h omega = 0.5 and 5.
  struct Claim {
    double k, energy, margin, momentum;
  };
  for (const Claim& claim : {Claim{100, 1.2e-3, 0.05e-3, 2e-13}, Claim{1e4, 0.051, 0.0005, 1e-13}}) {
    const double k = claim.k;
    test::Motion<double> f(2, [k](const double&, const Vector<double>& y, double* a) {
      const double r = std::sqrt(y[0] * y[0] + y[1] * y[1]), pull = -k * (r - 1) / r;
      a[0] = pull * y[0];
      a[1] = pull * y[1];
    });
    const auto energy = [k](const Vector<double>& y) {
      const double r = std::sqrt(y[0] * y[0] + y[1] * y[1]);
      return (y[2] * y[2] + y[3] * y[3]) / 2 + k / 2 * (r - 1) * (r - 1);
    };
    const auto method = test::make<double>("implicit_midpoint");
    method->bind(f);
    Vector<double> y(4);
    y << 1.02, 0, 0, 1;
    const double e0 = energy(y), l0 = y[0] * y[3] - y[1] * y[2];
    double de = 0, dl = 0;
    for (int n = 0; n < 2000; ++n) {
      REQUIRE(!method->step(f, n * 0.05, y, 0.05).failure);
      de = std::max(de, std::abs(energy(y) / e0 - 1));
      dl = std::max(dl, std::abs((y[0] * y[3] - y[1] * y[2]) / l0 - 1));
    }
    CAPTURE(k, de, dl);
    CHECK(std::abs(de - claim.energy) < claim.margin);
    CHECK(dl < claim.momentum);
  }
}
