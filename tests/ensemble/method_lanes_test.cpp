// Classical methods of fixed steps in lanes: the bits of a member alone, whoever stands beside it, and the run of the
// scene to rounding.

#include "forces/gravity.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/lane_method.hpp"
#include "tests/ensemble/support.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string gravity = "type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\"\n";
const std::string oblate = "[[hamiltonian.force]]\ntype = \"oblateness\"\nJ2 = 1e-3\nradius = 0.01\n";
const std::string relativity = "[[hamiltonian.force]]\ntype = \"post_newtonian\"\nc = 100\n";

/// The key that a method needs to make steps of one length.
std::string fixed(const std::string& method) {
  return noether::method(method).info->adaptive ? "adaptive = false\n" : "";
}

/// Planets under forces and a method.
std::string stepped(const std::string& forces, const std::string& method, int steps = 200) {
  const std::string text = replaced(planets(forces, method, steps), "step = 0.1\n", "step = 0.1\n" + fixed(method));
  return forces == gravity + relativity ? replaced(text, "type = \"energy\"", "type = \"angular_momentum\"") : text;
}

/// A ball on a spring that it makes harder or softer by its mass.
std::string ball(const std::string& method, double step, int steps) {
  return R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
method = ")" +
         method + "\"\n" + fixed(method) + "step = " + std::to_string(step) + "\nsteps = " + std::to_string(steps) +
         "\n";
}

/// Members of 60 steps in lanes have the bits that each has alone.
void check_bits(const std::string& forces, const std::string& method) {
  const ScratchFolder folder;
  INFO(forces << " " << method);
  write_text(folder / "scene.toml", stepped(forces, method, 60));
  REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
  check_company(EnsembleScene(folder / "scene.toml", plan_of(near), {}, true, standard_parts()), 16);
}

TEST_CASE("explicit methods in lanes have the bits of each member alone", "[ensemble][lanes]") {
  check_bits(gravity, "rk4");
  check_bits(gravity + relativity, "dormand_prince_5");  // its last stage is state
  check_bits(gravity + oblate, "dprkn_12");
  check_bits(gravity, "commutator_free_4");
}

TEST_CASE("collocation in lanes has the bits of each member alone, however many sweeps the others take",
          "[ensemble][lanes]") {
  // Near-parabolic arcs and encounters, at which sweeps do not converge and a member goes on by Newton's iteration,
  // beside members of a few sweeps a step.
  check_bits(gravity, "gauss_3");
  check_bits(gravity + oblate, "implicit_midpoint");
  check_bits(gravity + relativity, "gauss_8");
}

TEST_CASE("multistep methods in lanes have the bits of each member alone", "[ensemble][lanes]") {
  // In encounters, where iterations differ in number, or do not converge and end a member.
  check_bits(gravity + relativity, "adams_bashforth_4");
  check_bits(gravity, "adams_moulton_5");
  check_bits(gravity + oblate, "adams_pece");
  check_bits(gravity + oblate, "stormer_cowell_13");
}

