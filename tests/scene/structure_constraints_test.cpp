/// Scenes whose constraints find their particles in a structure: how many, and which bonded terms go.

#include "engine/topology.hpp"
#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace noether::test {
namespace {

Scene good(const std::string& name) {
  return load_scene(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/scenes/good" / name);
}

Vec3<double> apart(const ParticleSystem<double>& s, Index i, Index j) {
  return s.box().minimum_image(Vec3<double>(s.positions()[j] - s.positions()[i]));
}

double term(const Scene& scene, const std::string& name) {
  for (const auto& [known, energy] : evaluate(scene).terms) {
    if (known == name) return energy;
  }
  FAIL("there is no term " << name);
  return 0;
}

TEST_CASE("bonded terms that constraints hold have no energy, and all others are there", "[scene][molecules]") {
  const Scene scene = good("hydrogen_bonds.toml"), hexane = good("bonds_and_angles.toml");
  CHECK(constraints_of(scene).equations() == 80);
  CHECK(constraints_of(hexane).equations() == 8 * 9);
  // Bonds of 1.09 angstrom are at their minimum, so that the sum of all terms shows no difference; moved apart it does.
  const auto energy = [](const Scene& of, double stretch, bool held) {
    ParticleSystem<double> s = of.particles;
    if (!held) {
      Topology topology = *s.topology();
      topology.rigid.clear();
      s.set_topology(std::make_shared<const Topology>(std::move(topology)));
    }
    for (const BondedTerm<2>& bond : s.topology()->bonds) {
      const auto [i, j] = bond.particles;
      if (i == 0 && j == 4) {
        s.positions().set(j, Vec3<double>(s.positions()[j] + stretch * apart(s, i, j).normalized()));
      }
    }
    Scene changed = of;
    changed.particles = std::move(s);
    return term(changed, "bonded");
  };
  const double stretch = 0.001, k = 2 * 340.0 * 418.4;
  CHECK(std::abs(energy(scene, 0, true) - energy(scene, 0, false)) < 1e-9);
  const double gained = energy(scene, stretch, false) - energy(scene, stretch, true);
  CHECK(std::abs(gained / (k * stretch * stretch / 2) - 1) < 1e-6);
  CHECK(std::abs(term(hexane, "bonded")) < 1e-10);  // in trans: only dihedrals are left, and these are at their minimum
}

}  // namespace
}  // namespace noether::test
