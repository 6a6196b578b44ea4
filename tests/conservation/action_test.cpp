#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

using Masses = std::vector<Quad>;

/// A star, three heavy planets whose order in the table is not that of their orbits, and two tracers.
ParticleSystem<Quad> bodies() {
  ParticleSystem<double> s;
  const auto source = planets(0.1, 3);
  for (const Index i : {0, 3, 1, 2}) {
    s.add(source.name(i), source.masses()[i], source.positions()[i], source.velocities()[i]);
  }
  s.add("tracer", 0, {0.4, -1.3, 0.2}, {0.8, 0.3, 0.1});
  s.add("far tracer", 0, {-3.4, 1.3, 0.2}, {-0.1, -0.45, 0.1});
  auto wide = s.as<Quad>();
  wide.clock() = Clock<Quad>::fixed(0.3, 0.1, 4);
  wide.clock().set_fraction(Quad(1) / Quad(3));
  return wide;
}

/// Masses that turn the velocities of the working coordinates into canonical momenta.
Masses inertial_masses(const ParticleSystem<Quad>& s) { return Masses(s.masses().begin(), s.masses().end()); }

Masses democratic_masses(const ParticleSystem<Quad>& s) {
  Masses m = inertial_masses(s);
  Quad total(0);
  for (const Quad& one : m) total += one;
  m[0] = total;
  return m;
}

/// m_0 m_i / (m_0 + m_i) and m_i M / (M - m_i), which make momenta of scaled velocities.
Masses scaled_masses(const ParticleSystem<Quad>& s, Coordinates coordinates) {
  const Masses inertial = inertial_masses(s);
  Masses m = democratic_masses(s);
  const Quad star = inertial[0], total = m[0];
  for (std::size_t k = 1; k < m.size(); ++k) {
    m[k] = coordinates == Coordinates::whds ? star * m[k] / (star + m[k]) : m[k] * total / (total - m[k]);
  }
  return m;
}

Masses jacobi_masses(const ParticleSystem<Quad>& s, const std::vector<std::int64_t>& order) {
  Masses m = inertial_masses(s);
  Quad inside = m[0];
  for (std::size_t k = 1; k < order.size(); ++k) {
    const auto i = static_cast<std::size_t>(order[k]);
    const Quad reduced = m[i] * inside / (inside + m[i]);
    inside += m[i];
    m[i] = reduced;
  }
  m[0] = inside;
  return m;
}

bool same_bits(const ParticleSystem<Quad>& a, const ParticleSystem<Quad>& b) {
  return a.positions().all() == b.positions().all() && a.velocities().all() == b.velocities().all();
}

/// Largest defect of dS = p1 dq1 - p0 dq0 over all directions of phase space, by central differences of order 2: their
/// error is 1e-20. Checks as well that the flow with action is the flow, bit for bit.
template <class H>
double action_defect(H& hamiltonian, const ParticleSystem<Quad>& start, const Masses& m, char letter, const Quad& h) {
  auto end = start, plain = start;
  hamiltonian.flow_with_action(letter, end, h);
  hamiltonian.flow(letter, plain, h);
  CHECK(same_bits(end, plain));
  const Quad delta(1e-10);
  double worst = 0;
  for (Index i = 0; i < start.size(); ++i) {
    for (int d = 0; d < 6; ++d) {
      auto plus = start, minus = start;
      (d < 3 ? plus.positions() : plus.velocities())[i][d % 3] += delta;
      (d < 3 ? minus.positions() : minus.velocities())[i][d % 3] -= delta;
      const Quad up = hamiltonian.flow_with_action(letter, plus, h);
      const Quad down = hamiltonian.flow_with_action(letter, minus, h);
      Quad expected(0);
      for (Index j = 0; j < start.size(); ++j) {
        const Vec3<Quad> dq = std::as_const(plus).positions()[j] - std::as_const(minus).positions()[j];
        expected += m[static_cast<std::size_t>(j)] * dot(Vec3<Quad>(std::as_const(end).velocities()[j]), dq);
      }
      if (d < 3) expected -= m[static_cast<std::size_t>(i)] * start.velocities()[i][d] * Quad(2) * delta;
      worst = std::max(worst, std::fabs(static_cast<double>((up - down - expected) / (Quad(2) * delta))));
    }
  }
  return worst;
}

/// Every letter of a Hamiltonian, forwards and backwards, in its own coordinates.
template <class H, class MassesOf> void check_actions(H hamiltonian, const MassesOf& masses_of) {
  auto s = bodies();
  hamiltonian.bind(s);
  hamiltonian.open(s);
  const Masses m = masses_of(s, hamiltonian);
  for (const char letter : hamiltonian.claims().alphabet) {
    if (hamiltonian.claims().lazy.find(letter) != std::string_view::npos) continue;  // not symplectic
    for (const double h : {0.37, -0.2}) {
      INFO("letter " << letter << " for " << h);
      CHECK(action_defect(hamiltonian, std::as_const(s), m, letter, Quad(h)) < 1e-16);
    }
  }
}

