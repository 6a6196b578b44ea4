/// How far sums over a lattice of charges are from Ewald's: what `evaluate --check` tells.

#include "forces/lattice_accuracy.hpp"
#include "forces/check_gradient.hpp"
#include "forces/coulomb.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/pair_forces.hpp"

#include <cmath>
#include <numeric>
#include <tuple>

namespace noether {

TEST_CASE("forces on single charges in 113 bits are those of Ewald's sum, with pairs left out and a net charge",
          "[forces][charges]") {
  for (const auto& s : {test::with_special_pairs(test::charged_liquid(2, 0.75)), test::charged_liquid(1)}) {
    CAPTURE(s.size());
    std::vector<Index> all(static_cast<std::size_t>(s.size()));
    std::iota(all.begin(), all.end(), Index(0));
    // Another alpha, another cutoff, other loops: the sum that runs use, in doubles.
    const test::Evaluated other =
        test::evaluated<double>(AnyForce<double>(Ewald{.cutoff = 2.4, .relative_error = 1e-13}), s);
    const std::vector<Vec3<double>> exact = detail::exact_lattice_forces(s, all, 1e-13);
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const auto at = static_cast<Index>(i);
      worst = std::max(worst, (exact[i] / s.masses()[at] - Vec3<double>(other.a[at])).norm());
    }
    CHECK(worst < 1e-11);
  }
}

TEST_CASE("six settings reach the error that is asked of them, as their own report tells", "[forces][charges]") {
  for (const auto& [cells, order, error, cutoff] : {std::tuple<int, int, double, double>{2, 4, 1e-2, 1.5},
                                                    {2, 4, 1e-3, 1.8},
                                                    {4, 5, 1e-4, 2.2},
                                                    {3, 6, 1e-5, 2.2},
                                                    {2, 7, 1e-6, 2.2},
                                                    {3, 8, 1e-7, 2.5}}) {
    const ParticleSystem<double> s = test::charged_liquid(cells);
    const double scale = s.units().coulomb_constant * std::pow(0.8, 2.0 / 3);  // C <q^2> (n/V)^(2/3)
    const AnyForce<double> force(ParticleMeshEwald{.cutoff = cutoff, .relative_error = error, .order = order});
    const std::optional<LatticeAccuracy> told = lattice_accuracy(force, s);
    REQUIRE(told);
    CAPTURE(order, error, told->reached, told->expected);
    CHECK(told->asked == error);
    CHECK(told->order == order);
    CHECK(told->charged == s.size());
    CHECK(told->sampled == (cells == 4 ? 64 : s.size()));
    CHECK(told->expected <= 1.01 * error);
    CHECK(told->reached < 2 * error);
    CHECK(told->reached > error / 2);
    // The same error by all charges, from a sum in doubles that has other parameters.
    const auto exact = test::evaluated<double>(AnyForce<double>(Ewald{.cutoff = 2.5, .relative_error = 1e-13}), s);
    const auto mesh = test::evaluated<double>(force, s);
    const double all = std::sqrt((mesh.a.all() - exact.a.all()).squaredNorm() / static_cast<double>(s.size())) / scale;
    // A sample of 64 in no order knows it to 1/sqrt(2 x 192) of itself: three of these.
    CHECK(std::abs(told->reached / all - 1) < (cells == 4 ? 0.16 : 1e-4));
  }
}

TEST_CASE("a sum over waves tells the same, and forces that are none tell nothing", "[forces][charges]") {
  ParticleSystem<double> s = test::charged_liquid(2);
  const auto waves = lattice_accuracy(AnyForce<double>(Ewald{.cutoff = 1.6, .relative_error = 1e-4}), s);
  REQUIRE(waves);
  CHECK(waves->order == 0);
  CHECK(*waves->kmax > 0);
  CHECK(waves->reached < 2e-4);
  CHECK(waves->reached > 5e-5);
  const AnyForce<double> mesh(ParticleMeshEwald{.cutoff = 1.6});
  CHECK(lattice_accuracy(mesh, s));
  CHECK_FALSE(lattice_accuracy(AnyForce<double>(Coulomb{}), s));
  for (Index i = 0; i < s.size(); ++i) s.column<Charge>()[i] = 0;
  CHECK_FALSE(lattice_accuracy(mesh, s));
}

TEST_CASE("the slopes of a mesh are asked of its own energy, not of the sum that is its truth", "[forces][charges]") {
  // A mesh of four points along each axis is far from Ewald's sum, and still the slope of its energy.
  const ParticleSystem<double> s = test::charged_liquid(1);
  const ParticleMeshEwald coarse{.cutoff = 1.4, .order = 4, .alpha = 2.4, .mesh_spacing = 0.9};
  CHECK(lattice_accuracy(AnyForce<double>(coarse), s)->reached > 1e-2);
  const double error = gradient_error(AnyForce<double>(coarse), s);
  CHECK(error < 1e-5);
  CHECK(error > 1e-14);  // doubles were asked, of which 113 bits would be far better
}

}  // namespace noether
