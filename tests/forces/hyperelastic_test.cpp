/// Bodies that deform: patch tests, gradients, the tumbling cube, a material of the user's own.

#include "forces/hyperelastic.hpp"

#include "engine/simulation.hpp"
#include "forces/check_gradient.hpp"
#include "forces/traction.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "scene/block.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <array>
#include <cmath>

namespace noether {
namespace {

using namespace noether::test;

const HyperelasticForce soft{{.lambda = 1, .mu = 0.8}};
const HyperelasticForce neo{{.material = ElasticLaw::neo_hookean, .lambda = 1, .mu = 0.8}};

/// Saint-Venant and Kirchhoff as a user writes it, by its energy alone.
struct OwnMaterial {
  double lambda = 1, mu = 0.8;
  static constexpr auto describe() {
    return part<OwnMaterial>("own_material", "a material of the user's own",
                             field<&OwnMaterial::lambda>("lambda", "pressure"));
  }
  template <class Real> Real energy(const Symmetric<Real>& c) const {
    const Real xx = (c.xx - Real(1)) / Real(2), yy = (c.yy - Real(1)) / Real(2), zz = (c.zz - Real(1)) / Real(2);
    const Real squares = xx * xx + yy * yy + zz * zz + (c.xy * c.xy + c.xz * c.xz + c.yz * c.yz) / Real(2);
    const Real trace = xx + yy + zz;
    return Real(lambda / 2) * trace * trace + Real(mu) * squares;
  }
};

/// The unit cube of 2^3 cells under the deformation of the patch test.
constexpr double patch[3][3] = {{1.1, 0.2, 0}, {0, 0.9, 0.1}, {0.05, 0, 1.2}};
ParticleSystem<double> patch_cube() {
  ParticleSystem<double> s = Block{.cells = {2, 2, 2}, .size = {1, 1, 1}, .density = 1}.build();
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> X = s.topology()->mesh->rest[static_cast<std::size_t>(i)];
    Vec3<double> x;
    for (int r = 0; r < 3; ++r) x[r] = patch[r][0] * X[0] + patch[r][1] * X[1] + patch[r][2] * X[2];
    s.positions().set(i, x);
  }
  return s;
}

struct Felt {
  double energy;
  std::vector<Vec3<double>> force;
  Mat3<double> virial;
  std::optional<Failure> failure;
};
Felt felt_by(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true, .virial = true});
  force.add_to(sink, s);
  std::vector<Vec3<double>> forces;
  for (Index i = 0; i < s.size(); ++i) forces.emplace_back(s.masses()[i] * std::as_const(a)[i]);
  return {sink.potential(), forces, sink.virial(), sink.failure()};
}

