// Constraints in a periodic box: molecules across its faces.

#include "constraints/angle.hpp"
#include "constraints/constraint_residual.hpp"
#include "forces/sum.hpp"
#include "integrators/langevin.hpp"
#include "monitors/monitors.hpp"
#include "monitors/pressure.hpp"
#include "monitors/temperature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/molecules.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {
namespace {

using namespace noether::test;

constexpr double edge = 5.5;  // shifts by eighths of it lie on its grid
const Vec3<double> shifts[] = {{edge / 2, 0, 0}, {edge / 8, 3 * edge / 8, -edge / 4}, {0, -edge / 2, 7 * edge / 8}};

/// The settled particles of a liquid after some steps.
ParticleSystem<double> flow(const MolecularLiquid& liquid, const Scheme& scheme, double dt, std::int64_t steps) {
  return run(liquid, scheme, dt, steps, sites);
}

TEST_CASE("molecules across the faces of a box are held wherever it is cut: the same bits", "[constraints][periodic]") {
  const MolecularLiquid liquid = molecular_liquid(3, edge);
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4}) {
    const auto straight = flow(liquid, *scheme, 0.004, 60);
    CHECK(difference(straight, liquid.particles, Vec3<double>::Zero()) > 0.1);
    for (const Vec3<double>& aside : shifts) {
      CHECK(difference(flow(cut_elsewhere(liquid, aside), *scheme, 0.004, 60), straight, aside) == 0);
    }
    // Atoms wrapped one by one, as files without images have them.
    CHECK(difference(flow(without_images(liquid), *scheme, 0.004, 60), straight, Vec3<double>::Zero()) == 0);
  }
  const MolecularLiquid swept = molecular_liquid(3, edge, {.solver = ConstraintMethod::rattle, .tolerance = 1e-4});
  CHECK(difference(flow(cut_elsewhere(swept, shifts[1]), schemes::verlet, 0.004, 60),
                   flow(swept, schemes::verlet, 0.004, 60), shifts[1]) == 0);
  // Elsewhere than on the grid: to rounding.
  const Vec3<double> aside(0.3, 1.7, 4.1);
  CHECK(difference(flow(cut_elsewhere(liquid, aside), schemes::verlet, 0.004, 60),
                   flow(liquid, schemes::verlet, 0.004, 60), aside) < 1e-12);
}

TEST_CASE("what a constraint takes from the start does not depend on where the box is cut", "[constraints][periodic]") {
  const MolecularLiquid liquid = molecular_liquid(3, edge);
  const auto taken = [&](const ParticleSystem<double>& s) {
    ConstraintSet set;
    for (const std::vector<Index>& molecule : liquid.molecules) {
      set.add(s, Distance{}, {molecule[0], molecule[1]});
      if (molecule.size() == 3) set.add(s, Distance{}, {molecule[1], molecule[2]});
      if (molecule.size() == 3 && set.groups().size() < 3) set.add(s, Angle{}, {molecule[0], molecule[1], molecule[2]});
    }
    return set.signature();
  };
  const std::string whole = taken(liquid.particles);
  for (const Vec3<double>& aside : shifts) {
    CHECK(taken(cut_elsewhere(liquid, aside).particles) == whole);
    CHECK(taken(without_images(cut_elsewhere(liquid, aside)).particles) == whole);
  }
}

TEST_CASE("free molecules move in a box as they do in open space", "[constraints][periodic]") {
  const MolecularLiquid liquid = molecular_liquid(2, 4.0);
  Mechanism open{ParticleSystem<double>(), liquid.constraints};
  const ParticleSystem<double>& s = liquid.particles;
  for (Index i = 0; i < s.size(); ++i) open.particles.add(s.name(i), s.masses()[i], s.unwrapped(i), s.velocities()[i]);
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::rattle}) {
    const MolecularLiquid solved = molecular_liquid(2, 4.0, {.solver = solver, .tolerance = 1e-13});
    const auto expected = run(open, schemes::verlet, 0.02, 300, ForceField<double>());
    const auto found = run(solved, schemes::verlet, 0.02, 300, ForceField<double>());
    double worst = 0, crossed = 0;
    for (Index i = 0; i < s.size(); ++i) {
      worst = std::max(worst, std::sqrt(norm2(Vec3<double>(found.unwrapped(i) - expected.positions()[i]))));
      crossed = std::max(crossed, std::abs(static_cast<double>(found.images().component(0)[i])));
    }
    CHECK(worst < 1e-10);
    CHECK(crossed >= 1);
  }
}

