/// The Lennard-Jones melt of LAMMPS's bench/in.lj: density 0.8442, cutoff 2.5 (plain), step 0.005, from a face-centred
/// lattice at temperature 1.44; whole steps with the search for neighbors.
///
/// Cases: `safe` finds neighbors when somebody has moved too far, as runs do; `fixed20` every 20 steps with a skin of
/// 0.3 as in.lj does, which misses pairs; `user` is `safe` with a potential written for PairForce; `mixed` and
/// `mixed_fixed20` have forces of pairs in single precision; `charged_fused` and `charged_apart` have charges in a
/// reaction field beside it, in one loop and as a second force. Beside them LAMMPS, plain and OPT, where python3 has
/// it, and GROMACS in double and mixed precision. Protocol: 200 steps to melt, then the median of 7 slices of 100 steps
/// each, cases in turn; processor time of one thread, wall time of more. Then the lower levels of SIMD on one thread,
/// and `safe` with fewer and with more atoms: what one costs, and its memory. At last what mixed precision costs: the
/// drift of the energy of 4000 atoms with a C4 switch over 50 000 steps of 0.002, from the slope through block means,
/// with its error, beside that of doubles.

#include "bench/melt.hpp"
#include "engine/charge.hpp"
#include "engine/monitors.hpp"
#include "engine/simd.hpp"
#include "engine/simulation.hpp"
#include "forces/fused_pair.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_force.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/schemes.hpp"

#include <optional>

using namespace noether;

namespace {

/// 4 cells^3 atoms at temperature 1.44, at rest as a whole.
ParticleSystem<double> lattice(int cells) {
  const double edge = std::cbrt(4 / 0.8442);
  ParticleSystem<double> s;
  s.set_box(Box::periodic(Vec3<double>::Constant(cells * edge)));
  std::uint64_t state = 87287;
  const auto random = [&] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(static_cast<std::int64_t>(state)) / 9223372036854775808.0;
  };
  const Vec3<double> basis[4] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
  for (int k = 0; k < cells; ++k) {
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        for (const Vec3<double>& b : basis) {
          const Vec3<double> v(random(), random(), random());
          s.add("", 1, edge * (Vec3<double>(i, j, k) + b), v);
        }
      }
    }
  }
  s.trim();
  Vec3<double> mean = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) mean += std::as_const(s).velocities()[i] / static_cast<double>(s.size());
  double twice_kinetic = 0;
  for (Index i = 0; i < s.size(); ++i) {
    s.velocities().add(i, -mean);
    twice_kinetic += norm2(std::as_const(s).velocities()[i]);
  }
  s.scale_velocities(std::sqrt(1.44 * 3 * static_cast<double>(s.size() - 1) / twice_kinetic));
  return s;
}

/// The potential as a user would write it.
struct TwelveSix {
  double scale() const { return 24; }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    const Real s2 = Real(1) / r2, s6 = s2 * s2 * s2;
    return {Real(4) * s6 * (s6 - Real(1)), Real(24) * s6 * (Real(2) * s6 - Real(1)) * s2};
  }
};

/// The same with charges of both signs, weak enough to leave the melt what it is.
ParticleSystem<double> charged_lattice(int cells) {
  ParticleSystem<double> s = lattice(cells);
  auto& charges = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) charges[i] = i % 2 == 0 ? 0.1 : -0.1;
  return s;
}

template <class F>
bench::Melt melt(std::string name, ParticleSystem<double> atoms, const F& force, const NeighborOptions& options) {
  KineticPotential<F> hamiltonian(force);
  hamiltonian.set_neighbor_options(options);
  return bench::melt(std::move(name), std::move(atoms), std::move(hamiltonian), schemes::verlet, 0.005);
}
template <class F> bench::Melt melt(std::string name, int cells, const F& force, const NeighborOptions& options) {
  return melt(std::move(name), lattice(cells), force, options);
}

