// Pairs too close, bonds too long, boxes too full: the run ends by name, and names the right ones.

#include "forces/bonded.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/classical.hpp"
#include "integrators/langevin.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/settings.hpp"

#include <array>
#include <optional>
#include <vector>

namespace noether::test {
namespace {

LennardJonesForce argon() {
  return {.cutoff = 2.5, .cutoff_style = Cutoff::shifted_force, .epsilon = 1.0, .sigma = 1.0};
}

Composition<AnyHamiltonian<double>> melt(const Scheme& scheme = schemes::verlet, double skin = 0) {
  return compose(kinetic_potential_over(field_of(argon()), NeighborOptions{.skin = skin}), scheme);
}

/// Beads of a ring of three, and a fourth one far from them, in a box; the bond of 'c' and 'a' is this much stretched.
ParticleSystem<double> ring(double stretched, double speed = 0) {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({9, 9, 9}));
  s.add("a", 1, {1, 1, 1}, {0, 0, 0});
  s.add("b", 1, {1.6, 1.8, 1}, {0, 0, 0});
  s.add("c", 1, {1 + stretched, 1, 1}, {speed, 0, 0});
  s.add("d", 1, {6, 6, 6}, {0, 0, 0});
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"fene", {30, 1.5, 1, 1}}};
  for (const auto& pair : {std::array<Index, 2>{0, 1}, {1, 2}, {2, 0}}) topology->bonds.push_back({pair, 0});
  s.set_topology(topology);
  return s;
}

/// How a ring with a bond that is too long, or becomes so, ends.
Outcome end_of_ring(double stretched, double speed, const Scheme& scheme, std::int64_t cadence, double skin = 0) {
  const auto hamiltonian = kinetic_potential_over(field_of(argon(), Bonded{}), NeighborOptions{.skin = skin});
  Simulation sim(ring(stretched, speed), compose(hamiltonian, scheme), 0.01);
  if (cadence > 0) sim.every(cadence, Energy{});
  return sim.run(100);
}

/// Two atoms of a liquid at rest put so far apart.
ParticleSystem<double> liquid_with_pair(double distance) {
  ParticleSystem<double> s = liquid(5, 0.8, 1.0, 0.05);
  s.positions().set(271, s.positions()[13] + Vec3<double>(distance, 0, 0));
  s.wrap();
  return s;
}

/// Four beads in a row, bonded, and two far off; the ends of the row, 'a' and 'd', are scaled, and so far apart.
ParticleSystem<double> row_with_ends(double apart, double factor) {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({9, 9, 9}));
  s.add("a", 1, {1, 1, 1}, {0, 0, 0});
  s.add("b", 1, {1, 2, 1}, {0, 0, 0});
  s.add("c", 1, {2, 1.9, 1}, {0, 0, 0});
  s.add("d", 1, {1 + apart, 1, 1}, {0, 0, 0});
  s.add("e", 1, {5, 5, 5}, {0, 0, 0});
  s.add("f", 1, {6.2, 5, 5}, {0, 0, 0});
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"harmonic", {100, 1}}};
  for (Index i = 0; i < 3; ++i) topology->bonds.push_back({{i, i + 1}, 0});
  topology->exclusions = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
  if (factor != 1) topology->scaled_pairs = {{{0, 3}, factor}};
  s.set_topology(topology);
  return s;
}

/// How a row ends that is under a pair force.
template <class Force>
Outcome end_of_row(const ParticleSystem<double>& s, const Force& force, double step, std::int64_t steps) {
  Simulation sim(s, compose(kinetic_potential(force, Bonded{}), schemes::verlet), step);
  return sim.run(steps);
}

const Buckingham helium{2500, 0.18, 3.1};

BuckinghamForce helium_pairs() { return {helium, 2.1, Cutoff::shifted_force}; }

}  // namespace

