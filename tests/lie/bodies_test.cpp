/// Methods on Lie groups over rigid bodies: tops against references of 28 digits, orders, what is kept, what is
/// refused.

#include "forces/external_fields.hpp"
#include "forces/linear_drag.hpp"
#include "forces/on_sites.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/lie/rkmk.hpp"
#include "monitors/monitors.hpp"
#include "tests/lie/top_errors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <string>

namespace noether {
namespace {

using test::heavy_top, test::weight_on_sites;

/// Steps of one length, with these options.
Classical<double> on_group(const std::string& name, MethodOptions options = {}) {
  if (methods::find(name)->adaptive) options.adaptive = false;
  return lie(weight_on_sites(), method(name, options));
}
/// With so many brackets.
Classical<double> with_terms(const std::string& name, std::int64_t terms) {
  return on_group(name, {.own = RkmkOptions{.dexp_terms = terms}});
}
double lie_top_error(const std::string& name, double h) { return test::heavy_top_error(on_group(name), h); }
double lie_slope(const std::string& name, double h = 0.05) {
  return std::log2(lie_top_error(name, h) / lie_top_error(name, h / 2));
}
bool is_near(double found, double figure) { return std::abs(found / figure - 1) < 0.02; }

std::string lie_refusal(const auto& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.message();
  }
  return "none";
}

}  // namespace

TEST_CASE("a heavy top on its group has the errors and orders of its methods", "[lie]") {
  CHECK(is_near(lie_top_error("rkmk_heun", 0.1), 1.730e-2));
  CHECK(is_near(lie_top_error("rkmk_rk4", 0.1), 2.628e-5));
  CHECK(is_near(lie_top_error("rkmk_dormand_prince_5", 0.1), 6.331e-7));
  CHECK(is_near(test::heavy_top_error(with_terms("rkmk_dormand_prince_5", 4), 0.1), 3.649e-7));
  CHECK(is_near(lie_top_error("crouch_grossman_3", 0.1), 3.417e-3));
  CHECK(is_near(lie_top_error("crouch_grossman_4", 0.1), 2.195e-5));
  CHECK(is_near(lie_top_error("commutator_free_3", 0.1), 2.502e-3));
  CHECK(is_near(lie_top_error("commutator_free_4", 0.1), 3.226e-5));
  CHECK(std::abs(lie_slope("rkmk_rk4") - 3.872) < 0.02);
  CHECK(std::abs(lie_slope("rkmk_dormand_prince_5") - 4.97) < 0.02);
  CHECK(std::abs(lie_slope("crouch_grossman_3") - 2.999) < 0.02);
  CHECK(std::abs(lie_slope("crouch_grossman_4") - 3.979) < 0.02);
  CHECK(std::abs(lie_slope("commutator_free_3") - 3.019) < 0.02);
  CHECK(std::abs(lie_slope("commutator_free_4") - 3.938) < 0.02);
  CHECK(std::abs(lie_slope("rkmk_cash_karp_5", 0.1) - 5) < 0.25);
}

/// The heavy top after a time of 2 by so many steps in 113 bits, all of y.
Vector<Quad> wide_top(const std::string& name, int steps) {
  ForceField<Quad> on_sites, forces;
  on_sites.add(UniformField{{0, 0, -1}});
  forces.add(OnSites<Quad>(std::move(on_sites)));
  BodyMotion<Quad> field(std::move(forces));
  const ParticleSystem<Quad> s = heavy_top().as<Quad>();
  field.bind(s);
  const auto method_in_use = make_method<Quad>(*methods::find(name), {.adaptive = false});
  method_in_use->bind(field);
  Vector<Quad> y;
  field.gather(s, y);
  const double h = 2.0 / steps;
  for (int n = 0; n < steps; ++n) method_in_use->step(field, Quad(n) * Quad(h), y, h);
  return y;
}

TEST_CASE("dop853 keeps its order 8 on the group", "[lie]") {
  const Vector<Quad> exact = wide_top("rkmk_dop853", 256);
  const auto error = [&](int steps) { return (wide_top("rkmk_dop853", steps) - exact).cwiseAbs().maxCoeff(); };
  CHECK(std::abs(std::log2(static_cast<double>(error(32) / error(64))) - 8) < 0.05);
}