TEST_CASE("classical methods in lanes are the runs of their scenes to rounding", "[ensemble][lanes]") {
  const ScratchFolder folder;
  const auto of = [&](const std::string& forces, const std::string& method) {
    INFO(forces << " " << method);
    write_text(folder / "scene.toml", stepped(forces, method));
    const EnsembleScene scene(folder / "scene.toml", plan_of(calm), {}, true, standard_parts());
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    const double most = difference(scene, {0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(most > 0);  // other code: else lanes were not used
    return most;
  };
  // 200 steps are three revolutions, as for splitting methods.
  for (const char* method : {"rk4", "dormand_prince_5", "cash_karp_5", "dop853", "dprkn_12"}) {
    CHECK(of(gravity, method) <= 2e-13);
  }
  // Of points, methods on groups are Runge-Kutta methods.
  for (const char* method :
       {"rkmk_cash_karp_5", "crouch_grossman_3", "crouch_grossman_4", "commutator_free_3", "commutator_free_4"}) {
    CHECK(of(gravity + relativity, method) <= 2e-13);
  }
  for (const char* method : {"implicit_midpoint", "gauss_2", "gauss_5"}) CHECK(of(gravity, method) <= 2e-13);
  for (const char* method : {"gauss_8", "gauss_radau_15"}) {
    CHECK(of(gravity + relativity, method) <= 2e-13);
  }
  for (const char* method : {"adams_bashforth_4", "adams_moulton_1", "adams_moulton_6", "adams_pece"}) {
    CHECK(of(gravity + relativity, method) <= 2e-13);
  }
  CHECK(of(gravity + oblate, "stormer_cowell_12") <= 2e-12);
  CHECK(of(gravity + oblate, "dprkn_12") <= 2e-13);
  CHECK(of(gravity + relativity, "dop853") <= 2e-13);
  CHECK(of(gravity + relativity, "gauss_4") <= 2e-13);
  CHECK(of(gravity + "[[hamiltonian.force]]\ntype = \"linear_drag\"\nrate = 1e-3\n", "gauss_4") <= 2e-13);
}

TEST_CASE("a step in lanes is the one of the method, whose order it has", "[ensemble][lanes]") {
  const ScratchFolder folder;
  // A ball over the same time by steps of two lengths: x = cos(omega t), and errors in the ratio 2^order.
  const auto error_of = [&](const std::string& method, int steps) {
    write_text(folder / "scene.toml", ball(method, 2.0 / steps, steps));
    const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:1.5:2"}), {}, true,
                              standard_parts());
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    double worst = 0;
    const std::vector<io::EnsembleRow> rows = rows_together(scene, {0, 1});
    for (std::size_t k = 0; k < 2; ++k) {
      const double omega = 1 / std::sqrt(k == 0 ? 1.0 : 1.5);
      worst = std::max(worst, std::abs(values_of(scene, rows[k], "position")[0] - std::cos(omega * 2.0)));
    }
    return worst;
  };
  const auto order_of = [&](const std::string& method, int steps) {
    INFO(method);
    return std::log2(error_of(method, steps) / error_of(method, 2 * steps));
  };
  CHECK(std::abs(order_of("euler", 40) - 1) < 0.1);
  CHECK(std::abs(order_of("heun", 10) - 2) < 0.1);
  CHECK(std::abs(order_of("rk4", 10) - 4) < 0.1);
  CHECK(std::abs(order_of("adams_bashforth_1", 40) - 1) < 0.1);
  CHECK(std::abs(order_of("adams_bashforth_3", 80) - 3) < 0.1);
  CHECK(std::abs(order_of("adams_moulton_4", 40) - 4) < 0.1);
  CHECK(std::abs(order_of("adams_pece", 40) - 4) < 0.1);
  CHECK(std::abs(order_of("implicit_midpoint", 10) - 2) < 0.1);
  CHECK(std::abs(order_of("gauss_2", 10) - 4) < 0.1);
  CHECK(std::abs(order_of("gauss_3", 4) - 6) < 0.2);
}

TEST_CASE("methods with a past go on in lanes from what is kept, and in a copy, bit for bit", "[ensemble][lanes]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", stepped(gravity, "rk4"));
  const ParticleSystem<double> like = load_scene(folder / "scene.toml").particles;
  constexpr std::int64_t all = 40;
  for (const char* name : {"adams_bashforth_4", "adams_moulton_6", "adams_pece", "stormer_cowell_12"}) {
    const MethodInfo* const info = methods::find(name);
    const MethodChoice choice = method(name, {.adaptive = info->adaptive ? std::optional(false) : std::nullopt});
    const auto begun = [&] {
      auto run = run_in_lanes(method_in_lanes(choice), ForceField<double>().add(Gravity{}), like,
                              Clock<double>::fixed(0, 0.1));
      for (std::size_t lane = 0; lane < LaneRun::lanes; ++lane) {
        ParticleSystem<double> s = like;
        s.positions().all() *= 1 + 0.01 * static_cast<double>(lane);
        run->put(lane, s);
      }
      return run;
    };
    const auto at_end = [&](const LaneRun& run, std::size_t lane) {
      ParticleSystem<double> s = like;
      run.take(lane, s);
      return s;
    };
    CHECK_THROWS_AS(begun()->carry(1), Error);  // changes of a state have no past
    const auto whole = begun();
    REQUIRE(whole->advance(all));
    // Before the start, in it, at its end (after order - 1 steps) and behind it.
    for (const std::int64_t kept : {0, 1, 3, 5, 11, 12, 20}) {
      CAPTURE(name, kept);
      const auto cut = begun(), copied = begun();
      REQUIRE(cut->advance(kept));
      cut->keep();
      REQUIRE(cut->advance(15));
      cut->go_back();
      REQUIRE(cut->advance(all - kept));
      REQUIRE(copied->advance(kept));
      copied->copy_lane(2, 5);
      REQUIRE(copied->advance(all - kept));
      for (std::size_t lane = 0; lane < LaneRun::lanes; ++lane) {
        CHECK(same_bits(at_end(*cut, lane), at_end(*whole, lane)));
        CHECK(same_bits(at_end(*copied, lane), at_end(*whole, lane == 5 ? 2 : lane)));
      }
      CHECK_FALSE(same_bits(at_end(*whole, 2), at_end(*whole, 5)));
    }
  }
}