TEST_CASE("a bond that breaks ends the run as overstretch, whoever looks and whatever the word", "[extremes][bonded]") {
  const Scheme baoab = word("BAOAB");
  for (const double speed : {0.0, 30.0}) {
    const double stretched = speed == 0 ? 1.6 : 1.0;
    for (const Scheme* scheme :
         {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_4, &schemes::blanes_moan_s6}) {
      std::optional<std::int64_t> step;
      for (const std::int64_t cadence : {0, 1, 3}) {
        CAPTURE(speed, scheme->name, cadence);
        const Outcome outcome = end_of_ring(stretched, speed, *scheme, cadence, cadence == 3 ? 0.5 : 0);
        CHECK(outcome.kind == Outcome::Kind::overstretch);
        CHECK(outcome.message.find("the bond of 'c' and 'a' is ") == 0);
        CHECK(outcome.quantity == "bond");
        REQUIRE(outcome.particle);
        CHECK(outcome.particle->name == "c");
        CHECK(outcome.step == step.value_or(outcome.step));
        step = outcome.step;
        CHECK((speed == 0) == (outcome.step == 0));
      }
    }
    for (const std::int64_t cadence : {0, 1}) {
      Simulation sim(ring(stretched, speed),
                     compose(in_bath(field_of(argon(), Bonded{}), {.temperature = 1, .friction = 0.1}), baoab), 0.01);
      if (cadence > 0) sim.every(cadence, Energy{});
      CHECK(sim.run(100).kind == Outcome::Kind::overstretch);
    }
  }
}

TEST_CASE("a broken bond is named at every SIMD level, on any number of threads", "[extremes][bonded]") {
  std::optional<std::string> message;
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    const AtLevel at(level);
    for (const int threads : {1, 2, 3}) {
      const Threads now(threads);
      // Long chains, so that bonds go in lanes and on several threads.
      ParticleSystem<double> s;
      auto topology = std::make_shared<Topology>();
      topology->bond_kinds = {{"fene", {30, 1.5, 1, 1}}};
      for (Index i = 0; i < 600; ++i) {
        s.add("", 1, {0.97 * static_cast<double>(i), 0, 0}, {i >= 300 ? 30.0 : 0.0, 0, 0});
        if (i > 0) topology->bonds.push_back({{i - 1, i}, 0});
      }
      s.set_topology(topology);
      Simulation sim(std::move(s), compose(kinetic_potential(Bonded{}), schemes::verlet), 0.01);
      const Outcome outcome = sim.run(100);
      CHECK(outcome.kind == Outcome::Kind::overstretch);
      REQUIRE(outcome.particle);
      CHECK(outcome.particle->index == 299);
      CHECK(is_finite(sim.particles()));
      CHECK(to_text(outcome) == message.value_or(to_text(outcome)));
      message = to_text(outcome);
    }
  }
}

TEST_CASE("methods of fixed steps name a force that fails too", "[extremes][bonded]") {
  for (const char* name : {"rk4", "heun", "gauss_1"}) {
    CAPTURE(name);
    Simulation sim(ring(1.6), classical_over(field_of(argon(), Bonded{}), method(name)), 0.01);
    CHECK(sim.run(10).kind == Outcome::Kind::overstretch);
  }
}

TEST_CASE("two atoms too close for the step are named at the start, before they are thrown apart",
          "[extremes][overlap]") {
  for (const double distance : {0.5, 0.6, 0.65, 0.69}) {
    CAPTURE(distance);
    ParticleSystem<double> s;
    s.set_box(Box::periodic({3, 3, 3}));
    s.add("a", 1, {1, 1, 1}, {0, 0, 0});
    s.add("b", 1, {1 + distance, 1, 1}, {0, 0, 0});
    s.add("c", 1, {2, 2.4, 2}, {0, 0, 0});
    for (const bool watched : {false, true}) {
      Simulation sim(s, melt(), 0.005);
      if (watched) sim.every(1, Energy{});
      const Outcome outcome = sim.run(1000);
      CHECK(outcome.kind == Outcome::Kind::overlap);
      CHECK(outcome.step == 0);
      CHECK(outcome.message.find(fmt::format("particles 'a' and 'b' are {:.3g} apart", distance)) == 0);
    }
    CHECK(Simulation(s, melt(), 1e-4).run(1000).ok());  // a step that can follow them
  }
}

