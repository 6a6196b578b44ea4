/// Rigid bodies under forces: tops against references of 28 digits, orders, what is kept and what is refused.

#include "integrators/rotating.hpp"
#include "integrators/check_flows.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace noether {
namespace {

using test::heavy_top, test::turning, test::weight_on_sites;

/// The larger of the largest errors of R and of Pi, relative to the largest Pi at the start.
double error_of(const ParticleSystem<double>& s, const Mat3<double>& r, const Vec3<double>& in_body, double size) {
  return std::max((test::matrix_of(s) - r).cwiseAbs().maxCoeff(),
                  (test::in_body_of(s) - in_body).cwiseAbs().maxCoeff() / size);
}

/// Of the heavy top A at t = 10. Reference by extrapolation in 28 to 40 digits, by extrapolation in 28 to 40 digits
double top_error(const std::string& scheme, double h, RotatingOptions options = {}) {
  Simulation sim(heavy_top(), compose(turning(weight_on_sites(), std::move(options)), *schemes::find(scheme)), h);
  REQUIRE(sim.run(std::lround(10 / h)).ok());
  Mat3<double> r;
  r << 0.63061869068486407790, 0.41148720346445770423, -0.6580261000476407484, 0.13793808901625566150,
      0.77494456231452710831, 0.61679332757228295161, 0.76373630957121009037, -0.4797282634201845721,
      0.43193476673961167427;
  const Vec3<double> pi(0.22808129162272360413, -0.5258554584300771690, 1.09631904314062503078);
  return error_of(sim.particles(), r, pi, 0.9);
}

}  // namespace

TEST_CASE("a heavy top has the errors and orders of its methods", "[integrators][rotating]") {
  const RotatingOptions axes{.rotor = Rotor::axes}, z_first{.rotor = Rotor::axes, .axes = "zyx"};
  const auto slope = [](const std::string& scheme, double h, const RotatingOptions& options) {
    return std::log2(top_error(scheme, h, options) / top_error(scheme, h / 2, options));
  };
  const auto near = [](double found, double figure) { return std::abs(found / figure - 1) < 0.02; };
  CHECK(near(top_error("verlet", 0.1), 4.124e-3));
  CHECK(near(top_error("verlet", 0.1, axes), 4.622e-3));
  CHECK(near(top_error("verlet", 0.1, z_first), 8.074e-3));
  CHECK(near(top_error("yoshida_4", 0.1), 3.661e-5));
  CHECK(near(top_error("yoshida_4", 0.1, axes), 8.727e-5));
  CHECK(near(top_error("blanes_moan_s6", 0.1), 6.756e-8));
  CHECK(near(top_error("srkn11b", 0.5), 8.169e-8));
  CHECK(near(top_error("srkn14a", 0.5), 4.134e-9));
  CHECK(near(top_error("srkn14a", 0.25), 9.103e-11));
  CHECK(std::abs(slope("verlet", 0.05, {}) - 2) < 0.02);
  CHECK(std::abs(slope("verlet", 0.05, axes) - 2) < 0.02);
  CHECK(std::abs(slope("yoshida_4", 0.05, {}) - 4) < 0.03);
  CHECK(std::abs(slope("yoshida_4", 0.05, axes) - 4) < 0.04);
  CHECK(std::abs(std::log2(top_error("srkn11b", 0.5) / top_error("srkn11b", 0.25)) - 6.16) < 0.1);
}

TEST_CASE("a top keeps the vertical part of its angular momentum", "[integrators][rotating]") {
  for (const Rotor rotor : {Rotor::exact, Rotor::axes}) {
    Simulation sim(heavy_top(), compose(turning(weight_on_sites(), {.rotor = rotor}), schemes::verlet), 0.1);
    REQUIRE(sim.run(1000).ok());
    CHECK(std::abs(sim.particles().column<BodySpin>()[0][2] - 0.9) < 3e-15);
    CHECK(std::abs(norm_defect<double>(sim.particles().column<BodyOrientation>()[0])) < 1e-15);
    CHECK(sim.particles().positions()[0] == Vec3<double>(0, 0, 0));
    CHECK(sim.particles().velocities()[0] == Vec3<double>(0, 0, 0));
  }
}

