/// State goes to named arrays and comes back exactly.

#include "engine/saved_state.hpp"

#include "engine/description.hpp"
#include "engine/simulation.hpp"
#include "engine/statistics.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

namespace noether {
namespace {

template <class T> T round_trip(const T& value) {
  SavedState saved;
  save_value(saved, "it", value);
  T back{};
  load_value(saved, "it", back);
  return back;
}

const Quad third = Quad(1) / Quad(3);
const Vec3<Quad> vector(third, -third, Quad(0));

enum class Color : std::uint8_t { red, green };

SavedState save_planets() {
  ParticleSystem<double> planets = test::outer_planets();
  planets.keep_low_words(true);
  return save_particles(planets);
}

}  // namespace

TEST_CASE("numbers, texts and lists of them come back", "[saved]") {
  CHECK(round_trip(true));
  CHECK(round_trip(std::int64_t{1} << 60) == std::int64_t{1} << 60);
  CHECK(round_trip(Color::green) == Color::green);
  CHECK(round_trip(0.1) == 0.1);
  CHECK(round_trip(third) == third);
  CHECK((round_trip(vector) == vector));
  CHECK(round_trip(std::string("a b")) == "a b");
  CHECK(round_trip(std::vector<std::string>{"", "x"}) == std::vector<std::string>{"", "x"});
  CHECK(round_trip(std::vector<std::int64_t>{3, -1}) == std::vector<std::int64_t>{3, -1});
  CHECK(round_trip(std::vector<double>{}).empty());
  CHECK(round_trip(std::vector<Quad>{third, third * third}) == std::vector<Quad>{third, third * third});
  CHECK(round_trip(std::array<Quad, 2>{third, Quad(2)}) == std::array<Quad, 2>{third, Quad(2)});
  CHECK((round_trip(std::vector<Vec3<Quad>>{vector, vector}).at(1) == vector));
}

TEST_CASE("numbers that are not finite come back, zero with its sign", "[saved]") {
  CHECK(std::isnan(round_trip(std::numeric_limits<double>::quiet_NaN())));
  CHECK(round_trip(-std::numeric_limits<double>::infinity()) == -std::numeric_limits<double>::infinity());
  CHECK(std::signbit(round_trip(-0.0)));
}

TEST_CASE("an optional comes back empty or full, over whatever was there", "[saved]") {
  CHECK_FALSE(round_trip(std::optional<double>{}).has_value());
  CHECK(round_trip(std::optional<double>{2.5}) == 2.5);
  SavedState saved;
  save_value(saved, "it", std::optional<double>{});
  std::optional<double> value = 1.0;
  load_value(saved, "it", value);
  CHECK_FALSE(value.has_value());
}

TEST_CASE("a part saves itself below its name", "[saved]") {
  SeriesStatistics series;
  for (int k = 0; k < 100; ++k) series.add(k, 0.1 * k * k);
  const SeriesStatistics again = round_trip(series);
  CHECK(again.slope() == series.slope());
  CHECK(again.rms() == series.rms());
  CHECK(again.samples() == 100);
  SavedState saved;
  save_value(saved, "it", series);
  CHECK(saved.count("it/samples") == 1);
}

TEST_CASE("a missing array and one of another type are named", "[saved]") {
  SavedState saved;
  save_value(saved, "count", 3);
  double number = 0;
  CHECK_THROWS_WITH(load_value(saved, "number", number), "the saved state has no array 'number' of the expected type");
  CHECK_THROWS_WITH(load_value(saved, "count", number), "the saved state has no array 'count' of the expected type");
}

TEMPLATE_TEST_CASE("raw particles come back with ids, names, clock, phase and low words", "[saved]", double, Quad) {
  auto s = test::outer_planets<TestType>();
  s.remove(1);
  s.keep_low_words(true);
  s.advance_positions(TestType(1) / TestType(3));
  s.clock() = Clock<TestType>::fixed(1.5, 0.1, 77);
  s.clock().set_fraction(TestType(1) / TestType(3));
  s.phase() = {.coordinates = std::uint8_t{2}, .opened = true, .pending = true};
  const auto again = load_particles<TestType>(save_particles(s));
  CHECK(test::same_bits(again, s));
  CHECK(again.ids() == s.ids());
  CHECK(again.names() == s.names());
  CHECK(again.next_id() == s.next_id());
  CHECK(again.time() == s.time());
  CHECK(again.phase() == s.phase());
  CHECK(again.units().name == "solar");
  REQUIRE(again.low_words() != nullptr);
  bool any = false;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<TestType> low = std::as_const(*s.low_words()).x[i];
    CHECK((std::as_const(*again.low_words()).x[i] == low));
    CHECK(again.masses()[i] == s.masses()[i]);
    any = any || low != Vec3<TestType>::Zero();
  }
  CHECK(any);
}

TEST_CASE("columns that parts have asked for come back with the particles", "[saved]") {
  auto s = test::outer_planets<Quad>();
  s.add_column<Charge>()[1] = third;
  s.add_column<Kind>()[2] = std::int64_t{1} << 60;
  s.add_column<SpinVector>().set(0, vector);
  const auto again = load_particles<Quad>(save_particles(s));
  CHECK(again.columns().size() == 3);
  CHECK(again.column<Charge>()[1] == third);
  CHECK(again.column<Kind>()[2] == std::int64_t{1} << 60);
  CHECK((again.column<SpinVector>()[0] == vector));
}

TEST_CASE("particles of which an array is cut or gone are refused", "[saved]") {
  const SavedState whole = save_planets();
  REQUIRE_NOTHROW(load_particles<double>(whole));
  for (const auto& [name, array] : whole) {
    CAPTURE(name);
    SavedState cut = whole;
    std::visit([](auto& values) { values.pop_back(); }, cut[name]);
    if (name != "id") CHECK_THROWS_AS(load_particles<double>(cut), Error);
    cut.erase(name);
    if (name != "position_low") CHECK_THROWS_AS(load_particles<double>(cut), Error);
  }
}

TEST_CASE("a choice that there is not is refused", "[saved]") {
  for (const char* name : {"phase", "clock/counts"}) {
    for (const std::int64_t number : {-1, 256}) {
      SavedState changed = save_planets();
      std::get<std::vector<std::int64_t>>(changed[name])[0] = number;
      CHECK_THROWS_AS(load_particles<double>(changed), Error);
    }
  }
}

TEST_CASE("an order that names no particle, or one twice, is refused", "[saved]") {
  Simulation run(test::outer_planets(), compose(test::wisdom_holman({.G = test::outer_G}), schemes::verlet_aba), 50.0);
  const SavedRun whole = run.save();
  REQUIRE_NOTHROW(run.restore(whole));
  for (const std::vector<std::int64_t>& order :
       {std::vector<std::int64_t>{0, 1, 2, 3, 4, 6}, {0, 1, 2, 3, 4, 4}, {0, 1, 2, 3, 4}, {1, 0, 2, 3, 4, 5}, {}}) {
    SavedRun changed = whole;
    changed.parts.at("integrator").at("hamiltonian/order") = order;
    CHECK_THROWS_WITH(run.restore(changed), "the saved order of Jacobi coordinates does not match these particles");
  }
}

}  // namespace noether
