// Types, charges and bonds in run.h5: as others read them, and back to the bit.

#include "engine/charge.hpp"
#include "io/bodies.hpp"
#include "io/compare_runs.hpp"
#include "io/digest.hpp"
#include "io/frame_particles.hpp"
#include "io/hdf5_file.hpp"
#include "io/inspect.hpp"
#include "io/repair.hpp"
#include "io/structure.hpp"
#include "io/trajectory_constants.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_layout.hpp"
#include "tests/io/support.hpp"

#include <cmath>
#include <memory>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// Every member of a topology is one that another has.
void check_same_topology(const Topology& one, const Topology& other) {
  CHECK(one.type_names == other.type_names);
  CHECK(one.types == other.types);
  CHECK(one.molecules == other.molecules);
  CHECK(one.bonds == other.bonds);
  CHECK(one.angles == other.angles);
  CHECK(one.dihedrals == other.dihedrals);
  CHECK(one.impropers == other.impropers);
  CHECK(one.bond_kinds == other.bond_kinds);
  CHECK(one.angle_kinds == other.angle_kinds);
  CHECK(one.dihedral_kinds == other.dihedral_kinds);
  CHECK(one.improper_kinds == other.improper_kinds);
  CHECK(one.pair_kinds == other.pair_kinds);
  CHECK(one.mixing == other.mixing);
  CHECK(one.explicit_pairs == other.explicit_pairs);
  CHECK(one.stated_cutoff == other.stated_cutoff);
  CHECK(one.exclusions == other.exclusions);
  CHECK(one.scaled_pairs == other.scaled_pairs);
}

/// Five atoms in a box, their ids in no order, with everything that a topology can have.
ParticleSystem<double> molecule() {
  ParticleSystem<double> s(unit_system("molecular"));
  s.set_box(Box::periodic({1.5, 2, 2.5}));
  s.add("O", 15.9994, {0.1, 1.9, -0.3}, {0.5, -0.25, 1.0 / 3});
  s.add("H_a", 1.008, {0.17, 1.85, 2.6}, {-2, 1, 0.125});
  s.add("H_b", 1.008, {0.1 / 3, 1.99, 0.01}, {0.1, 0.2, 0.3});
  s.add("M", 0.5, {0.11, 1.8, 0.2}, {0, 0, 0});
  s.add("ion", 22.99, {0.7, 0.6, 0.5}, {0, 0, -1});
  s.restore_ids({40, 7, 12, 987654321, 3});
  auto& charges = s.add_column<Charge>();
  for (const auto& [i, q] : {std::pair(0, -0.8476), std::pair(1, 0.4238), std::pair(2, 0.4238), std::pair(4, 1.0)})
    charges[i] = q;
  Topology topology;
  topology.type_names = {"OW", "HW", "Na+"};
  topology.types = {0, 1, 1, 0, 2};
  topology.molecules = {5, 5, 5, 5, 9};
  topology.bonds = {{{0, 2}, 1}, {{1, 0}, 0}};
  topology.angles = {{{2, 0, 1}, 0}};
  topology.dihedrals = {{{3, 2, 0, 1}, 0}};
  topology.impropers = {{{0, 1, 2, 3}, 0}};
  topology.bond_kinds = {{"harmonic", {1000.0 / 3, 0.1}}, {"morse", {400, 20, 0.1 / 7}}};
  topology.angle_kinds = {{"harmonic", {383, 1.9106332362490186}}};
  topology.dihedral_kinds = {{"ryckaert_bellemans", {1, 2, 3, 4, 5, 6}}};
  topology.improper_kinds = {{"harmonic", {0.7, 0.1}}};
  topology.pair_kinds = {{0.65, 0.3166}, {0, 0}, {0.1, 0.25}};
  topology.mixing = Mixing::geometric;
  topology.explicit_pairs[{0, 2}] = {0.2, 0.29};
  topology.stated_cutoff = 0.9;
  topology.scale_by_bonds(5, {0, 0, 0.5});
  topology.exclude({{3, 4}});
  topology.scaled_pairs.push_back({{2, 4}, 0.25});
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
  return s;
}