TEST_CASE("a top of 150 rad/s is followed by its exact turns", "[integrators][rotating]") {
  // Bruels and Cardona's: the axis of the largest rate goes through its centre of mass.
  Mat3<double> r;
  r << 0.22929964080360759365, 0.17334396409838604259, 0.95779619170155087135, -0.7653407422046809422,
      0.64008859207056878286, 0.06738058045687271853, -0.6013943989171537362, -0.7484907911335813094,
      0.27943928238402867045;
  const Vec3<double> pi(-12.523846080322450700, 70.3125, -90.237641631475043459);
  const auto run = [](const std::string& scheme, RotatingOptions options) {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, top("top", 15, {15.234375, 0.46875, 15.234375}, {0, 1, 0}),
             {.angular_velocity = Vec3<double>(0, 150, -4.61538)});
    Simulation sim(s, compose(turning(weight_on_sites(9.81), std::move(options)), *schemes::find(scheme)), 0.002);
    REQUIRE(sim.run(500).ok());
    return sim.particles();
  };
  const Vec3<double> center = test::matrix_of(run("srkn14a", {})).col(1);
  CHECK((center - r.col(1)).cwiseAbs().maxCoeff() < 1e-11);
  const auto error = [&](const RotatingOptions& options) { return error_of(run("verlet", options), r, pi, 70.3125); };
  CHECK(std::abs(error({}) / 1.034e-5 - 1) < 0.02);
  CHECK(std::abs(error({.rotor = Rotor::axes}) / 6.2e-2 - 1) < 0.05);
}

TEST_CASE("Lagrange's top nods and goes round as its quadratures say", "[integrators][rotating]") {
  const double period = 2.62410021994501064743, precession = 0.97016986498882435069;
  ParticleSystem<double> s(unit_system("reduced"));
  const double theta = 0.5;
  // theta' = phi' = 0: it turns about its own axis alone, which leans in the plane of x and z.
  add_body(
      s, top("top", 1, {1, 1, 0.5}, {0, 0, 1}),
      {.orientation = {std::cos(theta / 2), 0, std::sin(theta / 2), 0}, .angular_velocity = Vec3<double>(0, 0, 6)});
  const int steps = 262;  // of a period, some 0.01 each
  Simulation sim(s, compose(turning(weight_on_sites()), *schemes::find("srkn14a")), period / steps);
  REQUIRE(sim.run(steps).ok());
  const Vec3<double> axis = test::matrix_of(sim.particles()).col(2);
  CHECK(std::abs(axis[2] - std::cos(theta)) < 1e-10);
  CHECK(std::abs(std::atan2(axis[1], axis[0]) - precession) < 1e-10);
  REQUIRE(sim.run(steps / 2).ok());
  CHECK(std::abs(test::matrix_of(sim.particles())(2, 2) - 0.79625364265518354576) < 1e-10);
}

TEST_CASE("the shadow of a top is flatter with every order, by both rotors", "[integrators][rotating]") {
  struct Figures {
    double h, energy, four, eight, twelve;
  };
  const auto check = [](Rotor rotor, const Figures& wanted) {
    CAPTURE(wanted.h);
    Simulation sim(heavy_top(), compose(turning(weight_on_sites(), {.rotor = rotor}), schemes::verlet), wanted.h);
    auto& shadow = sim.every(1, ShadowHamiltonian<double>({4, 8, 12}));
    REQUIRE(sim.run(std::lround(10 / wanted.h)).ok());
    const double scale = *shadow.scale();
    CHECK(std::abs(shadow.fluctuation(0) * scale / wanted.four - 1) < 0.1);
    CHECK(std::abs(shadow.fluctuation(1) * scale / wanted.eight - 1) < 0.1);
    CHECK(std::abs(shadow.fluctuation(2) * scale / wanted.twelve - 1) < 0.2);
    CHECK(shadow.verdict().starts_with("kept"));
    // The energy itself, at every step.
    Simulation plain(heavy_top(), compose(turning(weight_on_sites(), {.rotor = rotor}), schemes::verlet), wanted.h);
    auto& energy = plain.every(1, Energy{});
    std::vector<double> values;
    for (long k = std::lround(10 / wanted.h); k > 0; --k) {
      REQUIRE(plain.run(1).ok());
      values.push_back(*energy.report().last);
    }
    double mean = 0, square = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (const double value : values) square += (value - mean) * (value - mean) / static_cast<double>(values.size());
    CHECK(std::abs(std::sqrt(square) / wanted.energy - 1) < 0.1);
  };
  check(Rotor::axes, {0.2, 3.48e-3, 1.42e-4, 3.76e-7, 5.63e-9});
  check(Rotor::axes, {0.1, 8.72e-4, 9.03e-6, 1.54e-9, 1.56e-12});
  check(Rotor::exact, {0.2, 1.54e-3, 1.42e-4, 3.57e-7, 4.64e-9});
  check(Rotor::exact, {0.1, 3.87e-4, 9.03e-6, 1.52e-9, 1.48e-12});
}

