/// The Lennard-Jones melt of LAMMPS's bench/in.lj: density 0.8442, cutoff 2.5 (plain), step 0.005, from a face-centred
/// lattice at temperature 1.44. Parts, of which arguments may name some:
///
/// `steps`: whole steps with the search for neighbors. `safe` finds them when somebody has moved too far, as runs do;
/// `fixed20` every 20 steps with a skin of 0.3 as in.lj does, which misses pairs; `mixed` and `mixed_fixed20` have
/// forces of pairs in single precision. Beside them LAMMPS, plain and OPT, where python3 has it, and GROMACS in double
/// and mixed precision, on one thread. Then the lower levels of SIMD.
///
/// `pairs`: what a potential costs. All on the same molten atoms, with the same cutoff and list (skin 0.3), in steps so
/// short that nobody moves and no list is made; each beside the built-in `lennard_jones`. `c4` is that with a switch;
/// `user` is a struct of this file under PairForce, `user_c4` with that switch; `charged_fused` and `charged_apart`
/// have charges in a reaction field beside `user`, in one loop and as a second force.
///
/// Protocol of both: slices of 100 steps, at the base level of SIMD of 20, ours and others in turn; two to settle, then
/// the medians of 7; processor time of one thread, wall time of more.
///
/// `sizes`: what an atom costs among fewer and among more, beside LAMMPS OPT, and its memory. `drift`: what mixed
/// precision costs, the drift of the energy of 4000 atoms with a C4 switch over 50 000 steps of 0.002, from the slope
/// through block means, with its error, beside that of doubles.

#include "bench/melt.hpp"
#include "engine/charge.hpp"
#include "engine/simulation.hpp"
#include "forces/fused_pair.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_force.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "numbers/simd.hpp"

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

const LennardJonesForce argon{.cutoff = 2.5, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0};

LennardJonesForce mixed(LennardJonesForce force) {
  force.precision = PairPrecision::mixed;
  return force;
}
LennardJonesForce switched(LennardJonesForce force) {
  force.cutoff_style = Cutoff::switch_c4;
  return force;
}

template <class F>
bench::Melt melt(std::string name, ParticleSystem<double> atoms, const F& force, const NeighborOptions& options,
                 double step = 0.005) {
  KineticPotential<F> hamiltonian(force);
  hamiltonian.set_neighbor_options(options);
  return bench::melt(std::move(name), std::move(atoms), std::move(hamiltonian), schemes::verlet, step);
}

std::vector<bench::Melt> whole_steps(int cells) {
  const ParticleSystem<double> atoms = lattice(cells);
  const NeighborOptions safe, fixed20{.skin = 0.3, .renewal = 20};
  return {melt("fixed20", atoms, argon, fixed20), melt("safe", atoms, argon, safe),
          melt("mixed_fixed20", atoms, mixed(argon), fixed20), melt("mixed", atoms, mixed(argon), safe)};
}

