// Members in lanes: the bits of a member alone, whoever stands beside it, and the run of the scene to rounding.

#include "study/ensemble_lanes.hpp"

#include "numbers/simd.hpp"
#include "tests/ensemble/support.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("a member has the same bits alone and in any company, in any lane", "[ensemble][lanes]") {
  const ScratchFolder folder;
  const auto check = [&](const std::string& hamiltonian, const std::string& method) {
    INFO(hamiltonian << " " << method);
    write_text(folder / "scene.toml", planets(hamiltonian, method, 120));
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    // Among the members are near-parabolic arcs, close encounters, and bodies that escape.
    check_company(EnsembleScene(folder / "scene.toml", plan_of(near), {}, true, standard_parts()), 16);
  };
  check("type = \"wisdom_holman\"", "verlet_aba");
  check("type = \"wisdom_holman\"\n[[hamiltonian.force]]\ntype = \"gr_potential\"\nc = 100", "aba_10_6_4");
  check("type = \"wisdom_holman\"\n[[hamiltonian.force]]\ntype = \"oblateness\"\nJ2 = 1e-3\nradius = 0.01",
        "verlet_aba");
  check("type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\"", "yoshida_4");
}

TEST_CASE("members in lanes are the runs of their scenes to rounding", "[ensemble][lanes]") {
  const ScratchFolder folder;
  const auto of = [&](const std::string& hamiltonian, const std::string& method, const std::string& integrator = "") {
    INFO(hamiltonian << " " << method << " " << integrator);
    write_text(folder / "scene.toml",
               replaced(planets(hamiltonian, method), "step = 0.1\n", "step = 0.1\n" + integrator + "\n"));
    const EnsembleScene scene(folder / "scene.toml", plan_of(calm), {}, true, standard_parts());
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    const double most = difference(scene, {0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(most > 0);  // other code: else lanes were not used
    return most;
  };
  const std::string wisdom_holman = "type = \"wisdom_holman\"";
  const std::string relativity = wisdom_holman + "\n[[hamiltonian.force]]\ntype = \"gr_potential\"\nc = 100\n";
  const std::string oblate = "[[hamiltonian.force]]\ntype = \"oblateness\"\nJ2 = 1e-3\nradius = 0.01\n";
  const std::string gravity = "type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\"";
  // 200 steps are three revolutions; roundings of 1e-16 a step grow with their square root and the time.
  CHECK(of(wisdom_holman, "verlet_aba") <= 2e-13);
  CHECK(of(wisdom_holman, "verlet_aba", "corrector = 17") <= 2e-13);
  CHECK(of(wisdom_holman, "verlet_aba", "corrector = 17\nkernel = \"composed\"") <= 2e-13);
  CHECK(of(wisdom_holman, "aba_10_6_4") <= 2e-13);
  CHECK(of(wisdom_holman, "aba_10_6_4", "compensated = true") <= 2e-13);
  CHECK(of(relativity, "verlet_aba") <= 2e-13);
  CHECK(of(relativity + oblate, "verlet_aba") <= 2e-13);
  CHECK(of(wisdom_holman + "\n" + oblate, "verlet_aba") <= 2e-13);
  const std::string drag = "\n[[hamiltonian.force]]\ntype = \"linear_drag\"\nrate = 1e-3";
  CHECK(of(wisdom_holman + drag, "verlet_aba") <= 2e-13);
  CHECK(of(gravity + drag, "verlet") <= 2e-13);
  CHECK(of(gravity, "verlet") <= 2e-13);
  CHECK(of(gravity, "srkn14a") <= 2e-13);
  CHECK(of(gravity + "\n" + oblate, "yoshida_4", "compensated = true") <= 2e-13);
}

TEST_CASE("planets in lanes have the same bits at every SIMD level", "[ensemble][lanes]") {
  const ScratchFolder folder;
  write_text(
      folder / "scene.toml",
      planets("type = \"wisdom_holman\"\n[[hamiltonian.force]]\ntype = \"gr_potential\"\nc = 100", "verlet_aba", 120));
  const SimdLevel before = simd_level();
  std::vector<std::vector<io::RowDigest>> digests;
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    set_simd_level(level);
    const EnsembleScene scene(folder / "scene.toml", plan_of(near), {}, true, standard_parts());
    digests.emplace_back();
    for (const io::EnsembleRow& row : rows_together(scene, {0, 1, 2, 3, 4, 5, 6, 7}))
      digests.back().push_back(row.digest);
  }
  set_simd_level(before);
  for (const auto& one : digests) CHECK(one == digests[0]);
}

TEST_CASE("members that fail in lanes end at the last whole step before, and disturb nobody", "[ensemble][lanes]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 100
[integrator]
method = "verlet"
step = 1
steps = 1000
[[every]]
type = "energy"
steps = 10
)");
  // The mass makes the spring harder or softer; above 25 the step is within the limit of linear theory.
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:50:8"}), {}, true,
                            standard_parts());
  CHECK(why_alone(load_scene(folder / "scene.toml")).empty());
  std::vector<std::int64_t> members = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<io::EnsembleRow> rows = rows_together(scene, members);
  std::size_t diverged = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto alone = run_members(scene, {&members[k], 1}, false, nullptr);
    CHECK(rows[k].outcome == alone[0].row->outcome);
    CHECK(rows[k].step == alone[0].row->step);  // the field's sums are the same in lanes and by themselves
    CHECK(rows[k].digest == alone[0].row->digest);
    CHECK(rows_together(scene, {members[k]})[0].bytes() == rows[k].bytes());
    diverged += rows[k].outcome == static_cast<std::int64_t>(Outcome::Kind::diverged) ? 1 : 0;
  }
  CHECK(diverged == 4);  // masses 1, 8, 15, 22
}