std::vector<std::string> xyz_lines(const std::filesystem::path& file) { return lines_of(read_text(file)); }

/// A run of free motion that writes each step.
struct FreeRun {
  explicit FreeRun(const std::filesystem::path& file, const ParticleSystem<double>& particles)
      : simulation(particles, compose(kinetic_potential(), schemes::verlet), 0.125),
        writer(&simulation.every(1, io::TrajectoryWriter(file))) {}

  Simulation<double> simulation;
  io::TrajectoryWriter* writer;
};

std::filesystem::path written_run(const ScratchFolder& folder, const ParticleSystem<double>& particles) {
  FreeRun run(folder / "run.h5", particles);
  REQUIRE(run.simulation.run(4).ok());
  run.writer->finish(Outcome{});
  return folder / "run.h5";
}

/// Puts other bytes of the same number in the place of some that stand in a file.
void change_bytes(const std::filesystem::path& file, std::int64_t from, std::int64_t to) {
  std::string bytes = read_text(file);
  const std::string old(reinterpret_cast<const char*>(&from), sizeof from);
  for (auto at = bytes.find(old); at != std::string::npos; at = bytes.find(old, at + 1))
    bytes.replace(at, sizeof to, reinterpret_cast<const char*>(&to), sizeof to);
  write_text(file, bytes);
}

}  // namespace

TEST_CASE("h5py finds types, charges, bonds and their units where H5MD has them", "[trajectory][topology]") {
  const ScratchFolder folder;
  const auto found = python_output("read_topology.py", {written_run(folder, molecule()).string()});
  if (!found) return;
  // In the order of ids: ion, H_a, H_b, O, M. The unit strings are those of h5md/modules/units.
  CHECK(*found ==
        "id 3 7 12 40 987654321\n"
        "species 3 2 2 1 1\n"
        "charge 1.0 0.4238 0.4238 -0.8476 0.0 effective e\n"
        "angles (12, 40, 7)\n"
        "bonds (40, 12) (7, 40)\n"
        "dihedrals (987654321, 12, 40, 7)\n"
        "impropers (40, 7, 12, 987654321)\n"
        "mass u\n"
        "position/value nm\n"
        "position/time ps\n"
        "velocity/value nm ps-1\n"
        "box/edges/value nm\n"
        "units 1 0 SI\n");
}

TEST_CASE("of a run in SI H5MD knows every unit, and MDAnalysis no metre", "[trajectory][topology]") {
  const ScratchFolder folder;
  ParticleSystem<double> s(unit_system("si"));
  s.set_box(Box::periodic({1, 1, 1}));
  s.add("a", 1, {0.5, 0.5, 0.5}, {0, 0, 0});
  s.add_column<Charge>()[0] = 2;
  const auto found = python_output("read_topology.py", {written_run(folder, s).string()});
  if (!found) return;
  CHECK(*found ==
        "id 0\nspecies none\ncharge 2.0 effective C\nmass kg\nposition/value none\nposition/time s\n"
        "velocity/value m s-1\nbox/edges/value m\nunits 1 0 SI\n");
  CHECK(io::read_frames(folder / "run.h5").length_unit == "m");
  CHECK(io::read_frames(folder / "run.h5").velocity_unit == "m/s");
  CHECK(io::read_frames(folder / "run.h5").time_unit == "s");
}

TEST_CASE("units in H5MD's words", "[trajectory][topology]") {
  const UnitSystem &si = unit_system("si"), &molecular = unit_system("molecular");
  CHECK(io::h5md_unit("mass length^2/time", si) == "kg m+2 s-1");
  CHECK(io::h5md_unit("charge length", molecular) == "e nm");
  CHECK(io::h5md_unit("angle", si) == "rad");
  CHECK(io::h5md_unit("1/time", si) == "s-1");
  CHECK(io::h5md_unit("1", si).empty());
  CHECK(io::h5md_unit("length, angle", si).empty());
  CHECK(io::h5md_unit("length", unit_system("solar")).empty());
  CHECK(io::h5md_unit("length", unit_system("reduced")).empty());
}

