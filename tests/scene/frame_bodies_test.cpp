// `bodies = "run.h5"`: scenes that start from a frame of another run.

#include "engine/charge.hpp"
#include "engine/sphere_columns.hpp"
#include "io/digest.hpp"
#include "io/frame_particles.hpp"
#include "io/inspect.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "numbers/error.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <filesystem>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

const std::string springs =
    "[hamiltonian]\ntype = 'kinetic_potential'\n"
    "[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = '0.45 nm'\n[[hamiltonian.force]]\ntype = 'bonded'\n"
    "[integrator]\nmethod = 'verlet'\nstep = '1 fs'\nsteps = 12\n";

/// Three atoms, two of them bonded, in a box.
const std::string chain_data =
    "LAMMPS, units = real\n\n3 atoms\n2 atom types\n1 bonds\n1 bond types\n\n0 12 xlo xhi\n0 13 ylo yhi\n0 14 zlo "
    "zhi\n\n"
    "Masses\n\n1 14.0266\n2 15.0345\n\nPair Coeffs # lj/cut\n\n1 0.0914 3.95\n2 0.1947 3.75\n\n"
    "Bond Coeffs # harmonic\n\n1 95.7 1.54\n\nAtoms # full\n\n1 1 1 0.25 1 1 1\n2 1 2 -0.25 2.5 1 1\n3 2 1 0 6 11 6\n\n"
    "Velocities\n\n1 0.01 0 0\n2 -0.05 0.02 0\n3 0 0.03 0.01\n\nBonds\n\n1 1 1 2\n";

const std::string one_planet =
    "units = 'solar'\n[particles]\nframe = 'barycenter'\n[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n"
    "[[particles.body]]\nname = 'Earth'\nmass = '3e-6 Msun'\na = '1 au'\ne = 0.3\n"
    "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n"
    "[integrator]\nmethod = 'verlet'\nstep = '1 day'\nuntil = '10 day'\n";

/// A folder with the run of a scene in it, each of whose steps is a frame.
struct EarlierRun {
  explicit EarlierRun(const std::string& scene_text) {
    write_text(folder / "chain.data", chain_data);
    const Scene scene = read_scene(scene_text, folder / "first.toml");
    units = std::string(scene.units->name);
    Simulation<double> run = assemble(scene);
    auto& writer = run.every(1, io::TrajectoryWriter(folder / "run.h5", {.scene_toml = scene.effective_toml}));
    REQUIRE(run.run(*scene.integrator.steps).ok());
    writer.finish(Outcome{});
    first = scene.particles;
  }
  /// A scene of the same units whose `[particles]` begins so.
  Scene scene(const std::string& particles, const std::string& rest) const {
    return read_scene("units = '" + units + "'\n[particles]\n" + particles + rest, folder / "scene.toml");
  }
  std::string refusal(const std::string& particles, const std::string& rest) const {
    try {
      scene(particles, rest);
    } catch (const Error& error) {
      std::string shown = error.what();
      const std::string path = (folder / "").string();
      for (auto at = shown.find(path); at != std::string::npos; at = shown.find(path)) shown.erase(at, path.size());
      return std::to_string(error.exit_code()) + " " + shown;
    }
    return "";
  }

  ScratchFolder folder;
  std::string units;
  ParticleSystem<double> first;
};

EarlierRun chain_run() { return EarlierRun("units = 'molecular'\n[particles]\nstructure = 'chain.data'\n" + springs); }

const std::string gravity_rest = one_planet.substr(one_planet.find("[hamiltonian]"));

}  // namespace

TEST_CASE("molecules of another run go on as rigid bodies, where and as fast as their atoms",
          "[scene][bodies][rigid]") {
  const EarlierRun run(
      "units = 'molecular'\n[particles]\ntype = 'water_box'\nmodel = 'spce'\nmolecules = 8\ntemperature = '300 K'\n"
      "density = '0.1 g/cm^3'\nseed = 3\n[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\n"
      "type = 'reaction_field'\ncutoff = '0.5 nm'\n[[hamiltonian.constraint]]\ntype = 'rigid_molecules'\n"
      "[integrator]\nmethod = 'verlet'\nstep = '1 fs'\nsteps = 12\n");
  const std::string rest =
      "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'reaction_field'\ncutoff = '0.5 nm'\n"
      "[integrator]\nmethod = 'verlet'\nstep = '1 fs'\nsteps = 12\n";
  const Scene turning = run.scene("bodies = 'run.h5'\nmolecules = 'rigid'\n", rest);
  const ParticleSystem<double>& bodies = turning.particles;
  REQUIRE(bodies.size() == 8);
  REQUIRE(bodies.bodies() != nullptr);
  // Kinetic energies of atoms and of bodies are the same, and so are those of their charges.
  const Scene atoms = run.scene("bodies = 'run.h5'\n", rest + "[[hamiltonian.constraint]]\ntype = 'rigid_molecules'\n");
  Simulation<double> as_atoms = assemble(atoms), as_bodies = assemble(turning);
  auto& of_atoms = as_atoms.every(1, Energy{});
  auto& of_bodies = as_bodies.every(1, Energy{});
  REQUIRE(as_atoms.run(0).ok());
  REQUIRE(as_bodies.run(0).ok());
  CHECK(of_atoms.scale().value() > 0);
  CHECK(std::abs(of_bodies.total() - of_atoms.total()) < 1e-9 * of_atoms.scale().value());
  // A run of bodies has none to make.
  const EarlierRun again(
      "units = 'molecular'\n[particles]\ntype = 'water_box'\nmodel = 'spce'\nmolecules = 8\n"
      "density = '0.1 g/cm^3'\nseed = 3\nrigid_bodies = true\n" +
      rest);
  CHECK(again.refusal("bodies = 'run.h5'\nmolecules = 'rigid'\n", rest) ==
        "2 scene.toml:4: the particles of run.h5 are rigid bodies already; take molecules out");
}