/// A spring that pulls on one side only, as somebody writes it who does not think of lanes.
struct OneSided {
  double k = 1;
  static constexpr auto describe() {
    return part<OneSided>("one_sided", "a spring where x is above 0", formula("U = k x^2/2, x > 0"),
                          field<&OneSided::k>("k", "1"));
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Real x = s.positions()[i][0];
      if (x > Real(0)) {
        out.force(i, Vec3<Real>(-Real(k) * x, Real(0), Real(0)));
        out.energy(Real(k) * x * x / Real(2));
      } else {
        out.force(i, Vec3<Real>(Real(1), Real(0), Real(0)));
        out.energy(-x);
      }
    }
  }
};

TEST_CASE("forces whose branches differ from lane to lane have the bits of each lane alone, masses and all",
          "[ensemble][lanes]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
force = [{ type = "one_sided", k = 2 }, { type = "harmonic_field", k = 0.1 }]
[integrator]
method = "yoshida_4"
step = 0.1
steps = 100
)");
  Parts parts = standard_parts();
  parts.add_force<OneSided>();
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:3:16"}), {}, true, parts);
  REQUIRE(why_alone(load_scene(folder / "scene.toml", parts)).empty());
  check_company(scene, 16);
  CHECK(difference(scene, {0, 3, 6, 9, 12, 15}) <= 1e-13);
}

/// Planets that are watched by monitors of chaos, at steps that are and are not multiples of each other.
std::string watched(const std::string& hamiltonian, const std::string& method, int steps = 200) {
  return planets(hamiltonian, method, steps) +
         "[[every]]\ntype = \"megno\"\nsteps = 30\n[[every]]\ntype = \"lyapunov\"\nsteps = 50\nseed = 2\n";
}

TEST_CASE("changes of members in lanes have the same bits alone and in any company", "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  const auto check = [&](const std::string& hamiltonian, const std::string& method) {
    INFO(hamiltonian << " " << method);
    write_text(folder / "scene.toml", watched(hamiltonian, method, 120));
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    // Near-parabolic arcs, close encounters, and bodies that escape, so that lanes are given to others.
    check_company(EnsembleScene(folder / "scene.toml", plan_of(near), {}, true, standard_parts()), 16);
  };
  check("type = \"wisdom_holman\"", "verlet_aba");
  check("type = \"wisdom_holman\"\n[[hamiltonian.force]]\ntype = \"gr_potential\"\nc = 100", "verlet");
  check("type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\"", "verlet");
}

TEST_CASE("MEGNO and exponents in lanes are those of the runs of their scenes to rounding",
          "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  const auto check = [&](const std::string& hamiltonian, const std::string& method,
                         const std::string& integrator = "") {
    INFO(hamiltonian << " " << method << " " << integrator);
    write_text(folder / "scene.toml",
               replaced(watched(hamiltonian, method), "step = 0.1\n", "step = 0.1\n" + integrator + "\n"));
    const EnsembleScene scene(folder / "scene.toml", plan_of(calm), {}, true, standard_parts());
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    const std::vector<std::int64_t> members = {0, 1, 2, 3, 4, 5, 6, 7};
    // Positions differ by 2e-13 at most, and Y is of the size of 2.
    const double megno = difference(scene, members, "megno"), exponent = difference(scene, members, "lyapunov");
    CHECK(megno > 0);  // else lanes were not used
    CHECK(megno <= 2e-11);
    CHECK(exponent <= 2e-12);
  };
  const std::string wisdom_holman = "type = \"wisdom_holman\"";
  const std::string relativity = wisdom_holman + "\n[[hamiltonian.force]]\ntype = \"gr_potential\"\nc = 100\n";
  const std::string oblate = "[[hamiltonian.force]]\ntype = \"oblateness\"\nJ2 = 1e-3\nradius = 0.01\n";
  const std::string gravity = "type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\"";
  check(wisdom_holman, "verlet_aba");
  check(wisdom_holman, "verlet");
  check(wisdom_holman, "verlet_aba", "corrector = 17");
  check(wisdom_holman, "aba_10_6_4", "compensated = true");
  check(relativity, "verlet_aba");
  check(relativity + oblate, "verlet_aba");
  check(gravity, "verlet");
  check(gravity, "verlet_aba");
  check(gravity + "\nsoftening = 0.01\n" + oblate, "yoshida_4");
}