TEST_CASE("what particles do not have takes no room in the file", "[trajectory][topology]") {
  const ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(5).ok());
  run.writer->finish(Outcome{});
  {
    const io::Hdf5File file = io::Hdf5File::open_to_read(folder / "run.h5");
    CHECK(file.children(io::particles_path) ==
          std::vector<std::string>{"box", "id", "mass", "name", "position", "velocity"});
    CHECK_FALSE(file.has("/connectivity"));
    CHECK_FALSE(file.has("/noether/topology"));
    CHECK_FALSE(file.has("/h5md/modules"));  // of solar units H5MD knows none
  }
  CHECK(io::read_frames(folder / "run.h5").types.empty());
}

TEST_CASE("any frame is read back as particles, to the bit", "[trajectory][topology][bodies]") {
  const ScratchFolder folder;
  const ParticleSystem<double> sent = molecule();
  const auto file = written_run(folder, sent);
  const io::Frames frames = io::read_frames(file);
  REQUIRE(frames.frames.size() == 5);
  CHECK(frames.types == std::vector<std::string>{"Na+", "HW", "HW", "OW", "OW"});
  for (std::int64_t k = 0; k < 5; ++k) {
    CAPTURE(k);
    const io::FrameParticles found = io::read_frame_particles(file, {.frame = k});
    const ParticleSystem<double>& s = found.particles;
    CHECK(found.step == k);
    CHECK(found.time == 0.125 * static_cast<double>(k));
    CHECK(s.ids() == sent.ids());
    CHECK(s.names() == sent.names());
    CHECK(s.box() == sent.box());
    check_same_topology(*s.topology(), *sent.topology());
    // The same run, made as far as that frame, is the truth.
    Simulation<double> run(sent, compose(kinetic_potential(), schemes::verlet), 0.125);
    REQUIRE(run.run(k).ok());
    const ParticleSystem<double>& at = run.particles();
    for (Index i = 0; i < 5; ++i) {
      CHECK(s.masses()[i] == at.masses()[i]);
      CHECK(s.column<Charge>()[i] == at.column<Charge>()[i]);
      CHECK(Vec3<double>(s.positions()[i]) == Vec3<double>(at.positions()[i]));
      CHECK(Vec3<double>(s.velocities()[i]) == Vec3<double>(at.velocities()[i]));
      CHECK(Vec3<std::int32_t>(s.images()[i]) == Vec3<std::int32_t>(at.images()[i]));
    }
  }
  const io::FrameParticles last = io::read_frame_particles(file);
  CHECK(last.frame == 4);
  CHECK(io::read_frame_particles(file, {.frame = -1}).sha256 == last.sha256);
  CHECK(io::read_frame_particles(file, {.frame = 0}).sha256 != last.sha256);
}

TEST_CASE("a frame becomes a file of its own with all that its particles have", "[topology][bodies][inspect]") {
  const ScratchFolder folder;
  const auto file = written_run(folder, molecule());
  CHECK(io::convert(file, folder / "start.h5", {.bodies = true, .frame = 2}) == 1);
  const io::FileInfo checked = io::verify(folder / "start.h5");
  CHECK(checked.damaged.empty());
  CHECK(checked.complete);
  CHECK(checked.frames == 1);
  CHECK(checked.last_step == 2);
  const io::FrameParticles one = io::read_frame_particles(folder / "start.h5"),
                           of_run = io::read_frame_particles(file, {.frame = 2});
  CHECK(one.sha256 == of_run.sha256);  // of the frame, and of all that particles have once
  check_same_topology(*one.particles.topology(), *of_run.particles.topology());
  CHECK(one.particles.ids() == of_run.particles.ids());
}

