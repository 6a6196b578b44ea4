/// Charges in lanes: the bits of letter by letter, whatever the field, the way of kicking, the threads and the level.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using System = ParticleSystem<double>;

/// Of both signs, some neutral, some without mass, some at rest, and if wanted some on the axis of a tokamak.
System charges(Index n, bool on_axis = true) {
  System s(unit_system("reduced"));
  s.add_column<Charge>();
  for (Index i = 0; i < n; ++i) {
    const double k = static_cast<double>(i);
    const double mass = i % 13 == 5 ? 0 : 1 + 0.3 * std::sin(k);
    Vec3<double> x(1.05 + 0.1 * std::sin(0.7 * k), 0.1 * std::cos(1.3 * k), 0.1 * std::sin(1.9 * k));
    Vec3<double> v(0.1 * std::cos(k), -0.0, -0.2 * std::sin(k));
    if (i % 17 == 3) v.setZero();
    if (on_axis && i % 23 == 7) x = Vec3<double>(-0.0, 0, 0.4);
    s.add("", mass, x, v);
    s.column<Charge>()[i] = i % 11 == 2 ? 0 : (i % 2 == 0 ? 1 : -0.6) * (1 + 0.01 * k);
  }
  return s;
}

ForceField<double> fields(const std::vector<AnyForce<double>>& added) {
  ForceField<double> all;
  for (const AnyForce<double>& one : added) all.add(one);
  return all;
}

/// The same Hamiltonian without a walk of its own.
class LetterByLetter : public ChargedParticles<ForceField<double>> {
 public:
  using ChargedParticles<ForceField<double>>::ChargedParticles;
  Advance run(const TimedWord<double>& word, System& s, const Span& span) {
    return walk_letters(*this, word, s, span, [&](char letter, const double& h) { this->flow(letter, s, h); });
  }
};

/// Cuts of a run.
using Cuts = std::vector<std::int64_t>;

template <class H>
std::pair<System, std::int64_t> end_of(H hamiltonian, const System& start, const Scheme& scheme, double h,
                                       const Cuts& cuts) {
  auto integrator = compose(std::move(hamiltonian), scheme);
  System s = start;
  s.clock() = Clock<double>::fixed(0, h);
  integrator.bind(s);
  for (const std::int64_t steps : cuts) REQUIRE(integrator.advance(s, {.steps = steps}).steps == steps);
  return {s, integrator.evaluations().force};
}

/// The same numbers to the bit, NaN (a charge at the centre of a dipole) among them.
void check_same_bits(const System& a, const System& b) {
  REQUIRE(a.size() == b.size());
  CHECK(a.clock().time() == b.clock().time());
  CHECK(a.phase().pending == b.phase().pending);
  Index differ = 0, known = 0;
  const auto bits = [](double x) { return std::isnan(x) ? std::pair(0.0, true) : std::pair(x, std::signbit(x)); };
  for (Index i = 0; i < a.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      differ += bits(a.positions()[i][k]) != bits(b.positions()[i][k]);
      differ += bits(a.velocities()[i][k]) != bits(b.velocities()[i][k]);
      known += std::isfinite(a.velocities()[i][k]);
    }
  }
  CHECK(differ == 0);
  CHECK(known >= 2 * a.size());
}

/// What each level of this processor makes of a run, in cuts, against letter by letter.
void check_run(const ForceField<double>& forces, const ChargedParticlesOptions& options, const Scheme& scheme, double h,
               const System& start, const Cuts& cuts = {1, 2, 37}) {
  std::int64_t steps = 0;
  for (const std::int64_t cut : cuts) steps += cut;
  const auto expected = end_of(LetterByLetter(forces, options), start, scheme, h, {steps});
  const SimdLevel before = simd_level();
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    set_simd_level(level);
    CAPTURE(name(level));
    for (const Cuts& some : {Cuts{steps}, cuts}) {
      const auto found = end_of(ChargedParticles<ForceField<double>>(forces, options), start, scheme, h, some);
      check_same_bits(expected.first, found.first);
      CHECK(expected.second == found.second);
    }
  }
  set_simd_level(before);
}

const std::vector<std::pair<std::string, ForceField<double>>>& all_fields() {
  static const std::vector<std::pair<std::string, ForceField<double>>> all = {
      {"uniform", fields({InField(UniformElectromagnetic{.E = {0.01, -0.02, 0.03}, .B = {0.2, -0.1, 1}})})},
      {"electric alone", fields({InField(UniformElectromagnetic{.E = {0.01, 0, 0}})})},
      {"gradient", fields({InField(GradientField{.B0 = 1, .gradient = 0.3})})},
      {"dipole", fields({InField(MagneticDipole{.moment = {0.1, -0.2, 3}})})},
      {"tokamak", fields({InField(Tokamak{.B0 = 1.3, .R0 = 1.1, .safety = 1.7})})},
      {"penning", fields({InField(PenningTrap{.B0 = 5, .gradient = 2})})},
      {"two uniform ones and a trap",
       fields({InField(UniformElectromagnetic{.E = {0.01, 0, 0}, .B = {0, 0.3, 0}}),
               InField(UniformElectromagnetic{.E = {0, 0.1, 0}, .B = {0, 0, 0.7}}), InField(PenningTrap{.B0 = 1})})},
      {"a trap before a uniform one",
       fields({InField(PenningTrap{.B0 = 5, .gradient = 2}), InField(UniformElectromagnetic{.B = {0, 0.3, 0}})})}};
  return all;
}

}  // namespace

