/// What constraints cost by each solver: nanoseconds a constraint and step, the violation that is left, iterations.
///
/// The position stage, free motion with it, and the velocity stage of molecules at 300 K without forces, 2 fs, one
/// thread: 512 rigid waters (SPC/E), 256 decanes with all bonds rigid (united atoms, 9 bonds, and all atoms, 31) and
/// with those of hydrogens alone (22), 16 peptides of 239 atoms with those of their hydrogens (`hydrogen_bonds`, from
/// `bench/structures/peptide.data`), 256 rings of six carbons with their hydrogens (18 bonds), 256 chains of 100
/// bonds, and chains of 10, 100 and 10 000 bonds, one of each. `water_as_started` are the waters with lengths of their
/// own, which differ in last digits, as where they are taken from positions.
///
/// Every solver but `settle`, which is for waters, takes the chain of 10 000 bonds. `m_shake` and `p_shake` leave it to
/// the sparse matrix of Newton's method, as every molecule that their kernels have no room for: the tolerance of
/// `p_shake` does not matter, and stands there once. The series of `lincs` is slow on triangles: see its violations.
///
/// Protocol: 20 slices, all cases in turn; medians of processor times. A slice is so many times ten steps from the
/// start, both stages (`ns_per_constraint_step`). `position_stage` and `velocity_stage` are its parts, by shares: in as
/// many rounds more a clock is read between stages, and the least time of each in any round counts. What a solver makes
/// of the gradients at a place counts to the velocity stage, which comes there first. `cost_scaling` is
/// the cost of a bond in the chain of 10 000 over that in the chain of 100, slice by slice. `iterations` are those of a
/// step, both stages: the most that a molecule needs, of a series its powers. `contraction` is what one of them leaves
/// of the violation, by those that rattle and p_shake need for 1e-4 and 1e-12.

#include "bench/support.hpp"

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/structure_constraints.hpp"
#include "io/structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace noether;

namespace {

constexpr double step = 0.002;  // [ps]
constexpr int steps_of_round = 10;
constexpr double lattice = 2.1;  ///< of molecules [nm]; no power of two, which would leave differences as they are

/// To read the time of a thread takes a microsecond, as long as a stage of ten bonds; rounds of so few constraints are
/// short enough for the clock, as hardly any is interrupted.
constexpr Index few_constraints = 5000;

/// Seconds of a round, stage by stage; of several rounds the least.
struct StageSeconds {
  double position = std::numeric_limits<double>::infinity();
  double velocity = std::numeric_limits<double>::infinity();

  void keep_less(const StageSeconds& other) {
    position = std::min(position, other.position);
    velocity = std::min(velocity, other.velocity);
  }
  double share_of_position() const { return position / (position + velocity); }
};

struct Case {
  std::string name;
  ParticleSystem<double> particles;
  ConstraintSolver<double> solver;
  std::int64_t rounds;  ///< of a slice
  std::vector<double> cost = {};
  StageSeconds stages = {};
  double violation = 0;
  double iterations = 0;  ///< of a step

