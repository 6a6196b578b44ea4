#pragma once
/// What the fuzz targets do with an input: read it as a user's file would be read, and check what was read.
///
/// An input may be taken or refused by an exception below noether::Error; all else is a finding: a broken property, an
/// exception of another kind, a crash, a report of a sanitizer. A LogicError is one too: no file breaks a contract.

#include "engine/bodies.hpp"
#include "engine/saved_state.hpp"
#include "engine/snapshot.hpp"
#include "io/bodies.hpp"
#include "io/body_sites.hpp"
#include "io/checkpoint.hpp"
#include "io/digest.hpp"
#include "io/files.hpp"
#include "io/hdf5_walk.hpp"
#include "io/structure.hpp"
#include "numbers/quantity.hpp"
#include "scene/scene.hpp"
#include "tests/support/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace noether::test {

/// A property that does not hold; no noether::Error, so that nothing takes it for a refusal.
class Broken : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& what) {
  if (!holds) throw Broken(what);
}

/// Whether a call takes its input. Exceptions that are no refusal pass through, uncaught: a sanitizer shows their
/// stack.
template <class Call> bool accepted(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    require(dynamic_cast<const LogicError*>(&error) == nullptr, std::string("a contract is broken: ") + error.what());
    return false;
  }
  return true;
}

/// One folder for all inputs of a process.
inline const ScratchFolder& fuzz_folder() {
  static const ScratchFolder folder;
  return folder;
}

