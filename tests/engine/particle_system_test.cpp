/// The state of the particles: identity, versions, compensation, columns on demand.

#include "engine/particle_system.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/planets.hpp"

#include <set>

namespace noether {
namespace {

ParticleSystem<double> three() {
  ParticleSystem<double> s;
  s.add("a", 1, {1, 2, 3}, {4, 5, 6});
  s.add("b", 2, {-1, 0, 1}, {0, 1, 0});
  s.add("c", 0, {7, 7, 7}, {1, 1, 1});
  return s;
}

using Ids = std::vector<std::int64_t>;

}  // namespace

TEST_CASE("particles keep what they were added with", "[particles]") {
  const auto s = three();
  REQUIRE(s.size() == 3);
  CHECK(s.name(1) == "b");
  CHECK(s.masses()[1] == 2);
  CHECK(s.positions()[0] == Vec3<double>(1, 2, 3));
  CHECK(s.velocities()[0] == Vec3<double>(4, 5, 6));
  CHECK(s.ids() == Ids{0, 1, 2});
  CHECK(s.units().name == "reduced");
  CHECK_FALSE(s.box().is_periodic());
}

TEST_CASE("an id is never used twice", "[particles]") {
  auto s = three();
  s.remove(2);
  s.remove(0);
  CHECK(s.ids() == Ids{1});
  CHECK(s.add("d", 1, {0, 0, 0}, {0, 0, 0}) == 1);
  CHECK(s.ids() == Ids{1, 3});
  CHECK(s.names() == std::vector<std::string>{"b", "d"});
  s.restore_ids({10, 4});
  s.add("e", 1, {0, 0, 0}, {0, 0, 0});
  CHECK(s.ids() == Ids{10, 4, 11});
}

TEST_CASE("a version names one state of positions and masses, and no two states share one", "[particles]") {
  auto s = three();
  const auto copy = s;
  CHECK(copy.version() == s.version());
  std::set<std::uint64_t> seen{s.version()};
  const auto moved = [&] { return seen.insert(s.version()).second; };
  s.positions().set(0, {0, 0, 0});
  CHECK(moved());
  s.masses()[0] = 3;
  CHECK(moved());
  s.advance_positions(0.5);
  CHECK(moved());
  s.shift(0, {1, 0, 0}, {0, 0, 0});
  s.moved();
  CHECK(moved());
  s.add("d", 1, {0, 0, 0}, {0, 0, 0});
  CHECK(moved());
  s.remove(3);
  CHECK(moved());
  s.velocities().set(0, {0, 0, 0});
  s.advance_velocities(1, VectorColumn<double>(3));
  s.scale_velocities(0.5);
  CHECK_FALSE(moved());  // forces by positions stay known
}

TEST_CASE("drifts, kicks and scalings are elementwise", "[particles]") {
  auto s = three();
  s.advance_positions(0.5);
  CHECK(std::as_const(s).positions()[0] == Vec3<double>(3, 4.5, 6));
  VectorColumn<double> a(3);
  a.set(0, {2, 0, -2});
  s.advance_velocities(0.5, a);
  CHECK(std::as_const(s).velocities()[0] == Vec3<double>(5, 5, 5));
  s.scale_velocities(2);
  CHECK(std::as_const(s).velocities()[0] == Vec3<double>(10, 10, 10));
  s.shift(1, {1, 1, 1}, {0, -1, 0});
  CHECK(std::as_const(s).positions()[1] == Vec3<double>(0, 1, 2) + 0.5 * Vec3<double>(0, 1, 0));
}

TEST_CASE("compensated sums carry what a plain sum loses", "[particles]") {
  for (const bool compensated : {false, true}) {
    ParticleSystem<double> s;
    s.add("a", 1, {1, 0, 0}, {0x1p-53, 0, 0});  // half an ulp of the position: each plain addition rounds it away
    s.keep_low_words(compensated);
    for (int n = 0; n < 1024; ++n) s.advance_positions(1);
    CAPTURE(compensated);
    CHECK(std::as_const(s).positions()[0][0] == (compensated ? 1 + 0x1p-43 : 1));
  }
}

TEST_CASE("low words begin at zero and go when nobody keeps them", "[particles]") {
  auto s = three();
  CHECK(s.low_words() == nullptr);
  s.keep_low_words(true);
  REQUIRE(s.low_words() != nullptr);
  CHECK(std::as_const(*s.low_words()).x[0] == Vec3<double>::Zero());
  s.shift(0, {0x1p-60, 0, 0}, {0, 0, 0});
  CHECK(std::as_const(*s.low_words()).x[0][0] == 0x1p-60);
  s.keep_low_words(true);
  CHECK(std::as_const(*s.low_words()).x[0][0] == 0x1p-60);
  s.keep_low_words(false);
  CHECK(s.low_words() == nullptr);
}

TEST_CASE("a column exists only if a part has asked for it", "[particles]") {
  auto s = three();
  const std::size_t bare = s.bytes_per_particle();
  CHECK(bare == 7 * sizeof(double) + sizeof(std::int64_t));
  CHECK_FALSE(s.has<Charge>());
  CHECK_THROWS_AS(s.column<Charge>(), MissingColumn);
  CHECK_THROWS_WITH(s.column<Charge>(), "the particles have no column 'charge'");
  s.add_column<Charge>()[1] = -1;
  s.add_column<Kind>()[2] = 7;
  s.add_column<SpinVector>().set(0, {0, 0, 1});
  CHECK(s.has<Charge>());
  CHECK(s.column<Charge>()[1] == -1);
  CHECK(s.column<Kind>()[2] == 7);
  CHECK(std::as_const(s.column<SpinVector>())[0] == Vec3<double>(0, 0, 1));
  CHECK(s.bytes_per_particle() == bare + sizeof(double) + sizeof(std::int64_t) + 3 * sizeof(double));
  CHECK(s.columns().size() == 3);
}

TEST_CASE("particles are neither added nor removed where columns of other parts would not follow", "[particles]") {
  auto s = three();
  s.keep_low_words(true);
  CHECK_THROWS_AS(s.add("d", 1, {0, 0, 0}, {0, 0, 0}), LogicError);
  CHECK_THROWS_AS(s.remove(0), LogicError);
  CHECK(s.size() == 3);
}

TEST_CASE("assigning state copies everything that a run changes", "[particles]") {
  auto s = three();
  auto copy = s;
  s.keep_low_words(true);
  s.add_column<Charge>()[0] = 2;
  s.clock() = Clock<double>::fixed(1, 2, 3);
  s.phase() = {.coordinates = std::uint8_t{1}, .opened = true, .pending = true};
  s.advance_positions(0.1);
  s.masses()[0] = 9;
  copy.assign_state(s);
  CHECK(test::same_bits(copy, s));
  CHECK(copy.version() == s.version());
  CHECK(copy.phase() == s.phase());
  CHECK(copy.time() == 7);
  CHECK(copy.masses()[0] == 9);
  CHECK(copy.low_words() != nullptr);
  CHECK(copy.column<Charge>()[0] == 2);

  auto other = three();
  other.remove(0);
  copy.assign_state(other);
  CHECK(copy.size() == 2);
  CHECK(copy.ids() == Ids{1, 2});
}

TEST_CASE("particles in Quad are the doubles, widened", "[particles]") {
  auto s = test::outer_planets();
  s.remove(2);
  const auto wide = s.as<Quad>();
  CHECK(wide.ids() == s.ids());
  CHECK(wide.names() == s.names());
  CHECK(wide.units().name == "solar");
  CHECK(std::as_const(wide).positions()[1][0] == Quad(std::as_const(s).positions()[1][0]));
  CHECK(test::same_bits(wide.as<double>(), s));
}

TEST_CASE("after the move to the barycenter the center of mass rests in the origin, to rounding", "[particles]") {
  const auto s = test::outer_planets();  // moved there
  Vec3<Quad> x = Vec3<Quad>::Zero(), v = Vec3<Quad>::Zero();
  Quad scale_x = 0, scale_v = 0;
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      x[k] += Quad(s.masses()[i]) * Quad(s.positions()[i][k]);
      v[k] += Quad(s.masses()[i]) * Quad(s.velocities()[i][k]);
      scale_x += abs(Quad(s.masses()[i]) * Quad(s.positions()[i][k]));
      scale_v += abs(Quad(s.masses()[i]) * Quad(s.velocities()[i][k]));
    }
  }
  CHECK(sqrt(norm2(x)) < Quad(4 * 0x1p-53) * scale_x);
  CHECK(sqrt(norm2(v)) < Quad(4 * 0x1p-53) * scale_v);

  ParticleSystem<double> tracers;
  tracers.add("a", 0, {1, 0, 0}, {0, 0, 0});
  CHECK_THROWS_WITH(
      move_to_barycenter(tracers),
      "there is no centre of mass, because every particle is a tracer of mass 0; give one of them a mass");
}

}  // namespace noether
