// A scene is put together once: its Hamiltonian is made and bound once, and the run that was checked is the one that
// runs.

#include "integrators/kinetic_potential.hpp"
#include "integrators/wrapped.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "numbers/simd.hpp"
#include "scene/run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace noether {
namespace {

/// How often Hamiltonians have been made and bound, and forces bound.
struct Counts {
  int made = 0, bound = 0, forces_bound = 0;
};
Counts counts;

template <class Real> class BoundOnce : public Wrapped<KineticPotential<ForceField<Real>, Real>> {
 public:
  using Around = Wrapped<KineticPotential<ForceField<Real>, Real>>;

  explicit BoundOnce(ForceField<Real> forces) : Around(KineticPotential<ForceField<Real>, Real>(std::move(forces))) {
    ++counts.made;
  }
  void bind(ParticleSystem<Real>& s) {
    ++counts.bound;
    Around::bind(s);
  }
};

struct MadeOnce {
  static constexpr auto describe() {
    return part<MadeOnce>("made_once", "forces alone, and a count of how often that is made", formula("H = T + U"),
                          letter('A', "drifts"), letter('B', "kicks"));
  }
  std::tuple<> forces() const { return {}; }
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> forces) const {
    return BoundOnce<Real>(std::move(forces));
  }
};

/// U = k x^2 / 2, and a count of how often it is bound.
struct CountedSpring {
  double k = 1;

  static constexpr auto describe() {
    return part<CountedSpring>("counted_spring", "a spring to the origin", formula("U = k |x|^2 / 2"),
                               field<&CountedSpring::k>("k", "mass/time^2"));
  }
  template <class Real> void bind(const ParticleSystem<Real>& /*any*/) { ++counts.forces_bound; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      out.force(i, Real(-k) * x);
      if (out.wants_energy()) out.energy(Real(k / 2) * norm2(x));
    }
  }
};

Parts counting_parts() {
  Parts parts = standard_parts();
  parts.add_hamiltonian<MadeOnce>();
  parts.add_force<CountedSpring>();
  counts = {};
  return parts;
}

const std::string spring = R"(
units = "reduced"
[[particles.body]]
name = "one"
mass = 1
x = [1, 0, 0]
v = [0, 0.5, 0]
[hamiltonian]
type = "made_once"
[[hamiltonian.force]]
type = "counted_spring"
[integrator]
method = "verlet"
step = 0.01
steps = 100
)";
const std::string watched = spring + "[[every]]\ntype = \"energy\"\nsteps = 10\n";

void check_once(const std::string& text) {
  const test::ScratchFolder folder;
  const Parts parts = counting_parts();
  SceneRun start = read_run(text, folder.path() / "spring.toml", parts);
  CHECK(counts.made == 1);
  CHECK(counts.bound == 1);
  CHECK(counts.forces_bound == 1);
  const RunReport report = run(std::move(start), {.out = folder.path() / "out"});
  CHECK(report.outcome.ok());
  CHECK(report.monitors.size() == 1);
  CHECK(counts.made == 1);
  CHECK(counts.bound == 1);
  CHECK(counts.forces_bound == 1);
}

}  // namespace

TEST_CASE("a run makes its Hamiltonian once, and binds it once", "[once]") {
  check_once(watched);
  check_once(spring);  // without [[every]]: its watches ask whether the energy is known
}

TEST_CASE("a run that was checked is bit for bit one that is put together anew", "[once]") {
  const test::ScratchFolder folder;
  const Parts parts = counting_parts();
  for (const std::string& text : {watched, spring}) {
    for (const char* method : {"verlet", "yoshida_4", "dormand_prince_5", "gauss_4"}) {
      INFO(method);
      const std::vector<std::string> sets = {std::string("integrator.method=") + method};
      const std::filesystem::path file = folder.path() / "spring.toml";
      const RunReport once =
          run(read_run(text, file, parts, sets), {.out = folder.path() / "once", .existing = Existing::fresh});
      const RunReport anew =
          run(read_scene(text, file, parts, sets), {.out = folder.path() / "anew", .existing = Existing::fresh});
      REQUIRE(once.outcome.ok());
      CHECK(once.digest == anew.digest);
      CHECK(once.evaluations.force == anew.evaluations.force);
      REQUIRE(once.monitors.size() == 1);
      CHECK(once.monitors[0].second.worst == anew.monitors[0].second.worst);
    }
  }
}

TEST_CASE("what was bound at another SIMD level is put together anew", "[once]") {
  const Parts parts = counting_parts();
  const SimdLevel usual = simd_level();
  SceneRun start = read_run(watched, "spring.toml", parts);
  const SimdLevel other = usual == SimdLevel::base ? SimdLevel::avx2 : SimdLevel::base;
  if (has_simd_level(other)) set_simd_level(other);
  static_cast<void>(start.assemble());
  CHECK(counts.made == (simd_level() == usual ? 1 : 2));
  set_simd_level(usual);
  static_cast<void>(start.assemble());  // the run that was checked is still there
  CHECK(counts.made == 2);
  static_cast<void>(start.assemble());  // and was given away
  CHECK(counts.made == 3);
}

TEST_CASE("a scene that is changed after it was read is put together as it is then", "[once]") {
  const Parts parts = counting_parts();
  Scene scene = read_scene(watched, "spring.toml", parts);
  scene.integrator.step = 0.02;
  Simulation<double> run = assemble(scene);
  CHECK(run.run(10).ok());
  CHECK(run.time() == 0.2);
  CHECK(counts.made == 2);
}

}  // namespace noether