TEST_CASE("a scaled pair too close ends the run as an unscaled one does, and both are named", "[extremes][overlap]") {
  for (const double apart : {0.0, 1e-9, 1e-4, 0.1, 0.3, 0.45}) {
    for (const double factor : {1.0, 0.5}) {
      CAPTURE(apart, factor);
      const Outcome outcome = end_of_row(row_with_ends(apart, factor), argon(), 0.005, 1000);
      CHECK(outcome.kind == Outcome::Kind::overlap);
      CHECK(outcome.step == 0);
      CHECK(outcome.message == fmt::format("particles 'a' and 'd' are {:.3g} apart, too close for their Lennard-Jones "
                                           "force; start with [minimize], or take a smaller step",
                                           apart));
      REQUIRE(outcome.particle);
      CHECK(outcome.particle->name == "a");
    }
  }
}

TEST_CASE("a scaled pair too close for the step is named with the way it would go", "[extremes][overlap]") {
  const double apart = 0.6, step = 0.005;
  const double r6 = std::pow(apart, -6), force = 24 * r6 * (2 * r6 - 1) / apart;
  // The end of a shifted force takes less than a thousandth, as does a digit less.
  const std::string way = fmt::format("{:.3g}", 0.5 * force * step * step);
  const Outcome outcome = end_of_row(row_with_ends(apart, 0.5), argon(), step, 1000);
  CHECK(outcome.kind == Outcome::Kind::overlap);
  CHECK(outcome.step == 0);
  CHECK(outcome.message ==
        fmt::format("particles 'a' and 'd' are 0.6 apart: their Lennard-Jones force would move 'a' by {} in one step, "
                    "further than a step can follow; start with [minimize], or take a smaller step",
                    way));
  CHECK(end_of_row(row_with_ends(apart, 0.5), argon(), 1e-4, 1000).ok());  // a step that can follow them
  CHECK(end_of_row(row_with_ends(apart, 1e-3), argon(), step, 100).ok());  // a force that it can follow
  ParticleSystem<double> s = row_with_ends(0.72, 0.5);
  CHECK(end_of_row(s, argon(), step, 100).ok());
  s.masses()[3] = 0.05;  // the one that is moved too far is the light one
  CHECK(end_of_row(s, argon(), step, 100).message.find("would move 'd' by") != std::string::npos);
}

TEST_CASE("a scaled pair within Buckingham's barrier ends the run, and one outside does not", "[extremes][overlap]") {
  const double top = helium.nearest();
  for (const double apart : {1e-3, 0.5 * top, 0.99 * top}) {
    for (const double factor : {1.0, 0.5}) {
      CAPTURE(apart, factor);
      const Outcome outcome = end_of_row(row_with_ends(apart, factor), helium_pairs(), 1e-5, 100);
      CHECK(outcome.kind == Outcome::Kind::overlap);
      CHECK(outcome.step == 0);  // nothing is proposed: within the barrier they attract
      CHECK(outcome.message ==
            fmt::format("particles 'a' and 'd' are {:.3g} apart, too close for their buckingham force", apart));
    }
  }
  CHECK(end_of_row(row_with_ends(1.01 * top, 0.5), helium_pairs(), 1e-5, 10).ok());
}

TEST_CASE("a scaled pair that comes too close in a liquid is named, on any number of threads and with any skin",
          "[extremes][overlap]") {
  std::optional<std::string> text;
  for (const int threads : {1, 2, 3}) {
    const Threads now(threads);
    for (const double skin : {0.0, 0.3}) {
      ParticleSystem<double> s = liquid_with_pair(0.9);
      auto topology = std::make_shared<Topology>();
      topology->scaled_pairs = {{{13, 271}, 0.5}, {{20, 40}, 0.5}};
      s.set_topology(topology);
      s.velocities().set(271, {-300, 0, 0});
      Simulation sim(s, melt(schemes::verlet, skin), 1e-4);
      const Outcome outcome = sim.run(1000);
      CAPTURE(threads, skin);
      CHECK(outcome.kind == Outcome::Kind::overlap);
      CHECK(outcome.step > 0);
      CHECK(outcome.message.find("particles 13 and 271 are ") == 0);
      CHECK(is_finite(sim.particles()));
      CHECK(to_text(outcome) == text.value_or(to_text(outcome)));
      text = to_text(outcome);
    }
  }
}

