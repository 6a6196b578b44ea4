/// The shadow Hamiltonian of charges in magnetic fields, whose momenta are m v + q A.

#include "tests/support/charges.hpp"
#include "forces/external_fields.hpp"
#include "integrators/k_symplectic.hpp"
#include "tests/shadow/support.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

using namespace noether;
using Catch::Matchers::StartsWith;

namespace {

template <class Real> using Lines = KSymplectic<ForceField<Real>, Real>;

template <class Real, class... Forces> Lines<Real> lines(const Forces&... added) {
  ForceField<Real> forces;
  (forces.add(added), ...);
  return Lines<Real>(forces);
}

/// The field of a solenoid that tells no A.
struct Bare {
  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& /*x*/, FieldValues<Real>& field) const {
    field.B[2] = Real(1);
  }
  static constexpr ElectromagneticClaims field_claims() { return {.vector_potential = false}; }
  static constexpr auto describe() { return part<Bare>("bare", "a solenoid"); }
};

/// The ring field with half of its A.
struct HalfPotential : test::RingField {
  template <class Real> void at(const Real& t, const Vec3<Real>& x, FieldValues<Real>& field) const {
    test::RingField::at(t, x, field);
    field.A /= Real(2);
  }
};

/// Two charges of both signs and a neutral particle on the banana orbit of a tokamak.
ParticleSystem<double> in_tokamak() {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add_column<Charge>();
  const double charges[] = {1, -0.7, 0};
  for (int i = 0; i < 3; ++i) {
    s.add("", 1 + 0.4 * i, {1.1, 0.1 * i, 0.05}, {0.02, 0.03 - 0.02 * i, 0.025});
    s.column<Charge>()[i] = charges[i];
  }
  return s;
}

}  // namespace

TEST_CASE("the shadow of charges in a ring field is flat to order 12, over p = v + A", "[shadow][charges]") {
  // B = R e_z, E = 1e-2 x/R^3 (HeEtAl2015). Fluctuations in units of energy for steps of 0.5 and 0.25, to order 12: an
  // independent program of 40 digits found 4.06e-6, 2.68e-7; 8.08e-8, 3.42e-10; 2.36e-9, 6.58e-13.
  const double expected[2][3] = {{4.06e-6, 8.08e-8, 2.36e-9}, {2.68e-7, 3.42e-10, 6.58e-13}};
  const ParticleSystem<double> start = test::one_charge({0, -1, 0}, {0.1, 0.01, 0});
  const double H = 0.5 * (0.1 * 0.1 + 0.01 * 0.01) + 0.01;
  std::vector<double> found[2];
  for (const int half : {0, 1}) {
    const auto shadow = test::shadow_of(compose(lines<Quad>(InField(test::RingField{})), schemes::verlet), start,
                                        half == 0 ? 0.5 : 0.25, half == 0 ? 300 : 600, {4, 8, 12});
    CHECK_THAT(shadow.verdict(), StartsWith("kept: order 12 fluctuates by "));
    for (std::size_t k = 0; k < 3; ++k) {
      found[half].push_back(H * shadow.fluctuation(k));
      CAPTURE(half, k, found[half][k]);
      CHECK(std::abs(found[half][k] / expected[half][k] - 1) < 0.04);
    }
  }
  const double order[] = {4, 8, 12};
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(std::log2(found[0][k] / found[1][k]) - order[k]) < 0.3);
}

TEST_CASE("a scheme of order 4 over charges has its shadow nearer to the energy", "[shadow][charges]") {
  const ParticleSystem<double> start = test::one_charge({0, -1, 0}, {0.1, 0.01, 0});
  const auto shadow =
      test::shadow_of(compose(lines<Quad>(InField(test::RingField{})), schemes::yoshida_4), start, 0.25, 200, {8, 12});
  const double H = 0.5 * (0.1 * 0.1 + 0.01 * 0.01) + 0.01;
  // The same independent program: 3.31e-10 and 6.18e-13.
  CHECK(std::abs(H * shadow.fluctuation(0) / 3.31e-10 - 1) < 0.1);
  CHECK(std::abs(H * shadow.fluctuation(1) / 6.18e-13 - 1) < 0.1);
}