  Index constraints() const { return solver.set().equations(); }
  /// Runs a slice: rounds of some steps, from the same start each time, since without forces angles become what no
  /// molecule has.
  /// @param by_clock  whether the clock tells, not the time of this thread
  /// @return ns for each constraint and step
  double slice(bool by_clock = false) {
    double seconds = 0;
    for (std::int64_t round = 0; round < rounds; ++round) {
      ParticleSystem<double> s = particles;
      ConstraintSolver<double> own = solver;
      const auto work = [&] {
        for (int k = 0; k < steps_of_round; ++k) {
          own.advance_positions(s, step);
          own.project_velocities(s, step);
        }
      };
      seconds += by_clock ? bench::seconds_of(work) : bench::processor_seconds_of(work);
      if (own.failure()) throw Error(name + ": the benchmark's run failed: " + own.failure()->message);
      violation = std::max(violation, own.set().worst(s).residual);
      iterations = static_cast<double>(own.iterations()) / steps_of_round;
    }
    cost.push_back(1e9 * seconds / static_cast<double>(rounds * steps_of_round * constraints()));
    return cost.back();
  }
  /// The same, with a clock read between stages.
  void watched_slice() {
    const bool by_clock = constraints() < few_constraints;
    const auto seconds_of = [by_clock](const auto& work) {
      return by_clock ? bench::seconds_of(work) : bench::processor_seconds_of(work);
    };
    for (std::int64_t round = 0; round < rounds; ++round) {
      ParticleSystem<double> s = particles;
      ConstraintSolver<double> own = solver;
      StageSeconds of_round{0, 0};
      for (int k = 0; k < steps_of_round; ++k) {
        of_round.position += seconds_of([&] { own.advance_positions(s, step); });
        of_round.velocity += seconds_of([&] { own.project_velocities(s, step); });
      }
      stages.keep_less(of_round);
    }
  }
  /// The cost of a stage: its share of each slice.
  bench::Measured cost_of(double share) const {
    std::vector<double> parts = cost;
    for (double& part : parts) part *= share;
    return bench::Measured(std::move(parts));
  }
};

/// A molecule: where its atoms are, and what is tied.
struct Molecule {
  std::vector<double> masses = {};
  std::vector<Vec3<double>> atoms = {};
  std::vector<std::pair<Index, Index>> bonds = {};

