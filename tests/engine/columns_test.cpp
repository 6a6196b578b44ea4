/// Columns that parts declare: one loop over them serves copies, saved states, checks, adding and removing particles.

#include "engine/charge.hpp"
#include "engine/not_finite.hpp"
#include "engine/saved_state.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/tops.hpp"

#include <limits>

namespace noether {
namespace {

using test::Orientation, test::Spin;

/// A column of nine numbers that nobody moves.
struct Stress {
  template <class Real> using type = RowColumn<Real, 9>;
  static constexpr std::string_view name = "stress", dimension = "energy";
  static constexpr ColumnRole role = ColumnRole::parameter;
};

ParticleSystem<double> bodies(Index n) {
  ParticleSystem<double> s(unit_system("reduced"));
  for (Index i = 0; i < n; ++i) s.add("b" + std::to_string(i), 1, Vec3<double>(double(i), 0, 0), Vec3<double>::Zero());
  return s;
}

/// Another part's column of a name that is taken.
struct Stretch {
  template <class Real> using type = VectorColumn<Real>;
  static constexpr std::string_view name = "stress", dimension = "length";
  static constexpr ColumnRole role = ColumnRole::configuration;
};

}  // namespace

TEST_CASE("who was given a column keeps it while others are added", "[engine][columns]") {
  ParticleSystem<double> s = bodies(2);
  auto& charges = s.add_column<Charge>();
  s.add_column<Stress>();
  s.add_column<Orientation>();
  s.add_column<Spin>();
  charges[1] = -1;
  CHECK(std::as_const(s).column<Charge>()[1] == -1);
}

TEST_CASE("two columns of one name that mean different things are refused", "[engine][columns]") {
  ParticleSystem<double> s = bodies(1);
  s.add_column<Stress>();
  CHECK_NOTHROW(s.add_column(column_info<Stress>()));
  const std::string message =
      "column 'stress' is declared twice, as a parameter of 9 numbers in [energy] that start at 0 0 0 0 0 0 0 0 0 and "
      "as a configuration of 3 numbers in [length] that start at 0 0 0; give one of them another name";
  CHECK_THROWS_WITH(s.add_column<Stretch>(), message);
  CHECK_THROWS_WITH(s.add_column(column_info<Stretch>()), message);
  CHECK(s.columns().size() == 1);
}

TEST_CASE("a column starts as its declaration says, and grows and shrinks with the particles", "[engine][columns]") {
  ParticleSystem<double> s = bodies(2);
  s.add_column<Orientation>();
  s.add_column<Charge>()[1] = -1;
  s.add_column<Stress>();
  s.column<Orientation>().set(1, {0, 1, 0, 0});
  s.add("late", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  const auto& turned = std::as_const(s).column<Orientation>();
  REQUIRE(turned.size() == 3);
  CHECK(turned[0] == test::Quaternion<double>(1, 0, 0, 0));
  CHECK(turned[1] == test::Quaternion<double>(0, 1, 0, 0));
  CHECK(turned[2] == test::Quaternion<double>(1, 0, 0, 0));
  CHECK(std::as_const(s).column<Charge>()[2] == 0);
  s.remove(0);
  CHECK(std::as_const(s).column<Orientation>()[0] == test::Quaternion<double>(0, 1, 0, 0));
  CHECK(std::as_const(s).column<Charge>()[0] == -1);
  CHECK(s.columns().size() == 3);
  CHECK(s.bytes_per_particle() == bodies(1).bytes_per_particle() + (4 + 1 + 9) * sizeof(double));
}

TEST_CASE("charged particles are added and removed while a run is edited", "[engine][columns]") {
  ParticleSystem<double> s = bodies(2);
  s.add_column<Spin>();
  s.add_column<Charge>();
  Simulation sim(s, compose(test::SpinningTops(2, Sum<>()), schemes::verlet), 0.1);
  REQUIRE(sim.run(3).ok());
  sim.edit([](ParticleSystem<double>& all) {
    all.add("third", 1, Vec3<double>(0, 1, 0), Vec3<double>::Zero());
    all.column<Charge>()[2] = 5;
    all.remove(0);
  });
  REQUIRE(sim.run(3).ok());
  CHECK(sim.particles().column<Charge>()[1] == 5);
  CHECK(sim.particles().column<Orientation>().size() == 2);
}

TEST_CASE("copies of the same particles take over what moves, and parameters only where these changed",
          "[engine][columns]") {
  ParticleSystem<double> s = bodies(3);
  s.add_column<Orientation>();
  s.add_column<Charge>();
  ParticleSystem<double> copy = s;
  const double* place = std::as_const(copy).column<Orientation>().component(0);
  const double* charges = std::as_const(copy).column<Charge>().data();
  s.column<Orientation>().set(2, {0, 0, 1, 0});
  copy.assign_state(s);
  CHECK(std::as_const(copy).column<Orientation>()[2] == test::Quaternion<double>(0, 0, 1, 0));
  s.column<Charge>()[0] = 3;
  copy.assign_state(s);
  CHECK(std::as_const(copy).column<Charge>()[0] == 3);
  CHECK(std::as_const(copy).column<Orientation>().component(0) == place);  // in place, nothing was allocated
  CHECK(std::as_const(copy).column<Charge>().data() == charges);
}

TEST_CASE("writing to a column makes known forces void, unless it is a momentum", "[engine][columns]") {
  ParticleSystem<double> s = bodies(1);
  s.add_column<Orientation>();
  s.add_column<Spin>();
  const std::uint64_t before = s.version();
  s.column<Spin>().set(0, {1, 0, 0});
  CHECK(s.version() == before);
  s.column<Orientation>().set(0, {0, 0, 0, 1});
  CHECK(s.version() != before);
}

TEST_CASE("saved states carry columns of every width with what they are", "[engine][columns]") {
  ParticleSystem<double> s = bodies(2);
  s.add_column<Orientation>().set(1, {0.5, 0.5, 0.5, 0.5});
  s.add_column<Spin>().set(0, {1, 2, 1. / 3});
  s.add_column<Stress>();
  s.column<Stress>().component(8)[1] = 0.1;
  const ParticleSystem<double> again = load_particles<double>(save_particles(s));
  REQUIRE(again.columns().infos() == s.columns().infos());
  CHECK(again.column<Orientation>()[1] == std::as_const(s).column<Orientation>()[1]);
  CHECK(again.column<Spin>()[0] == Vec3<double>(1, 2, 1. / 3));
  CHECK(again.column<Stress>().component(8)[1] == 0.1);
  SavedState broken = save_particles(s);
  broken["columns/kind"] = std::vector<std::int64_t>{1, 5, 0, 2, 3, 0, 0, 9, 0};
  CHECK_THROWS_WITH(load_particles<double>(broken), "a column has 5 numbers per particle; 1, 3, 4 or 9 are expected");
}

TEST_CASE("a number of a column that is not finite is found, and only where it moves", "[engine][columns]") {
  ParticleSystem<double> s = bodies(2);
  s.add_column<Spin>();
  s.add_column<Charge>()[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(not_finite(s));
  s.column<Spin>().set(1, {0, std::numeric_limits<double>::infinity(), 0});
  REQUIRE(not_finite(s));
  CHECK(not_finite(s)->message == "spin of b1 is not finite");
}

}  // namespace noether
