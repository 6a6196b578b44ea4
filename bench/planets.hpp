#pragma once
/// The system of the benchmarks of orbits: a star and five planets.

#include "bench/support.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"

#include <cmath>

namespace noether::bench {

/// The outer Solar System in round numbers.
inline ParticleSystem<double> six_bodies() {
  ParticleSystem<double> s(unit_system("solar"));
  s.add("Sun", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  const double masses[] = {9.5e-4, 2.9e-4, 4.4e-5, 5.2e-5, 6.6e-9}, distances[] = {5.2, 9.5, 19.2, 30.1, 39.5};
  for (int k = 0; k < 5; ++k) {
    const double speed = std::sqrt(s.units().G / distances[k]), angle = 1.3 * k;
    s.add("planet " + std::to_string(k), masses[k],
          distances[k] * Vec3<double>(std::cos(angle), std::sin(angle), 0.02 * k),
          speed * Vec3<double>(-std::sin(angle), std::cos(angle), 0));
  }
  return s;
}

/// Leapfrog, steps of 10 days, as a program writes it.
inline Simulation<double> leapfrog6() {
  return Simulation(six_bodies(), compose(KineticPotential(Gravity{}), schemes::verlet), 10.0);
}

/// ABA(10,6,4) over the Wisdom-Holman splitting, steps of 100 days, as a program writes it.
inline Simulation<double> wh6() {
  return Simulation(six_bodies(), compose(WisdomHolman(WisdomHolmanOptions{}), schemes::aba_10_6_4), 100.0);
}

/// Processor time of `steps` more steps, a step [ns].
inline double step_ns(Simulation<double>& simulation, std::int64_t steps) {
  return 1e9 * processor_seconds_of([&] { static_cast<void>(simulation.run(steps)); }) / static_cast<double>(steps);
}

/// Two runs that took turns, slice by slice.
struct Turns {
  std::vector<double> first;            ///< a step of the first run [ns]
  std::vector<double> longer, as_long;  ///< a step of the second one: so much longer [ns], so many times as long
};

/// Lets two runs take turns: 50 slices of so many steps each, after one to warm up.
inline Turns take_turns(Simulation<double>& first, Simulation<double>& second, std::int64_t steps) {
  Turns turns;
  for (int slice = 0; slice <= 50; ++slice) {
    const double one = step_ns(first, steps), other = step_ns(second, steps);
    if (slice == 0) continue;
    turns.first.push_back(one);
    turns.longer.push_back(other - one);
    turns.as_long.push_back(other / one);
  }
  return turns;
}

}  // namespace noether::bench
