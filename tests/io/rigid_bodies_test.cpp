// Rigid bodies in run.h5: what they are made of, to the bit, their atoms as XYZ, and runs that begin from a frame.

#include "tests/support/rigid_bodies.hpp"
#include "engine/charge.hpp"
#include "engine/sites.hpp"
#include "io/digest.hpp"
#include "io/frame_particles.hpp"
#include "io/hdf5_file.hpp"
#include "io/inspect.hpp"
#include "io/structure.hpp"
#include "scene/scene.hpp"
#include "tests/io/support.hpp"
#include "tests/support/files.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <memory>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// Two molecules of water, a dumbbell and an ion in a box, their ids in no order; one molecule across a face.
ParticleSystem<double> mixture() {
  ParticleSystem<double> s(unit_system("molecular"));
  const std::vector<BodySite> water = {
      {.place = {0, -0.0065, 0}, .mass = 15.9994, .charge = -0.8476, .type = 0, .name = "OW"},
      {.place = {0.0816, 0.0513, 0}, .mass = 1.00794, .charge = 0.4238, .type = 1, .name = "HW"},
      {.place = {-0.0816, 0.0513, 0}, .mass = 1.00794, .charge = 0.4238, .type = 1, .name = "HW"}};
  Bodies bodies;
  const RigidBody one = body_of_sites("water", water);
  add_body(s, bodies, one, {.x = {0.02, 1, 1}, .v = {1, 0, 0.5}, .angular_velocity = Vec3<double>(4, -6, 3)});
  s.add("ion", 22.99, {0.7, 0.6, 0.5}, {0, 0, -1});
  add_body(s, bodies, one,
           {.x = {0.9, 1.1, 0.3}, .orientation = {0.5, 0.5, -0.5, 0.5}, .spin = Vec3<double>(0.01, 0.02, 0)});
  add_body(s, bodies,
           body_of_sites("N2",
                         {{.place = {0, 0, 0.055}, .mass = 14, .type = 2, .name = "N"},
                          {.place = {0, 0, -0.055}, .mass = 14, .type = 2, .name = "N"}},
                         true),
           {.x = {0.5, 0.4, 1.3}, .angular_velocity = Vec3<double>(9, 0, 0)});
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  auto& charges = s.add_column<Charge>();
  charges[1] = 1;
  Topology topology;
  topology.type_names = {"OW", "HW", "N", "Na"};
  topology.types = {0, 3, 0, 2};
  s.set_topology(std::make_shared<const Topology>(topology));
  s.restore_ids({40, 7, 12, 3});
  s.set_box(Box::periodic({1.5, 2, 2.5}));
  return s;
}

TEST_CASE("what bodies are made of comes back from run.h5 to the bit", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  const ParticleSystem<double> s = mixture();
  io::write_one_frame(folder / "run.h5", s, 3, 0.25);
  const io::FrameParticles found = io::read_frame_particles(folder / "run.h5");
  REQUIRE(found.particles.bodies() != nullptr);
  CHECK(*found.particles.bodies() == *s.bodies());
  CHECK(io::digest(found.particles) == io::digest(s));
  CHECK(found.left_out.empty());
  // Parts of a new scene need not declare the columns of bodies.
  const io::FrameParticles again = io::read_frame_particles(folder / "run.h5", {.columns = std::vector<ColumnInfo>{}});
  CHECK((again.left_out.empty() && again.particles.has<BodySpin>()));
}