TEST_CASE("sums of Stoermer and Cowell's method carry their rounding errors in lanes", "[ensemble][lanes]") {
  const ScratchFolder folder;
  // Even motion by steps of 0.1: as plain sums, 160000 of these end some 1e-8 beside it.
  std::string text = ball("stormer_cowell_12", 0.1, 160000);
  text = replaced(replaced(text, "k = 1\n", "k = 1e-30\n"), "v = [0, 0, 0]", "v = [1, -3, 0]");
  write_text(folder / "scene.toml", text);
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:2:2"}), {}, true,
                            standard_parts());
  REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
  for (const io::EnsembleRow& row : rows_together(scene, {0, 1})) {
    const std::vector<double> x = values_of(scene, row, "position");
    CHECK(std::abs(x[0] - 16001) <= 4e-12);  // two units of the last place
    CHECK(std::abs(x[1] + 48000) <= 2e-11);
  }
}

TEST_CASE("a member in lanes whose sweeps do not converge goes on by Newton's iteration", "[ensemble][lanes]") {
  const ScratchFolder folder;
  // h omega from 10 to 1.4: sweeps converge below 2, that of the last mass.
  write_text(folder / "scene.toml", ball("gauss_2", 10, 100));
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:50:8"}), {}, true,
                            standard_parts());
  REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
  check_company(scene, 8);
  // A linear problem, whose stages both find to rounding.
  CHECK(difference(scene, {0, 1, 2, 3, 4, 5, 6, 7}) <= 1e-12);
  for (const io::EnsembleRow& row : rows_together(scene, {0, 3, 7}))
    CHECK(row.outcome == static_cast<std::int64_t>(Outcome::Kind::completed));
}

TEST_CASE("members that fail under methods in lanes end as they do alone", "[ensemble][lanes]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", ball("rk4", 10, 1000));
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:50:8"}), {}, true,
                            standard_parts());
  std::vector<std::int64_t> members = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<io::EnsembleRow> rows = rows_together(scene, members);
  std::size_t diverged = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto alone = run_members(scene, {&members[k], 1}, false, nullptr);
    CHECK(rows[k].outcome == alone[0].row->outcome);
    CHECK(rows[k].step == alone[0].row->step);
    CHECK(rows_together(scene, {members[k]})[0].bytes() == rows[k].bytes());
    diverged += rows[k].outcome == static_cast<std::int64_t>(Outcome::Kind::diverged) ? 1 : 0;
  }
  CHECK(diverged == 2);  // h omega above 2.83: masses 1 and 8
}

