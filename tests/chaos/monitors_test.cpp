/// MEGNO and Lyapunov exponents: what is known of them, two runs in 113 bits, restarts, and scenes.

#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/tangent_run.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/chaos.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>

using namespace noether;
using namespace noether::test;

namespace {

/// Two planets of a hundredth of the star's mass in all; `a` of the outer one makes them regular or chaotic.
ParticleSystem<double> two_planets(double mass, double a) {
  ParticleSystem<double> s;
  const double e = 0.1;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("b", mass, {1 - e, 0, 0}, {0, std::sqrt((1 + e) / (1 - e)), 0});
  s.add("c", mass, {-a, 0, 0.01 * a}, {0, -std::sqrt(1 / a), 0});
  move_to_barycenter(s);
  return s;
}

/// ln of how far two runs in 113 bits part whose starts differ by 1e-20 of `c`, at every step.
std::vector<double> partings(const ParticleSystem<double>& start, const Vector<double>& c, double tau, double dt,
                             std::int64_t steps) {
  const auto make = [&](const Quad& epsilon) {
    ParticleSystem<Quad> s = start.as<Quad>();
    const Index n = s.size();
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < n; ++i) {
        s.positions().component(k)[i] += epsilon * Quad(c[k * n + i]);
        s.velocities().component(k)[i] += epsilon * Quad(c[(3 + k) * n + i]);
      }
    }
    return Simulation<Quad>(std::move(s), compose(WisdomHolman<Quad>({.G = 1.0}), schemes::verlet_aba), dt);
  };
  Simulation<Quad> one = make(Quad(0)), other = make(Quad(1e-20));
  std::vector<double> logs;
  for (std::int64_t k = 0; k <= steps; ++k) {
    if (k > 0) REQUIRE((one.run(1).ok() && other.run(1).ok()));
    const ParticleSystem<Quad> a = one.particles(), b = other.particles();
    Quad sum(0);
    for (Index i = 0; i < a.size(); ++i) {
      sum += norm2(Vec3<Quad>(b.positions()[i] - a.positions()[i]));
      sum += Quad(tau * tau) * norm2(Vec3<Quad>(b.velocities()[i] - a.velocities()[i]));
    }
    logs.push_back(0.5 * std::log(static_cast<double>(sum / Quad(1e-40))));
  }
  return logs;
}

std::string scene_of(const std::string& every, const std::string& method = "\"verlet_aba\"") {
  return R"(units = "reduced"
[[particles.body]]
name = "star"
mass = 1.0
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "b"
mass = 0.001
x = [1, 0, 0]
v = [0, 1, 0]
[[particles.body]]
name = "c"
mass = 0.001
x = [-1.6, 0, 0]
v = [0, -0.79, 0.01]
[hamiltonian]
type = "wisdom_holman"
G = 1
[integrator]
method = )" +
         method + R"(
step = 0.1
steps = 200
[[every]]
)" + every;
}

}  // namespace

TEST_CASE("sums of MEGNO are those of known growths", "[chaos]") {
  // ln |c| = lambda t: Y = lambda t exactly, and <Y> = lambda t / 2.
  MegnoSums<double> exponential;
  for (int k = 0; k < 1000; ++k) exponential.add(0.01);
  CHECK(std::abs(exponential.value - 10) < 1e-12);
  CHECK(std::abs(exponential.mean() - 5) < 1e-12);
  // |c| = t from t = 1 on: Y -> 2.
  MegnoSums<double> linear;
  for (int k = 0; k < 100000; ++k) linear.add(std::log((k + 2.0) / (k + 1.0)));
  CHECK(std::abs(linear.value - 2) < 1e-3);
  CHECK(std::abs(linear.mean() - 2) < 2e-3);
}

TEST_CASE("MEGNO of regular planets tends to 2, and of chaotic ones grows as two runs in 113 bits part", "[chaos]") {
  const double dt = 0.15, tau = 1;
  for (const auto& [mass, a, steps, chaotic] : {std::tuple{1e-4, 2.3, 1500, false}, std::tuple{3e-3, 1.4, 900, true}}) {
    const ParticleSystem<double> start = two_planets(mass, a);
    const WisdomHolman<double> hamiltonian({.G = 1.0});
    Megno<double> watching(tangent_flow(hamiltonian, schemes::verlet_aba, start));
    watching.time_scale = tau;
    Simulation<double> sim(start, compose(hamiltonian, schemes::verlet_aba), dt);
    auto& megno = sim.every(300, std::move(watching));
    REQUIRE(sim.run(0).ok());
    SavedState saved;
    megno.save(saved, "megno");
    std::vector<double> numbers;
    load_value(saved, "megno/changes", numbers);
    const Vector<double> c = Eigen::Map<const Vector<double>>(numbers.data(), static_cast<Index>(numbers.size()));
    CHECK(std::abs(c.norm() - 1) < 1e-15);  // tau is 1
    REQUIRE(sim.run(steps).ok());
    const std::vector<double> logs = partings(start, c, tau, dt, steps);
    double sum = 0, mean = 0, y = 0;
    for (int k = 1; k <= steps; ++k) {
      sum += (k - 0.5) * (logs[static_cast<std::size_t>(k)] - logs[static_cast<std::size_t>(k) - 1]);
      mean += 0.5 * (y + 2 * sum / k);
      y = 2 * sum / k;
    }
    mean /= steps;
    INFO("mass " << mass << ": <Y> = " << megno.mean() << ", parting " << logs.back());
    CHECK(std::abs(megno.value() - y) < (chaotic ? 1e-4 : 1e-8));
    CHECK(std::abs(megno.mean() - mean) < (chaotic ? 1e-4 : 1e-8));
    if (chaotic) {
      CHECK(megno.mean() > 4);
      CHECK(logs.back() > 8);
    } else {
      CHECK(std::abs(megno.mean() - 2) < 0.2);
    }
  }
}