TEST_CASE("XYZ shows the atoms of bodies where they are, with the velocities of their places", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  const ParticleSystem<double> s = mixture();
  io::write_one_frame(folder / "run.h5", s, 3, 0.25);
  CHECK(io::convert(folder / "run.h5", folder / "run.xyz") == 1);
  const ParticleSystem<double> atoms = io::read_structure(folder / "run.xyz");
  const Sites<double> sites(s);
  REQUIRE(atoms.size() == 9);
  CHECK(atoms.topology()->type_names == std::vector<std::string>{"OW", "HW", "Na", "N"});
  double momentum = 0, kinetic = 0;
  for (Index a = 0; a < 9; ++a) {
    const Vec3<double> apart = s.box().minimum_image<double>(Vec3<double>(std::as_const(atoms).positions()[a]) -
                                                             Vec3<double>(sites.particles().positions()[a]));
    CHECK(apart.norm() < 1e-14);
    CHECK(std::abs(atoms.column<Charge>()[a] - sites.particles().column<Charge>()[a]) < 1e-15);
    const Vec3<double> v = std::as_const(atoms).velocities()[a];
    momentum += atoms.masses()[a] * v[0];
    kinetic += atoms.masses()[a] * v.squaredNorm() / 2;
  }
  CHECK(std::abs(momentum - 18.01528) < 1e-12);
  CHECK(std::abs(kinetic / (kinetic_energy(s) + turning_energy_of(s)) - 1) < 1e-13);
  // A table keeps orientations and spins, a row a body.
  io::convert(folder / "run.h5", folder / "run.csv");
  CHECK(read_text(folder / "run.csv").find("orientation[3]") != std::string::npos);
}

/// A run of the mixture without forces, a frame each step.
struct Tumbling {
  Tumbling(const std::filesystem::path& file, bool sites, ParticleSystem<double> start = mixture())
      : simulation(std::move(start), compose(turning(ForceField<double>(), {.rotor = Rotor::exact}), schemes::verlet),
                   0.01),
        writer(&simulation.every(1, io::TrajectoryWriter(file, {.scene_toml = "title = \"t\"\n", .sites = sites}))) {}

  Simulation<double> simulation;
  io::TrajectoryWriter* writer;
};

TEST_CASE("frames have the sites of bodies where they are asked for, and h5py finds them", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  {
    Tumbling with(folder / "run.h5", true), without(folder / "bare.h5", false);
    REQUIRE(with.simulation.run(3).ok());
    REQUIRE(without.simulation.run(3).ok());
  }
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  CHECK(io::info(folder / "run.h5").digest == io::info(folder / "bare.h5").digest);
  const io::Hdf5File file = io::Hdf5File::open_to_read(folder / "run.h5");
  CHECK_FALSE(io::Hdf5File::open_to_read(folder / "bare.h5").has("/particles/sites"));
  CHECK(file.open("/particles/sites/position/value").shape() == std::vector<Index>{4, 9, 3});
  CHECK(file.open("/particles/sites/particle").read_integers() ==
        std::vector<std::int64_t>{3, 3, 7, 12, 12, 12, 40, 40, 40});
  // What the file says of sites and what follows from its bodies are one, to the bit.
  io::convert(folder / "run.h5", folder / "run.xyz");
  io::convert(folder / "bare.h5", folder / "bare.xyz");
  CHECK(read_text(folder / "run.xyz") == read_text(folder / "bare.xyz"));
  const auto found = python_output("read_sites.py", {(folder / "run.h5").string()});
  if (found) {
    CHECK(*found ==
          "N N ion OW HW HW OW HW HW\nspecies 3 3 4 1 2 2 1 2 2\n"
          "charge 0.0 0.0 1.0 -0.8476 0.4238 0.4238 -0.8476 0.4238 0.4238\n");
  }
}

