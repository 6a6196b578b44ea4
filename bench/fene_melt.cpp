/// The melt of chains of LAMMPS's bench/in.chain: 320 chains of 100 beads at density 0.85, FENE bonds and repulsive
/// Lennard-Jones pairs, at temperature 1; whole steps with the search for neighbors.
///
/// Cases: `langevin` in a bath of friction 0.1 by BAOAB with steps of 0.012 as in.chain, and `nve` by Verlet with steps
/// of 0.005. Beside them LAMMPS from the same beads, plain and OPT, where python3 has it (OPT has a variant of the pair
/// style, none of the bonds or of the bath). Protocol: walks of chains are led downhill and 500 steps of 0.005 in a
/// strong bath; then 200 steps to settle, and the medians of 7 slices of 100 steps each, ours and LAMMPS's in turn;
/// processor time of one thread, wall time of more.

#include "bench/melt.hpp"
#include "engine/simulation.hpp"
#include "engine/topology.hpp"
#include "forces/bonded.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "integrators/minimize.hpp"
#include "scene/builders.hpp"

#include <filesystem>
#include <fstream>

using namespace noether;

namespace {

constexpr int chains = 320, beads = 100, atoms = chains * beads;

ForceField<double> forces() {
  ForceField<double> all;
  all.add(LennardJonesForce{.cutoff = 1.122462048309373, .cutoff_style = Cutoff::shifted});
  all.add(Bonded{});
  return all;
}

/// Chains that have forgotten that they were walks.
ParticleSystem<double> settled() {
  ParticleSystem s =
      PolymerChains{.chains = chains, .beads = beads, .density = 0.85, .mass = 1, .temperature = 1.0}.build();
  static_cast<void>(minimize(s, AnyForce<double>(forces()), {.max_force = 50}));
  auto bath = Langevin(KineticPotential(forces()), {.temperature = 1, .friction = 1, .seed = 1});
  Simulation sim(std::move(s), compose(std::move(bath), word("BAOAB")), 0.005);
  if (const Outcome outcome = sim.run(500); !outcome.ok()) throw Error(to_text(outcome));
  ParticleSystem<double> end = sim.particles();
  end.phase() = Phase{};
  return end;
}

/// As LAMMPS reads it.
void write_data(const std::filesystem::path& path, const ParticleSystem<double>& s) {
  std::ofstream file(path);
  file << fmt::format("chains\n\n{} atoms\n{} bonds\n1 atom types\n1 bond types\n", atoms, chains * (beads - 1));
  const char* axes = "xyz";
  for (int k = 0; k < 3; ++k) {
    const double half = s.box().edges()[k] / 2;
    file << fmt::format("{} {} {}lo {}hi\n", -half, half, axes[k], axes[k]);
  }
  file << "\nMasses\n\n1 1\n\nBond Coeffs\n\n1 30 1.5 1 1\n\nAtoms # bond\n\n";
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i];
    file << fmt::format("{} {} 1 {} {} {}\n", i + 1, i / beads + 1, x[0], x[1], x[2]);
  }
  file << "\nVelocities\n\n";
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> v = s.velocities()[i];
    file << fmt::format("{} {} {} {}\n", i + 1, v[0], v[1], v[2]);
  }
  file << "\nBonds\n\n";
  int bond = 0;
  for (int i = 0; i < atoms; ++i) {
    if (i % beads < beads - 1) file << fmt::format("{} 1 {} {}\n", ++bond, i + 1, i + 2);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("fene_melt", count, arguments);
  const int threads = thread_count(), steps = 100;
  const ParticleSystem<double> start = settled();
  const std::filesystem::path data = std::filesystem::temp_directory_path() / "noether_bench_chains.data";
  write_data(data, start);
  using Field = KineticPotential<ForceField<double>>;
  std::vector<bench::Melt> cases;
  cases.push_back(bench::melt("langevin", start,
                              Langevin(Field(forces()), {.temperature = 1, .friction = 0.1, .seed = 2}), word("BAOAB"),
                              0.012));
  cases.push_back(bench::melt("nve", start, Field(forces()), schemes::verlet, 0.005));
  for (const int by : threads > 1 ? std::vector<int>{1, threads} : std::vector<int>{1}) {
    set_thread_count(by);
    for (bench::Melt& one : cases) {
      std::vector<bench::Melt> ours = {one}, peers;
      for (const std::string package : by == 1 ? std::vector{"plain", "opt"} : std::vector<const char*>{}) {
        bench::add_peer(peers, "lammps_" + package,
                        fmt::format("lammps_melt.py fene {} {} '{}'", package, one.name, data.string()), atoms);
      }
      bench::take_turns(ours, peers, steps);
      bench::add_rate(rows, ours[0], peers);
      bench::add_search(rows, ours[0]);
    }
  }
  std::filesystem::remove(data);
}
