/// Secant forces between two states: their work is the difference of the energies, to rounding.

#include "forces/bonded.hpp"
#include "forces/gravity.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/springs.hpp"
#include "forces/sum.hpp"
#include "integrators/force_motion.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <string>

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

namespace {

/// Three particles in a cell, the first two bonded across its wall.
ParticleSystem<double> across_a_wall() {
  ParticleSystem<double> s(unit_system("reduced"));
  const std::array<Vec3<double>, 3> x = {Vec3<double>{0.3, 1, 1}, {3.7, 1.5, 1}, {1.9, 3, 2}};
  for (std::size_t i = 0; i < 3; ++i) s.add("p" + std::to_string(i), 1, x[i], Vec3<double>::Zero());
  s.set_box(Box::periodic({4, 5, 6}));
  return s;
}
ParticleSystem<double> with_moved(const ParticleSystem<double>& from, Index i, const Vec3<double>& way) {
  ParticleSystem<double> to = from;
  to.shift(i, way, Vec3<double>::Zero());
  to.moved();
  return to;
}
template <class F>
std::string failure_of_secants(const F& force, const ParticleSystem<double>& from, const ParticleSystem<double>& to) {
  VectorColumn<double> a(to.size());
  ForceSink<double> sink(a, to, {});
  force.add_secant_to(sink, from, to);
  return sink.failure() ? sink.failure()->message : "";
}

}  // namespace

TEST_CASE("springs follow their image through the wall, and fail where another one becomes the nearest",
          "[forces][secant]") {
  const ParticleSystem<double> from = across_a_wall();
  const HarmonicBond spring{.k = 3, .length = 0.5, .tied = {{0, 1}}};
  const ParticleSystem<double> through = with_moved(from, 0, {-0.5, 0.2, 0.1});
  REQUIRE(through.positions()[0][0] > 3);
  const auto [work, difference] = work_of(spring, from, through);
  CHECK(std::abs(work) > 0.01);
  CHECK(std::abs(work - difference) < 1e-14);
  const std::string changed = failure_of_secants(spring, from, with_moved(from, 0, {1.6, 0, 0}));
  CHECK_THAT(changed, Catch::Contains("the nearest image of 'p0' and 'p1' changes within one step"));
  CHECK_THAT(
      failure_of_secants(Tether{.point = {0, 0, 0}, .k = 1, .tied = {{2}}}, from, with_moved(from, 2, {0.2, 0, 0})),
      Catch::Contains("the nearest image of 'p2' changes within one step"));
}

TEST_CASE("pairs have the work of their energy when another image becomes the nearest", "[forces][secant]") {
  const ParticleSystem<double> from = across_a_wall(), to = with_moved(from, 0, {1.6, 0, 0});
  const LennardJonesForce force{.cutoff = 2.5, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0};
  const auto [work, difference] = work_of(force, from, to);
  CHECK(std::abs(work) > 0.1);
  CHECK(std::abs(work - difference) < 1e-11);
  ParticleSystem<double> scaled = from;
  auto topology = std::make_shared<Topology>();
  topology->scaled_pairs = {{{0, 1}, 0.5}};
  scaled.set_topology(topology);
  CHECK_THAT(failure_of_secants(force, scaled, with_moved(scaled, 0, {1.6, 0, 0})),
             Catch::Contains("'p1' and 'p0' changes"));
  CHECK(failure_of_secants(force, scaled, with_moved(scaled, 0, {0.1, 0, 0})).empty());
  CHECK_THAT(failure_of_secants(force, from, with_moved(from, 0, {6.5, 0, 0})),
             Catch::Contains("changes by more than the box is long in one step"));
}

TEST_CASE("secants of a jump of the energy do its work, however short the step", "[forces][secant]") {
  for (const double step : {1e-3, 1e-7, 1e-10}) {
    ParticleSystem<double> from(unit_system("reduced"));
    from.add("a", 1, {0, 0, 0}, {0, 0, 0});
    from.add("b", 1, {2 - step / 3, 0, 0}, {0, 0, 0});
    const ParticleSystem<double> to = with_moved(from, 1, {step, 0, 0});
    const auto check = [&, &before = from](const auto& force) {
      const auto [work, difference] = work_of(force, before, to);
      CHECK(std::abs(work - difference) < 2e-12);  // units of the sums of energies
    };
    check(LennardJonesForce{.cutoff = 2, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0});
    check(LennardJonesForce{.cutoff = 2, .cutoff_style = Cutoff::shifted, .epsilon = 1.0, .sigma = 1.0});
    check(MorseForce{{.depth = 1, .a = 1, .length = 1}, 2, Cutoff::plain});
  }
}