namespace {

/// The weight of a top as a force on the body itself, with some part of its torque.
struct Weight {
  double part = 1;
  static ForceClaims claims() { return {.keeps_momentum = false, .keeps_angular_momentum = false, .on_bodies = true}; }
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> arm = to_space<double>(test::matrix_of(s, i), Vec3<double>(0.2, 0.3, 0.5));
      out.torque(i, part * cross<double>(arm, Vec3<double>(0, 0, -1)));
      out.energy(arm[2]);
    }
  }
};

/// Turns about two axes alone, though the energy knows three.
class WithoutThirdAxis : public Wrapped<AnyHamiltonian<double>> {
 public:
  using Wrapped::Wrapped;
  HamiltonianClaims claims() const {
    HamiltonianClaims claims = Wrapped::claims();
    claims.columns = claims.turns = true;
    return claims;
  }
  void flow(char letter, ParticleSystem<double>& s, const double& h) {
    static_cast<void>(flow_with_action(letter, s, h));
  }
  double flow_with_action(char letter, ParticleSystem<double>& s, const double& h) {
    const double action = letter == 'A' ? h * turning_energy_of(s) : 0;
    for (Index i = 0; letter == 'A' && i < s.size(); ++i) {
      auto& orientation = s.column<BodyOrientation>();
      const Turned<double> turned =
          turn_by_axes<double>(std::as_const(orientation)[i], std::as_const(s).column<BodySpin>()[i],
                               std::as_const(s).column<BodyInertia>()[i], h, {0, 1, 0});
      orientation.set(i, turned.orientation);
    }
    return action + Wrapped::flow_with_action(letter, s, h);
  }
  EnergyTerms<double> energy(const ParticleSystem<double>& s) {
    EnergyTerms<double> terms = Wrapped::energy(s);
    terms.kinetic += turning_energy_of(s);
    return terms;
  }
};

}  // namespace

TEST_CASE("the shadow finds a torque that is not the slope of its energy, and a rotor without an axis",
          "[integrators][rotating]") {
  const auto verdict = [](auto hamiltonian) {
    Simulation sim(heavy_top(), compose(std::move(hamiltonian), schemes::verlet), 0.05);
    auto& shadow = sim.every(1, ShadowHamiltonian<double>({4, 8, 12}));
    REQUIRE(sim.run(400).ok());
    return shadow.verdict();
  };
  const auto weighing = [](double part) {
    ForceField<double> force;
    force.add(Weight{part});
    return force;
  };
  CHECK(verdict(turning(weighing(1))).starts_with("kept"));
  CHECK_FALSE(verdict(turning(weighing(0.9))).starts_with("kept"));
  CHECK_FALSE(verdict(WithoutThirdAxis(KineticPotential<ForceField<double>>(weighing(1)))).starts_with("kept"));
}

TEST_CASE("a rotor without an axis and a torque that is no slope are named before a run", "[integrators][rotating]") {
  const auto weighing = [](double part) {
    ForceField<double> force;
    force.add(Weight{part});
    return force;
  };
  // It has a point and a line beside it, all of them turned and moving.
  ParticleSystem<double> s = heavy_top();
  s.add("point", 2, {1, 2, 3}, {0.1, -0.4, 0.2});
  add_body(s, body_of_sites("line", {{.place = {0, 0, 0}, .mass = 2}, {.place = {0.3, 0.4, 1.2}, .mass = 1}}, true),
           {.x = {5, 0, 0}, .v = {0, 0.3, 0}, .spin = Vec3<double>(0.8, -0.6, 0)});
  s.column<BodyOrientation>().set(0, Quaternion<double>(0.5, -0.5, 0.5, 0.5));
  for (const Rotor rotor : {Rotor::exact, Rotor::axes, Rotor::variational}) {
    CHECK_NOTHROW(check_flows(turning(test::weight_on_sites(), {.rotor = rotor}), s));
  }
  // Its third axis lies along the y of space now: Pi_3/I_3 = -0.4/(2/3).
  CHECK_THROWS_WITH(
      check_flows(WithoutThirdAxis(KineticPotential<ForceField<double>>(test::weight_on_sites())), s),
      "'kinetic_potential' turns 'top' about its own axis z by 0, where the slope of its energy has -0.6; "
      "check the flows of its letters and the energy it reports");
  const ParticleSystem<double> top = heavy_top();
  CHECK_NOTHROW(check_flows(turning(weighing(1)), top));
  // arm x weight = (-0.3, 0.2, 0), of which nine tenths act.
  CHECK_THROWS_WITH(check_flows(turning(weighing(0.9)), top),
                    "'kinetic_potential' twists 'top' about x by -0.27, where the slope of its energy has -0.3; check "
                    "the flows of its letters and the energy it reports");
}