/// Adds the drift of the energy, and its error.
void add_drift(const bench::Rows& rows, const std::string& name, const LennardJonesForce& force) {
  Simulation run(lattice(10), compose(KineticPotential(force), schemes::verlet), 0.002);
  static_cast<void>(run.run(2000));
  const Energy& energy = run.every(10, Energy{});
  static_cast<void>(run.run(50'000));
  const MonitorReport report = energy.report();
  const Index atoms = run.particles().size();
  const auto add = [&](const char* metric, double slope) {
    const double by_atom = slope * *report.scale / static_cast<double>(atoms);
    rows.add(name, metric, bench::Measured({by_atom}), "epsilon/tau/atom", atoms);
  };
  add("drift", report.slope.value_or(0));
  add("drift_error", report.slope_error.value_or(0));
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("lj_melt", count, arguments);
  const int threads = thread_count();
  const int cells = 20, steps = 100;
  std::vector<bench::Melt> cases;
  const LennardJonesForce argon{.cutoff = 2.5, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0};
  LennardJonesForce mixed = argon;
  mixed.precision = PairPrecision::mixed;
  cases.push_back(melt("fixed20", cells, argon, {.skin = 0.3, .renewal = 20}));
  cases.push_back(melt("safe", cells, argon, {}));
  cases.push_back(melt("mixed_fixed20", cells, mixed, {.skin = 0.3, .renewal = 20}));
  cases.push_back(melt("mixed", cells, mixed, {}));
  cases.push_back(melt("user", cells, PairForce<TwelveSix>{{}, 2.5, Cutoff::plain}, {}));
  const ReactionField field{2.5};
  const PairForce<Pair<TwelveSix, ReactionField>> fused{{TwelveSix{}, field}, 2.5, Cutoff::plain};
  cases.push_back(melt("charged_fused", charged_lattice(cells), fused, {}));
  cases.push_back(melt("charged_apart", charged_lattice(cells),
                       Sum(PairForce<TwelveSix>{{}, 2.5, Cutoff::plain}, ReactionFieldForce{field}), {}));
  for (const int by : threads > 1 ? std::vector<int>{1, threads} : std::vector<int>{1}) {
    set_thread_count(by);
    bench::take_turns(cases, steps);
    std::vector<std::optional<bench::Peer>> peers;
    if (by == 1) {
      peers = {bench::lammps("lammps_plain", "lj plain", 32'000), bench::lammps("lammps_opt", "lj opt", 32'000),
               bench::gromacs("gmx_d", 32'000), bench::gromacs("gmx", 32'000)};
      if (!peers[0]) fmt::print(stderr, "lj_melt: python3 has no lammps to compare with\n");
      if (!peers[2]) fmt::print(stderr, "lj_melt: there is no GROMACS in double (gmx_d) to compare with\n");
      std::erase(peers, std::nullopt);
    }
    if (peers.empty()) peers = {std::nullopt};
    for (bench::Melt& one : cases) {
      for (const auto& peer : peers) {
        rows.add(one.name, "atom_steps_per_s", bench::Measured(one.rates), "1/s", one.size, peer);
      }
      bench::add_search(rows, one);
    }
  }
  set_thread_count(1);
  const SimdLevel best = simd_level();
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2}) {
    if (level >= best) break;
    set_simd_level(level);
    bench::take_turns(cases, level == SimdLevel::base ? 20 : steps);
    for (const bench::Melt& one : cases) {
      rows.add(one.name, "atom_steps_per_s", bench::Measured(one.rates), "1/s", one.size);
    }
  }
  set_simd_level(best);
  cases.clear();
  for (const int size : {10, 20, 50, 100}) {
    const double before = bench::resident_bytes();
    bench::Melt one = melt("size", size, argon, {});
    one.run(size > 50 ? 20 : 100);
    for (int repeat = 0; repeat < 3; ++repeat) one.rates.push_back(one.rate(size > 50 ? 14 : 50));
    rows.add(one.name, "atom_steps_per_s", bench::Measured(one.rates), "1/s", one.size);
    if (size <= 20) continue;  // memory of the cases before is used again
    rows.add(one.name, "bytes_per_atom",
             bench::Measured({(bench::resident_bytes() - before) / static_cast<double>(one.size)}), "B", one.size);
  }
  LennardJonesForce switched = argon;
  switched.cutoff_style = Cutoff::switch_c4;
  add_drift(rows, "double", switched);
  switched.precision = PairPrecision::mixed;
  add_drift(rows, "mixed", switched);
}