/// What runs on one core beside `whole_steps(20)`.
std::vector<bench::Melt> other_programs() {
  std::vector<bench::Melt> peers;
  bench::add_peer(peers, "lammps_plain", "lammps_melt.py lj plain", 32'000);
  bench::add_peer(peers, "lammps_opt", "lammps_melt.py lj opt", 32'000);
  bench::add_peer(peers, "gmx_d", "gromacs_melt.py gmx_d", 32'000);
  bench::add_peer(peers, "gmx", "gromacs_melt.py gmx", 32'000);
  return peers;
}

/// Atoms after 300 steps, with charges of both signs, which most potentials leave alone.
ParticleSystem<double> molten(int cells) {
  Simulation run(lattice(cells), compose(KineticPotential(argon), schemes::verlet), 0.005);
  static_cast<void>(run.run(300));
  ParticleSystem<double> atoms = run.particles();
  atoms.phase() = Phase{};
  auto& charges = atoms.add_column<Charge>();
  for (Index i = 0; i < atoms.size(); ++i) charges[i] = i % 2 == 0 ? 0.1 : -0.1;
  return atoms;
}

/// The first is the yardstick. Wells are as deep and as wide as its own, or nearly so.
std::vector<bench::Melt> pair_loops(int cells) {
  constexpr double cutoff = 2.5;
  constexpr Cutoff plain = Cutoff::plain;
  const ParticleSystem<double> atoms = molten(cells);
  const auto row = [&](const char* name, const auto& force) { return melt(name, atoms, force, {.skin = 0.3}, 1e-9); };
  const PairForce<TwelveSix> user{{}, cutoff, plain};
  const ReactionField field{cutoff};
  return {row("lennard_jones", argon),
          row("c4", switched(argon)),
          row("user", user),
          row("user_c4", PairForce<TwelveSix>{{}, cutoff, Cutoff::switch_c4}),
          row("morse", MorseForce{{1, 5.35, 1.1225}, cutoff, plain}),
          row("buckingham", BuckinghamForce{{900'000, 0.08, 3.5}, cutoff, plain}),
          row("charged_fused", PairForce<Pair<TwelveSix, ReactionField>>{{TwelveSix{}, field}, cutoff, plain}),
          row("charged_apart", Sum(user, ReactionFieldForce{field}))};
}

/// Rows of pair loops beside the first of them.
void add_pair_loops(const bench::Rows& rows, std::vector<bench::Melt>& loops, int steps) {
  bench::take_turns(loops, steps);
  const bench::Peer yardstick{loops[0].name, loops[0].version, loops[0].time_by_atom().median};
  for (const bench::Melt& one : loops) {
    rows.add(one.name, "ns_per_atom_step", one.time_by_atom(), "ns", one.size, yardstick);
  }
}

/// Repeats something at the levels of SIMD below the one in use.
template <class Work> void at_lower_levels(const Work& work) {
  const SimdLevel best = simd_level();
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2}) {
    if (level >= best) break;
    set_simd_level(level);
    work(level == SimdLevel::base ? 20 : 100);
  }
  set_simd_level(best);
}

void measure_steps(const bench::Rows& rows, int threads) {
  std::vector<bench::Melt> ours = whole_steps(20);
  for (const int by : threads > 1 ? std::vector<int>{1, threads} : std::vector<int>{1}) {
    set_thread_count(by);
    std::vector<bench::Melt> peers;
    if (by == 1) peers = other_programs();
    bench::take_turns(ours, peers, 100);
    for (const bench::Melt& one : ours) {
      bench::add_rate(rows, one, peers);
      bench::add_search(rows, one);
    }
  }
  set_thread_count(1);
  at_lower_levels([&](int steps) {
    bench::take_turns(ours, steps);
    for (const bench::Melt& one : ours) bench::add_rate(rows, one);
  });
}

void measure_pairs(const bench::Rows& rows) {
  std::vector<bench::Melt> loops = pair_loops(20);
  add_pair_loops(rows, loops, 100);
  at_lower_levels([&](int steps) { add_pair_loops(rows, loops, steps); });
}

void measure_sizes(const bench::Rows& rows) {
  for (const int cells : {10, 20, 50, 100}) {
    const double before = bench::resident_bytes();
    bench::Melt one = melt("size", lattice(cells), argon, {});
    std::vector<bench::Melt> peers;
    bench::add_peer(peers, "lammps_opt", fmt::format("lammps_melt.py lj opt {}", cells), one.size);
    const int steps = cells > 50 ? 20 : 60;  // LAMMPS looks for neighbors every 20 steps
    const auto both = [&](const auto& body) {
      body(one);
      for (bench::Melt& peer : peers) body(peer);
    };
    both([&](bench::Melt& melt) { melt.seconds(steps); });
    for (int turn = 0; turn < 3; ++turn) {
      both([&](bench::Melt& melt) { melt.take_turn(steps); });
    }
    bench::add_rate(rows, one, peers);
    if (cells <= 20) continue;  // memory of the cases before is used again
    const double bytes = (bench::resident_bytes() - before) / static_cast<double>(one.size);
    rows.add(one.name, "bytes_per_atom", bench::Measured({bytes}), "B", one.size);
  }
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
  const bench::Rows rows("lj_melt", count, arguments, {"steps", "pairs", "sizes", "drift"});
  const int threads = thread_count();
  if (rows.wants("steps")) measure_steps(rows, threads);
  set_thread_count(1);
  if (rows.wants("pairs")) measure_pairs(rows);
  if (rows.wants("sizes")) measure_sizes(rows);
  if (rows.wants("drift")) {
    add_drift(rows, "double", switched(argon));
    add_drift(rows, "mixed", mixed(switched(argon)));
  }
}
