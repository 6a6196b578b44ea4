// A charge in a Penning trap, whose motion is three circles: which pusher is where the closed form is?
#include "engine/simulation.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

using namespace noether;

namespace {

constexpr double B0 = 25, k = 4.9 * 4.9;  // q = m = 1
const PenningTrap trap{.B0 = B0, .gradient = k};
const Vec3<double> x0(10, 0, 0), v0(100, 0, 100);

ParticleSystem<double> ion() {
  ParticleSystem<double> s;
  s.add_column<Charge>();
  s.add("ion", 1, x0, v0);
  s.column<Charge>()[0] = 1;
  return s;
}

// w = x + i y obeys w'' = k w - i B w': two circles of frequencies (B +- sqrt(B^2 - 4 k))/2; z swings at sqrt(2 k).
Vec3<double> exact(double t) {
  using C = std::complex<double>;
  const double root = std::sqrt(B0 * B0 - 4 * k), fast = (B0 + root) / 2, slow = (B0 - root) / 2;
  const C w(x0[0], x0[1]), u(v0[0], v0[1]), i(0, 1);
  const C of_fast = (u + i * slow * w) / (-i * (fast - slow)), of_slow = w - of_fast;
  const C there = of_fast * std::exp(-i * fast * t) + of_slow * std::exp(-i * slow * t);
  const double axial = std::sqrt(2 * k);
  return {there.real(), there.imag(), x0[2] * std::cos(axial * t) + v0[2] / axial * std::sin(axial * t)};
}

double error(AnyIntegrator<double> by, std::int64_t steps) {
  Simulation sim(ion(), std::move(by), 1.0 / static_cast<double>(steps));
  if (!sim.run(steps).ok()) return std::nan("");
  double worst = 0;
  for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(sim.particles().positions()[0][j] - exact(1)[j]));
  return worst;
}

AnyIntegrator<double> turning(ChargedParticlesOptions options, const Scheme& scheme) {
  return compose(ChargedParticles(trap, options), scheme);
}

}  // namespace

int main() {
  Simulation sim(ion(), turning({.rotation = Rotation::boris}, schemes::verlet_aba), 1.0 / 160);
  auto& energy = sim.every(1, Energy{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(1600);
  fmt::print("{}\nenergy within {:.1e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);
  struct Way {
    const char* name;
    AnyIntegrator<double> by;
  };
  const std::vector<Way> ways = {
      {"boris", turning({.rotation = Rotation::boris}, schemes::verlet_aba)},
      {"hyper_boris",
       turning({.rotation = Rotation::hyper_boris, .cycles = 2, .gyrophase_order = 6}, schemes::verlet_aba)},
      {"helix", turning({}, schemes::verlet_aba)},
      {"boris, order 4", turning({.rotation = Rotation::boris}, schemes::yoshida_4)},
      {"helix, order 4", turning({}, schemes::blanes_moan_s6)},
      {"helix, order 8", turning({}, schemes::kahan_li_8_s17)},
      {"rk4", classical(Sum(InField(trap)), method("rk4"))},
      {"gauss_8", classical(Sum(InField(trap)), method("gauss_8", {.adaptive = false}))}};
  for (const Way& way : ways) {
    const double coarse = error(way.by, 160), fine = error(way.by, 320);
    fmt::print("{:<16} {:.1e} from its place after 160 steps, {:.1e} after 320\n", way.name, coarse, fine);
  }
  return 0;
}
