/// Rigid SPC/E water, 7754 molecules (23 262 atoms) at 0.997 g/cm^3 and 300 K: whole steps of 2 fs, cutoff 0.9 nm, with
/// a list that is made anew when somebody has moved too far. Charges in a reaction field, or by particle mesh Ewald, in
/// double and mixed precision. Beside them, from the same start, GROMACS in double and mixed precision, the CPU
/// platform of OpenMM, and for Ewald's sum LAMMPS OPT, where these are installed; a row of `force_error` has that of
/// the start, against Ewald's sum in 113 bits, root mean square of 64 atoms, in units of C <q^2> (n/V)^(2/3).
///
/// GROMACS has its defaults, a mesh of 0.12 nm and splines of order 4; ours is asked for 2e-3, of which
/// water reaches half, beside 1.1e-3 that these reach on 216 molecules (LAMMPS's accuracy and OpenMM's tolerance are
/// likewise the widest of round numbers). Packages of GROMACS choose instructions with care for old processors: its
/// version names them.
///
/// `steps`: on one thread, in processor time; `threads`: on all, by the clock, ours and GROMACS. Both in slices of 50
/// steps, all in turn; two to settle, then the medians of 7.

#include "bench/melt.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/charge.hpp"
#include "engine/simulation.hpp"
#include "forces/ewald_split.hpp"
#include "forces/lattice_accuracy.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/langevin.hpp"
#include "scene/constrained.hpp"
#include "scene/json.hpp"
#include "scene/water_box.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <utility>

#include <unistd.h>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

namespace {

constexpr double cutoff = 0.9 * nm, step = 2 * fs;

const LennardJonesForce oxygens{.cutoff = cutoff, .cutoff_style = Cutoff::shifted};

/// What acts beside constraints.
struct Charges {
  std::string name, of_peers;  ///< ours, and what scripts of bench/peers call the kind
  ForceField<double> forces, mixed;
};

/// A force between oxygens and one between charges, in one precision.
template <class F> ForceField<double> in_precision(PairPrecision precision, F charges) {
  LennardJonesForce pairs = oxygens;
  pairs.precision = charges.precision = precision;
  ForceField<double> forces;
  forces.add(pairs);
  forces.add(charges);
  return forces;
}

template <class F> Charges charges(std::string name, std::string of_peers, const F& force) {
  return {std::move(name), std::move(of_peers), in_precision(PairPrecision::full, force),
          in_precision(PairPrecision::mixed, force)};
}

const ParticleMeshEwald mesh{.cutoff = cutoff, .relative_error = 2e-3};

std::vector<Charges> all_charges() {
  return {charges("reaction_field", "reaction_field", ReactionFieldForce{{.radius = cutoff}}),
          charges("particle_mesh_ewald", "pme", mesh)};
}

/// Downhill, then warmed by a bath for a picosecond, at rest as a whole.
ParticleSystem<double> warm_water() {
  ParticleSystem<double> water =
      WaterBox{
          .model = WaterModel::spce, .molecules = 7754, .density = 0.997 * g_per_cm3, .temperature = 300 * K, .seed = 7}
          .build();
  const ConstraintSet rigid = rigid_molecules(water);
  const ForceField<double> forces = all_charges()[0].forces;
  static_cast<void>(minimize(water, AnyForce<double>(forces), rigid, {.max_force = 400 * kJ_per_mol / nm}));
  const Langevin bath(KineticPotential(forces, rigid), {.temperature = 300 * K, .friction = 10 / ps, .seed = 3});
  Simulation<double> warming(std::move(water), compose(bath, word("BAOAB")), step);
  static_cast<void>(warming.run(500));
  ParticleSystem<double> warm = warming.particles();
  Vec3<double> momentum = Vec3<double>::Zero();
  for (Index i = 0; i < warm.size(); ++i) momentum += warm.masses()[i] * std::as_const(warm).velocities()[i];
  const double mass = warm.masses().all().sum();
  for (Index i = 0; i < warm.size(); ++i) warm.velocities().add(i, -momentum / mass);
  warm.phase() = {};
  return warm;
}

Json list_of(const Vec3<double>& x) { return Json::list({x[0], x[1], x[2]}); }

/// A folder with what other programs are told, as long as it lives.
class Told {
 public:
  explicit Told(const ParticleSystem<double>& water) {
    std::filesystem::create_directory(folder_);
    std::vector<Json> x, v;
    for (Index i = 0; i < water.size(); ++i) {
      const Vec3<double> oxygen = water.positions()[i / 3 * 3];
      const Vec3<double> from = water.box().minimum_image(Vec3<double>(water.positions()[i] - oxygen));
      x.push_back(list_of(oxygen + from));  // molecules are whole
      v.push_back(list_of(water.velocities()[i]));
    }
    const PairKind kind = water.topology()->pair_kind(0, 0);
    write(start(), Json::object({{"edge", water.box().edges()[0]},
                                 {"cutoff", cutoff},
                                 {"sigma", kind.sigma},
                                 {"epsilon", kind.epsilon},
                                 {"charge", water.column<Charge>()[1]},
                                 {"x", Json::list(x)},
                                 {"v", Json::list(v)}}));
    write_exact(water);
  }
  Told(const Told&) = delete;
  Told& operator=(const Told&) = delete;
  ~Told() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::string start() const { return (folder_ / "start.json").string(); }
  std::string exact() const { return (folder_ / "exact.json").string(); }

