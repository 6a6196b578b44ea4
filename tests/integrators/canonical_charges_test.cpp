/// Charges by their momenta m v + q A: the rates of H, orders, what is symplectic, kept and bounded, and bits.

#include "integrators/canonical_charges.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/grid_field.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "monitors/charges.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::banana_v;
using test::banana_x;
using test::ring_v;
using test::ring_x;
using test::trap;

const double half_turn = std::acos(-1.0);
const PlaneWave wave{.E0 = {0.6, 0, 0}, .direction = {0, 0, 1}, .omega = 2, .c = 1};

template <class Real, class Field> ForceField<Real> forces_of(const Field& field) {
  ForceField<Real> forces;
  forces.add(InField(field));
  return forces;
}
MethodChoice fixed(const char* name) {
  MethodChoice choice = method(name);
  if (choice.info->adaptive) choice.options.adaptive = false;
  return choice;
}
template <class Real, class Field> AnyIntegrator<Real> by_momenta(const Field& field, const char* name) {
  return Classical<Real>(std::make_unique<CanonicalCharges<Real>>(forces_of<Real>(field)), fixed(name));
}
template <class Real, class Field> AnyIntegrator<Real> by_velocities(const Field& field, const char* name) {
  return Classical<Real>(std::make_unique<ForceMotion<ForceField<Real>, Real>>(forces_of<Real>(field)), fixed(name));
}

/// The energy of one charge as one function of t, q and p.
template <class Field> struct EnergyOfCharge {
  Field field;
  double charge, mass;

  Index size() const { return 3; }
  static std::string name() { return "energy_of_charge"; }
  static constexpr bool time_dependent = true;
  template <class Real> Real value(const Real& t, const Vector<Real>& q, const Vector<Real>& p) const {
    FieldValues<Real> here;
    field.at(t, Vec3<Real>(q[0], q[1], q[2]), here);
    Real square(0);
    for (int k = 0; k < 3; ++k) square += (p[k] - Real(charge) * here.A[k]) * (p[k] - Real(charge) * here.A[k]);
    return square / Real(2 * mass) + Real(charge) * here.phi;
  }
};

template <class Field> double difference_of_rates(const Field& field) {
  constexpr double charge = -1.5, mass = 2, time = 0.7;
  const EnergyOfCharge<Field> energy{field, charge, mass};
  CanonicalCharges<double> charges(forces_of<double>(field));
  const auto s = test::one_charge({1.1, 0.2, -0.1}, {0.3, 0.5, 0.2}, charge, mass);
  charges.bind(s);
  Vector<double> y, rates, point(6), expected(6);
  charges.gather(s, y);
  charges.rate(time, y, rates);
  point << y.head(3), mass * y.tail(3);  // y has p over the largest mass
  CanonicalMotion<EnergyOfCharge<Field>, double> of_energy(energy);
  of_energy.bind(initial_state(energy, {1, 0, 0, 0, 0, 0}));
  of_energy.rate(time, point, expected);
  expected.tail(3) /= mass;
  CHECK(std::abs(charges.hamiltonian(time, y) - of_energy.hamiltonian(time, point) / mass) < 1e-14);
  return (rates - expected).cwiseAbs().maxCoeff();
}

/// Where a charge is at the end.
Vec3<Quad> end_of(const AnyIntegrator<Quad>& by, const Vec3<double>& x, const Vec3<double>& v, int steps, double time) {
  Simulation<Quad> sim(test::one_charge<Quad>(x, v), by, Clock<Quad>::fixed(0, time / steps));
  const Outcome outcome = sim.run(steps);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  return sim.particles().positions()[0];
}

using State = Eigen::Matrix<Quad, 6, 1>;

/// A step in x and p = v + A(x), in 113 bits.
template <class Field> State step(const AnyIntegrator<Quad>& by, const Field& field, const State& from, double h) {
  const auto A = [&](const Vec3<Quad>& x) {
    FieldValues<Quad> values;
    field.at(Quad(0), x, values);
    return values.A;
  };
  ParticleSystem<Quad> s = test::one_charge<Quad>({0, 0, 0}, {0, 0, 0});
  s.positions().set(0, from.head<3>());
  s.velocities().set(0, Vec3<Quad>(from.tail<3>() - A(from.head<3>())));
  Simulation<Quad> sim(std::move(s), by, Clock<Quad>::fixed(0, h));
  REQUIRE(sim.run(1).ok());
  State to;
  const Vec3<Quad> x = sim.particles().positions()[0], v = sim.particles().velocities()[0];
  to << x, Vec3<Quad>(v + A(x));
  return to;
}

