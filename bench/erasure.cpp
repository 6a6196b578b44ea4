/// What a scene costs over the same run written in C++, where the compiler knows every part: six bodies.
///
/// Protocol: 10^6 steps each in 50 slices, a slice of the program and one of the scene in turn; the median of the
/// ratios of processor times.

#include "bench/planets.hpp"

#include "scene/scene.hpp"

using namespace noether;

namespace {

Simulation<double> from_scene(const std::string& hamiltonian, const std::string& method, int step) {
  Scene scene = read_scene(fmt::format("units = 'solar'\n[[particles.body]]\nname = 'replaced'\nmass = '1 Msun'\n"
                                       "x = ['0 au', '0 au', '0 au']\nv = ['0 m/s', '0 m/s', '0 m/s']\n{}"
                                       "[integrator]\nmethod = '{}'\nstep = '{} day'\nsteps = 1\n",
                                       hamiltonian, method, step),
                           "scene.toml");
  scene.particles = bench::six_bodies();
  return assemble(scene);
}

void compare(const bench::Rows& rows, const std::string& name, Simulation<double> program, Simulation<double> scene) {
  const bench::Turns turns = bench::take_turns(program, scene, 20'000);
  rows.add(name, "scene_over_program", bench::Measured(turns.as_long), "1", 6);
  rows.add(name, "step_ns", bench::Measured(turns.first), "ns", 6);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("erasure", count, arguments);
  set_thread_count(1);
  compare(
      rows, "leapfrog6", bench::leapfrog6(),
      from_scene("[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n", "verlet", 10));
  compare(rows, "wh6", bench::wh6(), from_scene("[hamiltonian]\ntype = 'wisdom_holman'\n", "aba_10_6_4", 100));
}