TEST_CASE("the shadow of charges in space, of both signs, under another force too", "[shadow][charges]") {
  const auto slopes = [](const auto& hamiltonian) {
    const auto coarse = test::shadow_of(compose(hamiltonian, schemes::verlet), in_tokamak(), 0.2, 100, {4, 8});
    const auto fine = test::shadow_of(compose(hamiltonian, schemes::verlet), in_tokamak(), 0.1, 200, {4, 8});
    return std::vector{std::log2(coarse.fluctuation(0) / fine.fluctuation(0)),
                       std::log2(coarse.fluctuation(1) / fine.fluctuation(1))};
  };
  const auto found = slopes(lines<Quad>(InField(Tokamak{}), HarmonicField{.k = 0.02}));
  CHECK(std::abs(found[0] - 4) < 0.2);
  CHECK(std::abs(found[1] - 8) < 0.3);
  // In doubles, a quadrupole beside the magnetic field.
  const auto held =
      test::shadow_of(compose(lines<double>(InField(PenningTrap{.B0 = 5, .gradient = 2})), schemes::verlet),
                      test::one_charge({0.3, 0.1, 0.2}, {0.1, 0.2, -0.1}), 0.02, 1000, test::shadow_orders);
  CAPTURE(held.verdict());
  CHECK(held.verdict().starts_with("kept"));
}

TEST_CASE("what breaks the symplectic form of charges shows in their shadow", "[shadow][charges]") {
  const ParticleSystem<double> start = test::one_charge({0, -1, 0}, {0.1, 0.01, 0});
  ForceField<double> ring;
  ring.add(InField(test::RingField{}));
  const auto fluctuation = [&](std::int64_t nodes) {
    return test::shadow_of(compose(KSymplectic<ForceField<double>>(ring, {.nodes = nodes}), schemes::verlet), start,
                           0.25, 1000, {8})
        .fluctuation(0);
  };
  CHECK(fluctuation(1) > 30 * fluctuation(8));  // quadrature too coarse for int B dx
  const auto wrong = test::shadow_of(compose(lines<double>(InField(HalfPotential{})), schemes::verlet), start, 0.25,
                                     1000, test::shadow_orders);
  CAPTURE(wrong.verdict());
  CHECK_FALSE(wrong.verdict().starts_with("kept"));
}

TEST_CASE("charges under the eyes of their shadow end in the same bits", "[shadow][charges]") {
  const auto end = [](bool watched, std::int64_t every) {
    Simulation run(in_tokamak(), compose(lines<double>(InField(Tokamak{})), schemes::yoshida_4), 0.1);
    if (watched) run.every(every, ShadowHamiltonian<double>({4, 8}));
    REQUIRE(run.run(60).ok());
    return std::pair(run.particles(), run.evaluations().force);
  };
  const auto bare = end(false, 1);
  for (const std::int64_t every : {1, 20}) {
    const auto watched = end(true, every);
    CHECK(test::same_bits(bare.first, watched.first));
    CHECK(bare.second == watched.second);
  }
}

TEST_CASE("a shadow of charges is refused by name where no momenta are known", "[shadow][charges]") {
  const auto attach = [](auto integrator) {
    Simulation run(in_tokamak(), std::move(integrator), 0.1);
    run.every(1, ShadowHamiltonian<double>());
  };
  CHECK_THROWS_WITH(attach(compose(lines<double>(InField(Tokamak{}), InField(Bare{})), schemes::verlet)),
                    "monitor 'shadow_hamiltonian' needs the action of every step: the field 'bare' has no vector "
                    "potential, so momenta m v + q A are not known");
  CHECK_NOTHROW(attach(compose(lines<double>(InField(Tokamak{})), schemes::verlet)));
  CHECK_THROWS_WITH(attach(compose(test::in_field(Tokamak{}, {.rotation = Rotation::boris}), schemes::verlet_aba)),
                    "monitor 'shadow_hamiltonian' needs the action of every step: no Hamiltonian has its kicks, which "
                    "turn velocities, as a flow, so the motion has no action");
}