/// Largest element of J^T W J - W of a step in canonical coordinates.
template <class Field> double defect(const AnyIntegrator<Quad>& by, const Field& field, double h) {
  State at;
  at << Quad(1.1), Quad(0.2), Quad(-0.1), Quad(0.3), Quad(0.5), Quad(0.2);
  const Quad e(1e-11);
  Eigen::Matrix<double, 6, 6> J, W = Eigen::Matrix<double, 6, 6>::Zero();
  for (int k = 0; k < 6; ++k) {
    State up = at, down = at;
    up[k] += e;
    down[k] -= e;
    const State slope = (step(by, field, up, h) - step(by, field, down, h)) / (Quad(2) * e);
    for (int i = 0; i < 6; ++i) J(i, k) = static_cast<double>(slope[i]);
  }
  for (int k = 0; k < 3; ++k) {
    W(k, k + 3) = 1;
    W(k + 3, k) = -1;
  }
  return (J.transpose() * W * J - W).cwiseAbs().maxCoeff();
}

/// A state, to be compared bit for bit.
std::vector<double> bits_of(Simulation<double>& sim) {
  const ParticleSystem<double>& s = sim.particles();
  std::vector<double> all;
  for (int k = 0; k < 3; ++k) {
    all.push_back(s.positions().component(k)[0]);
    all.push_back(s.velocities().component(k)[0]);
  }
  return all;
}

/// Where the charge is at a look, and how fast.
struct Diary {
  std::pair<Vec3<double>, Vec3<double>>* seen;
  void observe(const Snapshot<double>& now) const { *seen = {now.state().positions()[0], now.state().velocities()[0]}; }
};

/// A field whose A is another one's, and one that is written for doubles.
struct WrongPotential {
  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    field.B[2] = Real(1);
    field.A[1] = x[0] / Real(2);
  }
};
struct InDoubles {
  void at(const double& /*t*/, const Vec3<double>& x, FieldValues<double>& field) const {
    field.B[2] = 1;
    field.A[1] = x[0];
  }
};

}  // namespace

TEST_CASE("rates by momenta are those of H(t, q, p) as one function", "[integrators][charges]") {
  // The oracle differentiates |p - q A|^2/2m + q phi and sees neither E nor B.
  CHECK(difference_of_rates(test::RingField{}) < 1e-14);
  CHECK(difference_of_rates(Tokamak{.B0 = 1.3, .R0 = 0.9, .safety = 1.7}) < 1e-14);
  CHECK(difference_of_rates(MagneticDipole{.moment = {0.2, -0.3, 1}}) < 1e-14);
  CHECK(difference_of_rates(MagneticMirror{.B0 = 2, .radius = 2, .distance = 3}) < 1e-14);
  CHECK(difference_of_rates(PenningTrap{.B0 = 2, .gradient = 0.4}) < 1e-14);
  CHECK(difference_of_rates(GradientField{.B0 = 1, .gradient = 0.3}) < 1e-14);
  CHECK(difference_of_rates(UniformElectromagnetic{.E = {0.1, 0.2, 0.3}, .B = {0.4, -0.5, 1}}) < 1e-14);
  CHECK(difference_of_rates(wave) < 1e-14);
}