template <class Real> void check_stages(const MolecularLiquid& liquid, int steps) {
  auto hamiltonian = hamiltonian_of<Real>(liquid, sites);
  ParticleSystem<Real> s = liquid.particles.as<Real>();
  s.clock() = Clock<Real>::fixed(0, 0.004);
  hamiltonian.bind(s);
  const double u = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
  for (int k = 0; k < steps; ++k) {
    for (const char letter : {'B', 'A'}) {
      hamiltonian.flow(letter, s, Real(0.004));
      REQUIRE(!hamiltonian.failure());
      REQUIRE(liquid.constraints.worst(s).residual <= 10 * u * edge);
      REQUIRE(velocity_across(liquid.constraints, s) <= 8 * u * edge);
    }
  }
}

TEST_CASE("in a box positions and velocities are on the constraints to rounding", "[constraints][periodic]") {
  check_stages<double>(molecular_liquid(3, edge), 200);
  check_stages<Quad>(molecular_liquid(2, edge), 3);
}

TEST_CASE("in a box doubles go where 113 bits go", "[constraints][periodic]") {
  const MolecularLiquid liquid = molecular_liquid(2, edge);
  const auto exact = run<Quad>(liquid, schemes::verlet, 0.004, 30, sites);
  const auto found = flow(liquid, schemes::verlet, 0.004, 30);
  double worst = 0;
  for (Index i = 0; i < found.size(); ++i) {
    const Vec3<Quad> x = exact.unwrapped(i);
    const Vec3<double> y = found.unwrapped(i);
    for (Index k = 0; k < 3; ++k) worst = std::max(worst, std::abs(static_cast<double>(x[k] - Quad(y[k]))));
  }
  CHECK(worst < 1e-13);
  CHECK(worst > 0);
}

TEST_CASE("bits of molecules in a box do not depend on threads, skins, who looks, or a save in between",
          "[constraints][periodic][restart]") {
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::rattle}) {
    const MolecularLiquid liquid = molecular_liquid(3, edge, {.solver = solver, .tolerance = 1e-6});
    const auto straight = flow(liquid, schemes::verlet, 0.004, 40);
    for (const int threads : {1, 2, 3, 4}) {
      const Threads so_many(threads);
      CHECK(same_bits(flow(liquid, schemes::verlet, 0.004, 40), straight));
    }
    for (const double skin : {0.05, 0.3, 1.5}) {
      const auto hamiltonian =
          kinetic_potential_over(field_of(sites), liquid.constraints, NeighborOptions{.skin = skin});
      Simulation<double> sim(liquid.particles, compose(hamiltonian, schemes::verlet), 0.004);
      REQUIRE(sim.run(40).ok());
      CHECK(same_bits(sim.particles(), straight));
    }
    const auto integrator = compose(hamiltonian_of(liquid, sites), schemes::verlet);
    Simulation<double> watched(liquid.particles, integrator, 0.004), second(liquid.particles, integrator, 0.004);
    watched.every(1, Energy{});
    watched.every(2, Pressure{});
    watched.every(3, Temperature{});
    REQUIRE(watched.run(17).ok());
    second.restore(watched.save());
    REQUIRE(second.run(23).ok());
    CHECK(same_bits(second.particles(), straight));
    CHECK((second.particles().images().all() - straight.images().all()).isZero());
  }
}

TEST_CASE("the energy of a molecular liquid fluctuates by the square of the step, and momentum stays",
          "[constraints][periodic]") {
  const MolecularLiquid liquid = molecular_liquid(3, edge);
  const auto rms = [&](const Scheme& scheme, double dt) {
    Simulation<double> sim(liquid.particles, compose(hamiltonian_of(liquid, sites), scheme), dt);
    auto& energy = sim.every_time(0.02, Energy{});
    const auto& residual = sim.every_time(0.02, ConstraintResidual{liquid.constraints});
    REQUIRE(sim.run(std::llround(2 / dt)).ok());
    CHECK(residual.worst() < 10 * 0x1p-53 * edge);
    Vec3<double> momentum = Vec3<double>::Zero();
    const ParticleSystem<double>& s = sim.particles();
    for (Index i = 0; i < s.size(); ++i) momentum += s.masses()[i] * s.velocities()[i];
    CHECK(std::sqrt(norm2(momentum)) < 1e-12);
    return *energy.report().rms;
  };
  const double coarse = rms(schemes::verlet, 0.004), fine = rms(schemes::verlet, 0.002);
  CHECK(coarse / fine > 3.8);
  CHECK(coarse / fine < 4.2);
  const double fourth = rms(schemes::yoshida_4, 0.004), finer = rms(schemes::yoshida_4, 0.002);
  CHECK(fourth / finer > 14);
  CHECK(fourth / finer < 18);
}

/// Accelerations of a liquid's particles by its pairs, as if nothing held them.
VectorColumn<double> felt(const ParticleSystem<double>& s, Mat3<double>* virial, double* energy) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true, .virial = true});
  sites.add_to(sink, s);
  *virial = sink.virial();
  *energy = sink.potential();
  return a;
}