  Index add(double mass, const Vec3<double>& x) {
    masses.push_back(mass);
    atoms.push_back(x);
    return static_cast<Index>(atoms.size()) - 1;
  }
};

/// `count` copies on a lattice, at 300 K.
/// @param own_lengths  whether lengths are those between atoms where they stand, not those of the molecule
Case made(std::string name, const Molecule& molecule, Index count, const ConstraintOptions& options,
          bool own_lengths = false) {
  std::mt19937 random(1);
  ParticleSystem<double> s(unit_system("molecular"));
  ConstraintSet set(options);
  for (Index m = 0; m < count; ++m) {
    const Vec3<double> x(lattice * static_cast<double>(m % 8), lattice * static_cast<double>(m / 8 % 8),
                         lattice * static_cast<double>(m / 64));
    for (std::size_t a = 0; a < molecule.atoms.size(); ++a) {
      std::normal_distribution<double> normal(0, std::sqrt(units::molecular::k_B * 300 / molecule.masses[a]));
      const double u = normal(random), v = normal(random), w = normal(random);
      s.add("atom", molecule.masses[a], x + molecule.atoms[a], {u, v, w});
    }
  }
  const auto atoms = static_cast<Index>(molecule.atoms.size());
  for (Index m = 0; m < count; ++m) {
    for (const auto& [a, b] : molecule.bonds) {
      const double length =
          (molecule.atoms[static_cast<std::size_t>(a)] - molecule.atoms[static_cast<std::size_t>(b)]).norm();
      set.add(s, own_lengths ? Distance{} : Distance{.length = length}, {atoms * m + a, atoms * m + b});
    }
  }
  ConstraintSolver<double> solver(set);
  solver.bind(s);
  const std::int64_t rounds = std::max<std::int64_t>(1, 200'000 / (steps_of_round * set.equations()));
  return {std::move(name), std::move(s), std::move(solver), rounds};
}

Molecule water() {
  Molecule m;
  const double angle = 109.47 * M_PI / 180;
  m.add(15.9994, {0, 0, 0});
  m.add(1.008, {0.1, 0, 0});
  m.add(1.008, {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0});
  m.bonds = {{0, 1}, {0, 2}, {1, 2}};
  return m;
}

/// A zigzag of carbons as united atoms.
Molecule chain(Index bonds) {
  Molecule m;
  const double half = 112 * M_PI / 360, bond = 0.153;
  for (Index i = 0; i <= bonds; ++i) {
    const double along = static_cast<double>(i) * bond * std::sin(half);
    m.add(14.027, {along, static_cast<double>(i % 2) * bond * std::cos(half), 0});
    if (i > 0) m.bonds.emplace_back(i - 1, i);
  }
  return m;
}

/// Hydrogens of a carbon in a chain or a ring: two above and below the plane of its neighbors, `outward` of it.
void add_hydrogens(Molecule& m, Index carbon, const Vec3<double>& outward, const Vec3<double>& up) {
  for (const double side : {1.0, -1.0}) {
    const Vec3<double> x = m.atoms[static_cast<std::size_t>(carbon)] + 0.109 * (0.577 * outward + 0.816 * side * up);
    m.bonds.emplace_back(carbon, m.add(1.008, x));
  }
}

Molecule decane() {
  Molecule m = chain(9);
  std::fill(m.masses.begin(), m.masses.end(), 12.011);
  for (Index i = 0; i < 10; ++i) add_hydrogens(m, i, {0, i % 2 == 0 ? -1.0 : 1.0, 0}, {0, 0, 1});
  m.bonds.emplace_back(0, m.add(1.008, m.atoms[0] + Vec3<double>(-0.0904, 0.061, 0)));
  m.bonds.emplace_back(9, m.add(1.008, m.atoms[9] + Vec3<double>(0.0904, -0.061, 0)));
  return m;
}

/// Cyclohexane, as a flat ring: lengths are what matters here.
Molecule ring() {
  Molecule m;
  for (Index i = 0; i < 6; ++i) {
    const double angle = M_PI / 3 * static_cast<double>(i);
    m.add(12.011, {0.153 * std::cos(angle), 0.153 * std::sin(angle), i % 2 == 0 ? 0.025 : -0.025});
  }
  for (Index i = 0; i < 6; ++i) {
    m.bonds.emplace_back(i, (i + 1) % 6);
    const Vec3<double> outward = m.atoms[static_cast<std::size_t>(i)] / 0.155;
    add_hydrogens(m, i, outward, {0, 0, 1});
  }
  return m;
}

/// The same with hydrogens held alone: clusters of two and three bonds.
Molecule decane_hydrogens() {
  Molecule m = decane();
  std::erase_if(m.bonds, [&](const auto& bond) { return m.masses[static_cast<std::size_t>(bond.second)] > 2; });
  return m;
}

/// Bonds of hydrogens of a peptide, as long as they are in its file.
Molecule peptide_hydrogens() {
  const UnitSystem units = unit_system("molecular");
  const ParticleSystem<double> read =
      io::read_structure(NOETHER_SOURCE_DIR "/bench/structures/peptide.data", {.units = &units, .file_units = "real"});
  Molecule m;
  for (Index i = 0; i < read.size(); ++i) m.add(read.masses()[i], read.positions()[i]);
  for (const HeldDistance& held : held_distances(read, RigidTerms::hydrogen_bonds, HeldLengths::start))
    m.bonds.emplace_back(held.particles[0], held.particles[1]);
  return m;
}

/// A solver at its usual settings.
struct Solver {
  std::string name;
  ConstraintOptions options;
};
std::vector<Solver> all_solvers() {
  return {{"newton", {}},
          {"m_shake", {.solver = ConstraintMethod::m_shake}},
          {"rattle_4", {.solver = ConstraintMethod::rattle, .tolerance = 1e-4}},
          {"rattle_7", {.solver = ConstraintMethod::rattle, .tolerance = 1e-7}},
          {"rattle_8", {.solver = ConstraintMethod::rattle, .tolerance = 1e-8}},
          {"rattle_12", {.solver = ConstraintMethod::rattle, .tolerance = 1e-12}},
          {"p_shake_4", {.solver = ConstraintMethod::p_shake, .tolerance = 1e-4}},
          {"p_shake_7", {.solver = ConstraintMethod::p_shake, .tolerance = 1e-7}},
          {"p_shake_8", {.solver = ConstraintMethod::p_shake, .tolerance = 1e-8}},
          {"p_shake_12", {.solver = ConstraintMethod::p_shake, .tolerance = 1e-12}},
          {"lincs_4_1", {.solver = ConstraintMethod::lincs, .iterations = 1, .order = 4}},
          {"lincs_8_2", {.solver = ConstraintMethod::lincs, .iterations = 2, .order = 8}},
          {"p_lincs_4_1", {.solver = ConstraintMethod::p_lincs, .iterations = 1, .order = 4}}};
}

const Case& named(const std::vector<Case>& cases, const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(), [&](const Case& one) { return one.name == name; });
}

/// What one iteration leaves of the violation, by the cases of a molecule.
void add_contractions(const bench::Rows& rows, const std::string& molecule, const std::vector<Case>& cases) {
  const auto of = [&](const std::string& solver) -> const Case& { return named(cases, molecule + "/" + solver); };
  const Index n = of("newton").constraints();
  for (const std::string solver : {"rattle", "p_shake"}) {
    const double more = (of(solver + "_12").iterations - of(solver + "_4").iterations) / 2;
    rows.add(molecule + "/" + solver, "contraction", bench::Measured({std::pow(1e-8, 1 / more)}), "1", n);
  }
}

/// How many times as quick threads are as one, by the clock, by the number of molecules.
void add_threads(const bench::Rows& rows, int threads) {
  const std::vector<std::pair<std::string, Molecule>> molecules{
      {"water", water()}, {"decane_united", chain(9)}, {"decane", decane()}};
  for (const auto& [name, molecule] : molecules) {
    for (const Index copies : {512, 4096, 32'768}) {
      Case one = made(name + "/newton", molecule, copies, {});
      one.slice();
      rows.add(one.name, "times_as_quick", bench::times_as_quick(threads, [&] { return one.slice(true); }), "1",
               one.constraints());
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("constraints", count, arguments);
  const int threads = thread_count();
  set_thread_count(1);
  std::vector<Case> cases;
  for (const Index bonds : {100, 10'000, 10}) {
    const std::string name = "chain" + std::to_string(bonds);
    for (const Solver& solver : all_solvers()) {
      const bool some = solver.name == "newton" || solver.name == "rattle_7" || solver.name == "p_lincs_4_1";
      const bool again = solver.options.solver == ConstraintMethod::p_shake && solver.name != "p_shake_7";
      if (some || (bonds == 10'000 && !again))
        cases.push_back(made(name + "/" + solver.name, chain(bonds), 1, solver.options));
    }
  }
  const std::vector<std::pair<std::string, Molecule>> molecules{{"water", water()},
                                                                {"decane_united", chain(9)},
                                                                {"decane", decane()},
                                                                {"decane_hydrogens", decane_hydrogens()},
                                                                {"peptide_hydrogens", peptide_hydrogens()},
                                                                {"cyclohexane", ring()}};
  for (const auto& [name, molecule] : molecules) {
    for (const Solver& solver : all_solvers()) {
      const Index copies = name == "water" ? 512 : name == "peptide_hydrogens" ? 16 : 256;
      cases.push_back(made(name + "/" + solver.name, molecule, copies, solver.options));
    }
  }
  cases.push_back(made("water/settle", water(), 512, {.solver = ConstraintMethod::settle}));
  cases.push_back(made("water_as_started/newton", water(), 512, {}, true));
  cases.push_back(made("chains/newton", chain(100), 256, {}));
  for (Case& one : cases) {  // warm-up
    one.slice();
    one.cost.clear();
  }
  std::vector<double> scaling;
  for (int k = 0; k < 20; ++k) {
    for (Case& one : cases) {
      one.slice();
      one.watched_slice();
    }
    scaling.push_back(named(cases, "chain10000/newton").cost.back() / named(cases, "chain100/newton").cost.back());
  }
  for (const Case& one : cases) {
    rows.add(one.name, "ns_per_constraint_step", bench::Measured(one.cost), "ns", one.constraints());
    const double share = one.stages.share_of_position();
    rows.add(one.name, "position_stage", one.cost_of(share), "ns", one.constraints());
    rows.add(one.name, "velocity_stage", one.cost_of(1 - share), "ns", one.constraints());
    rows.add(one.name, "violation_max", bench::Measured({one.violation}), "1", one.constraints());
    rows.add(one.name, "iterations", bench::Measured({one.iterations}), "1", one.constraints());
  }
  for (const auto& [name, molecule] : molecules) add_contractions(rows, name, cases);
  rows.add("chain10000_over_100", "cost_scaling", bench::Measured(scaling), "1", 10'000);
  if (threads > 1) add_threads(rows, threads);
}