TEST_CASE("the Lorenz attractor has its three exponents, whose sum is the divergence of the flow", "[chaos]") {
  const MethodChoice choice = method("rk4");
  const ParticleSystem<double> start = initial_state(Lorenz{}, {1.0, 2.0, 20.0});
  Simulation<double> sim(start, classical(Lorenz{}, choice), 0.0025);
  auto& spectrum = sim.every(
      20000, Lyapunov<double>(
                 tangent_flow<double>(std::make_unique<SystemMotion<Lorenz, double>>(Lorenz{}), choice, start, 3), 3));
  REQUIRE(sim.run(80000).ok());
  const std::vector<double> exponents = spectrum.exponents();
  REQUIRE(exponents.size() == 3);
  CHECK(std::abs(exponents[0] + exponents[1] + exponents[2] + 10 + 1 + 8.0 / 3) < 1e-6);
  // Sprott, Chaos and Time-Series Analysis (2003): 0.9056, 0, -14.5723; a stretch of 200 is short.
  CHECK(std::abs(exponents[0] - 0.9056) < 0.05);
  CHECK(std::abs(exponents[1]) < 0.02);
}

TEST_CASE("exponents of a symplectic map add up to nothing, and neither looks nor a restart change a bit", "[chaos]") {
  const ParticleSystem<double> start = two_planets(1e-3, 1.7);
  const auto make = [&] {
    return Simulation<double>(start, compose(WisdomHolman<double>({.G = 1.0}), schemes::verlet_aba), 0.1);
  };
  const auto watcher = [&](Index k) {
    return Lyapunov<double>(tangent_flow(WisdomHolman<double>({.G = 1.0}), schemes::verlet_aba, start, k), k);
  };
  Simulation<double> whole = make(), first = make(), second = make();
  auto& all = whole.every(50, watcher(18));
  auto& megno =
      whole.every(50, Megno<double>(tangent_flow(WisdomHolman<double>({.G = 1.0}), schemes::verlet_aba, start)));
  first.every(50, watcher(18));
  first.every(50, Megno<double>(tangent_flow(WisdomHolman<double>({.G = 1.0}), schemes::verlet_aba, start)));
  auto& again = second.every(50, watcher(18));
  auto& megno_again =
      second.every(50, Megno<double>(tangent_flow(WisdomHolman<double>({.G = 1.0}), schemes::verlet_aba, start)));
  REQUIRE(whole.run(200).ok());
  REQUIRE(first.run(130).ok());
  second.restore(first.save());
  REQUIRE(second.run(70).ok());
  double sum = 0, size = 0;
  for (const double one : all.exponents()) sum += one, size = std::max(size, std::abs(one));
  CHECK(size > 0.01);
  CHECK(std::abs(sum) < 1e-9);
  CHECK(all.exponents() == again.exponents());
  CHECK(megno.mean() == megno_again.mean());
  CHECK(megno.value() == megno_again.value());
  // An edit ends it, and says so.
  second.edit([](ParticleSystem<double>& s) { s.velocities().add(1, {0.01, 0, 0}); });
  REQUIRE(second.run(50).ok());
  CHECK(again.report().reason.find("edited") != std::string::npos);
}

TEST_CASE("scenes have megno and lyapunov, and refuse them by name where steps have no derivative", "[chaos]") {
  const auto refusal = [](const std::string& every, const std::string& method = "\"verlet_aba\"") {
    return refusal_of([&] { read_scene(scene_of(every, method), "scene.toml"); });
  };
  for (const char* method : {"\"verlet_aba\"", "\"gauss_4\"\nadaptive = false", "\"aba_8_6_4\""}) {
    INFO(method);
    Scene scene = read_scene(scene_of("type = \"megno\"\nsteps = 100", method), "scene.toml");
    Simulation<double> sim = assemble(scene);
    REQUIRE(sim.run(200).ok());
    int seen = 0;
    sim.for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
      if (name != "megno") return;
      ++seen;
      CHECK(std::abs(monitor.get<Megno<double>>()->mean() - 2) < 1);
    });
    CHECK(seen == 1);
  }
  CHECK(refusal("type = \"megno\"\nsteps = 10", "\"dop853\"").find("'dop853' chooses its steps") != std::string::npos);
  CHECK(refusal("type = \"lyapunov\"\nvectors = 19\nsteps = 10").find("more than the 18 numbers") != std::string::npos);
  CHECK(refusal("type = \"lyapunov\"\nvectors = 0\nsteps = 10").find("below 1") != std::string::npos);
  CHECK(refusal("type = \"megno\"\nseed = -1\nsteps = 10").find("below 0") != std::string::npos);
  CHECK(refusal("type = \"megno\"\ntime_scale = 0\nsteps = 10").find("time above 0") != std::string::npos);
}