TEST_CASE("planets become a table, and come back to the bit and in their order", "[bodies][inspect]") {
  const ScratchFolder folder;
  ParticleSystem<double> planets = outer_planets();
  planets.restore_ids({10, 5, 6, 7, 8, 9});  // the Sun has the largest
  WritingRun run(folder / "run.h5", planets);
  REQUIRE(run.simulation.run(33).ok());
  run.writer->finish(Outcome{});
  io::convert(folder / "run.h5", folder / "start.csv", {.bodies = true, .frame = 3});
  const ParticleSystem<double> table = io::read_bodies(folder / "start.csv"),
                               frame = io::read_frame_particles(folder / "run.h5", {.frame = 3}).particles;
  CHECK(table.names() == planets.names());
  CHECK(frame.names() == planets.names());
  CHECK(table.ids() == planets.ids());
  CHECK(frame.ids() == planets.ids());
  const io::Frame stored = io::read_frames(folder / "run.h5").frames.at(3);
  for (Index i = 0; i < 6; ++i) {
    const std::size_t row = i == 0 ? 5 : static_cast<std::size_t>(i) - 1;
    for (const ParticleSystem<double>* s : {&table, &frame}) {
      CHECK(s->masses()[i] == planets.masses()[i]);
      for (Index k = 0; k < 3; ++k) {
        CHECK(s->positions()[i][k] == stored.positions[3 * row + static_cast<std::size_t>(k)]);
        CHECK(s->velocities()[i][k] == stored.velocities[3 * row + static_cast<std::size_t>(k)]);
      }
    }
  }
}

TEST_CASE("XYZ calls particles by their types, and keeps charges", "[topology][inspect]") {
  const ScratchFolder folder;
  io::convert(written_run(folder, molecule()), folder / "run.xyz");
  const std::vector<std::string> xyz = xyz_lines(folder / "run.xyz");
  CHECK(xyz.at(1).starts_with("Properties=species:S:1:pos:R:3:masses:R:1:momenta:R:3:initial_charges:R:1 Time=0 "));
  CHECK(xyz.at(2).starts_with("Na+ "));
  CHECK(xyz.at(3).starts_with("HW "));
  CHECK(xyz.at(5).starts_with("OW "));
  const ParticleSystem<double> back = io::read_structure(folder / "run.xyz", {.frame = -1});
  CHECK(back.topology()->type_names == std::vector<std::string>{"Na+", "HW", "OW"});
  for (Index i = 0; i < 5; ++i)
    CHECK(back.column<Charge>()[i] == io::read_frames(folder / "run.h5").charges.at(static_cast<std::size_t>(i)));

  // In reduced units too, and types may be numbers.
  ParticleSystem<double> beads;
  beads.add("atom_1", 1, {0, 0, 0}, {0, 0, 0});
  beads.add("atom_2", 1, {1, 0, 0}, {0, 0, 0});
  Topology topology;
  topology.type_names = {"1", "2"};
  topology.types = {1, 0};
  beads.set_topology(std::make_shared<const Topology>(topology));
  const ScratchFolder other;
  io::convert(written_run(other, beads), other / "run.xyz");
  CHECK(xyz_lines(other / "run.xyz").at(2) == "2 0 0 0 0 0 0");
  CHECK(xyz_lines(other / "run.xyz").at(3) == "1 1 0 0 0 0 0");
}

TEST_CASE("types and bonds that have changed are found", "[topology][flips][messages]") {
  const ScratchFolder folder;
  const auto file = written_run(folder, molecule());
  CHECK(io::verify(file).damaged.empty());
  change_bytes(file, 987654321, 987654323);  // in ids and in bonds alike: all of it still fits together
  CHECK(io::verify(file).damaged ==
        std::vector<std::string>{
            "the ids, names, masses, types, bonds or parameters of the particles differ from those that were written"});
  CHECK(error_of([&] { io::read_frame_particles(file); }) ==
        file.string() +
            ": damaged: the ids, names, masses, types, bonds or parameters differ from those that were written; see "
            "'noether verify' for what is intact in this file");
}