TEST_CASE("with one commutator less Kutta's method has order 3, and cannot be had", "[lie]") {
  const MethodInfo& info = *methods::find("rkmk_rk4");
  const tableaus::NamedTableau kutta{"rk4", tableaus::rk4};
  const auto error = [&](double h) {
    Rkmk<double> short_series(info, {}, kutta, 1);
    BodyMotion<double> field(weight_on_sites());
    ParticleSystem<double> s = heavy_top();
    field.bind(s);
    short_series.bind(field);
    Vector<double> y;
    field.gather(s, y);
    for (int n = 0; n < std::lround(10 / h); ++n) short_series.step(field, n * h, y, h);
    field.scatter(y, s);
    return test::heavy_top_error(s);
  };
  CHECK(is_near(error(0.1), 7.184e-4));
  CHECK(std::abs(std::log2(error(0.05) / error(0.025)) - 2.98) < 0.03);
  CHECK(lie_refusal([] { with_terms("rkmk_rk4", 1); }) ==
        "dexp_terms = 1 would take its order from 'rkmk_rk4', which has 4; at least 2 is expected");
  CHECK(lie_refusal([] { with_terms("rkmk_dop853", 5); }) ==
        "dexp_terms = 5 would take its order from 'rkmk_dop853', which has 8; at least 6 is expected");
  CHECK(lie_refusal([] { with_terms("rkmk_rk4", 21); }) ==
        "dexp_terms = 21 is more than 20, beyond which the series has no use");
  CHECK(lie_refusal([] { with_terms("rkmk_euler", 0); }) == "none");
}

TEST_CASE("orientations stay rotations to rounding, whatever moves them", "[lie]") {
  for (const char* name : {"rkmk_heun", "rkmk_rk4", "rkmk_dop853", "crouch_grossman_4", "commutator_free_4"}) {
    CAPTURE(name);
    Simulation sim(heavy_top(), on_group(name), 0.1);
    REQUIRE(sim.run(1000).ok());
    CHECK(std::abs(norm_defect<double>(sim.particles().column<BodyOrientation>()[0])) < 1e-15);
    CHECK(sim.particles().positions()[0] == Vec3<double>(0, 0, 0));
  }
}

TEST_CASE("spins in axes of space keep that of a free body to the bit, on its coadjoint orbit", "[lie]") {
  struct Row {
    const char* name;
    double error, slope;
  };
  for (const auto& [name, error, slope] :
       {Row{"rkmk_heun", 1.129e-2, 2.08}, {"rkmk_rk4", 9.019e-7, 4.02}, {"rkmk_dormand_prince_5", 1.996e-8, 4.98}}) {
    CAPTURE(name);
    const auto at = [&, which = std::string(name)](double h) {
      MethodOptions options{.spin_axes = SpinAxes::space};
      if (methods::find(which)->adaptive) options.adaptive = false;
      Simulation sim(test::free_body(), lie(ForceField<double>{}, method(which, options)), h);
      REQUIRE(sim.run(std::lround(10 / h)).ok());
      CHECK(sim.particles().column<BodySpin>()[0] == test::free_body().column<BodySpin>()[0]);
      return test::free_body_error(sim.particles());
    };
    CHECK(std::abs(at(0.1) / error - 1) < 0.03);
    CHECK(std::abs(std::log2(at(0.1) / at(0.05)) - slope) < 0.06);
  }
  for (const tableaus::NamedTableau& table : tableaus::all_explicit()) {
    const std::string name = "rkmk_" + std::string(table.name);
    CAPTURE(name);
    MethodOptions options{.spin_axes = SpinAxes::space};
    if (methods::find(name)->adaptive) options.adaptive = false;
    Simulation sim(test::free_body(), lie(ForceField<double>{}, method(name, options)), 0.1);
    REQUIRE(sim.run(1000).ok());
    CHECK(std::abs(test::in_body_of(sim.particles()).norm() - 1) < 2e-15);
  }
  // And J_z of a top, whose weight twists it about no vertical axis.
  Simulation sim(heavy_top(), on_group("rkmk_heun", {.spin_axes = SpinAxes::space}), 0.1);
  REQUIRE(sim.run(1000).ok());
  CHECK(std::abs(sim.particles().column<BodySpin>()[0][2] - 0.9) < 1e-13);
}

TEST_CASE("bodies that fly and turn go along screws on SE(3), with the order of the method", "[lie]") {
  const auto flying = [] {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("body", 1, {2, 1, 2. / 3}),
             {.x = {1, 0, 0}, .v = {0, 0.8, 0.1}, .spin = Vec3<double>(0.6, -0.4, 0.9)});
    s.add("point", 0, {0, 1, 0}, {0.5, 0, 0});
    return s;
  };
  const auto run = [&](const std::string& name, BodyGroup group, SpinAxes axes, double h) {
    Simulation sim(
        flying(), lie(test::on_sites(HarmonicField{1}), method(name, MethodOptions{.group = group, .spin_axes = axes})),
        h);
    REQUIRE(sim.run(std::lround(4 / h)).ok());
    return sim.particles();
  };
  for (const char* name : {"rkmk_rk4", "commutator_free_4"}) {
    for (const SpinAxes axes : {SpinAxes::body, SpinAxes::space}) {
      const ParticleSystem<double> truth = run("rkmk_rk4", BodyGroup::so3, SpinAxes::body, 1. / 1024);
      const auto error = [&, of = std::string(name)](double h) {
        const ParticleSystem<double> s = run(of, BodyGroup::se3, axes, h);
        return std::max({(s.positions()[0] - truth.positions()[0]).norm(),
                         (s.velocities()[0] - truth.velocities()[0]).norm(),
                         (test::matrix_of(s) - test::matrix_of(truth)).norm()});
      };
      CAPTURE(name, axes);
      CHECK(error(1. / 16) < 1e-4);
      CHECK(std::abs(std::log2(error(1. / 16) / error(1. / 32)) - 4) < 0.3);
    }
  }
}

