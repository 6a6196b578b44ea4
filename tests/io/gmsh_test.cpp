// Meshes of Gmsh: what is read, and what is refused, in which words.

#include "engine/mesh.hpp"
#include "io/structure.hpp"
#include "tests/io/support.hpp"

#include <cmath>

using namespace noether;
using test::error_of;

namespace {

const std::string seeds = NOETHER_SOURCE_DIR "/tests/fuzz/seeds/structure/";
const io::StructureOptions weighed = {.units = &unit_system("reduced"), .densities = {{"", 6}, {"soft rubber", 12}}};

std::string mesh_refusal(const std::string& before, const std::string& after, io::StructureOptions options = weighed,
                         const std::string& seed = "wedge.msh") {
  std::string content = test::read_text(seeds + seed);
  const std::size_t at = content.find(before);
  REQUIRE(at != std::string::npos);
  content.replace(at, before.size(), after);
  const test::ScratchFolder folder;
  test::write_text(folder / "m.msh", content);
  const std::string message = error_of([&] { io::read_structure(folder / "m.msh", options); });
  const std::size_t name = message.find("m.msh");
  return name == std::string::npos ? message : message.substr(name);
}

}  // namespace

TEST_CASE("meshes of both versions are the same particles, elements and surfaces", "[structure][mesh]") {
  for (const char* file : {"wedge.msh", "wedge41.msh"}) {
    INFO(file);
    std::vector<std::string> notes;
    io::StructureOptions options = weighed;
    options.notes = &notes;
    const ParticleSystem<double> s = io::read_structure(seeds + file, options);
    CHECK(s.ids() == std::vector<std::int64_t>{1, 2, 3, 4, 9});
    CHECK(s.name(4) == "node_9");
    CHECK(notes == std::vector<std::string>{"1 node of the mesh belongs to no tetrahedron and is left out"});
    const Mesh& mesh = *s.topology()->mesh;
    CHECK(mesh.regions == std::vector<std::string>{"steel", "soft rubber"});
    CHECK(mesh.surfaces == std::vector<std::string>{"held"});
    REQUIRE(mesh.tetrahedra.size() == 2);
    CHECK(mesh.tetrahedra[0] == BondedTerm<4>{{0, 1, 2, 3}, 0});
    CHECK(std::abs(mesh.sixfold_volume(mesh.tetrahedra[1]) - 2) < 1e-15);  // turned where the file has it inside out
    CHECK(mesh.particles_of(0) == std::vector<Index>{0, 1, 2, 3});
    CHECK(s.masses()[0] == 0.25);  // 6 / 6 / 4
    CHECK(s.masses()[4] == 1);     // 12 (2 / 6) / 4
    CHECK(s.masses()[1] == 1.25);
    CHECK(s.positions()[4] == Vec3<double>(1, 1, 1));
  }
}

TEST_CASE("lengths of a mesh are in the unit that file_units names", "[structure][mesh]") {
  const ParticleSystem<double> s = io::read_structure(
      seeds + "wedge.msh", {.units = &unit_system("si"), .file_units = "mm", .densities = {{"", 1000}}});
  CHECK(s.positions()[1] == Vec3<double>(0.001, 0, 0));
  CHECK(error_of([] {
          io::read_structure(seeds + "wedge.msh",
                             {.units = &unit_system("si"), .file_units = "kg", .densities = {{"", 1000}}});
        }) == "file_units = \"kg\" is not a unit of length, as a mesh needs one");
}

TEST_CASE("meshes that cannot be followed are refused where they are wrong", "[structure][mesh][messages]") {
  CHECK(mesh_refusal("2.2 0 8", "2.2 1 8") ==
        "m.msh:2: the mesh is binary; ASCII is expected: give Mesh.Binary = 0 to Gmsh");
  CHECK(mesh_refusal("2.2 0 8", "3 0 8") ==
        "m.msh:2: the mesh has version 3; 2.2 and 4.1 are supported: give Mesh.MshFileVersion = 4.1 to Gmsh");
  CHECK(mesh_refusal("$Nodes", "$Points") == "m.msh: there is no $Nodes, as a mesh of Gmsh has");
  CHECK(mesh_refusal("6 4 2 2 2 9 3 2 4", "6 11 2 2 2 9 3 2 4 1 2 3 4 1 2") ==
        "m.msh:26: this element is a tetrahedron of second order; tetrahedra of first order are expected, with "
        "triangles");
  CHECK(mesh_refusal("6 4 2 2 2 9 3 2 4", "6 4 2 2 2 4 3 2 1") ==
        "m.msh:26: this tetrahedron is given in line 25 already; put each into one physical volume");
  CHECK(mesh_refusal("6 4 2 2 2 9 3 2 4", "6 4 2 2 2 8 3 2 4") ==
        "m.msh:26: node 8 of this element is not in the mesh");
  CHECK(mesh_refusal("9 1 1 1", "9 0.5 0.5 0") ==
        "m.msh: element 1 of the mesh is flat: its volume is 0 where its longest edge is 1.41421; take it out or make "
        "the mesh anew");
  CHECK(mesh_refusal("6\n1 15", "7\n1 15") == "m.msh:27: the section ends where an element is expected");
  CHECK(mesh_refusal("2 1 0 0", "1 1 0 0") == "m.msh:13: node 1 is given twice");
  CHECK(mesh_refusal("2 1 0 0", "2 1 0 x").starts_with("m.msh:13: "));
  CHECK(mesh_refusal("2.2", "2.2", {.units = &unit_system("reduced")}) ==
        "a mesh does not say how heavy it is; give density = ...");
  CHECK(mesh_refusal("2.2", "2.2", {.units = &unit_system("reduced"), .densities = {{"steel", 7}}}) ==
        "no density is given for the region 'soft rubber' of the mesh");
  CHECK(mesh_refusal("2.2", "2.2", {.units = &unit_system("reduced"), .densities = {{"brass", 7}}}) ==
        "density is given for 'brass', but the regions of the mesh are steel, soft rubber");
}

TEST_CASE("a surface is in each of its physical groups, turned over or not, and a volume in one", "[structure][mesh]") {
  std::string content = test::read_text(seeds + "wedge41.msh");
  const auto replace = [&](const std::string& before, const std::string& after) {
    const std::size_t at = content.find(before);
    REQUIRE(at != std::string::npos);
    content.replace(at, before.size(), after);
  };
  replace("5 0 0 0 1 1 1 1 7 0", "5 0 0 0 1 1 1 2 -7 8 0");
  replace("3\n2 7 \"held\"", "4\n2 7 \"held\"\n2 8 \"painted\"");
  const test::ScratchFolder folder;
  test::write_text(folder / "m.msh", content);
  const Mesh mesh = *io::read_structure(folder / "m.msh", weighed).topology()->mesh;
  CHECK(mesh.surfaces == std::vector<std::string>{"held", "painted"});
  CHECK(mesh.particles_of(mesh.surface("held")) == mesh.particles_of(mesh.surface("painted")));
  CHECK(mesh.particles_of(mesh.surface("held")).size() == 4);

  CHECK(mesh_refusal("1 0 0 0 1 1 1 1 1 0", "1 0 0 0 1 1 1 2 1 2 0", weighed, "wedge41.msh") ==
        "m.msh:14: volume 1 is in the physical volumes 1 and 2; put it into one");
  CHECK(mesh_refusal("$EndEntities\n", "$EndEntities\n$PartitionedEntities\n0\n$EndPartitionedEntities\n", weighed,
                     "wedge41.msh")
            .starts_with("m.msh:17: the mesh is divided into partitions"));
}
