// A discrete Lagrangian that a user writes: equal to the built-in one, with parameters, with forces, alone.

#include "integrators/variational/discrete_lagrangian.hpp"
#include "tests/variational/lagrangians.hpp"

using namespace noether;

namespace {

/// The midpoint rule over a pendulum, as a user writes it.
struct OwnMidpoint {
  template <class Real> Real operator()(const Vector<Real>& q0, const Vector<Real>& q1, const Real& h) const {
    using std::cos;
    const Real v = (q1[0] - q0[0]) / h;
    return h * (v * v / Real(2) + cos((q0[0] + q1[0]) / Real(2)));
  }
};

/// Simpson's sum of the potential over a straight line, with a gravity of one's own, and a drag of the trapezoidal
/// kind.
struct OwnSimpson {
  double g = 1, drag = 0;
  static constexpr auto describe() {
    return part<OwnSimpson>("own_simpson", "Simpson's rule over a straight line",
                            field<&OwnSimpson::g>("g", "1", "gravity"), field<&OwnSimpson::drag>("drag", "1", "drag"));
  }
  int order() const { return 2; }
  template <class Real> Real operator()(const Vector<Real>& q0, const Vector<Real>& q1, const Real& h) const {
    using std::cos;
    const Real v = (q1[0] - q0[0]) / h;
    const Real middle = cos((q0[0] + q1[0]) / Real(2));
    return h * (v * v / Real(2) + Real(g) * (cos(q0[0]) + Real(4) * middle + cos(q1[0])) / Real(6));
  }
  template <class Real>
  void force(const Vector<Real>& q0, const Vector<Real>& q1, const Real& /*h*/, Vector<Real>& minus,
             Vector<Real>& plus) const {
    minus[0] = plus[0] = Real(-drag / 2) * (q1[0] - q0[0]);
  }
};

std::vector<double> end_of(Classical<double> steps, double h, long count) {
  Simulation<double> run(phase_state({2.0}, {0.3}), std::move(steps), h);
  REQUIRE(run.run(count).ok());
  return run.particles().variables();
}

}  // namespace

TEST_CASE("a user's midpoint L_d is the built-in one to rounding, with a system behind it and alone", "[own action]") {
  const auto built_in = end_of(variational(SimplePendulum{}, method("variational_midpoint")), 0.1, 60);
  const auto own = end_of(variational(SimplePendulum{}, Variational{OwnMidpoint{}}), 0.1, 60);
  const auto alone = end_of(variational(Variational{OwnMidpoint{}}), 0.1, 60);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(std::abs(own[i] - built_in[i]) < 2e-13);
    CHECK(alone[i] == own[i]);
  }
}

TEST_CASE("an L_d with parameters takes them, and forces beside it take energy", "[own action]") {
  const auto error = [](double h) {
    const auto end = end_of(variational(SimplePendulum{}, Variational{OwnSimpson{}}), h, std::lround(6 / h));
    return std::abs(end[0] + 1.113341245855598);
  };
  CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - 2) < 0.05);
  const auto weak = end_of(variational(Variational{OwnSimpson{.g = 0}}), 0.5, 10);
  CHECK(std::abs(weak[0] - 3.5) < 1e-14);  // free motion
  // q'' = - drag q': p = 0.3 (1 - drag h / 2) / (1 + drag h / 2) a step
  const auto slowed = end_of(variational(Variational{OwnSimpson{.g = 0, .drag = 0.2}}), 0.5, 10);
  CHECK(std::abs(slowed[1] - 0.3 * std::pow(0.95 / 1.05, 10)) < 1e-15);
}

TEST_CASE("an L_d is a method by its name, and is refused where there is no action", "[own action]") {
  const MethodInfo& info = Variational<OwnSimpson>::info();
  CHECK(info.name == "own_simpson");
  CHECK(info.order == 2);
  CHECK(Variational<OwnMidpoint>::info().order == 1);
  CHECK_THROWS_WITH(phase_state({1, 2}, {3}),
                    "2 coordinates with 1 momenta are not a valid state; as many of each are expected, at least one");
  ParticleSystem<double> odd;
  odd.set_variables({1, 2, 3});
  CHECK_THROWS_WITH(Simulation(odd, variational(Variational{OwnMidpoint{}}), 0.1),
                    "the discrete Lagrangian 'discrete_lagrangian' moves coordinates and as many momenta, but it was "
                    "given 3 variables and 0 particles");
}

TEST_CASE("an L_d is refused over a system that has drag or depends on time, unless it has a force too",
          "[own action]") {
  const SimplePendulum dragged{.damping = 0.1};
  const auto over = [](const auto& system, auto own) {
    return Simulation<double>(initial_state(system), variational(system, Variational{own}), 0.1);
  };
  CHECK_THROWS_WITH(over(dragged, OwnMidpoint{}),
                    "the discrete Lagrangian 'discrete_lagrangian' has no force, but 'pendulum' has one beside its "
                    "Lagrangian; give the discrete one a force too, or use a method such as 'galerkin_gauss_2'");
  CHECK_NOTHROW(over(dragged, OwnSimpson{.drag = 0.1}));
  CHECK_THROWS_WITH(over(test::Shaken{}, OwnMidpoint{}),
                    "the discrete Lagrangian 'discrete_lagrangian' is told no time, but '' depends on it; use a method "
                    "over its own Lagrangian, such as 'galerkin_gauss_2'");
}

TEST_CASE("an L_d that is singular, or turns so, names the step and the place", "[own action]") {
  Simulation<double> run(phase_state({0.1}, {1.9}), variational(Variational{OwnMidpoint{}}), 2.5);
  const Outcome outcome = run.run(400);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CAPTURE(outcome.message);
  CHECK(outcome.message.find("D1 D2 L_d has no inverse at 0.") != std::string::npos);
}