TEST_CASE("a run that writes sites goes on with them, and what is changed in them is found", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  SavedRun saved;
  {
    Tumbling whole(folder / "whole.h5", true);
    REQUIRE(whole.simulation.run(4).ok());
    Tumbling half(folder / "run.h5", true);
    REQUIRE(half.simulation.run(2).ok());
    saved = half.simulation.save();
    REQUIRE(half.simulation.run(1).ok());  // a frame that is cut off again
  }
  {
    Tumbling rest(folder / "run.h5", true);
    rest.simulation.restore(saved);
    REQUIRE(rest.simulation.run(2).ok());
  }
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  for (const char* name : {"position", "velocity", "image"}) {
    const std::string path = std::string("/particles/sites/") + name + "/value";
    const auto of = [&](const char* file) { return io::Hdf5File::open_to_read(folder / file).open(path); };
    CHECK(of("run.h5").shape() == std::vector<Index>{5, 9, 3});
    if (std::string(name) == "image") {
      CHECK(of("run.h5").read_integers() == of("whole.h5").read_integers());
    } else {
      CHECK(of("run.h5").read_reals() == of("whole.h5").read_reals());
    }
  }
  // A site that is elsewhere: the number of the last frame alone, whose bytes are found by their value.
  std::string bytes = read_text(folder / "run.h5");
  const std::vector<double> x =
      io::Hdf5File::open_to_read(folder / "run.h5").open("/particles/sites/position/value").read_reals(4, 1);
  std::string number(sizeof(double), '\0');
  std::memcpy(number.data(), &x[4], sizeof(double));
  const std::size_t at = bytes.find(number);
  REQUIRE(at != std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  write_text(folder / "run.h5", bytes);
  const auto damaged = io::verify(folder / "run.h5").damaged;
  REQUIRE(damaged.size() == 1);
  CHECK(damaged[0].find("frame 4 at step 4") != std::string::npos);
}

TEST_CASE("a file from before it said what bodies are made of says so once its run goes on", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  const ParticleSystem<double> now = mixture();
  ParticleSystem<double> before = now;
  before.set_bodies(nullptr);  // their columns are in such a file, and nothing else
  std::map<std::string, SavedState> saved;
  {
    io::TrajectoryWriter writer(folder / "run.h5");
    writer.begin(before);
    writer.flush();
    writer.save(saved["trajectory"], "state");
  }
  CHECK_FALSE(io::Hdf5File::open_to_read(folder / "run.h5").has("/noether/bodies"));
  {
    io::TrajectoryWriter writer(folder / "run.h5");
    writer.load(saved["trajectory"], "state");
    writer.begin(now);
    writer.finish({});
  }
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  {
    io::TrajectoryWriter writer(folder / "run.h5");
    writer.load(saved["trajectory"], "state");
    Simulation<double> one(now, compose(turning(ForceField<double>()), schemes::verlet), 0.01);
    one.every(1, writer);
    REQUIRE(one.run(1).ok());
  }
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  const io::FrameParticles found = io::read_frame_particles(folder / "run.h5", {.frame = 0});
  CHECK_FALSE(found.lost_bodies);
  REQUIRE(found.particles.bodies() != nullptr);
  CHECK(*found.particles.bodies() == *now.bodies());
}

TEST_CASE("sites of bodies of one site each are refused", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, ellipsoid("rock", 1, {3, 2, 1}), {});
  CHECK(error_of([&] {
          io::write_one_frame(folder / "run.h5", s, 0, 0, {.sites = true});
        }).find("no body has more than one") != std::string::npos);
}

TEST_CASE("bodies of which nothing more can be shown stay rows of their own", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, ellipsoid("rock", 1, {3, 2, 1}), {.orientation = {0.5, 0.5, 0.5, 0.5}});
  io::write_one_frame(folder / "run.h5", s, 0, 0);
  io::convert(folder / "run.h5", folder / "run.xyz");
  CHECK(read_text(folder / "run.xyz").find(":orientation:R:4:spin:R:3") != std::string::npos);
}