const auto inertial = [](const auto& s, const auto& /*hamiltonian*/) { return inertial_masses(s); };
const auto jacobi = [](const auto& s, const auto& hamiltonian) { return jacobi_masses(s, hamiltonian.order()); };
const auto democratic = [](const auto& s, const auto& /*hamiltonian*/) { return democratic_masses(s); };

ForceField<Quad> further_forces() {
  ForceField<Quad> field;
  field.add(HarmonicField{0.3}).add(OscillatingField{{0.1, 0.2, -0.1}, 2.0, 0.4});
  return field;
}

TEST_CASE("the actions of drift and kick are those of their flows", "[conservation][action]") {
  check_actions(kinetic_potential<Quad>(Gravity{.G = 1.0, .softening = 0.1}), inertial);
  check_actions(kinetic_potential<Quad>(OscillatingField{{0.1, 0.2, -0.1}, 2.0, 0.4}), inertial);
  check_actions(kinetic_potential_over(further_forces().add(Gravity{.G = 1.0})), inertial);
}

TEST_CASE("the actions of Kepler arcs and interaction kicks are those of their flows in Jacobi coordinates",
          "[conservation][action]") {
  check_actions(WisdomHolman<Quad>({}), jacobi);
  check_actions(WisdomHolman<Quad, ForceField<Quad>>({}, further_forces()), jacobi);
  check_actions(WisdomHolman<Quad, ForceField<Quad>>({}, field_of<Quad>(HarmonicField{0.3})), jacobi);
}

TEST_CASE("the actions of Kepler arcs and interaction kicks are those of their flows in democratic coordinates",
          "[conservation][action]") {
  const WisdomHolmanOptions options{.coordinates = Coordinates::democratic};
  check_actions(wisdom_holman<Quad>(options), democratic);
  check_actions(wisdom_holman_over(options, further_forces()), democratic);
  check_actions(wisdom_holman<Quad>(options, HarmonicField{0.3}), democratic);
}

TEST_CASE("the actions of Kepler arcs and interaction kicks are those of their flows where velocities are scaled",
          "[conservation][action]") {
  for (const Coordinates coordinates : {Coordinates::whds, Coordinates::barycentric}) {
    CAPTURE(static_cast<int>(coordinates));
    const WisdomHolmanOptions options{.coordinates = coordinates};
    const auto scaled = [&](const auto& s, const auto& /*hamiltonian*/) { return scaled_masses(s, coordinates); };
    check_actions(wisdom_holman<Quad>(options), scaled);
    check_actions(wisdom_holman_over(options, further_forces()), scaled);
  }
}

TEST_CASE("erased Hamiltonians give the same actions and the same bits", "[conservation][action]") {
  const KineticPotential<Gravity, Quad> plain(Gravity{.G = 1.0});
  check_actions(AnyHamiltonian<Quad>(plain), inertial);
  for (const char letter : {'A', 'B'}) {
    auto s = bodies(), t = bodies();
    auto first = plain;
    AnyHamiltonian<Quad> second(plain);
    first.bind(s);
    second.bind(t);
    CHECK(first.flow_with_action(letter, s, Quad(0.37)) == second.flow_with_action(letter, t, Quad(0.37)));
    CHECK(same_bits(s, t));
  }
}

TEST_CASE("drag has no action, the letters beside it keep theirs", "[conservation][action]") {
  auto damped = test::damped(kinetic_potential<Quad>(Gravity{.G = 1.0}), {.rate = 0.1});
  auto s = bodies();
  damped.bind(s);
  CHECK_THROWS_AS(damped.flow_with_action('D', s, Quad(0.1)), LogicError);
  CHECK(action_defect(damped, s, inertial_masses(s), 'A', Quad(0.37)) < 1e-16);
  CHECK(action_defect(damped, s, inertial_masses(s), 'B', Quad(0.37)) < 1e-16);
}

/// Reports the action of a kick with the opposite sign.
class WrongSign : public KineticPotential<ForceField<Quad>, Quad> {
 public:
  WrongSign() : KineticPotential(field_of<Quad>(Gravity{.G = 1.0})) {}
  Quad flow_with_action(char letter, ParticleSystem<Quad>& s, const Quad& h) {
    return -KineticPotential::flow_with_action(letter, s, h);
  }
};

TEST_CASE("an action of the wrong sign is found", "[conservation][action]") {
  WrongSign wrong;
  auto s = bodies();
  wrong.bind(s);
  CHECK(action_defect(wrong, s, inertial_masses(s), 'B', Quad(0.37)) > 1e-3);
}

}  // namespace
}  // namespace noether