/// The input as a file, replaced by the next one.
inline std::filesystem::path as_file(const std::string& name, std::string_view bytes) {
  const std::filesystem::path file = fuzz_folder() / name;
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

// ---- quantities ----------------------------------------------------------------------------------------------------

/// A quantity that was read is finite, and what is printed of it reads back to the bit.
inline void take_quantity_as(std::string_view text, const Dimension& dimension, const UnitSystem& system) {
  double value = 0;
  if (!accepted([&] { value = parse_quantity(text, dimension, system); })) return;
  require(std::isfinite(value), "a quantity is not finite");
  const std::string shown = example_of(dimension, format_number(value), system);
  require(parse_quantity(shown, dimension, system) == value, "'" + shown + "' reads back as another number");
}

/// Text as a quantity, a unit, a dimension; kinds and unit systems that are read alike are left out, for speed.
inline void take_quantity(std::string_view text) {
  static constexpr std::array kinds = {dimensions::none, dimensions::time, dimensions::energy, dimensions::density};
  for (const char* name : {"solar", "reduced"}) {
    const UnitSystem& system = unit_system(name);
    for (const Dimension& kind : kinds) take_quantity_as(text, kind, system);
    double angle = 0;
    if (accepted([&] { angle = parse_angle(text, system); })) require(std::isfinite(angle), "an angle is not finite");
    accepted([&] { parse_unit(text, system); });
  }
  Dimension dimension;
  if (!accepted([&] { dimension = parse_dimension(text); })) return;
  const auto readable = [](int power) { return std::abs(power) <= 9; };
  if (!readable(dimension.length) || !readable(dimension.mass) || !readable(dimension.time) ||
      !readable(dimension.charge) || !readable(dimension.temperature)) {
    return;
  }
  require(parse_dimension(to_text(dimension)) == dimension, "a dimension reads back as another one");
}

// ---- tables of bodies ----------------------------------------------------------------------------------------------

/// Bodies are finite, have masses of at least 0, and names and ids of their own.
inline void check_bodies(const ParticleSystem<double>& bodies) {
  require(bodies.size() > 0, "a table without bodies was taken");
  for (Index i = 0; i < bodies.size(); ++i) {
    const Vec3<double> x = bodies.positions()[i], v = bodies.velocities()[i];
    for (const double number : {bodies.masses()[i], x[0], x[1], x[2], v[0], v[1], v[2]}) {
      require(std::isfinite(number), "a body is not finite");
    }
    require(bodies.masses()[i] >= 0, "a mass is negative");
  }
  const std::set<std::string> names(bodies.names().begin(), bodies.names().end());
  const std::set<std::int64_t> ids(bodies.ids().begin(), bodies.ids().end());
  require(names.size() == bodies.names().size() && names.count("") == 0, "names are empty or equal");
  require(ids.size() == bodies.ids().size() && *ids.begin() >= 0, "ids are negative or equal");
}

/// A table of bodies, CSV or of Horizons, in the unit systems that differ in how they read it.
inline void take_bodies(std::string_view table) {
  const std::filesystem::path file = as_file("bodies", table);
  for (const char* system : {"solar", "si", "reduced"}) {
    ParticleSystem<double> bodies;
    if (accepted([&] { bodies = io::read_bodies(file, {.units = &unit_system(system)}); })) check_bodies(bodies);
  }
}

// ---- sites of rigid bodies -----------------------------------------------------------------------------------------

/// Sites in a table, in unit systems with units and without, with types and without: what becomes a body of them has a
/// mass, moments and axes.
inline void take_body_sites(std::string_view table) {
  const std::filesystem::path file = as_file("sites.csv", table);
  for (const char* system : {"molecular", "reduced"}) {
    for (const io::SiteTypes& types : {io::SiteTypes{}, io::SiteTypes{{"O", "H"}, {-0.8, 0.4}}}) {
      std::vector<BodySite> sites;
      if (!accepted([&] { sites = io::read_body_sites(file, unit_system(system), types); })) continue;
      RigidBody body;
      if (!accepted([&] { body = body_of_sites("body", sites, std::nullopt); })) continue;
      require(body.mass > 0 && std::isfinite(body.mass), "a body has no mass");
      require(body.sites.size() == sites.size(), "a body has other sites");
      for (int k = 0; k < 3; ++k)
        require(body.inertia[k] >= 0 && std::isfinite(body.inertia[k]), "a moment of inertia is no number from 0 on");
      require(std::abs(norm_defect(body.axes)) < 1e-12, "the axes of a body are no rotation");
    }
  }
}

// ---- structures ----------------------------------------------------------------------------------------------------

/// Types and terms name what is there, and pairs are sorted.
inline void check_topology(const ParticleSystem<double>& s) {
  const Topology& topology = *s.topology();
  require(topology.types.size() == s.ids().size() || (topology.types.empty() && topology.type_names.empty()),
          "a particle has no type");
  for (const std::int64_t type : topology.types) {
    require(type >= 0 && type < static_cast<std::int64_t>(topology.type_names.size()), "a type has no name");
  }
  const auto inside = [&](const auto& terms, std::size_t kinds) {
    for (const auto& term : terms) {
      require(kinds == 0 || static_cast<std::size_t>(term.type) < kinds, "a term is of no kind");
      for (const Index i : term.particles) require(i >= 0 && i < s.size(), "a term joins what is not there");
    }
  };
  inside(topology.bonds, topology.bond_kinds.size());
  inside(topology.angles, topology.angle_kinds.size());
  inside(topology.dihedrals, topology.dihedral_kinds.size());
  inside(topology.impropers, topology.improper_kinds.size());
}

/// A chain of four atoms that leaves its coefficients to a script.
inline const std::filesystem::path& chain_without_coefficients() {
  static const std::filesystem::path file = as_file(
      "chain.data",
      "#\n4 atoms\n3 bonds\n1 angles\n1 dihedrals\n2 atom types\n1 bond types\n1 angle types\n1 dihedral types\n"
      "0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nAtom Type Labels\n\n1 C\n2 O\n\nMasses\n\nC 12\nO 16\n\n"
      "Atoms # full\n\n1 1 C 0 1 1 1\n2 1 C 0 2 1 1\n3 1 O 0 2 2 1\n4 1 O 0 2 2 2\n\n"
      "Bonds\n\n1 1 1 2\n2 1 2 3\n3 1 3 4\n\nAngles\n\n1 1 1 2 3\n\nDihedrals\n\n1 1 1 2 3 4\n");
  return file;
}

/// A structure in each format, in units that fit, and the coefficients of one.
inline void take_structure(std::string_view bytes) {
  const io::StructureOptions with_script = {.units = &unit_system("reduced"),
                                            .coefficients = {as_file("structure.in", bytes)}};
  accepted([&] { check_topology(io::read_structure(chain_without_coefficients(), with_script)); });
  const std::array<std::pair<const char*, io::StructureOptions>, 5> readings = {{
      {"structure.data", {.units = &unit_system("reduced")}},
      {"structure.lmp", {.file_units = "real", .box = Box::open()}},
      {"structure.xyz", {}},
      {"structure.msh", {.units = &unit_system("si"), .densities = {{"", 1000}}}},
      {"structure.gro",
       {.types = {{.type = "OW", .mass = 16}, {.type = "HW1", .mass = 1}, {.type = "HW2", .mass = 1}}}},
  }};
  for (const auto& reading : readings) {
    const std::filesystem::path file = as_file(reading.first, bytes);
    ParticleSystem<double> particles;
    if (!accepted([&] { particles = io::read_structure(file, reading.second); })) continue;
    check_bodies(particles);
    check_topology(particles);
  }
}

// ---- scenes --------------------------------------------------------------------------------------------------------

/// The changes of a scene's own comments, as in tests/scenes: `#!set key=value`.
inline std::vector<std::string> sets_in(std::string_view text) {
  static constexpr std::string_view mark = "#!set ";
  std::vector<std::string> sets;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (text.starts_with(mark)) sets.emplace_back(text.substr(mark.size(), end - mark.size()));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return sets;
}

/// A scene: its effective text is the same scene, and a small one can be assembled and make a step.
inline void take_scene(std::string_view text) {
  static const Parts parts = standard_parts();
  static const std::filesystem::path file = [] {
    std::filesystem::copy_file(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/scenes/good/bodies.csv",
                               fuzz_folder() / "bodies.csv");
    return fuzz_folder() / "scene.toml";
  }();
  // Builders fill memory as they are asked to.
  for (const char* builder : {"lattice", "liquid", "polymer_chains"}) {
    if (text.find(builder) != std::string_view::npos) return;
  }
  Scene scene;
  if (!accepted([&] { scene = read_scene(text, file, parts, sets_in(text)); })) return;
  const Scene again = read_scene(scene.effective_toml, file, parts);
  require(again.effective_toml == scene.effective_toml, "the effective scene has another effective scene");
  require(io::digest(again.particles) == io::digest(scene.particles), "the effective scene has other particles");
  if (scene.particles.size() > 64) return;
  Simulation<double> simulation = assemble(scene);
  accepted([&] { static_cast<void>(simulation.run(1)); });  // however it ends
}

// ---- the structure of HDF5 files -----------------------------------------------------------------------------------

/// Any bytes: the walk ends, and what it tells lies within the file.
inline void take_hdf5(std::string_view bytes) {
  std::istringstream file{std::string(bytes)};
  const io::Hdf5Walk walked = io::walk_hdf5(file, bytes.size());
  if (walked.fault) require(!walked.fault->what.empty(), "a fault is not told");
  std::uint64_t last = 0;
  for (const io::ByteRange& range : walked.unused) {
    require(range.begin >= last && range.begin < range.end && range.end <= bytes.size(), "a range is outside the file");
    last = range.begin;
  }
}

// ---- checkpoints ---------------------------------------------------------------------------------------------------

/// The small run whose checkpoints the targets damage.
inline Simulation<double> checkpointed_run() {
  static const Scene scene = read_scene(
      "units = 'reduced'\n"
      "particles.body = [{name = 'a', mass = 1, x = [0, 0, 0], v = [0, 0, 0]},"
      " {name = 'b', mass = 0.1, x = [1, 0, 0], v = [0, 1, 0]}]\n"
      "hamiltonian = {type = 'wisdom_holman'}\n"
      "integrator = {method = 'aba1064', step = 0.01, steps = 10, compensated = true}\n"
      "every = [{type = 'energy', steps = 1}, {type = 'elements', steps = 2}]\n"
      "stop = [{type = 'escape', distance = 9}]\n",
      "scene.toml");
  return assemble(scene);
}

/// Looks at a run once and keeps what a checkpoint would.
struct KeepsRun {
  SavedRun* kept;
  static constexpr auto describe() { return part<KeepsRun>("keeps_run", "the run as a checkpoint keeps it"); }
  void observe(const Snapshot<double>& now) { *kept = now.saved_run(); }
};

/// The state of that run after two steps.
inline const SavedRun& saved_run() {
  static const SavedRun run = [] {
    SavedRun kept;
    Simulation<double> simulation = checkpointed_run();
    simulation.every(2, KeepsRun{&kept});
    require(simulation.run(2).ok(), "the run of the sample failed");
    return kept;
  }();
  return run;
}

/// A checkpoint whose run cannot be told from the one that made it is restored; any other may be refused.
inline void restore(const SavedRun& run) {
  accepted([&] { load_particles<double>(run.particles); });
  Simulation<double> simulation = checkpointed_run();
  if (accepted([&] { simulation.restore(run); })) {
    accepted([&] { static_cast<void>(simulation.run(2)); });  // however it ends
  }
}

/// The bytes of a file as they stand.
inline void take_checkpoint(std::string_view bytes) {
  const std::filesystem::path file = as_file("checkpoint.h5", bytes);
  io::Checkpoint checkpoint;
  if (accepted([&] { checkpoint = io::read_checkpoint(file); })) restore(checkpoint.run);
}

/// A content with the hash that fits it.
inline std::string with_hash(std::string_view content) {
  return fmt::format("{}sha256:{}\n", content, io::sha256(content));
}

/// The bytes before the hash: it is made to fit, so that HDF5 and what reads its content see them.
inline void take_checkpoint_content(std::string_view bytes) { take_checkpoint(with_hash(bytes)); }

/// An input as instructions; what lies behind its end is 0.
class Instructions {
 public:
  explicit Instructions(std::string_view bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const auto first = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return first;
  }
  std::size_t below(std::size_t count) { return byte() % count; }
  std::int64_t integer() {
    // Most faults need a number near 0, the others any.
    if (const std::uint8_t small = byte(); small < 0xff) return static_cast<std::int64_t>(small) - 4;
    std::uint64_t all = 0;
    for (int k = 0; k < 8; ++k) all = all << 8U | byte();
    return static_cast<std::int64_t>(all);
  }
  double real() {
    const std::int64_t whole = integer();
    return std::abs(static_cast<double>(whole)) < 1000 ? static_cast<double>(whole) : std::bit_cast<double>(whole);
  }
  std::string text() {
    const std::size_t size = std::min<std::size_t>(byte(), bytes_.size());
    const std::string out(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return out;
  }

 private:
  std::string_view bytes_;
};

/// Makes an array of a type and size as told.
inline SavedArray array_from(Instructions& in) {
  const std::size_t type = in.below(3), size = in.below(16);
  SavedArray array;
  if (type == 0) array = std::vector<double>(size);
  if (type == 1) array = std::vector<std::int64_t>(size);
  if (type == 2) array = std::vector<std::string>(size);
  for (std::size_t k = 0; k < size; ++k) {
    if (type == 0) std::get<0>(array)[k] = in.real();
    if (type == 1) std::get<1>(array)[k] = in.integer();
    if (type == 2) std::get<2>(array)[k] = in.text();
  }
  return array;
}

/// Changes one array: takes it out, replaces it, cuts or lengthens it, sets an element.
inline void damage(SavedState& state, Instructions& in) {
  if (state.empty()) return;
  const auto chosen = std::next(state.begin(), static_cast<std::ptrdiff_t>(in.below(state.size())));
  const std::size_t how = in.below(5);
  if (how == 0) state.erase(chosen);
  if (how == 1) chosen->second = array_from(in);
  if (how == 2) std::visit([&](auto& values) { values.resize(in.below(16)); }, chosen->second);
  if (how == 3) state[in.text()] = array_from(in);
  if (how != 4) return;
  std::visit(
      [&](auto& values) {
        if (values.empty()) return;
        auto& element = values[in.below(values.size())];
        if constexpr (std::is_same_v<std::decay_t<decltype(element)>, double>) element = in.real();
        if constexpr (std::is_same_v<std::decay_t<decltype(element)>, std::int64_t>) element = in.integer();
        if constexpr (std::is_same_v<std::decay_t<decltype(element)>, std::string>) element = in.text();
      },
      chosen->second);
}

/// A checkpoint of which arrays were changed: written and read it is the same, and it is restored or refused.
inline void take_checkpoint_state(std::string_view bytes) {
  io::Checkpoint checkpoint;
  checkpoint.run = saved_run();
  Instructions in(bytes);
  while (!in.at_end()) {
    const std::size_t part = in.below(checkpoint.run.parts.size() + 1);
    const auto at = std::next(checkpoint.run.parts.begin(), static_cast<std::ptrdiff_t>(part) - (part > 0 ? 1 : 0));
    damage(part == 0 ? checkpoint.run.particles : at->second, in);
  }
  restore(checkpoint.run);
}

/// A checkpoint of two bodies as a file has it, without its hash: where the targets for bytes begin.
inline std::string sample_checkpoint_content() {
  const std::filesystem::path file = fuzz_folder() / "sample.h5";
  io::Checkpoint checkpoint;
  checkpoint.run = saved_run();
  io::write_checkpoint(file, checkpoint);
  const std::string bytes = io::read_bytes(file);
  return bytes.substr(0, bytes.rfind("sha256:"));
}

/// Puts an input that no file of seeds holds, because it follows the code, into the first folder of the command line:
/// the one where libFuzzer keeps what it finds.
inline void add_seed(int argc, char** argv, const std::string& bytes) {
  for (int k = 1; k < argc; ++k) {
    if (!std::filesystem::is_directory(argv[k])) continue;
    write_text(std::filesystem::path(argv[k]) / "sample", bytes);
    return;
  }
}

}  // namespace noether::test