TEST_CASE("a run of rigid bodies begins from a frame", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  const auto text = [](const std::string& particles) {
    return "units = 'reduced'\n[particles]\n" + particles +
           "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity_of_bodies'\n"
           "degree = 'sites'\n[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 20\n"
           "[[every]]\ntype = 'trajectory'\nsteps = 10\n";
  };
  const std::string rock =
      "[[particles.rigid_body]]\nname = 'rock'\nx = [1, 0, 0]\nv = [0, 0.7, 0]\nangular_velocity = [0.1, 0.2, 1]\n"
      "site = [{place = [0.1, 0, 0], mass = 0.1}, {place = [0, 0.2, 0], mass = 0.1}, {place = [0, 0, 0.3], mass = "
      "0.1}]\n[[particles.body]]\nname = 'star'\nmass = 1\nx = [0, 0, 0]\nv = [0, 0, 0]\n";
  const auto end_of = [&](const std::string& particles, const char* name, std::int64_t steps) {
    const Scene scene = read_scene(text(particles), folder / "scene.toml");
    Simulation<double> sim = assemble(scene, {.trajectory = folder / name, .checkpoint = {}});
    REQUIRE(sim.run(steps).ok());
    return sim.particles();
  };
  const ParticleSystem<double> whole = end_of(rock, "whole.h5", 20);
  end_of(rock, "half.h5", 10);
  const ParticleSystem<double> rest = end_of("bodies = 'half.h5'\n", "rest.h5", 10);
  CHECK((whole.positions()[0] - rest.positions()[0]).norm() < 1e-14);
  CHECK((whole.column<BodyOrientation>()[0] - rest.column<BodyOrientation>()[0]).norm() < 1e-14);
  CHECK((whole.column<BodySpin>()[0] - rest.column<BodySpin>()[0]).norm() < 1e-15);
}

TEST_CASE("bodies of tables beside those of a frame with types are refused, of both kinds", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  io::write_one_frame(folder / "run.h5", mixture(), 3, 0.25);
  const auto refused = [&](const std::string& table) {
    return error_of([&] {
      read_scene("units = 'molecular'\n[particles]\nbodies = 'run.h5'\n" + table +
                     "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'lennard_jones'\n"
                     "cutoff = '0.6 nm'\nepsilon = '1 kJ/mol'\nsigma = '0.3 nm'\n"
                     "[integrator]\nmethod = 'verlet'\nstep = '1 fs'\nsteps = 1\n",
                 folder / "scene.toml");
    });
  };
  CHECK(
      refused("[[particles.rigid_body]]\nname = 'more'\nmass = '1 u'\ninertia = ['1 u nm^2', '1 u nm^2', '1 u nm^2']\n"
              "x = ['1 nm', '1 nm', '1 nm']\n")
          .find("take [[particles.rigid_body]] out") != std::string::npos);
  CHECK(refused("[[particles.body]]\nname = 'more'\nmass = '1 u'\nx = ['1 nm', '1 nm', '1 nm']\n")
            .find("take [[particles.body]] out") != std::string::npos);
}

TEST_CASE("frames whose bodies do not fit their particles are damaged", "[io][rigid_bodies]") {
  const ScratchFolder folder;
  ParticleSystem<double> s = mixture();
  s.column<BodyInertia>().set(1, Vec3<double>(1, 1, 1));  // of the ion
  io::write_one_frame(folder / "run.h5", s, 0, 0);
  CHECK(error_of([&] { io::read_frame_particles(folder / "run.h5"); }).find("moments of inertia, but is not a body") !=
        std::string::npos);
  s = mixture();
  Bodies bodies = *s.bodies();
  bodies.kinds[0].sites[1].type = 9;
  s.set_bodies(std::make_shared<const Bodies>(bodies));
  io::write_one_frame(folder / "run.h5", s, 0, 0);
  CHECK(error_of([&] { io::read_frame_particles(folder / "run.h5"); }).find("a site is of type 9") !=
        std::string::npos);
  s = mixture();
  s.column<BodySpin>().set(0, Vec3<double>(std::nan(""), 0, 0));
  io::write_one_frame(folder / "run.h5", s, 0, 0);
  CHECK(error_of([&] { io::read_frame_particles(folder / "run.h5"); }).find("'spin' is not finite") !=
        std::string::npos);
}

}  // namespace
}  // namespace noether::test

#endif
