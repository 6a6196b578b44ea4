/// Secant forces between two states: their work is the difference of the energies, to rounding.

#include "forces/gravity.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/force_motion.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

namespace noether {
namespace {

/// Six particles and the same a step later, by `size` of their distances.
std::pair<ParticleSystem<double>, ParticleSystem<double>> two_states(double size, bool periodic = false) {
  ParticleSystem<double> from(unit_system("reduced"));
  for (int i = 0; i < 6; ++i) {
    from.add("p" + std::to_string(i), 1 + 0.5 * i, Vec3<double>(std::cos(2.0 * i), std::sin(3.0 * i), 0.7 * i),
             Vec3<double>::Zero());
  }
  if (periodic) from.set_box(Box::periodic({4, 5, 6}));
  ParticleSystem<double> to = from;
  for (Index i = 0; i < 6; ++i) {
    const auto k = static_cast<double>(i);
    to.shift(i, size * Vec3<double>(std::sin(5 * k), std::cos(7 * k), std::sin(11 * k + 1)), Vec3<double>::Zero());
  }
  to.moved();
  return {from, to};
}

/// A force that knows no secants.
struct Bare {
  template <class Real> void add_to(ForceSink<Real>& /*out*/, const ParticleSystem<Real>& /*s*/) const {}
};

template <class F> double energy_of(const F& force, const ParticleSystem<double>& s) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  return sink.potential();
}

/// Work of the secants, and U(from) - U(to).
template <class F>
std::pair<double, double> work_of(const F& force, const ParticleSystem<double>& from,
                                  const ParticleSystem<double>& to) {
  VectorColumn<double> a(to.size());
  ForceSink<double> sink(a, to, {});
  force.add_secant_to(sink, from, to);
  double work = 0;
  for (Index i = 0; i < to.size(); ++i) {
    work += to.masses()[i] * dot(std::as_const(a)[i], Vec3<double>(to.unwrapped(i) - from.unwrapped(i)));
  }
  return {work, energy_of(force, from) - energy_of(force, to)};
}

}  // namespace

TEST_CASE("the work of secants is the difference of energies, for steps of any size", "[forces][secant]") {
  for (const double size : {1e-8, 1e-5, 1e-3, 0.1, 0.5}) {
    const auto [from, to] = two_states(size);
    const auto check = [&, &before = from, &after = to](const auto& force) {
      const auto [work, difference] = work_of(force, before, after);
      CHECK(std::abs(work - difference) < 1e-12 * (1 + std::abs(energy_of(force, before))));
      CHECK(std::abs(work) > 0.01 * size * size);
    };
    check(Gravity{.G = 1});
    check(Gravity{.G = 1, .softening = 0.3});
    check(PairForce<MorsePair>{{.depth = 1, .a = 1.5, .length = 1}, 3});
    check(ForceField<double>().add(Gravity{.G = 1}).add(PairForce<MorsePair>{{.depth = 1, .a = 1.5, .length = 1}, 3}));
  }
}

TEST_CASE("in a periodic box pairs that come into range, and images, have their secants", "[forces][secant]") {
  const auto [from, to] = two_states(0.3, true);
  const auto [work, difference] = work_of(PairForce<MorsePair>{{.depth = 1, .a = 1.5, .length = 1}, 1.9}, from, to);
  CHECK(std::abs(work - difference) < 1e-11);
}

TEST_CASE("secants become forces where the step becomes small", "[forces][secant]") {
  const auto [from, to] = two_states(1e-7);
  const Gravity gravity{.G = 1};
  VectorColumn<double> secant(6), force(6);
  ForceSink<double> one(secant, to, {}), other(force, to, {});
  gravity.add_secant_to(one, from, to);
  gravity.add_to(other, to);
  CHECK((secant.all() - force.all()).cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("vector fields give potential, masses and secants of their forces", "[forces][secant]") {
  const auto [from, to] = two_states(0.2);
  ForceMotion<Gravity, double> field(Gravity{.G = 1});
  field.bind(from);
  Vector<double> y0, y1, a;
  field.gather(from, y0);
  field.gather(to, y1);
  REQUIRE(field.has_potential());
  REQUIRE(field.has_secant());
  CHECK(field.potential(0, y0) == energy_of(Gravity{.G = 1}, from));
  const Vector<double> m = field.masses();
  REQUIRE(m.size() == 18);
  CHECK(m[7] == 1.5);
  field.secant(0, y0, y1, a);
  const double work = (m.cwiseProduct(a)).dot(y1.head(18) - y0.head(18));
  CHECK(std::abs(work - (field.potential(0, y0) - field.potential(0, y1))) < 1e-13);
  ForceMotion<Bare, double> none{Bare{}};
  CHECK_FALSE(none.has_secant());
  CHECK_THROWS_AS(none.secant(0, y0, y1, a), LogicError);
}

}  // namespace noether
