/// Water by rotations and by constraints from one start: the same atoms, with the errors of each.

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "engine/charge.hpp"
#include "engine/make_rigid.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace noether {
namespace {

using test::turning;

/// Charges and Lennard-Jones between oxygens, of all pairs of two molecules at any distance: a user's force.
struct WaterPairs {
  static ForceClaims claims() { return {.exclusions = true}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    const auto& q = s.template column<Charge>();
    for (Index i = 0; i < s.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        if (s.topology()->is_special(j, i)) continue;
        const Vec3<Real> d = s.positions()[i] - s.positions()[j];
        const Real r2 = norm2(d), r = sqrt(r2);
        Real energy = Real(138.935458) * q[i] * q[j] / r, over = energy;  // - r dU/dr
        if (s.topology()->type(i) == 0 && s.topology()->type(j) == 0) {
          const Real x = Real(0.316557 * 0.316557) / r2, x6 = x * x * x;
          energy += Real(4 * 0.650194) * (x6 * x6 - x6);
          over += Real(24 * 0.650194) * (Real(2) * x6 * x6 - x6);
        }
        out.pair(i, j, Vec3<Real>(over / r2 * d));
        out.energy(energy);
      }
    }
  }
};

/// The dimer A of the studies as atoms. Reference by extrapolation in 28 to 40 digits
ParticleSystem<double> dimer() {
  ParticleSystem<double> s(unit_system("molecular"));
  const std::vector<double> x = {0.0,
                                 -0.0064605512288420015,
                                 0.0,
                                 0.081649043092011721276,
                                 0.051275345422711033983,
                                 0.0,
                                 -0.081649043092011721276,
                                 0.051275345422711033983,
                                 0.0,
                                 0.28646055122884200152,
                                 0.06,
                                 0.03,
                                 0.22872465457728896602,
                                 0.06,
                                 0.11164904309201172128,
                                 0.22872465457728896602,
                                 0.06,
                                 -0.051649043092011721276};
  const std::vector<double> v = {0.1193816536865260045725,    -0.05,
                                 -0.005842204915368006096665, -0.05382603626813310194914,
                                 0.1949471292760351638283,    0.7149956402429144635889,
                                 -0.05382603626813310194914,  -0.2949471292760351638283,
                                 -0.2647928768612261917245,   -0.1,
                                 0.03061834631347399542750,   0.02522385860189401066916,
                                 -0.6715433016440820489328,   0.6120712517281917083297,
                                 -0.3789274179589772378813,   0.4715433016440820489328,
                                 -0.2044191791919255044314,   -0.3789274179589772378813};
  Topology t;
  t.type_names = {"O", "H"};
  s.add_column<Charge>();
  for (Index i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(3 * i);
    const bool oxygen = i % 3 == 0;
    s.add(oxygen ? "O" : "H", oxygen ? 15.9994 : 1.00794, {x[k], x[k + 1], x[k + 2]}, {v[k], v[k + 1], v[k + 2]});
    s.column<Charge>()[i] = oxygen ? -0.8476 : 0.4238;
    t.types.push_back(oxygen ? 0 : 1);
    if (!oxygen) t.bonds.push_back({{i - i % 3, i}, 0});
  }
  t.scale_by_bonds(6, {0, 0, 0});
  s.set_topology(std::make_shared<const Topology>(std::move(t)));
  return s;
}

/// The largest error of a coordinate of an atom at 0.2 ps.
double error_of(const VectorColumn<double>& x) {
  static const std::vector<double> exact = {-0.08341812867196917597, -0.01865285646927580202, -0.002122201528734164723,
                                            -0.04753284927159890251, 0.02591289477900664537,  -0.08413525255132185866,
                                            -0.1733226300726064205,  -0.05765885346384951582, -0.02201473345310523341,
                                            0.3707046129880254922,   0.07541860588189248190,  0.04169809828959217572,
                                            0.3899231851019898813,   0.1550627215427760628,   -0.01563828916633452814,
                                            0.2752712656429819305,   0.04802167876337431798,  0.02978656610507153835};
  double worst = 0;
  for (Index i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(x[i][k] - exact[static_cast<std::size_t>(3 * i + k)]));
  }
  return worst;
}