TEST_CASE("members whose implicit formula is not solved in lanes end as they do alone", "[ensemble][lanes]") {
  const ScratchFolder folder;
  // Iteration contracts by h omega / 2: 4, 1.1, 0.8, 0.66 and less.
  write_text(folder / "scene.toml", ball("adams_moulton_2", 8, 20));
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:85:8"}), {}, true,
                            standard_parts());
  const std::vector<io::EnsembleRow> rows = rows_together(scene, {0, 1, 2, 3, 4, 5, 6, 7});
  for (std::int64_t k = 0; k < 8; ++k) {
    CAPTURE(k);
    const auto alone = run_members(scene, {&k, 1}, false, nullptr);
    const io::EnsembleRow& here = rows[static_cast<std::size_t>(k)];
    CHECK(here.outcome == alone[0].row->outcome);
    CHECK(here.step == alone[0].row->step);
    CHECK(rows_together(scene, {k})[0].bytes() == here.bytes());
    CHECK((here.outcome == static_cast<std::int64_t>(Outcome::Kind::solver_failure)) == (k < 2));
  }
}

/// Planets that are watched by monitors of chaos, at steps that are and are not multiples of each other.
std::string followed(const std::string& forces, const std::string& method, int steps = 200) {
  return stepped(forces, method, steps) +
         "[[every]]\ntype = \"megno\"\nsteps = 30\n[[every]]\ntype = \"lyapunov\"\nsteps = 50\nseed = 2\n";
}

TEST_CASE("small changes under methods in lanes have the bits of each member alone", "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  const auto check = [&](const std::string& forces, const std::string& method) {
    INFO(forces << " " << method);
    write_text(folder / "scene.toml", followed(forces, method, 60));
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    check_company(EnsembleScene(folder / "scene.toml", plan_of(near), {}, true, standard_parts()), 8);
  };
  check(gravity, "gauss_4");
  check(gravity + relativity, "gauss_2");
  check(gravity, "dormand_prince_5");  // its last stage is state
}

TEST_CASE("MEGNO and exponents of methods in lanes are those of the runs of their scenes to rounding",
          "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  const auto check = [&](const std::string& forces, const std::string& method) {
    INFO(forces << " " << method);
    write_text(folder / "scene.toml", followed(forces, method));
    const EnsembleScene scene(folder / "scene.toml", plan_of(calm), {}, true, standard_parts());
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    const std::vector<std::int64_t> members = {0, 3, 6, 7};
    const double megno = difference(scene, members, "megno"), exponent = difference(scene, members, "lyapunov");
    // Bounds as for splitting methods: positions differ by 2e-13 at most, and Y is of the size of 2.
    CHECK(megno > 0);  // else lanes were not used
    CHECK(megno <= 2e-11);
    CHECK(exponent <= 2e-12);
  };
  check(gravity, "gauss_4");
  check(gravity, "implicit_midpoint");
  check(gravity + oblate, "gauss_7");
  check(gravity + relativity, "gauss_8");
  check(gravity + "[[hamiltonian.force]]\ntype = \"linear_drag\"\nrate = 1e-3\n", "gauss_3");
  check(gravity, "dprkn_12");
  check(gravity + relativity, "dormand_prince_5");
}

TEST_CASE("members in lanes have the same bits with small changes beside them and without",
          "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  const auto positions = [&](const std::string& text) {
    write_text(folder / "scene.toml", text);
    const EnsembleScene scene(folder / "scene.toml", plan_of(near), {}, true, standard_parts());
    std::vector<double> all;
    for (const io::EnsembleRow& row : rows_together(scene, {0, 3, 5, 7, 10, 12, 14, 15})) {
      for (const double x : values_of(scene, row, "position")) all.push_back(x);
    }
    REQUIRE(all.size() >= 8 * 9);
    return all;
  };
  for (const char* method : {"gauss_3", "rk4"}) {
    INFO(method);
    const std::vector<double> with = positions(followed(gravity, method, 60)),
                              without = positions(stepped(gravity, method, 60));
    REQUIRE(with.size() == without.size());
    for (std::size_t k = 0; k < with.size(); ++k) CHECK((with[k] == without[k] || std::isnan(without[k])));
  }
}