TEST_CASE("secants fail where a state has no energy", "[forces][secant]") {
  ParticleSystem<double> from(unit_system("reduced"));
  from.add("a", 1, {0, 0, 0}, {0, 0, 0});
  from.add("b", 1, {1.2, 0, 0}, {0, 0, 0});
  const BuckinghamForce buckingham{{.A = 300, .rho = 0.3, .C = 0.5}, 2.4};
  CHECK(failure_of_secants(buckingham, from, with_moved(from, 1, {-0.2, 0, 0})).empty());
  CHECK_THAT(failure_of_secants(buckingham, from, with_moved(from, 1, {-1.15, 0, 0})),
             Catch::Contains("'b' and 'a' are 0.05 apart, but their potential is defined from"));
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"fene", {30, 1.5, 1, 1}}};
  topology->bonds = {{{0, 1}, 0}};
  from.set_topology(topology);
  CHECK(failure_of_secants(Bonded{}, from, with_moved(from, 1, {0.2, 0, 0})).empty());
  CHECK_THAT(failure_of_secants(Bonded{}, from, with_moved(from, 1, {0.4, 0, 0})),
             Catch::Contains("the bond of 'a' and 'b' is 1.6 long, but a fene bond must be shorter than 1.5"));
}

TEST_CASE("pairs that have no energy may be as close as they like", "[forces][secant]") {
  ParticleSystem<double> from(unit_system("reduced"));
  from.add("a", 1, {0, 0, 0}, {0, 0, 0});
  from.add("b", 1, {0.05, 0, 0}, {0, 0, 0});
  from.add("c", 1, {0, 1.2, 0}, {0, 0, 0});
  auto topology = std::make_shared<Topology>();
  topology->types = {0, 0, 1};
  topology->type_names = {"near", "far"};
  from.set_topology(topology);
  const ParticleSystem<double> to = with_moved(from, 2, {0, 0.1, 0});
  const BuckinghamForce between{{.A = 300, .rho = 0.3, .C = 0.5}, 2.4, Cutoff::plain, {}, "near", "far"};
  CHECK(failure_of_secants(between, from, to).empty());
  const BuckinghamForce within{{.A = 300, .rho = 0.3, .C = 0.5}, 2.4, Cutoff::plain, {}, "near", "near"};
  CHECK_THAT(failure_of_secants(within, from, to), Catch::Contains("are 0.05 apart"));
}

TEST_CASE("secants do not depend on how many cells the particles have crossed", "[forces][secant]") {
  const auto secants = [](std::int32_t cells, const auto& force) {
    ParticleSystem<double> from = across_a_wall();
    VectorColumn<std::int32_t> images(from.size());
    for (Index i = 0; i < from.size(); ++i) images.component(0)[i] = cells, images.component(2)[i] = -cells;
    from.restore_images(images);
    const ParticleSystem<double> to = with_moved(from, 0, {-0.4, 0.001, 0.0002});  // through a wall
    VectorColumn<double> a(to.size());
    ForceSink<double> sink(a, to, {});
    force.add_secant_to(sink, from, to);
    return a;
  };
  const HarmonicBond spring{.k = 3, .length = 0.5, .tied = {{0, 1}}};
  const LennardJonesForce pairs{.cutoff = 2.5, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0};
  for (const std::int32_t cells : {1, 100000}) {
    const auto compare = [&](const auto& force) {
      const VectorColumn<double> here = secants(0, force), there = secants(cells, force);
      for (int k = 0; k < 3; ++k) {
        for (Index i = 0; i < here.size(); ++i) CHECK(here.component(k)[i] == there.component(k)[i]);
      }
    };
    compare(spring);
    compare(pairs);
  }
}

TEST_CASE("fields wrap particles between secants without a change of these", "[forces][secant]") {
  const ParticleSystem<double> from = across_a_wall(), to = with_moved(from, 0, {-0.2, 0.2, 0.1});
  const HarmonicBond spring{.k = 3, .length = 0.5, .tied = {{0, 1}}};
  ForceMotion<HarmonicBond, double> field(spring);
  field.bind(from);
  Vector<double> y0, y1, first, then;
  field.gather(from, y0);
  field.gather(to, y1);
  field.secant(0, y0, y1, first);
  Vector<double> outside = y1;
  outside[0] -= 0.5;
  field.potential(0, outside);
  field.secant(0, y0, y1, then);
  CHECK(first == then);
  CHECK(first.cwiseAbs().maxCoeff() > 0.1);
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