/// The centre of mass of a molecule, relative to its first particle.
Vec3<double> center_of(const ParticleSystem<double>& s, const std::vector<Index>& molecule) {
  Vec3<double> sum = Vec3<double>::Zero();
  double mass = 0;
  for (const Index i : molecule) {
    const Vec3<double> d = s.positions()[i] - s.positions()[molecule.front()];
    sum += s.masses()[i] * s.box().minimum_image(d);
    mass += s.masses()[i];
  }
  return sum / mass;
}

TEST_CASE("the virial of atoms with that of constraints is the virial of rigid molecules", "[constraints][periodic]") {
  // sum m v^2 + sum x . (f + constraints) = sum M V^2 + sum X . F, as the moments of inertia of molecules stay.
  for (const Vec3<double>& aside : shifts) {
    const MolecularLiquid liquid = cut_elsewhere(molecular_liquid(3, edge), aside);
    Simulation<double> sim(liquid.particles, compose(hamiltonian_of(liquid, sites), schemes::verlet), 0.004);
    const auto& pressure = sim.every(50, Pressure{});
    REQUIRE(sim.run(50).ok());
    const ParticleSystem<double>& s = sim.particles();
    Mat3<double> atomic;
    double energy = 0;
    const VectorColumn<double> a = felt(s, &atomic, &energy);
    double expected = atomic.trace(), without = atomic.trace();
    for (const std::vector<Index>& molecule : liquid.molecules) {
      const Vec3<double> center = center_of(s, molecule);
      Vec3<double> momentum = Vec3<double>::Zero();
      double mass = 0;
      for (const Index i : molecule) {
        const Vec3<double> d = s.positions()[i] - s.positions()[molecule.front()];
        expected -= s.masses()[i] * dot(Vec3<double>(s.box().minimum_image(d) - center), std::as_const(a)[i]);
        momentum += s.masses()[i] * s.velocities()[i];
        mass += s.masses()[i];
        without += s.masses()[i] * norm2(s.velocities()[i]);
      }
      expected += norm2(momentum) / mass;
    }
    const double volume = s.box().volume();
    CHECK(std::abs(pressure.value() * 3 * volume / expected - 1) < 1e-11);
    CHECK(std::abs(without / expected - 1) > 0.1);  // the test of the test
  }
}

TEST_CASE("the pressure of rigid molecules is the work of widening the box", "[constraints][periodic]") {
  // - dU/dV at molecules moved with the box, each of them as it is: what the virial adds to sum M V^2 / 3 V.
  const MolecularLiquid liquid = molecular_liquid(3, edge, {}, 0);
  const auto energy_at = [&](double factor) {
    ParticleSystem<double> wide;
    for (const std::vector<Index>& molecule : liquid.molecules) {
      const ParticleSystem<double>& s = liquid.particles;
      const Vec3<double> center = s.unwrapped(molecule.front()) + center_of(s, molecule);
      for (const Index i : molecule) {
        const Vec3<double> d = s.unwrapped(i) - center;
        wide.add(s.name(i), s.masses()[i], factor * center + d, {0, 0, 0});
      }
    }
    wide.set_box(Box::periodic(Vec3<double>::Constant(factor * edge)));
    wide.set_topology(liquid.particles.shared_topology());
    Mat3<double> virial;
    double energy = 0;
    felt(wide, &virial, &energy);
    return energy;
  };
  Simulation<double> sim(liquid.particles, compose(hamiltonian_of(liquid, sites), schemes::verlet), 0.004);
  const auto& pressure = sim.every(1, Pressure{});
  REQUIRE(sim.run(0).ok());
  const double h = 1e-4,
               slope = (8 * (energy_at(1 + h) - energy_at(1 - h)) - (energy_at(1 + 2 * h) - energy_at(1 - 2 * h))) /
                       (12 * h);
  CHECK(std::abs(pressure.value() * 3 * std::pow(edge, 3) + slope) < 1e-8 * std::abs(slope));
}

