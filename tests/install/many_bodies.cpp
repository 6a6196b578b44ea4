// A program as users write it, for cmake/check_install.cmake: whatever flags it is built with, it ends in the same
// bits.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace noether;

/// A star, planets and tracers on a spiral of nearly circular orbits (G = 1).
static ParticleSystem<double> disc(int planets, int tracers) {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  for (int k = 0; k < planets + tracers; ++k) {
    const double r = 1 + 0.01 * k, v = 1 / std::sqrt(r), angle = 2.399963 * k;
    s.add("body", k < planets ? 1e-6 : 0, {r * std::cos(angle), r * std::sin(angle), 0.01 * (k % 7)},
          {-v * std::sin(angle), v * std::cos(angle), 0});
  }
  return s;
}

template <class I> static void run(const char* name, const I& integrator) {
  Simulation simulation(disc(200, 150), integrator, 0.01);
  simulation.every(3, Energy{});
  const Outcome outcome = simulation.run(20);
  fmt::print("{} {} {}\n", name, outcome, io::digest(simulation.particles()));
}

int main() {
  const Sum forces(Gravity{.softening = 0.01}, Oblateness{.J2 = 1e-3, .radius = 0.1},
                   OscillatingField{.acceleration = {1e-4, 0, 0}, .omega = 3});
  run("verlet", compose(KineticPotential(forces), schemes::verlet));
  run("blanes_moan_s10", compose(KineticPotential(forces), schemes::blanes_moan_s10, {.compensated = true}));
  run("aba_10_6_4", compose(WisdomHolman(WisdomHolmanOptions{}), schemes::aba_10_6_4));
}