void check_patch(const HyperelasticForce& force, double energy, const std::array<double, 9>& stress) {
  const ParticleSystem<double> s = patch_cube();
  const Felt felt = felt_by(force, s);
  CHECK(std::abs(felt.energy - energy) < 1e-13);
  const Mesh& mesh = *s.topology()->mesh;
  for (Index i = 0; i < s.size(); ++i) {  // inner nodes, and each face: P N times its area, which is 1
    const Vec3<double> X = mesh.rest[static_cast<std::size_t>(i)];
    if (X == Vec3<double>(0, 0, 0)) CHECK(std::sqrt(norm2(felt.force[static_cast<std::size_t>(i)])) < 1e-14);
  }
  // All that acts on nodes with x above 0 is the stress through the middle, and P N of the other faces on both sides.
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<double> moment = Vec3<double>::Zero();  // sum of f X over all nodes = - P V
    for (Index i = 0; i < s.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      moment -= felt.force[at] * mesh.rest[at][axis];
    }
    for (int r = 0; r < 3; ++r) {
      CHECK(std::abs(moment[r] - stress[static_cast<std::size_t>(3 * r + axis)]) < 1e-13);
    }
  }
  Mat3<double> virial = Mat3<double>::Zero();  // - F P^T V
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) virial(r, c) -= patch[r][k] * stress[static_cast<std::size_t>(3 * c + k)];
    }
  }
  CHECK((felt.virial - virial).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("patch test: energy and stress of Saint-Venant and Kirchhoff, and of a neo-Hookean material",
          "[hyperelastic]") {
  check_patch(soft, 0.11090328125000004,
              {0.5040750000000004, 0.2208500000000001, 0.06720000000000001, 0.16320000000000004, 0.12982500000000013,
               0.126425, 0.07891250000000001, 0.0952, 0.7419000000000001});
  check_patch(neo, 0.0814938950380539,
              {0.31058168807849995, 0.15736380411147455, 0.023725762996729172, 0.12653740264922225, 0.02404428542927764,
               0.07472760822294908, 0.02945521644589815, 0.057996309547560215, 0.43803321407195817});
}

TEST_CASE("hyperelastic forces are minus the gradients of their energies, those of a user's material too",
          "[hyperelastic]") {
  ParticleSystem<double> s = Block{
      .cells = {1, 1, 1},
      .size = {1, 2, 0.5},
      .density = 1,
      .stretch = {1.2, 0.9, 1.05},
      .angular_velocity = {1, 0.3,
                           2}}.build();
  s.positions().set(3, std::as_const(s).positions()[3] + Vec3<double>(0.1, 0.05, -0.07));
  CHECK(gradient_error(soft, s) < 1e-18);
  CHECK(gradient_error(neo, s) < 1e-18);
  CHECK(gradient_error(Traction{.surface = "x_high", .traction = {1, 2, 3}}, s) < 1e-18);
  const Hyperelastic<OwnMaterial> own{};
  CHECK(gradient_error(own, s) < 1e-18);
  const Felt expected = felt_by(soft, s), felt = felt_by(own, s);
  CHECK(std::abs(felt.energy - expected.energy) < 1e-15);
  for (std::size_t i = 0; i < 8; ++i) CHECK(norm2(Vec3<double>(felt.force[i] - expected.force[i])) < 1e-30);
}

TEST_CASE("constants of Lame and of engineers are the same material", "[hyperelastic]") {
  const IsotropicMaterial steel{.young_modulus = 210, .poisson_ratio = 0.3};
  CHECK(std::abs(steel.law().mu - 210 / 2.6) < 1e-13);
  CHECK(std::abs(steel.law().lambda - 210 * 0.3 / (1.3 * 0.4)) < 1e-13);
}

TEST_CASE("masses of a block are those of its volume, and a surface has its area", "[hyperelastic]") {
  const ParticleSystem<double> s = Block{.cells = {3, 2, 4}, .size = {1.5, 2, 0.5}, .density = 7}.build();
  double mass = 0;
  for (Index i = 0; i < s.size(); ++i) mass += s.masses()[i];
  CHECK(std::abs(mass - 10.5) < 1e-13);
  const Mesh& mesh = *s.topology()->mesh;
  CHECK(mesh.tetrahedra.size() == 6 * 24);
  CHECK(mesh.particles_of(mesh.surface("y_low")).size() == 20);
  const Felt pull = felt_by(Traction{.surface = "z_high", .traction = {0, 0, 2}}, s);
  Vec3<double> all = Vec3<double>::Zero();
  for (const Vec3<double>& f : pull.force) all += f;
  CHECK(norm2(Vec3<double>(all - Vec3<double>(0, 0, 6))) < 1e-26);
}

TEST_CASE("an element that is turned inside out is told by its number, flat ones are refused", "[hyperelastic]") {
  ParticleSystem<double> s = Block{.cells = {1, 1, 1}, .size = {1, 1, 1}, .density = 1}.build();
  s.positions().set(0, Vec3<double>(3, 3, 3));
  const Felt felt = felt_by(soft, s);
  REQUIRE(felt.failure);
  CHECK(felt.failure->kind == Outcome::Kind::inverted_element);
  CHECK_THAT(felt.failure->message, Catch::Contains("element 0 of 'node_0_0_0'"));
  Topology flat = *s.topology();
  auto mesh = std::make_shared<Mesh>(*flat.mesh);
  mesh->rest[0] = mesh->rest[7];
  flat.mesh = mesh;
  s.set_topology(std::make_shared<const Topology>(flat));
  CHECK_THROWS_WITH(check_force(soft, s), Catch::Contains("element 0 of the mesh is flat"));
  mesh->rest[0] = {0, 0, 0};
  mesh->triangles[3].particles[1] = 8;
  CHECK_THROWS_WITH(check_force(Traction{.surface = "z_high", .traction = {0, 0, 2}}, s),
                    Catch::Contains("triangle 3 of the mesh names particle 8, but there are 8"));
}

TEST_CASE("forces in lanes have the bits of elements one by one, with and without energy", "[hyperelastic]") {
  ParticleSystem<double> s =
      Block{.cells = {3, 2, 5}, .size = {1, 1, 1}, .density = 1, .stretch = {1.1, 0.95, 1.02}, .bend = 0.4}.build();
  const Index n = s.size();
  for (Index i = 0; i < n; ++i) s.positions().component(1)[i] += 0.01 * std::sin(static_cast<double>(7 * i));
  for (const HyperelasticForce& force : {soft, neo}) {
    VectorColumn<double> plain(n), with_energy(n);
    ForceSink<double> one(plain, s, {}), other(with_energy, s, {.energy = true});
    force.add_to(one, s);
    force.add_to(other, s);
    CHECK_FALSE(one.failure());
    CHECK(plain.all() == with_energy.all());
  }
}

// ---- the tumbling cube of shared figures ---------------------------------------------------------------------------

ParticleSystem<double> tumbling_cube() {
  return Block{
      .cells = {1, 1, 1}, .size = {1, 1, 1}, .density = 1, .stretch = {1.2, 0.9, 1.05}, .angular_velocity = {1, 0.3, 2}}
      .build();
}

TEST_CASE("the tumbling cube under Verlet comes to where it was computed to be", "[hyperelastic]") {
  const auto at_4 = [](double h) {
    return run(kinetic_potential(soft), *schemes::find("verlet"), tumbling_cube(), h, std::llround(4 / h));
  };
  const Vec3<double> coarse = at_4(0.01).positions()[0], fine = at_4(0.005).positions()[0];
  const Vec3<double> found = fine + (fine - coarse) / 3;
  CHECK(std::sqrt(norm2(
            Vec3<double>(found - Vec3<double>(-0.671841657621937, 0.29887924895386087, -0.3730148325708469)))) < 2e-6);
}

}  // namespace
}  // namespace noether