TEST_CASE("an ideal gas of rigid molecules has the pressure of its molecules, in NVE and in a bath",
          "[constraints][periodic]") {
  const MolecularLiquid gas = molecular_liquid(4, edge);
  const KineticPotential<ForceField<double>, double, ConstraintSet> free(ForceField<double>(), gas.constraints);
  Simulation<double> sim(gas.particles, compose(free, schemes::verlet), 0.01);
  const auto& pressure = sim.every(1, Pressure{});
  const double volume = std::pow(edge, 3);
  for (int k = 0; k < 20; ++k) {
    REQUIRE(sim.run(5).ok());
    double translation = 0;
    for (const std::vector<Index>& molecule : gas.molecules) {
      Vec3<double> momentum = Vec3<double>::Zero();
      double mass = 0;
      for (const Index i : molecule) {
        momentum += sim.particles().masses()[i] * sim.particles().velocities()[i];
        mass += sim.particles().masses()[i];
      }
      translation += norm2(momentum) / mass;
    }
    CHECK(std::abs(pressure.value() * 3 * volume / translation - 1) < 1e-12);
  }
  // P V = N k_B T of N molecules, and the temperature of all degrees of freedom that are left.
  const double kT = 0.8;
  Simulation<double> bath(gas.particles,
                          compose(Langevin(free, {.temperature = kT, .friction = 4, .seed = 5}), word("BAOAB")), 0.02);
  const auto& warm = bath.every(20, Pressure{});
  const auto& temperature = bath.every(20, Temperature{});
  REQUIRE(bath.run(100).ok());
  REQUIRE(bath.run(8000).ok());
  const auto molecules = static_cast<double>(gas.molecules.size());
  CHECK(temperature.degrees_of_freedom() == 3 * bath.particles().size() - gas.constraints.equations());
  CHECK(std::abs(temperature.report().rms.value() / kT - 1) < 0.015);
  CHECK(std::abs(warm.mean() * volume / (molecules * kT) - 1) < 0.015);
}

TEST_CASE("bonds that reach half of an edge are refused, and those below are not", "[constraints][periodic][refusal]") {
  ParticleSystem<double> s;
  s.add("a", 1, {0.1, 0, 0}, {0, 0, 0});
  s.add("b", 1, {3.1, 0, 0}, {0, 0, 0});
  s.set_box(Box::periodic({5, 8, 9}));
  const auto bind = [&](const Distance& distance) {
    ConstraintSet set;
    set.add(s, distance, {0, 1});
    return refusal_of([&] {
      ParticleSystem<double> bound = s;
      ConstraintSolver<double>(set).bind(bound);
    });
  };
  CHECK(bind({3}) ==
        "distance of 'a' and 'b', 3 apart, reaches half of an edge of the periodic box, 2.5: the nearest images would "
        "no longer be the tied ones; enlarge the box");
  CHECK(bind({2.5}) != "");
  CHECK(bind({}) == "");  // the nearest images are 2 apart
  CHECK(bind({2}) == "");
}

TEST_CASE("a polymer that closes through a face of the box is held", "[constraints][periodic]") {
  Mechanism m;
  m.particles.set_box(Box::periodic({6, 7, 8}));
  for (int k = 0; k < 6; ++k) {
    m.particles.add(std::to_string(k), 1, {k + 0.5, 0.3 * (k % 2), 0.2 * (k % 3)}, {0.4, 0.1 * k, 0.2 * (k % 2)});
  }
  for (Index i = 0; i < 6; ++i) m.constraints.add(m.particles, Distance{}, {i, (i + 1) % 6});
  Simulation<double> sim(m.particles, compose(hamiltonian_of(m, ForceField<double>()), schemes::verlet), 0.01);
  const auto& residual = sim.every(10, ConstraintResidual{m.constraints});
  auto& energy = sim.every(10, Energy{});
  REQUIRE(sim.run(2000).ok());
  CHECK(residual.worst() < 40 * 0x1p-53);
  CHECK(*energy.report().worst < 1e-3);
  CHECK(sim.particles().images().component(0)[0] >= 1);
}

TEST_CASE("surfaces hold particles where they are unwrapped, and pressure says that they do not tell",
          "[constraints][periodic]") {
  MolecularLiquid m = molecular_liquid(2, 4.0);
  const Index held = m.molecules[1].front(), sliding = m.molecules[3].front();
  m.constraints.add(m.particles, Fixed{}, {held});
  m.constraints.add(m.particles, OnPlane{.normal = {0, 0, 1}}, {sliding});
  Simulation<double> sim(m.particles, compose(hamiltonian_of(m, sites), schemes::verlet), 0.004);
  const auto& residual = sim.every(10, ConstraintResidual{m.constraints});
  CHECK(refusal_of([&] { sim.every(1, Pressure{}); }) ==
        "monitor 'pressure' needs the virial, but a force or constraint of this run has none: what holds particles in "
        "place does not contribute to the pressure");
  REQUIRE(sim.run(2000).ok());
  CHECK(residual.worst() < 100 * 0x1p-53);
  const ParticleSystem<double>& s = sim.particles();
  CHECK(std::sqrt(norm2(Vec3<double>(s.unwrapped(held) - m.particles.unwrapped(held)))) < 1e-14);
  CHECK(std::abs(s.unwrapped(sliding)[2] - m.particles.unwrapped(sliding)[2]) < 1e-14);
  CHECK(std::abs(s.unwrapped(sliding)[0] - m.particles.unwrapped(sliding)[0]) > 0.1);
}

}  // namespace
}  // namespace noether
