/// A force that looks up its particles in `bind` is bound by whatever evaluates it.

#include "engine/simulation.hpp"
#include "forces/check_gradient.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/minimize.hpp"
#include "integrators/wisdom_holman.hpp"
#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/gyration.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace noether::test {
namespace {

/// A spring to the origin for the particle of an id, whose place it looks up when it is bound.
struct Leash {
  std::int64_t id = 1;
  double k = 0.25;
  Index at = -1;

  static constexpr auto describe() {
    return part<Leash>("leash", "a spring to the origin for one particle", formula("U = k |x|^2 / 2"),
                       field<&Leash::id>("id", "1"), field<&Leash::k>("k", "mass/time^2"));
  }
  static ForceClaims claims() { return {.keeps_momentum = false, .charges = false, .exclusions = false}; }
  template <class Real> void bind(const ParticleSystem<Real>& s) {
    at = -1;
    for (Index i = 0; i < s.size(); ++i) {
      if (s.ids()[static_cast<std::size_t>(i)] == id) at = i;
    }
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Index i = at >= 0 ? at : throw LogicError("a leash was evaluated that nobody had bound");
    out.force(i, Vec3<Real>(Real(-k) * s.positions()[i]));
    out.energy(Real(k) * norm2(s.positions()[i]) / Real(2));
  }
};
/// Counts in its workspace how often it finds nothing there.
struct Forgetful {
  inline static int begun = 0;
  struct Kept {
    bool known = false;
  };
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& /*s*/) const {
    Kept& kept = out.workspace().template get<Kept>();
    if (!kept.known) ++begun;
    kept.known = true;
  }
};

const std::string scene_with_leash = R"(
units = "reduced"
[[particles.body]]
name = "sun"
mass = 1
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "planet"
mass = 0.5
x = [2, 0, 0]
v = [0, 0.6, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "leash"
id = 1
[integrator]
method = "verlet"
step = 0.01
steps = 10
)";

ParticleSystem<double> sun_and_planet() {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 0.5, {2, 0, 0}, {0, 0.6, 0});
  return s;
}

}  // namespace

TEST_CASE("other forces of a Wisdom-Holman splitting are bound, and find their caches again", "[scene][bound]") {
  const ParticleSystem<double> s = sun_and_planet();
  const auto arcs = test::wisdom_holman({.G = 1}, Leash{});
  const auto kicks = test::kinetic_potential(Gravity{.G = 1}, Leash{});
  const auto far = [&](const auto& hamiltonian, double step, std::int64_t steps) {
    const ParticleSystem<double> end = test::run(hamiltonian, schemes::yoshida_4, s, step, steps);
    return Vec3<double>(end.positions()[1]);
  };
  const Vec3<double> one = far(arcs, 0.01, 200), other = far(kicks, 0.01, 200);
  CHECK(std::sqrt(norm2(Vec3<double>(one - other))) < 1e-6);
  Forgetful::begun = 0;
  far(test::wisdom_holman({.G = 1}, Forgetful{}), 0.01, 20);
  CHECK(Forgetful::begun == 1);
}

TEST_CASE("evaluate binds forces, and so do checks of their gradients and minimizations", "[scene][bound]") {
  Parts parts = standard_parts();
  parts.add_force<Leash>();
  const Evaluation e = evaluate(read_scene(scene_with_leash, "scene.toml", parts), true);
  CHECK(e.potential == 0.5);
  CHECK(e.force_max == 0.5);
  CHECK(*e.gradient_error < 1e-12);
  CHECK_NOTHROW(check_gradient(Leash{}, sun_and_planet()));
  parts.add_hamiltonian<Gyration>();
  std::string turning = scene_with_leash;
  turning.replace(turning.find("kinetic_potential\""), 18, "gyration\"\nomega = 2");
  CHECK(evaluate(read_scene(turning, "scene.toml", parts)).potential == 0.5);
  ParticleSystem<double> s = sun_and_planet();
  CHECK(minimize(s, Leash{}, {.max_force = 1e-6}).converged());
  CHECK(std::abs(std::as_const(s).positions()[1][0]) < 1e-5);
}

}  // namespace noether::test
