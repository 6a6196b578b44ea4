/// A million bodies: a few steps of them, and the memory they take.

#include "forces/external_fields.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/drivers.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace noether::test {

namespace {

constexpr Index million = 1'000'000;

/// A star of mass 1 and tracers on circular orbits (G = 1) with radii from 1 to 2.
ParticleSystem<double> disk(Index tracers) {
  ParticleSystem<double> s;
  s.add("star", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  for (Index k = 0; k < tracers; ++k) {
    const double r = 1 + static_cast<double>(k) / static_cast<double>(tracers);
    const double angle = 2.399963 * static_cast<double>(k), v = 1 / std::sqrt(r), c = std::cos(angle),
                 d = std::sin(angle);
    s.add("t" + std::to_string(k), 0, {r * c, r * d, 0}, {-v * d, v * c, 0});
  }
  return s;
}

/// Largest distance of a tracer from where its circle has led it after a time, in radii.
double worst_on_circles(const ParticleSystem<double>& start, const ParticleSystem<double>& end, double time) {
  double worst = 0;
  for (Index i = 1; i < start.size(); ++i) {
    const Vec3<double> x = start.positions()[i], v = start.velocities()[i];
    const double r = x.norm(), phase = time / (r * std::sqrt(r));
    const Vec3<double> expected = std::cos(phase) * x + std::sin(phase) * r / v.norm() * v;
    worst = std::max(worst, (end.positions()[i] - expected).norm() / r);
  }
  return worst;
}

template <class H> double disk_error(const H& hamiltonian, double dt, std::int64_t steps) {
  const auto start = disk(million);
  Simulation simulation(start, compose(hamiltonian, schemes::verlet), dt);
  const auto& energy = simulation.every(steps, Energy{});
  const Outcome outcome = simulation.run(steps);
  check_named_end(simulation, outcome, dt);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(energy.worst() == 0);  // tracers have none, and the star rests
  return worst_on_circles(start, simulation.particles(), dt * static_cast<double>(steps));
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
/// Bytes that the program has allocated and not given back.
double allocated_bytes() {
  const auto info = ::mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}
#endif

}  // namespace

TEST_CASE("a million tracers go round a star over arcs to rounding, and under kicks to their order",
          "[extremes][nightly]") {
  constexpr double dt = 0.01;
  constexpr std::int64_t steps = 4;
  // Eight roundings per arc; a circle whose speed is rounded is another one, three times as far astray by the radian.
  CHECK(disk_error(wisdom_holman({.G = 1.0}), dt, steps) < 8 * rounding * steps * 2);
  // The energy that verlet keeps differs by (w h)^2 terms: (w t)^3 is an upper bound of what t = 0.04 makes of them.
  CHECK(disk_error(kinetic_potential(Gravity{.G = 1.0}), dt, steps) < 0.04 * 0.04 * 0.04);
}

TEST_CASE("a box of a million bodies on springs swings as one would, and keeps its energy", "[extremes][nightly]") {
  ParticleSystem<double> box;
  for (Index k = 0; k < million; ++k) {
    const Index i = k % 100, j = k / 100 % 100, l = k / 10000;
    const Vec3<double> place(static_cast<double>(i), static_cast<double>(j), static_cast<double>(l));
    box.add("b" + std::to_string(k), 1, place / 100, Vec3<double>::Zero());
  }
  constexpr double dt = 0.01;
  constexpr std::int64_t steps = 4;
  const auto start = box;
  WatchedRun run(std::move(box), compose(kinetic_potential(HarmonicField{.k = 1}), schemes::verlet), dt, steps);
  const Outcome outcome = run.simulation.run(steps);
  check_named_end(run.simulation, outcome, dt);
  CHECK(outcome.kind == Outcome::Kind::completed);
  // Verlet moves by the angle arccos(1 - h^2/2) per step: every component alike, to rounding.
  const double factor = std::cos(steps * std::acos(1 - dt * dt / 2));
  double worst = 0;
  const ParticleSystem<double>& end = run.simulation.particles();
  for (Index i = 0; i < million; ++i) {
    const Vec3<double> x = start.positions()[i];
    worst = std::max(worst, (end.positions()[i] - factor * x).cwiseAbs().maxCoeff());
  }
  CHECK(worst < 8 * rounding * 3 * steps);
  CHECK(run.energy.worst() < dt * dt / 4);  // v^2 + x^2 (1 - h^2/4) is kept to rounding
}

TEST_CASE("a million particles take the bytes that explain prints, and their names", "[extremes][slow]") {
  const auto few = disk(2);
  ExtremeScene scene{.bodies = {body_text(few, 0), body_text(few, 1)}, .steps = 1};
  const ProcessResult explained = noether(SceneFolder(scene.text()), "explain scene.toml --json");
  CHECK(json_member(explained.out, "bytes_per_particle") == std::to_string(few.bytes_per_particle()));
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
  const auto s = disk(million);
  const double before = allocated_bytes();
  const ParticleSystem<double> copy = s;
  const double each = (allocated_bytes() - before) / static_cast<double>(million);
  const auto expected = static_cast<double>(s.bytes_per_particle() + sizeof(std::string));
  CAPTURE(each, expected);
  CHECK(copy.size() == s.size());
  CHECK(each > expected - 0.1);
  CHECK(each < expected + 3 * sizeof(double) + 0.1);  // vectors that were appended may keep room for half as many more
#else
  WARN("memory not measured: this needs the allocator of glibc, without sanitizers");
#endif
}

TEST_CASE("the program runs a million tracers from a table", "[extremes][nightly]") {
  const auto s = disk(million);
  std::string table = "name,mass,x,y,z,vx,vy,vz\n";
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
    table += fmt::format("{},{},{},{},{},{},{},{}\n", s.name(i), s.masses()[i], x[0], x[1], x[2], v[0], v[1], v[2]);
  }
  for (const char* hamiltonian :
       {"type = \"wisdom_holman\"\n", "type = \"kinetic_potential\"\nforce = [{ type = \"gravity\" }]\n"}) {
    const SceneFolder folder(
        fmt::format("units = \"reduced\"\n[particles]\nbodies = \"disk.csv\"\n[hamiltonian]\n{}"
                    "[integrator]\nmethod = \"verlet\"\nstep = 0.01\nsteps = 4\n[[every]]\n"
                    "type = \"energy\"\nsteps = 4\n",
                    hamiltonian));
    write_text(folder / "disk.csv", table);
    const ProcessResult result = noether(folder, "run scene.toml --json");
    INFO(result.out << result.err);
    CHECK(result.exit_code == 0);
    CHECK(json_member(result.out, "particles") == "1000001");
    CHECK_FALSE(lacks_figures(result.out));
  }
}

}  // namespace noether::test