TEST_CASE("a scene starts from any frame of another run, with masses, types, charges and bonds", "[scene][bodies]") {
  const EarlierRun run = chain_run();
  const io::Frames frames = io::read_frames(run.folder / "run.h5");
  REQUIRE(frames.frames.size() == 13);
  for (const std::int64_t k : {0, 5, 12, -1}) {
    CAPTURE(k);
    const Scene scene = run.scene("bodies = 'run.h5'\nframe = " + std::to_string(k) + "\n", springs);
    const ParticleSystem<double>& s = scene.particles;
    const io::Frame& frame = frames.frames.at(k < 0 ? 12 : static_cast<std::size_t>(k));
    for (Index i = 0; i < 3; ++i) {
      CHECK(s.masses()[i] == run.first.masses()[i]);
      CHECK(s.column<Charge>()[i] == run.first.column<Charge>()[i]);
      for (Index j = 0; j < 3; ++j) {
        const std::size_t at = 3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(j);
        CHECK(s.positions()[i][j] == frame.positions.at(at));
        CHECK(s.velocities()[i][j] == frame.velocities.at(at));
        CHECK(s.images()[i][j] == frame.images.at(at));
      }
    }
    CHECK(s.names() == run.first.names());
    CHECK(s.ids() == run.first.ids());
    CHECK(s.box() == run.first.box());
    CHECK(s.topology()->types == run.first.topology()->types);
    CHECK(s.topology()->type_names == std::vector<std::string>{"1", "2"});
    CHECK(s.topology()->bonds == run.first.topology()->bonds);
    CHECK(s.topology()->bond_kinds == run.first.topology()->bond_kinds);
    CHECK(s.topology()->pair_kinds == run.first.topology()->pair_kinds);
    CHECK(s.topology()->exclusions == run.first.topology()->exclusions);
    // What is the last frame today is told by its number, whatever the other run writes tomorrow.
    CHECK(scene.effective_toml.find("frame = " + std::to_string(k < 0 ? 12 : k)) != std::string::npos);
    const Scene again = read_scene(scene.effective_toml, scene.file);
    CHECK(again.effective_toml == scene.effective_toml);
    CHECK(io::digest(again.particles) == io::digest(s));
  }
}

TEST_CASE("a run from a frame has the energy that the other run had there", "[scene][bodies]") {
  const EarlierRun run = chain_run();
  const Scene scene = run.scene("bodies = 'run.h5'\nframe = 7\n", springs);
  Simulation<double> fresh = assemble(scene);
  Simulation<double> whole =
      assemble(read_scene("units = 'molecular'\n[particles]\nstructure = 'chain.data'\n" + springs, scene.file));
  const Energy& there = whole.every(7, Energy{});
  const Energy& here = fresh.every(1, Energy{});
  REQUIRE(whole.run(7).ok());
  REQUIRE(fresh.run(0).ok());
  CHECK(here.total() == there.total());
  CHECK(here.total() != 0);
}