/// A ball in the well of Henon and Heiles, as far as a megno and a lyapunov show.
std::string well(const std::string& v, int steps) {
  return R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [0, -0.2, 0], v = [)" +
         v + R"(, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "henon_heiles"
[integrator]
method = "gauss_4"
adaptive = false
step = 0.5
steps = )" +
         std::to_string(steps) +
         "\n[[every]]\ntype = \"megno\"\nsteps = 30\n[[every]]\ntype = \"lyapunov\"\nsteps = 50\nseed = 2\n";
}

TEST_CASE("by gauss_4 in lanes MEGNO of regular motion tends to 2, and of chaotic one grows by its exponent",
          "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  const auto made = [&](const std::string& text) {
    write_text(folder / "scene.toml", text);
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    // The motion does not depend on the mass.
    return EnsembleScene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:2:2"}), {}, true,
                         standard_parts());
  };
  // `noether run` of these has <Y> = 1.960 at a speed of 0.2, and 145.9 at 0.5 with an exponent of 0.0941.
  const EnsembleScene regular = made(well("0.2", 6000));
  for (const io::EnsembleRow& row : rows_together(regular, {0, 1})) {
    CHECK(std::abs(values_of(regular, row, "megno_mean")[0] - 2) < 0.05);
    CHECK(values_of(regular, row, "lyapunov_exponent")[0] * 3000 < 12);  // ln of some 3000 / (2 pi) oscillations
  }
  const EnsembleScene chaotic = made(well("0.5", 6000));
  for (const io::EnsembleRow& row : rows_together(chaotic, {0, 1})) {
    const double mean = values_of(chaotic, row, "megno_mean")[0];
    const double exponent = values_of(chaotic, row, "lyapunov_exponent")[0];
    CHECK(mean > 100);
    // <Y> = lambda t/2 where growth is even in time.
    CHECK(std::abs(2 * mean / (exponent * 3000) - 1) < 0.3);
  }
  // Over t = 100 rounding grows by e^10 at most, and Y is of the size of 10.
  const EnsembleScene early = made(well("0.5", 200));
  CHECK(difference(early, {0, 1}, "megno") <= 1e-9);
  CHECK(difference(early, {0, 1}, "lyapunov") <= 1e-10);
}

TEST_CASE("small changes go along where sweeps in lanes do not converge", "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  // h omega from 10 to 1.4, as above; a change moves as the ball does, whose motion is linear.
  write_text(folder / "scene.toml", ball("gauss_2", 10, 100) + "[[every]]\ntype = \"megno\"\nsteps = 10\n");
  const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:50:8"}), {}, true,
                            standard_parts());
  REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
  check_company(scene, 8);
  CHECK(difference(scene, {0, 1, 2, 3, 4, 5, 6, 7}, "megno") <= 1e-11);
}

TEST_CASE("small changes that grow without end stay numbers under methods in lanes", "[ensemble][lanes][chaos]") {
  const ScratchFolder folder;
  // x'' = x / m: |c| grows as e^(omega t), beyond what doubles hold; the ball itself is at rest.
  for (const char* method : {"gauss_4", "dormand_prince_5", "rk4"}) {
    INFO(method);
    const std::string at_rest = replaced(ball(method, 0.5, 2000), "x = [1, 0, 0]", "x = [0, 0, 0]");
    write_text(folder / "scene.toml",
               replaced(at_rest, "k = 1", "k = -1") + "[[every]]\ntype = \"lyapunov\"\nsteps = 100\n");
    const EnsembleScene scene(folder / "scene.toml", plan_of({"particles.body.ball.mass=1:1.5:2"}), {}, true,
                              standard_parts());
    REQUIRE(why_alone(load_scene(folder / "scene.toml")).empty());
    const std::vector<io::EnsembleRow> rows = rows_together(scene, {0, 1});
    for (std::size_t k = 0; k < 2; ++k) {
      // Of order 4 and 5 at h omega of 1/2: errors of the exponent of some h^4 / 120 and less.
      const double omega = 1 / std::sqrt(k == 0 ? 1.0 : 1.5);
      CHECK(std::abs(values_of(scene, rows[k], "lyapunov_exponent")[0] / omega - 1) < 2e-3);
    }
  }
}