TEST_CASE("lanes move charges with the bits of letter by letter, in every field of theirs",
          "[integrators][charges][lanes]") {
  for (const auto& [name, forces] : all_fields()) {
    CAPTURE(name);
    check_run(forces, {.rotation = Rotation::boris}, schemes::verlet_aba, 0.3, charges(83));
    check_run(forces, {}, schemes::verlet, 0.3, charges(83));
  }
}

TEST_CASE("lanes have every way of kicking", "[integrators][charges][lanes]") {
  const ForceField<double> forces =
      fields({InField(Tokamak{}), InField(UniformElectromagnetic{.E = {0.3, 0.1, -0.2}})});
  for (const Relativistic relativistic : {Relativistic::boris, Relativistic::vay, Relativistic::higuera_cary}) {
    for (const double h : {0.2, 20.0}) {
      CAPTURE(int(relativistic), h);
      check_run(forces, {.relativistic = relativistic, .c = 0.5}, schemes::verlet_aba, h, charges(41));
    }
  }
  for (const auto& [cycles, order] : {std::pair{1, 4}, std::pair{2, 2}, std::pair{3, 6}, std::pair{5, 16}}) {
    CAPTURE(cycles, order);
    check_run(forces, {.rotation = Rotation::hyper_boris, .cycles = cycles, .gyrophase_order = order},
              schemes::verlet_aba, 0.4, charges(41));
  }
  // Turns of more than half a right angle leave the polynomials of the lanes.
  for (const double h : {-0.3, 1.0, 5.0, 1e4}) {
    CAPTURE(h);
    check_run(forces, {}, schemes::verlet, h, charges(41));
    check_run(forces, {.rotation = Rotation::boris}, schemes::verlet_aba, h, charges(41));
  }
}

TEST_CASE("lanes walk every word over drifts and kicks", "[integrators][charges][lanes]") {
  const ForceField<double> forces = fields({InField(MagneticDipole{.moment = {0, 0, 1}})});
  for (const char* name : {"verlet", "verlet_aba", "yoshida_4", "kahan_li_6_s9", "symplectic_euler_a", "srkn6b"}) {
    CAPTURE(name);
    check_run(forces, {}, *schemes::find(name), 0.1, charges(20));
  }
  check_run(forces, {.rotation = Rotation::boris}, schemes::yoshida_4, 0.1, charges(20));
}

TEST_CASE("bits of charges in lanes depend neither on their number, nor on threads, cadences and a restart",
          "[integrators][charges][lanes]") {
  const ForceField<double> forces = fields({InField(Tokamak{})});
  const ChargedParticlesOptions boris{.rotation = Rotation::boris};
  for (const Index n : {1, 7, 8, 9, 64, 65, 700})
    check_run(forces, boris, schemes::verlet_aba, 0.3, charges(n), {3, 1});
  const auto run = [&](int threads, const Cuts& cuts, bool restart) {
    set_thread_count(threads);
    const auto make = [&] {
      return Simulation(charges(700, false),
                        compose(ChargedParticles<ForceField<double>>(forces, boris), schemes::verlet_aba), 0.3);
    };
    Simulation sim = make();
    for (const std::int64_t steps : cuts) REQUIRE(sim.run(steps).ok());
    if (restart) {
      Simulation next = make();
      next.restore(sim.save());
      REQUIRE(next.run(30).ok());
      return next.particles();
    }
    REQUIRE(sim.run(30).ok());
    return sim.particles();
  };
  const int threads = thread_count();
  const System expected = run(1, {30}, false);
  CHECK(test::same_bits(expected, run(2, {30}, false)));
  CHECK(test::same_bits(expected, run(2, {1, 1, 28}, false)));
  CHECK(test::same_bits(expected, run(1, {13, 17}, true)));
  set_thread_count(threads);
}

TEST_CASE("lanes leave to letters what they do not know", "[integrators][charges][lanes]") {
  const ChargedParticlesOptions boris{.rotation = Rotation::boris};
  const auto at_once = [&](const ForceField<double>& forces, const System& s, CompositionOptions options = {}) {
    auto integrator = compose(ChargedParticles<ForceField<double>>(forces, boris), schemes::verlet_aba, options);
    System bound = s;
    integrator.bind(bound);
    return integrator.claims().steps_at_once;
  };
  const AnyForce<double> tokamak = InField(Tokamak{});
  CHECK(at_once(fields({tokamak}), charges(10)) == 1024);
  CHECK(at_once(fields({tokamak}), charges(10'000)) == 400);
  CHECK(at_once(fields({tokamak, HarmonicField{.k = 1}}), charges(10)) == 1);
  CHECK(at_once(fields({tokamak, InField(test::RingField{})}), charges(10)) == 1);
  CHECK(at_once(fields({tokamak, InField(PlaneWave{.E0 = {1, 0, 0}})}), charges(10)) == 1);
  CHECK(at_once(fields({tokamak}), charges(10), {.compensated = true}) == 1);
  check_run(fields({tokamak, HarmonicField{.k = 1}}), boris, schemes::verlet_aba, 0.3, charges(20));
}

}  // namespace noether