TEST_CASE("a bond of nobody, a type of no name and an order that is none are damage", "[topology][messages]") {
  const auto error_with = [](const std::string& path, const std::vector<std::int64_t>& values,
                             const std::vector<Index>& shape) {
    const ScratchFolder folder;
    const auto file = written_run(folder, outer_planets());
    {
      const io::Hdf5File open = io::Hdf5File::open_to_append(file);
      open.write("/noether/topology/type_name", {"A", "B"});
      open.write("/noether/topology/mixing", {"geometric"});
      open.write(path, values, shape);
      if (path.ends_with("bonds")) open.write("/noether/topology/bonds_kind", std::vector<std::int64_t>{0}, {1});
      open.flush();
    }
    const std::string said = error_of([&] { io::read_frame_particles(file); });
    REQUIRE(said.starts_with(file.string() + ": damaged: "));
    return said.substr(file.string().size() + 11);
  };
  CHECK(error_with("/connectivity/bonds", {0, 77}, {1, 2}) ==
        "a bond or a pair names the id 77, which no particle has");
  CHECK(error_with("/connectivity/bonds", {0, 1, 2}, {1, 3}) == "'/connectivity/bonds' does not have the shape (m, 2)");
  CHECK(error_with("/particles/system/species", {1, 1, 1, 1, 1, 3}, {6}) == "the species 3 is not one of the 2 types");
  CHECK(error_with("/particles/system/species", {1, 1}, {2}) == "ids and species differ in number");
  CHECK(error_with("/noether/topology/order", {0, 1, 2, 3, 4, 4}, {6}) ==
        "'/noether/topology/order' does not name each particle once");
  CHECK(error_with("/noether/topology/pair_types", {0, 1}, {1, 2}) == "pairs and their parameters differ in number");
}

TEST_CASE("what is no start is refused", "[bodies][messages]") {
  const ScratchFolder folder;
  const auto file = written_run(folder, molecule());
  const std::string name = file.string();
  CHECK(error_of([&] { io::read_frame_particles(file, {.frame = 5}); }) ==
        name + ": frame = 5, but 'run.h5' has 5 frames: 0 to 4, or -1 for the last");
  CHECK(error_of([&] { io::read_frame_particles(file, {.frame = -2}); }) ==
        name + ": frame = -2, but 'run.h5' has 5 frames: 0 to 4, or -1 for the last");
  CHECK(error_of([&] { io::read_frame_particles(file, {.units = &unit_system("si")}); }) ==
        name + ": the particles of 'run.h5' are in the units 'molecular', not 'si'; give units = \"molecular\"");
  CHECK(error_of([&] { io::convert(file, folder / "start.csv", {.bodies = true}); }) ==
        "cannot write bodies to '" + (folder / "start.csv").string() +
            "': a table cannot store a periodic box; give a name that ends in .h5");
  CHECK(error_of([&] { io::convert(file, folder / "start.xyz", {.bodies = true}); }) ==
        "cannot write bodies to '" + (folder / "start.xyz").string() +
            "': give a name that ends in .h5, or in .csv if there are no types, bonds, rigid bodies or box");
  CHECK(error_of([&] { io::convert(file, file, {.bodies = true}); }) ==
        "'" + name + "' would overwrite itself; give another name");
  CHECK(error_of([&] { io::convert(file, folder / "all.h5"); }) ==
        "cannot convert to '" + (folder / "all.h5").string() +
            "': give --bodies to write one frame for a new scene, or a name that ends in .xyz, .csv or .vtu for all "
            "frames");
  LorenzRun lorenz(folder / "lorenz.h5");
  REQUIRE(lorenz.simulation.run(5).ok());
  lorenz.writer->finish(Outcome{});
  CHECK(error_of([&] { io::read_frame_particles(folder / "lorenz.h5"); }) ==
        (folder / "lorenz.h5").string() +
            ": this is the run of a first-order system, which has no particles; give its variables in [system]");
}