double by_rotations(const std::string& scheme, double h, Rotor rotor = Rotor::exact) {
  Simulation sim(make_rigid(dimer()),
                 compose(turning(test::on_sites(WaterPairs{}), {.rotor = rotor}), *schemes::find(scheme)), h);
  REQUIRE(sim.run(std::lround(0.2 / h)).ok());
  return error_of(Sites<double>(sim.particles()).particles().positions());
}

double by_rattle(double h) {
  ParticleSystem<double> s = dimer();
  ConstraintSet set;
  for (const Index o : {0, 3}) {
    set.add(s, Distance{}, {o, o + 1});
    set.add(s, Distance{}, {o, o + 2});
    set.add(s, Distance{}, {o + 1, o + 2});
  }
  Simulation sim(s, compose(KineticPotential(WaterPairs{}, set), schemes::verlet), h);
  REQUIRE(sim.run(std::lround(0.2 / h)).ok());
  return error_of(sim.particles().positions());
}

}  // namespace

TEST_CASE("molecules become bodies that begin as their atoms did", "[integrators][rigid_water]") {
  const ParticleSystem<double> atoms = dimer(), bodies = make_rigid(atoms);
  REQUIRE(bodies.size() == 2);
  CHECK(bodies.bodies()->kinds.size() == 1);
  const Sites<double> sites(bodies);
  for (Index i = 0; i < 6; ++i) {
    CHECK((sites.particles().positions()[i] - atoms.positions()[i]).norm() < 1e-15);
    CHECK(sites.particles().topology()->type(i) == atoms.topology()->type(i));
    CHECK(sites.particles().column<Charge>()[i] == atoms.column<Charge>()[i]);
  }
  CHECK(std::abs(turning_energy_of(bodies) + kinetic_energy(bodies) - kinetic_energy(atoms)) < 1e-12);
  VectorColumn<double> a(2);
  ForceSink<double> sink(a, bodies, {.energy = true});
  test::on_sites(WaterPairs{}).add_to(sink, bodies);
  CHECK(std::abs(sink.potential() - 18.9158098296200670684) < 1e-12);
  // In a box, and with another molecule that is bent.
  ParticleSystem<double> bent = dimer();
  bent.positions().add(4, {0.02, 0, 0});
  CHECK_THROWS_WITH(make_rigid(bent), Catch::Matchers::Contains("has another shape than the first of its kind"));
  ParticleSystem<double> wrapped = dimer();
  wrapped.set_box(Box::periodic({3, 3, 3}));
  const Sites<double> again{make_rigid(wrapped)};
  for (Index i = 0; i < 6; ++i) {
    CHECK((again.particles().unwrapped(i) - wrapped.unwrapped(i)).norm() < 1e-14);
  }
}

TEST_CASE("two waters have the errors of rotations and of constraints", "[integrators][rigid_water]") {
  const auto near = [](double found, double figure) { return std::abs(found / figure - 1) < 0.03; };
  CHECK(near(by_rotations("verlet", 0.002), 2.351e-3));
  CHECK(near(by_rotations("verlet", 0.001), 5.865e-4));
  CHECK(near(by_rotations("verlet", 0.002, Rotor::axes), 2.396e-3));
  CHECK(near(by_rotations("verlet", 0.001, Rotor::axes), 5.981e-4));
  CHECK(near(by_rotations("blanes_moan_s6", 0.004), 2.867e-6));
  CHECK(near(by_rotations("blanes_moan_s6", 0.002), 1.787e-7));
  CHECK(near(by_rotations("srkn14a", 0.008), 3.315e-7));
  CHECK(near(by_rotations("srkn14a", 0.2 / 35), 1.002e-8));
  CHECK(near(by_rattle(0.002), 8.031e-3));
  CHECK(near(by_rattle(0.001), 1.924e-3));
}

}  // namespace noether