TEST_CASE("methods over momenta have their orders, in 113 bits", "[integrators][charges][slow]") {
  // The truth moves velocities, by another method at a tolerance of 1e-24.
  const auto end_by_velocities = [](const auto& field, const Vec3<double>& x, const Vec3<double>& v) {
    Simulation<Quad> truth(
        test::one_charge<Quad>(x, v),
        Classical<Quad>(std::make_unique<ForceMotion<ForceField<Quad>, Quad>>(forces_of<Quad>(field)),
                        method("gragg_bulirsch_stoer", {.rtol = 1e-24})),
        Clock<Quad>::free(0));
    REQUIRE(truth.run_until(2).ok());
    return Vec3<Quad>(truth.particles().positions()[0]);
  };
  struct Row {
    const char* method;
    int order, steps;
  };
  const auto slope = [&](const auto& field, const Vec3<double>& x, const Vec3<double>& v, const Vec3<Quad>& truth,
                         const Row& row) {
    std::array<double, 2> errors{};
    for (const int halved : {0, 1}) {
      const Vec3<Quad> end = end_of(by_momenta<Quad>(field, row.method), x, v, row.steps << halved, 2);
      errors[static_cast<std::size_t>(halved)] = static_cast<double>(Quad((end - truth).norm()));
    }
    CAPTURE(row.method, errors[0], errors[1]);
    CHECK(std::abs(std::log2(errors[0] / errors[1]) - row.order) < 0.1);
  };
  const Vec3<Quad> in_ring = end_by_velocities(test::RingField{}, ring_x, ring_v);
  for (const Row& row :
       {Row{"implicit_midpoint", 2, 40}, Row{"gauss_2", 4, 20}, Row{"gauss_3", 6, 10}, Row{"gauss_4", 8, 8},
        Row{"tao_2", 2, 80}, Row{"tao_4", 4, 80}, Row{"semiexplicit_2", 2, 40}, Row{"semiexplicit_4", 4, 40},
        Row{"avf", 2, 40}, Row{"hbvm_4_2", 4, 20}, Row{"gonzalez", 2, 40}}) {
    slope(test::RingField{}, ring_x, ring_v, in_ring, row);
  }
  // Where A changes with time, the momenta do too.
  const Vec3<double> wave_x(0.1, 0, 0.2), wave_v(0.1, 0.2, 0.4);
  const Vec3<Quad> in_wave = end_by_velocities(wave, wave_x, wave_v);
  for (const Row& row : {Row{"gauss_2", 4, 20}, Row{"semiexplicit_4", 4, 40}, Row{"tao_4", 4, 80}}) {
    slope(wave, wave_x, wave_v, in_wave, row);
  }
}

TEST_CASE("over momenta Gauss's and semiexplicit steps are symplectic, over velocities Gauss's are not",
          "[integrators][charges]") {
  for (const char* name : {"gauss_2", "implicit_midpoint", "semiexplicit_2", "semiexplicit_4"}) {
    CAPTURE(name);
    CHECK(defect(by_momenta<Quad>(Tokamak{}, name), Tokamak{}, 0.2) < 1e-14);
    CHECK(defect(by_momenta<Quad>(test::RingField{}, name), test::RingField{}, 0.2) < 1e-14);
  }
  for (const char* name : {"avf", "tao_2"}) {
    CAPTURE(name);
    CHECK(defect(by_momenta<Quad>(Tokamak{}, name), Tokamak{}, 0.2) > 1e-6);
  }
  CHECK(defect(by_velocities<Quad>(Tokamak{}, "gauss_2"), Tokamak{}, 0.2) > 1e-6);
}

TEST_CASE("energy-exact methods keep the energy of charges in a trap and in a tokamak", "[integrators][charges]") {
  const auto worst = [](const auto& field, const char* name, const Vec3<double>& x, const Vec3<double>& v, double step,
                        int steps) {
    Simulation sim(test::one_charge(x, v), by_momenta<double>(field, name), step);
    CHECK(sim.claims().energy_exact);
    auto& energy = sim.every(1, Energy{});
    REQUIRE(sim.run(steps).ok());
    return energy.worst();
  };
  for (const char* name : {"avf", "hbvm_2", "gonzalez", "itoh_abe_symmetric"}) {
    CAPTURE(name);
    CHECK(worst(trap, name, {10, 0, 0}, {100, 0, 100}, 1.0 / 160, 200) < 5e-14);
    // v is the difference of p and A, 20 to 40 times as large: 1e-16 of these is a rounding error of the energy.
    CHECK(worst(Tokamak{}, name, banana_x, banana_v, half_turn / 10, 200) < 1e-11);
  }
  Simulation by_gauss(test::one_charge(banana_x, banana_v), by_momenta<double>(Tokamak{}, "gauss_2"), half_turn / 10);
  auto& energy = by_gauss.every(1, Energy{});
  REQUIRE(by_gauss.run(500).ok());
  CHECK(energy.worst() > 1e-9);
}

TEST_CASE("what is quadratic in x and p is kept by symplectic methods: the moment of a charge about its field",
          "[integrators][charges]") {
  const auto lost = [](const auto& field, const char* name) {
    const ChargeMotion motion{.fields = {AnyForce<double>(InField(field))}, .c = {}};
    CanonicalMomentum around;
    around.watch(motion);
    Simulation sim(test::one_charge({1, 0.2, 0.1}, {0.3, 1, 0.2}), by_momenta<double>(field, name), 0.05);
    auto& p = sim.every(1, around);
    REQUIRE(sim.run(400).ok());
    return p.worst();
  };
  const UniformElectromagnetic uniform{.B = {0, 0, 2}};  // A = B x x/2
  const PenningTrap weak{.B0 = 2, .gradient = 0.3};
  for (const char* name : {"semiexplicit_2", "semiexplicit_4", "gauss_2"}) {
    CAPTURE(name);
    CHECK(lost(uniform, name) < 2e-14);
    CHECK(lost(weak, name) < 2e-14);
  }
  CHECK(lost(weak, "tao_2") > 1e-8);
  CHECK(lost(test::RingField{}, "semiexplicit_2") < 2e-14);  // x p_y - y p_x is quadratic, whatever A is
}

