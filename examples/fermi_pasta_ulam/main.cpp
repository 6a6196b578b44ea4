// The chain of Fermi, Pasta and Ulam by line integrals: from how many nodes on its energy is exact, beside symplectic
// methods, and whether the energy of one wave spreads over all of them.
#include "engine/simulation.hpp"
#include "forces/anharmonic_chain.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace noether;

namespace {

const AnharmonicChain quartic{.k = 1, .quartic = 2};  // springs of energy d^2 / 2 + d^4 / 2: degree 4
const AnharmonicChain cubic{.k = 1, .cubic = 0.25};   // degree 3, and weaker

ParticleSystem<double> chain(const std::vector<double>& displacements) {
  ParticleSystem<double> s;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    s.add(fmt::format("q{}", i + 1), 1, {displacements[i], 0, 0}, {0, 0, 0});
  }
  return s;
}

// 1.2 sin(pi i / 7): the longest wave.
const ParticleSystem<double> six = chain({0.5206604869410697, 0.9381977789616357, 1.1699134946181884,
                                          1.1699134946181884, 0.9381977789616357, 0.5206604869410697});

AnyIntegrator<double> by(const std::string& name) {
  if (const Scheme* scheme = schemes::find(name)) return compose(KineticPotential(quartic), *scheme);
  return classical(quartic, method(name));
}

// Where the six are at t = 20, by short steps of Gauss's method of order 16.
ParticleSystem<double> exact_end() {
  Simulation sim(six, classical(quartic, method("gauss_8", {.adaptive = false})), 0.02);
  return sim.run(1000).ok() ? sim.particles() : six;
}

Outcome follow(const std::string& name, const ParticleSystem<double>& there) {
  Simulation sim(six, by(name), 0.2);
  auto& energy = sim.every(1, Energy{});
  const Outcome outcome = sim.run(100);
  double error = 0;
  for (Index i = 0; i < there.size(); ++i) {
    error = std::max(error, std::abs(sim.particles().positions()[i][0] - there.positions()[i][0]));
  }
  fmt::print("{:<18} order {}, energy within {:.1e}, {:.2e} from its place{}\n", name, sim.claims().order,
             energy.worst(), error, sim.claims().symplectic ? ", symplectic" : "");
  return outcome;
}

// The energy of a linear chain in its longest wave.
double longest_wave(const ParticleSystem<double>& s) {
  const double ends = static_cast<double>(s.size() + 1), turn = std::numbers::pi / ends;
  const double omega = 2 * std::sin(turn / 2);
  double q = 0, p = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const double wave = std::sqrt(2 / ends) * std::sin(turn * static_cast<double>(i + 1));
    q += wave * s.positions()[i][0];
    p += wave * s.velocities()[i][0];
  }
  return (p * p + omega * omega * q * q) / 2;
}

Outcome spread() {
  std::vector<double> wave;
  for (int i = 1; i <= 16; ++i) wave.push_back(2 * std::sin(std::numbers::pi * i / 17));
  Simulation sim(chain(wave), classical(cubic, method("hbvm_3_2")), 0.25);
  auto& energy = sim.every(1, Energy{});
  const double all = longest_wave(sim.particles());
  for (const double t : {300, 600, 900, 1290}) {
    const Outcome outcome = sim.run_until(t);
    if (!outcome.ok()) return outcome;
    fmt::print("t = {}: {:.0f} % in the longest wave, energy within {:.0e}\n", t,
               100 * longest_wave(sim.particles()) / all, energy.worst());
  }
  return {};
}

}  // namespace

int main() {
  Simulation sim(six, by("hbvm_4_2"), 0.2);
  auto& energy = sim.every(1, Energy{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(500);
  fmt::print("{}\nenergy within {:.0e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);
  const ParticleSystem<double> there = exact_end();
  for (const char* name :
       {"verlet", "implicit_midpoint", "avf", "yoshida_4", "gauss_2", "hbvm_2_2", "hbvm_3_2", "hbvm_4_2", "hbvm_6_3"}) {
    const Outcome followed = follow(name, there);
    if (!followed.ok()) return exit_code(followed);
  }
  return exit_code(spread());
}