TEST_CASE("every method of a family that has lanes has them", "[ensemble][lanes]") {
  std::set<std::string> in_lanes;
  for (const MethodInfo* info : methods::all()) {
    const MethodChoice choice{info, {.adaptive = info->adaptive ? std::optional(false) : std::nullopt}};
    if (info->fixed && method_in_lanes(choice)) in_lanes.insert(std::string(info->name));
  }
  for (const MethodInfo& info : methods::collocation_list()) CHECK(in_lanes.contains(std::string(info.name)));
  for (const MethodInfo& info : methods::runge_kutta_list()) CHECK(in_lanes.contains(std::string(info.name)));
  for (const MethodInfo& info : methods::rkmk_list()) CHECK(in_lanes.contains(std::string(info.name)));
  for (const MethodInfo& info : methods::exponential_list()) CHECK(in_lanes.contains(std::string(info.name)));
  for (const MethodInfo& info : methods::nystrom_list()) CHECK(in_lanes.contains(std::string(info.name)));
  CHECK_FALSE(method_in_lanes(method("gauss_8")));  // steps of its own choice
  for (const MethodInfo& info : methods::multistep_list()) CHECK(in_lanes.contains(std::string(info.name)));
  CHECK_FALSE(method_in_lanes(method("adams_pece")));
  CHECK_FALSE(method_in_lanes(method("bdf_2")));
}

TEST_CASE("methods that go one by one say why", "[ensemble][lanes]") {
  const ScratchFolder folder;
  const auto why = [&](const std::string& text) {
    write_text(folder / "scene.toml", text);
    return why_alone(load_scene(folder / "scene.toml"));
  };
  CHECK(why(stepped(gravity, "rk4")).empty());
  CHECK(why(replaced(planets(gravity, "dop853"), "step = 0.1\nsteps = 200", "until = 20")) ==
        "the method 'dop853' chooses its steps");
  CHECK(why(stepped("type = \"wisdom_holman\"", "rk4")) == "the Hamiltonian 'wisdom_holman' has no lanes");
  CHECK(why(stepped(gravity, "adams_bashforth_2")).empty());
  CHECK(why(stepped(gravity, "galerkin_gauss_2")) == "the method 'galerkin_gauss_2' has no lanes");
  CHECK(why(stepped(gravity, "bdf_2")) == "the method 'bdf_2' solves linear systems, which have no lanes");
  CHECK(why(stepped(gravity, "wide_gauss_8")) == "the stages of 'wide_gauss_8' fill the lanes of one system");
  CHECK(why(stepped(gravity, "encke_gauss_8")) == "the stages of 'encke_gauss_8' fill the lanes of one system");
  CHECK(why(stepped(gravity, "hbvm_16_5")) == "the nodes of 'hbvm_16_5' take the lanes of one system");
  CHECK(why(stepped(gravity, "hbvm_3")) == "the nodes of 'hbvm_3' take the lanes of one system");
  CHECK(why(stepped(gravity, "gauss_7")).empty());
  CHECK(why(stepped(gravity, "gauss_radau_15")) ==
        "the stages of 'gauss_radau_15' fill the lanes where gravity acts alone");
  CHECK(why(stepped(gravity + relativity, "gauss_radau_15")).empty());
  CHECK(why(stepped(gravity, "rk4") + "[[every]]\ntype = \"megno\"\nsteps = 10\n").empty());
  CHECK(why(stepped(gravity, "rk4") + "[[every]]\ntype = \"lyapunov\"\nvectors = 2\nsteps = 10\n") ==
        "monitor 'lyapunov' follows 2 vectors, of which one goes in lanes");
}

}  // namespace
}  // namespace noether::test
