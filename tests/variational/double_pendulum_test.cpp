// A double pendulum in its two angles against the same bobs on rods that constraints hold.

#include "integrators/systems/double_pendulum.hpp"
#include "constraints/constraint_set.hpp"
#include "constraints/distance.hpp"
#include "constraints/surfaces.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "tests/support/drivers.hpp"
#include "tests/variational/lagrangians.hpp"

#include <numbers>

using namespace noether;

namespace {

constexpr double g = 9.80665, turning = std::numbers::pi / 8;

/// The start of examples/double_pendulum.
ParticleSystem<double> bobs() {
  ParticleSystem<double> s;
  s.add("upper", 1, {std::numbers::sqrt2, -std::numbers::sqrt2, 0}, {0, 0, 0});
  s.add("lower", 2, {std::numbers::sqrt2 + 3, -std::numbers::sqrt2, 0}, {0, 3 * turning, 0});
  return s;
}

ParticleSystem<double> on_rods(double end) {
  const ParticleSystem<double> s = bobs();
  ConstraintSet rods;
  rods.add(s, OnSphere{.radius = 2}, {0});
  rods.add(s, Distance{.length = 3}, {0, 1});
  Simulation<double> run(
      s, compose(test::kinetic_potential_over(test::field_of(UniformField{{0, -g, 0}}), rods), schemes::kahan_li_8_s17),
      0x1p-7);
  REQUIRE(run.run_until(end).ok());
  return run.particles();
}

std::vector<double> in_angles(double end) {
  using std::numbers::pi;
  const DoublePendulum system{.mass1 = 1, .mass2 = 2, .length1 = 2, .length2 = 3, .g = g};
  const double p1 = 2 * 2 * 3 * turning * std::cos(pi / 4), p2 = 2 * 9 * turning;
  Simulation<double> run(initial_state(system, {pi / 4, pi / 2}, {p1, p2}),
                         variational(system, method("galerkin_gauss_6")), 0x1p-5);
  REQUIRE(run.run_until(end).ok());
  return run.particles().variables();
}

}  // namespace

TEST_CASE("a double pendulum in angles is the constrained one over 5 s to 1e-10", "[variational]") {
  const ParticleSystem<double> rods = on_rods(5);
  const std::vector<double> y = in_angles(5);
  const Vec3<double> upper(2 * std::sin(y[0]), -2 * std::cos(y[0]), 0);
  const Vec3<double> lower = upper + Vec3<double>(3 * std::sin(y[1]), -3 * std::cos(y[1]), 0);
  CHECK((rods.positions()[0] - upper).cwiseAbs().maxCoeff() < 1e-10);
  CHECK((rods.positions()[1] - lower).cwiseAbs().maxCoeff() < 1e-10);
  CHECK((bobs().positions()[1] - lower).cwiseAbs().maxCoeff() > 0.1);
}
