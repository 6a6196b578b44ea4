// Springs: bonds, tethers, and the chain of Fermi, Pasta and Ulam, against gradients and closed forms.

#include "forces/springs.hpp"

#include "engine/simulation.hpp"
#include "forces/anharmonic_chain.hpp"
#include "forces/check_gradient.hpp"
#include "forces/fermi_pasta_ulam.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {
namespace {

using namespace noether::test;

template <class Real, class F> VectorColumn<Real> accelerations(const F& force, const ParticleSystem<Real>& s) {
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, s, {});
  force.add_to(sink, s);
  return a;
}

const HarmonicBond bonds{.k = 2.5, .length = 0.7, .tied = {{0, 1}, {1, 3}, {2, 0}}};
const Tether tethers{.point = {0.3, -1, 2}, .k = 1.5, .length = 0.4, .tied = {{0}, {2}}};

TEST_CASE("springs are minus the gradients of their energies, with and without a rest length", "[springs]") {
  const auto s = four_bodies();
  CHECK(gradient_error(bonds, s) < 1e-20);
  CHECK(gradient_error(tethers, s) < 1e-20);
  HarmonicBond slack = bonds;
  slack.length = 0;
  CHECK(gradient_error(slack, s) < 1e-20);
  CHECK(gradient_error(FermiPastaUlam{.k = 3, .quartic = 0.5}, s) < 1e-20);
  CHECK(gradient_error(AnharmonicChain{.k = 3, .cubic = -0.7, .quartic = 0.5}, s) < 1e-20);
}

TEST_CASE("bonds keep momentum and angular momentum, and reach the particles they tie only", "[springs]") {
  const auto s = four_bodies().as<Quad>();
  HarmonicBond one{.k = 3, .length = 1, .tied = {{0, 2}}};
  const auto a = accelerations(one, s), all = accelerations(bonds, s);
  CHECK(norm2(a[1]) == Quad(0));
  CHECK(norm2(a[3]) == Quad(0));
  CHECK(norm2(a[0]) > Quad(0));
  Vec3<Quad> force = Vec3<Quad>::Zero(), torque = Vec3<Quad>::Zero();
  for (Index i = 0; i < s.size(); ++i) {
    force += s.masses()[i] * all[i];
    torque += cross(s.positions()[i], Vec3<Quad>(s.masses()[i] * all[i]));
  }
  CHECK(std::sqrt(static_cast<double>(norm2(force))) < 1e-32);
  CHECK(std::sqrt(static_cast<double>(norm2(torque))) < 1e-32);
  CHECK_FALSE(tethers.claims().keeps_momentum);
  CHECK_FALSE(tethers.claims().keeps_angular_momentum);
  CHECK(Tether{.k = 1}.claims().keeps_angular_momentum);
}

TEST_CASE("springs in a periodic box hold the nearest images, wherever the box is cut", "[springs]") {
  // The same particles, the box cut at many places: forces and energies are those of open space.
  const auto open = four_bodies();
  const auto [low, high] = std::minmax_element(open.positions().component(0), open.positions().component(0) + 4);
  double reach = *high - *low;
  for (int k = 0; k < 3; ++k) {
    for (Index i = 0; i < 4; ++i) reach = std::max(reach, std::abs(open.positions()[i][k] - tethers.point[k]));
  }
  const auto edges = Vec3<double>(5 * reach, 4 * reach, 6 * reach);
  const Sum springs(bonds, tethers);
  VectorColumn<double> expected(4), felt(4);
  ForceSink<double> sink(expected, open, {.energy = true});
  springs.add_to(sink, open);
  for (int cut = 0; cut < 20; ++cut) {
    const Vec3<double> aside = 0.05 * cut * edges;
    ParticleSystem<double> s = open;
    Tether there = tethers;
    for (int k = 0; k < 3; ++k) {
      there.point[k] += aside[k];
      for (Index i = 0; i < 4; ++i) s.positions().component(k)[i] += aside[k];
    }
    s.set_box(Box::periodic(edges));
    ForceSink<double> here(felt, s, {.energy = true});
    Sum(bonds, there).add_to(here, s);
    CHECK(std::abs(here.potential() / sink.potential() - 1) < 1e-12);
    for (Index i = 0; i < 4; ++i) {
      CHECK(norm2(Vec3<double>(std::as_const(felt)[i] - std::as_const(expected)[i])) <
            1e-24 * norm2(std::as_const(expected)[i]));
    }
  }
  CHECK_FALSE(claims_of(springs).virial);
  CHECK(claims_of(bonds).virial);
}