TEST_CASE("planets start from a frame, in their order, and may be moved to their barycenter and have company",
          "[scene][bodies]") {
  const EarlierRun run(one_planet);
  const Scene last = run.scene("bodies = 'run.h5'\n", gravity_rest);
  CHECK(last.particles.names() == std::vector<std::string>{"Sun", "Earth"});
  CHECK(last.particles.topology() == nullptr);
  const io::FrameParticles frame = io::read_frame_particles(run.folder / "run.h5");
  CHECK(io::digest(last.particles) == io::digest(frame.particles));
  const Scene moved = run.scene("bodies = 'run.h5'\nframe = 'barycenter'\n", gravity_rest);
  CHECK((Vec3<double>(moved.particles.positions()[1]) - Vec3<double>(last.particles.positions()[1])).norm() < 1e-15);
  const Scene three = run.scene(
      "bodies = 'run.h5'\nframe = 3\n[[particles.body]]\nname = 'comet'\nmass = '0 Msun'\na = '5 au'\ne = 0.9\n",
      gravity_rest);
  CHECK(three.particles.names() == std::vector<std::string>{"Sun", "Earth", "comet"});
  // 2451600 - 2451545 = 55 days.
  const std::string comet = "[[particles.body]]\nname = 'comet'\nmass = '0 Msun'\na = '5 au'\ne = 0.9\n";
  const Scene by_day =
      run.scene("bodies = 'run.h5'\nepoch = 'JD 2451545'\n" + comet + "T = 'JD 2451600'\n", gravity_rest);
  const Scene by_time = run.scene("bodies = 'run.h5'\n" + comet + "T = '55 day'\n", gravity_rest);
  CHECK(io::digest(by_day.particles) == io::digest(by_time.particles));
  CHECK(by_day.effective_toml.find("epoch = \"JD 2451545\"") != std::string::npos);
}

TEST_CASE("the table and the file of one frame are the same start as the frame", "[scene][bodies]") {
  const EarlierRun run(one_planet);
  const auto bits = [](const Scene& scene) { return io::digest(scene.particles); };
  const std::string frame = bits(run.scene("bodies = 'run.h5'\nframe = 4\n", gravity_rest));
  io::convert(run.folder / "run.h5", run.folder / "start.csv", {.bodies = true, .frame = 4});
  io::convert(run.folder / "run.h5", run.folder / "start.h5", {.bodies = true, .frame = 4});
  CHECK(bits(run.scene("bodies = 'start.csv'\n", gravity_rest)) == frame);
  CHECK(bits(run.scene("bodies = 'start.h5'\n", gravity_rest)) == frame);
  CHECK(bits(run.scene("bodies = 'run.h5'\n", gravity_rest)) ==
        bits(run.scene("bodies = 'run.h5'\nframe = 10\n", gravity_rest)));
}

TEST_CASE("a table has the columns of parts, and is the same start as the frame", "[scene][bodies]") {
  // Spheres of open space: a radius, and three columns of what contacts have done, one of them a count.
  const std::string sheet =
      "[hamiltonian]\ntype = 'shearing_sheet'\nOmega = '1.5e-4 1/s'\n[[hamiltonian.force]]\ntype = 'hard_spheres'\n"
      "restitution = 0.7\n[integrator]\nmethod = 'verlet'\nstep = '100 s'\nsteps = 12\n";
  const EarlierRun run(
      "units = 'si'\n[particles]\n[[particles.body]]\nname = 'a'\nmass = '2 kg'\nx = ['0 m', '0 m', '0.1 m']\n"
      "v = ['3 mm/s', '0 m/s', '0 m/s']\nradius = '0.7 m'\n[[particles.body]]\nname = 'b, \"large\"'\nmass = '3 kg'\n"
      "x = ['2 m', '0.3 m', '0 m']\nv = ['0 m/s', '-0.45 mm/s', '0 m/s']\nradius = '0.8 m'\n" +
      sheet);
  io::convert(run.folder / "run.h5", run.folder / "start.csv", {.bodies = true});
  const std::string text = read_text(run.folder / "start.csv");
  CHECK(text.substr(0, text.find('\n')) ==
        "id,name,mass [kg],x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s],contact_heat [J],"
        "contact_transport [kg m^2/s],contacts,radius [m]");
  const Scene table = run.scene("bodies = 'start.csv'\n", sheet), frame = run.scene("bodies = 'run.h5'\n", sheet);
  CHECK(table.warnings.empty());
  CHECK(io::digest(table.particles) == io::digest(frame.particles));
  const auto columns = [](const Scene& scene) {
    const ParticleSystem<double>& s = scene.particles;
    std::vector<double> all;
    for (Index i = 0; i < 2; ++i) {
      all.insert(all.end(), {s.column<BodyRadius>()[i], s.column<ContactCount>()[i], s.column<ContactHeat>()[i],
                             s.column<ContactTransport>()[i]});
    }
    return all;
  };
  CHECK(columns(table) == columns(frame));
  CHECK(columns(table)[0] == 0.7);
  CHECK(columns(table)[1] == 1);
  CHECK(columns(table)[2] > 0);
  // And back: a run of the table has a table with the same text.
  io::write_one_frame(run.folder / "again.h5", table.particles, 0, 0);
  io::convert(run.folder / "again.h5", run.folder / "again.csv", {.bodies = true});
  CHECK(read_text(run.folder / "again.csv") == read_text(run.folder / "start.csv"));
}