TEST_CASE("scaled atoms in one place are named by the program, which speaks of no gravity", "[extremes][overlap]") {
  const SceneFolder folder(
      "units = \"reduced\"\n[particles]\nstructure = \"row.data\"\nfile_units = \"lj\"\nspecial = [0, 0, 0.5]\n"
      "[hamiltonian]\ntype = \"kinetic_potential\"\nforce = [{ type = \"lennard_jones\", cutoff = 2.5, epsilon = 1, "
      "sigma "
      "= 1 }, { type = \"bonded\" }]\n[integrator]\nmethod = \"verlet\"\nstep = 0.005\nsteps = 100\n");
  for (const char* last : {"1 1 1", "1.3 1 1"}) {
    write_text(
        folder / "row.data",
        fmt::format("row\n\n4 atoms\n3 bonds\n1 atom types\n1 bond types\n\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo "
                    "zhi\n\nMasses\n\n1 1\n\nBond Coeffs # harmonic\n\n1 100 1\n\nAtoms # bond\n\n1 1 1 1 1 1\n2 1 "
                    "1 1 2 1\n3 1 1 2 2 1\n4 1 1 {}\n\nBonds\n\n1 1 1 2\n2 1 2 3\n3 1 3 4\n",
                    last));
    const ProcessResult result = noether(folder, "run scene.toml --fresh");
    INFO(result.out << result.err);
    CHECK(result.exit_code == 1);
    CHECK(has(result.err, "overlap at step 0: particles 'atom_1' and 'atom_4' are "));
    CHECK(has(result.err, "too close for their Lennard-Jones force"));
    CHECK_FALSE(has(result.err, "gravity"));
  }
}

TEST_CASE("a close pair in a liquid is named, on any number of threads and with any skin", "[extremes][overlap]") {
  for (const double distance : {0.6, 0.65}) {
    for (const Scheme& scheme : {schemes::verlet, schemes::verlet_aba}) {
      std::optional<std::string> text;
      for (const int threads : {1, 2, 3}) {
        const Threads now(threads);
        for (const double skin : {0.0, 0.1, 0.6}) {
          CAPTURE(distance, scheme.name, threads, skin);
          Simulation sim(liquid_with_pair(distance), melt(scheme, skin), 0.005);
          const Outcome outcome = sim.run(1000);
          CHECK(outcome.kind == Outcome::Kind::overlap);
          CHECK(outcome.step == 0);
          CHECK(outcome.message.find("particles 13 and 271 are ") == 0);
          CHECK(to_text(outcome) == text.value_or(to_text(outcome)));
          text = to_text(outcome);
        }
      }
    }
  }
}

TEST_CASE("liquids as hot, and steps as long, as people take them never end for a close pair", "[extremes][overlap]") {
  for (const auto& [temperature, step] : {std::pair(0.7, 0.01), {1.5, 0.008}, {10.0, 0.004}}) {
    CAPTURE(temperature, step);
    CHECK(Simulation(liquid(5, 0.8442, temperature), melt(), step).run(1000).ok());
  }
}

TEST_CASE("a box far too full is refused by name before neighbors are listed", "[extremes][overlap]") {
  for (const int cells : {10, 20}) {  // 4000 and 32 000 atoms
    for (const int threads : {1, 2}) {
      const Threads now(threads);
      const ParticleSystem<double> s = liquid(cells, 1e3, 1.0);
      Composition integrator(KineticPotential(field_of(argon())), schemes::verlet);
      const auto& hamiltonian = integrator.hamiltonian();
      ParticleSystem<double> first = s;
      first.clock() = Clock<double>::fixed(0, 1e-4);
      integrator.bind(first);
      const Advance done = integrator.advance(first, {.steps = 1});
      REQUIRE(done.failure != nullptr);
      CHECK(done.failure->kind == Outcome::Kind::overlap);
      CHECK(done.failure->message.find("with more than 32768 others or images of them in the range 2.5") !=
            std::string::npos);
      CHECK(hamiltonian.workspace().find<NeighborList>()->statistics().pairs == 0);
      CHECK(hamiltonian.workspace().find<NeighborList>()->statistics().bytes < 300'000'000);
      CHECK(Simulation(s, melt(), 1e-4).run(5).kind == Outcome::Kind::overlap);
    }
  }
}

}  // namespace noether::test