TEST_CASE("a body that a fixed point holds is refused on Kepler arcs", "[integrators][rotating]") {
  ParticleSystem<double> s = heavy_top();
  CHECK_THROWS_WITH(
      Simulation(s, compose(Rotating<WisdomHolman<double>>(WisdomHolman<double>({})), schemes::verlet), 0.1),
      Catch::Contains("cannot be on a Kepler arc"));
}

TEST_CASE("free bodies keep their angular momentum to the bit and their energy to rounding",
          "[integrators][rotating]") {
  for (const double h : {0.01, 0.1, 5.}) {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("body", 1, {1.3, 2.1, 0.9}), {.spin = Vec3<double>(1, 0.2, -0.5)});
    Simulation sim(s, compose(turning(ForceField<double>{}), schemes::verlet), h);
    auto& energy = sim.every(1, Energy{});
    REQUIRE(sim.run(std::lround(1000 / h)).ok());
    CHECK(sim.particles().column<BodySpin>()[0] == Vec3<double>(1, 0.2, -0.5));
    CHECK(energy.worst() < 1e-16 * std::sqrt(1000 / h) * 20);
  }
}

TEST_CASE("a million steps of turns axis by axis leave the energy of a free body without a slope",
          "[integrators][rotating]") {
  // The free body of the studies: I = (2, 1, 2/3), Pi = (cos 1.1, 0, sin 1.1); a symplectic map oscillates and does not
  // drift.
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("body", 1, {2, 1, 2. / 3}), {.spin = Vec3<double>(std::cos(1.1), 0, std::sin(1.1))});
  Simulation sim(s, compose(turning(ForceField<double>{}, {.rotor = Rotor::axes}), schemes::verlet), 0.05);
  auto& energy = sim.every(53, Energy{});  // at phases that do not come back
  REQUIRE(sim.run(1'000'000).ok());
  const MonitorReport report = energy.report();
  CAPTURE(*report.slope, *report.slope_error, *report.worst);
  CHECK(std::abs(*report.slope) < 3 * *report.slope_error);
  CHECK(*report.slope_error * 50'000 < 1e-6);  // over the whole run, of an energy that oscillates by more
  CHECK(*report.worst > 1e-5);
  CHECK(*report.worst < 1e-3);
  CHECK(sim.particles().column<BodySpin>()[0] == s.column<BodySpin>()[0]);
}

TEST_CASE("methods that cannot turn bodies refuse them", "[integrators][rotating]") {
  const auto refusal = [](const auto& make) {
    try {
      make();
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("none");
  };
  const RotatingOptions axes{.rotor = Rotor::axes};
  const auto by = [&](const std::string& scheme) {
    return refusal([&] { compose(turning(weight_on_sites(), axes), *schemes::find(scheme)); });
  };
  CHECK(
      by("blanes_moan_s6").find("needs exact flows, but part A of 'kinetic_potential' is a symmetric map of order 2") !=
      std::string::npos);
  CHECK(by("srkn14a").find("needs exact flows") != std::string::npos);
  CHECK(by("yoshida_4") == "none");
  CHECK(refusal([&] {
          Simulation sim(heavy_top(), compose(KineticPotential(weight_on_sites()), schemes::verlet), 0.1);
        }).find("some particles are rigid bodies, but 'kinetic_potential' does not turn them") != std::string::npos);
  CHECK(refusal([&] {
          ParticleSystem<double> points(unit_system("reduced"));
          points.add("a", 1, {0, 0, 0}, {0, 0, 0});
          Simulation sim(points, compose(turning(weight_on_sites()), schemes::verlet), 0.1);
        }) == "there are no rigid bodies to turn; add some, or take Rotating out");
}

}  // namespace noether