 private:
  static void write(const std::string& file, const Json& what) { std::ofstream(file) << what.text() << "\n"; }

  void write_exact(const ParticleSystem<double>& water) const {
    VectorColumn<double> a(water.size());
    ForceSink<double> sink(a, water, {});
    oxygens.add_to(sink, water);
    std::vector<Index> asked;
    for (int k = 1; k <= 64; ++k) {
      const double place = 0.6180339887498949 * k;
      asked.push_back(static_cast<Index>((place - std::floor(place)) * static_cast<double>(water.size())));
    }
    const std::vector<Vec3<double>> known = detail::exact_lattice_forces(water, asked, 1e-13);
    std::vector<Json> rows;
    for (std::size_t p = 0; p < asked.size(); ++p) {
      const Index i = asked[p];
      const Vec3<double> f = known[p] + water.masses()[i] * std::as_const(a)[i];
      rows.push_back(Json::list({std::int64_t{i}, f[0], f[1], f[2]}));
    }
    const auto n = static_cast<double>(water.size());
    const double squares = detail::charge_sums(water).squares / n;
    write(exact(), Json::object({{"unit", coulomb_constant * squares * std::pow(n / water.box().volume(), 2.0 / 3)},
                                 {"forces", Json::list(rows)}}));
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("noether_bench_water_{}", getpid());
};

void add_error(const bench::Rows& rows, const std::string& name, double error, Index n) {
  rows.add(name, "force_error", bench::Measured({error}), "C<q^2>(n/V)^(2/3)", n);
}

/// Another program, and a row of its error where it sums all images.
void add_peer(const bench::Rows& rows, std::vector<bench::Melt>& peers, const std::string& name,
              const std::string& script, const Told& told, Index n) {
  const bool all_images = script.find("pme") != std::string::npos || script.find("pppm") != std::string::npos;
  if (all_images) {
    bench::PeerProgram program(script);
    if (const auto answer = program.version() ? program.ask(told.exact()) : std::nullopt)
      add_error(rows, name + "_" + *program.version(), std::stod(*answer), n);
  }
  bench::add_peer(peers, name, script, n);
}

/// @param threads  of ours and of GROMACS; the others run on one
void measure(const bench::Rows& rows, const ParticleSystem<double>& water, const Told& told, int threads) {
  for (const Charges& kind : all_charges()) {
    std::vector<bench::Melt> ours, peers;
    const auto add_ours = [&](const std::string& name, const ForceField<double>& forces) {
      ours.push_back(bench::melt(name, water, KineticPotential(forces, rigid_molecules(water)), schemes::verlet, step));
    };
    add_ours(kind.name, kind.forces);
    add_ours(kind.name + "_mixed", kind.mixed);
    const auto add = [&](const std::string& name, const std::string& script) {
      add_peer(rows, peers, name, script, told, water.size());
    };
    const std::string how = fmt::format(" {} '{}'", kind.of_peers, told.start());
    for (const char* gromacs : {"gmx_d", "gmx"})
      add(gromacs, fmt::format("gromacs_water.py {}{} {}", gromacs, how, threads));
    if (threads == 1) {
      add("openmm_cpu", "openmm_water.py CPU" + how);
      if (kind.of_peers == "pme") add("lammps_opt", fmt::format("lammps_water.py pppm '{}'", told.start()));
    }
    bench::take_turns(ours, peers, 50);
    for (const bench::Melt& one : ours) bench::add_rate(rows, one, peers);
    if (threads == 1) continue;
    rows.add(kind.name, "times_as_quick", bench::times_as_quick(threads, [&] { return ours[0].seconds(50); }), "1",
             water.size());
    set_thread_count(threads);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("water", count, arguments, {"steps", "threads"});
  const int threads = thread_count();
  const ParticleSystem<double> water = warm_water();
  const Told told(water);
  ParticleMeshEwald mixed = mesh;
  mixed.precision = PairPrecision::mixed;
  for (const auto& [name, charges] : {std::pair("particle_mesh_ewald", mesh), {"particle_mesh_ewald_mixed", mixed}}) {
    if (const auto accuracy = lattice_accuracy(charges, water)) add_error(rows, name, accuracy->reached, water.size());
  }
  if (rows.wants("steps")) {
    set_thread_count(1);
    measure(rows, water, told, 1);
  }
  if (rows.wants("threads") && threads > 1) {
    set_thread_count(threads);
    measure(rows, water, told, threads);
  }
}