TEST_CASE("in lanes MEGNO of regular planets tends to 2, and of chaotic ones grows by their exponent",
          "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  std::string text = watched("type = \"wisdom_holman\"", "verlet_aba", 40000);
  text = text.substr(0, text.find("[[stop]]")) + text.substr(text.find("[[every]]\ntype = \"megno\""));
  write_text(folder / "scene.toml", text);
  // One by one, without lanes, these have <Y> = 2.001 and 112, and exponents times time of 9 and 221.
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.c.a=1.5:1.2913:2"}), {}, true,
                            standard_parts());
  const std::vector<io::EnsembleRow> rows = rows_together(scene, {0, 1});
  const auto figure = [&](std::size_t row, const std::string& column) {
    return values_of(scene, rows[row], column).front();
  };
  CHECK(std::abs(figure(0, "megno_mean") - 2) < 0.05);
  CHECK(std::abs(figure(0, "megno_value") - 2) < 0.5);
  const double time = 0.1 * 40000;
  const double exponent = figure(1, "lyapunov_exponent");
  CHECK(figure(1, "megno_mean") > 20);
  CHECK(exponent * time > 40);
  // <Y> = lambda t/2 where growth is even in time.
  CHECK(std::abs(2 * figure(1, "megno_mean") / (exponent * time) - 1) < 0.3);
  CHECK(figure(0, "lyapunov_exponent") * time < 12);  // ln of some 4000 / (2 pi) revolutions
}

TEST_CASE("what goes one by one says why", "[ensemble][lanes]") {
  const ScratchFolder folder;
  const auto why = [&](const std::string& what, const std::string& by) {
    write_text(folder / "scene.toml", replaced(planets(), what, by));
    return why_alone(load_scene(folder / "scene.toml"));
  };
  CHECK(why("verlet_aba", "verlet_aba").empty());
  CHECK(why("method = \"verlet_aba\"", "method = \"gauss_8\"") == "the method 'gauss_8' chooses its steps");
  CHECK(why("method = \"verlet_aba\"", "method = \"gauss_8\"\nadaptive = false") ==
        "the Hamiltonian 'wisdom_holman' has no lanes");
  CHECK(why("method = \"verlet_aba\"", "method = \"galerkin_gauss_2\"") ==
        "the method 'galerkin_gauss_2' has no lanes");
  CHECK(why("type = \"wisdom_holman\"", "type = \"wisdom_holman\"\ncoordinates = \"democratic\"") ==
        "coordinates = \"democratic\" have no lanes");
  CHECK(why("step = 0.1", "step = 0.1\nkernel = \"lazy\"") == "kernels of modified kicks have no lanes");
  CHECK(why("name = \"c\"\nmass = 1e-3", "name = \"c\"\nmass = 0") ==
        "tracers of wisdom_holman go in lanes by themselves");
  CHECK(why("[[stop]]", "[[every]]\ntype = \"shadow_hamiltonian\"\nsteps = 10\n[[stop]]") ==
        "monitor 'shadow_hamiltonian' asks for the action of the flows");
  CHECK(why("[[stop]]", "[[every]]\ntype = \"megno\"\nsteps = 10\n[[stop]]").empty());
  CHECK(why("[[stop]]", "[[every]]\ntype = \"lyapunov\"\nvectors = 6\nsteps = 10\n[[stop]]") ==
        "monitor 'lyapunov' follows 6 vectors, of which one goes in lanes");
  CHECK(why("[[stop]]", "[[every]]\ntype = \"megno\"\nsteps = 10\nafter = 5\n[[stop]]") ==
        "monitor 'megno' does not begin with the run");
}

}  // namespace
}  // namespace noether::test