TEST_CASE("a file from before types stood in it is read, verified, repaired, converted and gone on with",
          "[trajectory][restart][old]") {
  const ScratchFolder folder;
  SavedRun saved;
  {
    WritingRun run(folder / "run.h5");
    REQUIRE(run.simulation.run(20).ok());
    run.writer->flush();
    saved = run.simulation.save();
  }
  {
    // The layout it had: species numbered by name for all particles, and no topology; of attributes one digest.
    const io::Hdf5File file = io::Hdf5File::open_to_append(folder / "run.h5");
    file.write("/particles/system/species", std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}, {6});
    file.set_attribute("/noether", io::constants_attribute, io::constants_digest(file));
    file.set_attribute("/noether", io::headers_attribute, io::headers_digest(file, 1));
    file.flush();
  }
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  CHECK(io::repair(folder / "run.h5").repaired.empty());
  CHECK(io::read_frames(folder / "run.h5").types.empty());
  CHECK(io::read_frame_particles(folder / "run.h5").particles.topology() == nullptr);
  CHECK_FALSE(io::read_frame_particles(folder / "run.h5").knows_types);  // scenes warn of it
  io::convert(folder / "run.h5", folder / "run.xyz");
  CHECK(xyz_lines(folder / "run.xyz").at(3).starts_with("Jupiter "));
  WritingRun whole(folder / "whole.h5"), resumed(folder / "run.h5");
  REQUIRE(whole.simulation.run(60).ok());
  resumed.simulation.restore(saved);
  REQUIRE(resumed.simulation.run(40).ok());
  resumed.writer->finish(Outcome{});
  CHECK(io::digest(resumed.simulation.particles()) == io::digest(whole.simulation.particles()));
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  CHECK(io::info(folder / "run.h5").frames == 13);
  whole.writer->finish(Outcome{});
  const io::RunComparison found = io::compare_runs(folder / "run.h5", folder / "whole.h5");
  CHECK(found.same());
  CHECK(
      found.notes ==
      std::vector<std::string>{
          "types, molecules, bonds and charges are not compared: the first is from a version that did not store them"});
}

TEST_CASE("verify --against compares types, molecules, bonds and pairs", "[trajectory][compare runs]") {
  const ScratchFolder folder;
  io::write_one_frame(folder / "a.h5", molecule(), 0, 0);
  io::write_one_frame(folder / "same.h5", molecule(), 0, 0);
  CHECK(io::compare_runs(folder / "a.h5", folder / "same.h5").same());
  const auto told = [&](auto change) {
    ParticleSystem<double> s = molecule();
    Topology changed = *s.topology();
    change(changed);
    s.set_topology(std::make_shared<const Topology>(std::move(changed)));
    io::write_one_frame(folder / "b.h5", s, 0, 0);
    const io::RunComparison found = io::compare_runs(folder / "a.h5", folder / "b.h5");
    CHECK_FALSE(found.same());
    CHECK(found.rows.at(0).equal == 1);  // the frames are the same
    return found.constants;
  };
  CHECK(told([](Topology& t) { t.bonds[1].type = 1; }) ==
        std::vector<std::string>{"'bonds_kind' is 0 and 1 in entry 1"});
  CHECK(told([](Topology& t) { std::swap(t.bonds[0].particles[0], t.bonds[0].particles[1]); }) ==
        std::vector<std::string>{"'bonds' is 40 and 12 in entry 0"});
  CHECK(told([](Topology& t) { t.molecules[4] = 8; }).size() == 1);
  CHECK(told([](Topology& t) { t.type_names[2] = "K+"; }) ==
        std::vector<std::string>{"'type_name' is Na+ and K+ in entry 2"});
  CHECK(told([](Topology& t) {
          t.explicit_pairs[{0, 2}].epsilon = 0.3;
        }) == std::vector<std::string>{"'pair_parameters' is 0.2 and 0.3 in entry 0"});
}

TEST_CASE("an attribute of bonds that has changed is found", "[trajectory][inspect][flips]") {
  const ScratchFolder folder;
  io::write_one_frame(folder / "run.h5", molecule(), 0, 0);
  REQUIRE(io::verify(folder / "run.h5").damaged.empty());
  {
    const io::Hdf5File file = io::Hdf5File::open_to_append(folder / "run.h5");
    file.set_reference("/connectivity/bonds", "particles_group", "/connectivity");
    file.flush();
  }
  CHECK(io::verify(folder / "run.h5").damaged ==
        std::vector<std::string>{"the units or other attributes of the particles differ from those that were written"});
}

}  // namespace noether::test

#endif