TEST_CASE("a bond without rest length is finite where its particles meet", "[springs]") {
  ParticleSystem<double> s;
  s.add("a", 1, {1, 1, 1}, {0, 0, 0});
  s.add("b", 1, {1, 1, 1}, {0, 0, 0});
  CHECK(accelerations(HarmonicBond{.k = 2, .tied = {{0, 1}}}, s)[0].allFinite());
  CHECK_FALSE(accelerations(HarmonicBond{.k = 2, .length = 1, .tied = {{0, 1}}}, s)[0].allFinite());
}

TEST_CASE("the stiff pairs of Fermi, Pasta and Ulam feel the potential of the literature", "[springs]") {
  // x_0i = (q_2i + q_2i-1)/sqrt 2, x_1i = (q_2i - q_2i-1)/sqrt 2; U as printed in these coordinates.
  const double omega = 50, r = std::sqrt(0.5);
  const double x0[3] = {1, 0.2, -0.4}, x1[3] = {0.02, -0.01, 0.005};
  ParticleSystem<double> s;
  for (int i = 0; i < 3; ++i) {
    s.add("a" + std::to_string(i), 1, {r * (x0[i] - x1[i]), 0, 0}, {0, 0, 0});
    s.add("b" + std::to_string(i), 1, {r * (x0[i] + x1[i]), 0, 0}, {0, 0, 0});
  }
  double expected = std::pow(x0[0] - x1[0], 4) + std::pow(x0[2] + x1[2], 4);
  for (int i = 0; i < 2; ++i) expected += std::pow(x0[i + 1] - x1[i + 1] - x0[i] - x1[i], 4);
  expected /= 4;
  for (const double x : x1) expected += omega * omega * x * x / 2;
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true});
  FermiPastaUlam{.k = omega * omega / 2}.add_to(sink, s);
  CHECK(std::abs(sink.potential() / expected - 1) < 1e-13);
}

TEST_CASE("what a spring ties is part of its signature", "[springs]") {
  HarmonicBond other = bonds;
  other.tied[1] = {1, 2};
  CHECK(detail::signature_of(bonds) != detail::signature_of(other));
  CHECK(detail::signature_of(tethers) == "tether(point = [0.3, -1, 2], k = 1.5, length = 0.4, tied = [[0][2]])");
}

TEST_CASE("springs hold the particles they were given when others are taken out of a run", "[springs]") {
  const auto simulation = [](const ParticleSystem<double>& s, const HarmonicBond& bond, const Tether& tether) {
    return Simulation<double>(s, compose(test::kinetic_potential(bond, tether), schemes::verlet), 0x1p-6);
  };
  ParticleSystem<double> s = four_bodies();
  auto run = simulation(s, {.k = 2, .length = 1, .tied = {{1, 3}}}, {.k = 1, .tied = {{3}}});
  run.edit([](ParticleSystem<double>& all) { all.remove(0); });
  run.edit([](ParticleSystem<double>& all) { all.remove(1); });
  s.remove(0);
  s.remove(1);
  auto alone = simulation(s, {.k = 2, .length = 1, .tied = {{0, 1}}}, {.k = 1, .tied = {{1}}});
  REQUIRE(run.run(100).ok());
  REQUIRE(alone.run(100).ok());
  for (Index i = 0; i < 2; ++i) CHECK(run.particles().positions()[i] == alone.particles().positions()[i]);
}

TEST_CASE("a spring to a particle that is not there is refused", "[springs][messages]") {
  const auto bound = [](const HarmonicBond& bond) {
    return Simulation<double>(four_bodies(), compose(test::kinetic_potential(bond), schemes::verlet), 0x1p-6);
  };
  CHECK_THROWS_WITH(bound({.k = 1, .tied = {{0, 4}}}),
                    "particle 4 is tied, but there are only 4 particles, counted from 0; give one of them");
  auto run = bound({.k = 1, .tied = {{1, 3}}});
  CHECK_THROWS_WITH(run.edit([](ParticleSystem<double>& all) { all.remove(1); }),
                    "the particle with id 1 is tied to others or to a place, but has been taken out; keep it");
}

TEST_CASE("a spring with a negative length is refused", "[springs]") {
  CHECK_THROWS_AS(check_part(HarmonicBond{.k = 1, .length = -1}), Error);
  CHECK_THROWS_AS(check_part(Tether{.k = 1, .length = NAN}), Error);
}

}  // namespace
}  // namespace noether