TEST_CASE("energies by momenta in a ring field, first and last tenth of 20 000 steps", "[integrators][charges][slow]") {
  const auto worst = [&](const AnyIntegrator<double>& by) {
    std::array<double, 2> tenths{};
    Simulation sim(test::one_charge(ring_x, ring_v), by, half_turn / 10);
    auto& energy = sim.every(1, Energy{});
    for (int k = 1; k <= 20'000; ++k) {
      REQUIRE(sim.run(1).ok());
      const MonitorReport report = energy.report();
      const double error = std::abs(*report.last / *report.first - 1);
      if (k <= 2000) tenths[0] = std::max(tenths[0], error);
      if (k > 18'000) tenths[1] = std::max(tenths[1], error);
    }
    return tenths;
  };
  const auto gauss = worst(by_momenta<double>(test::RingField{}, "gauss_2")),
             rk4 = worst(by_momenta<double>(test::RingField{}, "rk4"));
  // An independent program of 40 lines, over complex x and p, has found these.
  CHECK(std::abs(gauss[0] / 4.5981e-6 - 1) < 1e-3);
  CHECK(std::abs(gauss[1] / 4.5981e-6 - 1) < 1e-3);
  CHECK(std::abs(rk4[0] / 0.019849 - 1) < 1e-3);
  CHECK(std::abs(rk4[1] / 0.158166 - 1) < 1e-3);
}

TEST_CASE("a run by momenta has the same bits, looked at or not, saved and read again", "[integrators][charges]") {
  for (const char* name : {"gauss_2", "tao_2", "semiexplicit_2", "avf"}) {
    const auto make = [&](const auto& field) {
      return Simulation(test::one_charge({1.05, 0.1, 0.03}, {0.1, 0.21, 0.17}, -1.3, 1.7),
                        by_momenta<double>(field, name), 0.1);
    };
    const auto check = [&](const auto& field) {
      CAPTURE(name);
      Simulation whole = make(field);
      REQUIRE(whole.run(120).ok());
      Simulation seen = make(field);
      seen.every(1, Energy{});
      seen.every(7, Momentum{});
      REQUIRE(seen.run(50).ok());
      static_cast<void>(seen.particles());
      Simulation again = make(field);
      again.every(1, Energy{});
      again.every(7, Momentum{});
      again.restore(seen.save());
      for (Simulation<double>* sim : {&seen, &again}) {
        REQUIRE(sim->run(70).ok());
        CHECK(bits_of(*sim) == bits_of(whole));
      }
    };
    check(Tokamak{});
    if (std::string(name) != "avf") check(wave);
  }
}

TEST_CASE("between its steps a run by momenta shows velocities of that time", "[integrators][charges]") {
  // In a wave A is that of the moment; the truth is that of velocities.
  const auto at = [](AnyIntegrator<double> by) {
    Simulation sim(test::one_charge({0.1, 0, 0.2}, {0.1, 0.2, 0.4}), std::move(by), 0.1);
    REQUIRE(sim.claims().between_steps);
    std::pair<Vec3<double>, Vec3<double>> seen;
    sim.at_times({1.037}, Diary{&seen});
    REQUIRE(sim.run(12).ok());
    return seen;
  };
  const auto [x, v] = at(by_momenta<double>(wave, "dop853"));
  const auto [x0, v0] = at(by_velocities<double>(wave, "dop853"));
  CHECK(v.norm() > 0.1);
  CHECK((x - x0).norm() < 1e-10);
  CHECK((v - v0).norm() < 1e-9);
}

TEST_CASE("fields on a grid have momenta where they have A", "[integrators][charges]") {
  FieldGrid values = FieldGrid::of(MagneticMirror{.B0 = 2, .radius = 2, .distance = 3}, {12, 12, 12},
                                   {-1.1, -1.1, -1.1}, {0.2, 0.2, 0.2});
  const GridField grid{.file = "", .grid = std::make_shared<const FieldGrid>(values)};
  Simulation sim(test::one_charge({0.1, 0, 0}, {0, 0.1, 0.02}), by_momenta<double>(grid, "avf"), 0.1);
  auto& energy = sim.every(1, Energy{});
  REQUIRE(sim.run(200).ok());
  CHECK(energy.worst() < 3e-11);  // second derivatives of cubics jump from cell to cell
  values.B = values.A;
  values.A.clear();
  const GridField alone{.file = "", .grid = std::make_shared<const FieldGrid>(values)};
  CHECK_THROWS_WITH(Simulation(test::one_charge({0.1, 0, 0}, {0, 0.1, 0.02}), by_momenta<double>(alone, "avf"), 0.1),
                    Catch::Contains("the field 'field_grid' has no vector potential, and momenta are m v + q A; use a "
                                    "method for y' = f that moves velocities"));
  CanonicalMomentum around;
  around.watch({.fields = {AnyForce<double>(InField(alone))}, .c = {}});
  CHECK_THROWS_WITH(around.check(test::one_charge({0.1, 0, 0}, {0, 0.1, 0.02})),
                    Catch::Contains("the field 'field_grid' has no vector potential"));
}

TEST_CASE("what has no momenta is refused by name", "[integrators][charges]") {
  const auto start = [](const auto& field, double mass = 1) {
    return Simulation(test::one_charge({0.1, 0, 0}, {0, 0.1, 0.02}, 1, mass), by_momenta<double>(field, "gauss_2"),
                      0.1);
  };
  CHECK_NOTHROW(start(UniformElectromagnetic{.B = {0, 0, 1}}));
  CHECK_THROWS_WITH(
      start(RadioFrequencyGap{.E0 = 1, .length = 1, .omega = 1, .c = 1}),
      Catch::Contains("the field 'radio_frequency_gap' has no vector potential, and momenta are m v + q A"));
  CHECK_THROWS_WITH(start(UniformElectromagnetic{.B = {0, 0, 1}}, 0), Catch::Contains("'charge' has no mass"));
  CHECK_THROWS_WITH(start(WrongPotential{}), Catch::Contains("whose rotation is not its B where 'charge' begins"));
  CHECK_THROWS_WITH(start(InDoubles{}), Catch::Contains("is written for doubles only"));
  ForceField<double> dragged = forces_of<double>(Tokamak{});
  dragged.add(DragForce{{0.1}});
  CHECK_THROWS_WITH(Simulation(test::one_charge({1, 0, 0}, {0, 0.1, 0}), by_velocities<double>(Tokamak{}, "avf"), 0.1),
                    Catch::Contains("keeps the energy, but a force of this run depends on velocities"));
  CHECK_THROWS_WITH(CanonicalCharges<double>(dragged), Catch::Contains("depends on velocities otherwise"));
  CHECK_THROWS_WITH(Simulation(test::one_charge({1, 0, 0}, {0, 0.1, 0}), by_momenta<double>(Tokamak{}, "avf_4"), 0.1),
                    Catch::Contains("use 'hbvm_2'"));
}

TEST_CASE("other forces act beside fields, and their energy is kept too", "[integrators][charges]") {
  ForceField<double> forces = forces_of<double>(UniformElectromagnetic{.E = {0.1, 0, 0}, .B = {0, 0.3, 2}});
  forces.add(HarmonicField{0.7});
  ParticleSystem<double> s = test::one_charge({1, 0.2, 0.1}, {0.3, 1, 0.2}, 1, 2);
  s.add("other", 0.01, {0.3, -0.4, 0.2}, {0.1, 0.2, -0.3});  // without a charge, and light
  Simulation sim(s, canonical_charges(forces, method("avf")), 0.05);
  auto& energy = sim.every(1, Energy{});
  REQUIRE(sim.run(200).ok());
  CHECK(energy.worst() < 2e-14);
  Simulation truth(
      s, Classical<double>(std::make_unique<ForceMotion<ForceField<double>, double>>(forces), fixed("gauss_8")), 0.05);
  Simulation gauss(s, Classical<double>(std::make_unique<CanonicalCharges<double>>(forces), fixed("gauss_8")), 0.05);
  REQUIRE(truth.run(200).ok());
  REQUIRE(gauss.run(200).ok());
  for (Index i = 0; i < 2; ++i) {
    CHECK((Vec3<double>(gauss.particles().positions()[i]) - Vec3<double>(truth.particles().positions()[i])).norm() <
          1e-12);
  }
}

}  // namespace noether