TEST_CASE("on points methods of Munthe-Kaas are the Runge-Kutta methods themselves, to the bit", "[lie]") {
  for (const tableaus::NamedTableau& table : tableaus::all_explicit()) {
    const std::string base(table.name);
    const auto run = [&](const std::string& name, bool adaptive) {
      MethodOptions options;
      if (methods::find(name)->adaptive) options.adaptive = adaptive;
      if (adaptive) options.rtol = 1e-8;
      auto integrator = test::classical_over(Gravity{.G = test::outer_G}, method(name, options));
      Simulation sim = adaptive ? Simulation(test::outer_planets(), integrator)
                                : Simulation(test::outer_planets(), integrator, 20.0);
      REQUIRE(sim.run(40).ok());
      return sim.particles();
    };
    CAPTURE(base);
    CHECK(test::same_bits(run(base, false), run("rkmk_" + base, false)));
    if (methods::find(base)->adaptive) CHECK(test::same_bits(run(base, true), run("rkmk_" + base, true)));
  }
}

TEST_CASE("steps of a top by an error estimate meet their tolerance", "[lie]") {
  double before = 1;
  for (const double rtol : {1e-5, 1e-7, 1e-9}) {
    for (const char* name : {"rkmk_dormand_prince_5", "rkmk_cash_karp_5", "rkmk_dop853"}) {
      CAPTURE(name, rtol);
      Simulation sim(heavy_top(), lie(weight_on_sites(), method(name, {.rtol = rtol})));
      REQUIRE(sim.run_until(10).ok());
      const double error = test::heavy_top_error(sim.particles());
      CHECK(error < 1000 * rtol);
      if (std::string(name) == "rkmk_dop853") {
        CHECK(error < before);
        before = error;
      }
      CHECK(sim.step() < 2000);
    }
  }
}

TEST_CASE("bodies on groups have the same bits for any cadence and across a restart", "[lie][restart]") {
  for (const char* name : {"rkmk_rk4", "rkmk_dormand_prince_5", "rkmk_dop853", "commutator_free_4"}) {
    for (const SpinAxes axes : {SpinAxes::body, SpinAxes::space}) {
      CAPTURE(name);
      const bool adaptive = methods::find(name)->adaptive;
      const MethodOptions options{.spin_axes = axes};
      const auto make = [&] {
        auto integrator = lie(weight_on_sites(), method(name, options));
        return adaptive ? Simulation(heavy_top(), integrator) : Simulation(heavy_top(), integrator, 0.1);
      };
      auto whole = make(), first = make(), second = make();
      first.every(3, Energy{});
      second.every(3, Energy{});
      if (adaptive) {
        first.every_time(0.33, Energy{});
        second.every_time(0.33, Energy{});
      }
      REQUIRE(whole.run(50).ok());
      REQUIRE(first.run(23).ok());
      second.restore(first.save());
      REQUIRE(second.run(27).ok());
      CHECK(test::same_bits(whole.particles(), second.particles()));
      CHECK(whole.evaluations().force == second.evaluations().force);
    }
  }
}

TEST_CASE("what methods on groups cannot do, they refuse", "[lie]") {
  CHECK(lie_refusal([] {
          Simulation sim(heavy_top(), test::classical_over(Gravity{}, method("rk4")), 0.1);
        }).find("or a method on groups of rotations, such as 'rkmk_rk4'") != std::string::npos);
  CHECK(lie_refusal([] {
          Simulation sim(heavy_top(), test::classical_over(Gravity{}, method("rkmk_rk4")), 0.1);
        }).find("or lie() in the place of classical()") != std::string::npos);
  CHECK(lie_refusal([] { Simulation sim(test::outer_planets(), lie(weight_on_sites(), method("rkmk_rk4")), 0.1); }) ==
        "there are no rigid bodies to turn; add some, or use classical over the forces");
  CHECK(lie_refusal([] { Simulation sim(heavy_top(), lie(weight_on_sites(), method("magnus_4")), 0.1); }) ==
        "method 'magnus_4' is for Y' = A(t) Y on rotations only, but 'kinetic_potential' is no such field; use "
        "'rkmk_dop853'");
  CHECK(lie_refusal([] {
          Simulation sim(heavy_top(), lie(test::on_sites(DragForce{{.rate = 1}}), method("rkmk_rk4")), 0.1);
        }).find("depends on velocities, which sites do not have") != std::string::npos);
}

}  // namespace noether