TEST_CASE("the box of a frame stays as it is where the scene gives the same, or is taken away", "[scene][bodies]") {
  const EarlierRun run = chain_run();
  const Scene plain = run.scene("bodies = 'run.h5'\n", springs),
              same = run.scene("bodies = 'run.h5'\nbox = ['1.2 nm', '1.3 nm', '1.4 nm']\n", springs),
              open = run.scene("bodies = 'run.h5'\nbox = 'open'\n", springs);
  CHECK(io::digest(same.particles) == io::digest(plain.particles));
  CHECK_FALSE(open.particles.box().is_periodic());
  CHECK(Vec3<double>(open.particles.positions()[2]) == plain.particles.unwrapped(2));
}

TEST_CASE("a frame that has changed since is told", "[scene][bodies][messages]") {
  const EarlierRun run(one_planet);
  const Scene scene = run.scene("bodies = 'run.h5'\nframe = 2\n", gravity_rest);
  const Scene other = read_scene(one_planet + "[[every]]\ntype='energy'\nsteps=1\n", run.folder / "first.toml");
  ParticleSystem<double> changed = other.particles;
  changed.masses()[1] = 4e-6;
  io::write_one_frame(run.folder / "run.h5", changed, 0, 0);
  try {
    std::string text = scene.effective_toml;
    text.replace(text.find("frame = 2"), 9, "frame = 0");
    read_scene(text, scene.file);
    FAIL("the hash is another one");
  } catch (const SceneError& error) {
    CHECK(error.message().starts_with("'run.h5' differs from the file this scene was run with: its hash is now "));
  }
}

TEST_CASE("a start that a run.h5 does not have is refused in one line", "[scene][bodies][messages]") {
  const EarlierRun run = chain_run();
  const auto said = [&](const std::string& particles) { return run.refusal(particles, springs); };
  CHECK(said("bodies = 'run.h5'\nframe = 13\n") ==
        "2 scene.toml:4: frame = 13, but 'run.h5' has 13 frames: 0 to 12, or -1 for the last");
  CHECK(said("bodies = 'run.h5'\nframe = -2\n") ==
        "2 scene.toml:4: frame = -2, but 'run.h5' has 13 frames: 0 to 12, or -1 for the last");
  CHECK(said("bodies = 'run.h5'\nframe = 'baricenter'\n") ==
        "2 scene.toml:4: unknown frame 'baricenter'; did you mean 'barycenter'?");
  CHECK(
      said("bodies = 'run.h5'\nframe = 'last'\n") ==
      "2 scene.toml:4: unknown frame 'last'; expected one of: barycenter, as_given, or the number of a frame, such as "
      "0 or -1 for the last");
  CHECK(said("bodies = 'run.h5'\nframe = 2.5\n") ==
        "2 scene.toml:4: frame = 2.5 is a number; \"barycenter\", or the number of a frame, such as 0 or -1 for the "
        "last, is expected");
  CHECK(said("structure = 'run.h5'\n") ==
        "2 scene.toml:3: 'run.h5' is not a structure; to start from the particles of a run give bodies = \"run.h5\"");
  CHECK(said("bodies = 'nosuch.h5'\n") == "3 scene.toml:3: nosuch.h5: there is no such file");
  CHECK(said("bodies = 'run.h5'\nepoch = 'JD 2451545'\n").starts_with("2 scene.toml:4: unknown key 'epoch'"));
  CHECK(
      said("bodies = 'run.h5'\n[[particles.body]]\nname = 'x'\nmass = '1 u'\n")
          .starts_with("2 scene.toml:4: the particles of run.h5 have types, bonds or charges, which bodies of tables"));
  const EarlierRun planets(one_planet);
  std::filesystem::copy_file(planets.folder / "run.h5", run.folder / "planets.h5");
  CHECK(said("bodies = 'planets.h5'\n") ==
        "2 scene.toml:3: the particles of 'planets.h5' are in the units 'solar', not 'molecular'; give units = "
        "\"solar\"");
  write_text(planets.folder / "b.csv", "name,mass [Msun],x [au],y,z,vx [au/day],vy,vz\nSun,1,0,0,0,0,0,0\n");
  CHECK(planets.refusal("bodies = 'b.csv'\nframe = 3\n", gravity_rest) ==
        "2 scene.toml:4: frame = 3 is the number of a frame, but a table of bodies has no frames; \"barycenter\" or "
        "\"as_given\" is expected");
  // A file that has lost its end is one of damage, whatever is asked of it.
  const std::string bytes = read_text(run.folder / "run.h5");
  write_text(run.folder / "run.h5", bytes.substr(0, bytes.size() / 2));
  CHECK(said("bodies = 'run.h5'\n").starts_with("3 scene.toml:3: run.h5: "));
}

}  // namespace noether::test

#endif
