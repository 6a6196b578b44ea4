/// Sums over particles: exact, and the same whatever the order of the particles, in every monitor that has any.

#include "engine/sums.hpp"

#include "engine/moments.hpp"
#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "forces/external_fields.hpp"
#include "forces/springs.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "monitors/pressure.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/temperature.hpp"
#include "monitors/time_correlation.hpp"
#include "numbers/pack.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace noether::test {
namespace {

constexpr double most = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Numbers between -1 and 1, times powers of two to both sides of 1.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}
  double next(int powers) {
    const double part = static_cast<double>(random_() >> 11U) * 0x1p-52 - 1;
    return std::ldexp(part, static_cast<int>(random_() % static_cast<std::uint64_t>(2 * powers + 1)) - powers);
  }
  std::mt19937_64& random() { return random_; }

 private:
  std::mt19937_64 random_;
};

double exact_sum(const std::vector<double>& all) {
  ExactDoubleSum sum;
  for (const double x : all) sum.add(x);
  return sum.rounded();
}

double sum_of(const std::vector<double>& all) {
  return sum_over<double>(std::ssize(all), [&](Index i) { return all[static_cast<std::size_t>(i)]; });
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& all) {
  std::vector<std::uint64_t> bits;
  std::transform(all.begin(), all.end(), std::back_inserter(bits),
                 [](double x) { return std::bit_cast<std::uint64_t>(x); });
  return bits;
}

/// Particles of very different sizes in a box, every other one nearly the opposite of the one before: sums of vectors
/// are far below their terms.
ParticleSystem<double> crowd(Index n, const Box& box) {
  Numbers numbers(static_cast<std::uint64_t>(n));
  ParticleSystem<double> s;
  double m = 0;
  Vec3<double> x, v;
  for (Index i = 0; i < n; ++i) {
    if (i % 2 == 0) {
      m = i % 10 == 4 ? 0 : std::abs(numbers.next(20));
      x = Vec3<double>(numbers.next(4), numbers.next(4), numbers.next(4));
      v = Vec3<double>(numbers.next(8), numbers.next(8), numbers.next(8));
    }
    const Vec3<double> off(numbers.next(30) * 0x1p-50, 0, numbers.next(30) * 0x1p-50);
    const double side = i % 2 == 0 ? 1 : -1;
    s.add("", m, side * x, side * v + off);
  }
  s.set_box(box);
  return s;
}

/// The same particles in another order; `seed` 0 turns it round.
ParticleSystem<double> reordered(const ParticleSystem<double>& s, std::uint64_t seed) {
  std::vector<Index> order(static_cast<std::size_t>(s.size()));
  std::iota(order.rbegin(), order.rend(), Index{0});
  if (seed != 0) std::shuffle(order.begin(), order.end(), std::mt19937_64(seed));
  ParticleSystem<double> other;
  for (const Index i : order) other.add("", s.masses()[i], s.positions()[i], s.velocities()[i]);
  other.set_box(s.box());
  VectorColumn<std::int32_t> images(s.images().size());
  for (Index k = 0; k < images.size(); ++k) images.set(k, s.images()[order[static_cast<std::size_t>(k)]]);
  other.restore_images(std::move(images));
  return other;
}

template <class M> void append_figures(const M& monitor, std::vector<double>& all) {
  for (const Series& series : monitor.series()) all.insert(all.end(), series.values.begin(), series.values.end());
  const MonitorReport report = monitor.report();
  for (const auto& figure : {report.first, report.last, report.worst, report.rms, report.slope, report.scale}) {
    all.push_back(figure.value_or(0));
  }
}

/// What all monitors that sum over particles have to say of a flight without forces.
std::vector<double> figures_of(const ParticleSystem<double>& s) {
  Simulation<double> sim(s, compose(test::kinetic_potential(), schemes::verlet), 0x1p-7);
  const auto& energy = sim.every(1, Energy{});
  const auto& shadow = sim.every(1, ShadowHamiltonian<>({4, 8}));
  const auto& momentum = sim.every(1, Momentum{});
  const auto& angular = sim.every(1, AngularMomentum{});
  const auto& center = sim.every(1, CenterOfMass{});
  const auto& temperature = sim.every(2, Temperature{});
  const auto& displacement = sim.every(1, MeanSquareDisplacement(4, 2));
  const auto& correlation = sim.every(1, VelocityAutocorrelation(4, 2));
  const Pressure* pressure = s.box().is_periodic() ? &sim.every(1, Pressure{}) : nullptr;
  REQUIRE(sim.run(12).ok());
  std::vector<double> all;
  append_figures(energy, all);
  append_figures(shadow, all);
  append_figures(momentum, all);
  append_figures(angular, all);
  append_figures(center, all);
  append_figures(temperature, all);
  append_figures(displacement, all);
  append_figures(correlation, all);
  if (pressure != nullptr) append_figures(*pressure, all);
  return all;
}

std::vector<double> momenta_of(const ParticleSystem<double>& s) {
  std::vector<double> all;
  for (const WideSums& sums : {weighted_sum(s, s.velocities()), weighted_positions(s), angular_momentum(s)}) {
    all.insert(all.end(), sums.high, sums.high + 3);
    all.insert(all.end(), sums.low, sums.low + 3);
  }
  return all;
}

double plain_momentum(const ParticleSystem<double>& s) {
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * s.velocities().component(0)[i];
  return sum;
}

}  // namespace

TEST_CASE("an exact sum is the sum rounded once, to even where it lies between two doubles", "[sums]") {
  for (const auto& sum : {exact_sum, sum_of}) {
    CHECK(sum({}) == 0);
    CHECK(sum({1.5}) == 1.5);
    CHECK(sum({-least}) == -least);
    CHECK(sum({most, 1, -most}) == 1);
    CHECK(sum({most, most, -most}) == most);
    CHECK(sum({1e16, 1, -1e16}) == 1);
    CHECK(sum({1, 0x1p-53}) == 1);
    CHECK(sum({1, 0x1p-53, least}) == 1 + 0x1p-52);
    CHECK(sum({-1, -0x1p-53, -least}) == -1 - 0x1p-52);
    CHECK(sum({1 + 0x1p-52, 0x1p-53}) == 1 + 0x1p-51);
    CHECK(sum({1, 0x1p-53, -least}) == 1);
    CHECK(sum({0x1p-1022, -least}) == 0x1p-1022 - least);
    CHECK(sum({least, least, least}) == 3 * least);
    CHECK(sum({0x1p300, -0x1p-300, -0x1p300}) == -0x1p-300);
    CHECK(sum({most, most}) == infinite);
    CHECK(sum({-infinite, most}) == -infinite);
    CHECK(std::isnan(sum({infinite, -infinite})));
    CHECK(std::isnan(sum({std::numeric_limits<double>::quiet_NaN(), 1})));
  }
}

TEST_CASE("an exact sum is that of 113 bits where these suffice", "[sums]") {
  Numbers numbers(1);
  for (const Index n : {1, 2, 5, 63, 64, 65, 700}) {
    std::vector<double> all;
    Quad sum = 0;
    for (Index i = 0; i < n; ++i) {
      all.push_back(std::nearbyint(numbers.next(20) * 0x1p40) * 0x1p-40);  // 113 bits hold the sums of these
      sum += Quad(all.back());
    }
    CHECK(exact_sum(all) == static_cast<double>(sum));
    CHECK(sum_of(all) == static_cast<double>(sum));
  }
}

TEST_CASE("sums of numbers that cancel do not depend on their order, nor on threads", "[sums][determinism]") {
  Numbers numbers(2);
  for (const Index n : {2, 3, 64, 65, 1000, 5000}) {
    std::vector<double> all;
    while (std::ssize(all) < n) {
      all.push_back(numbers.next(300));
      if (std::ssize(all) % 3 != 0) all.push_back(-all.back());
    }
    const double sum = sum_of(all);
    CHECK(sum == exact_sum(all));
    for (int round = 0; round < 5; ++round) {
      const Threads threads(1 + round % 3);
      std::shuffle(all.begin(), all.end(), numbers.random());
      CAPTURE(n, round);
      CHECK(bits_of({sum_of(all)}) == bits_of({sum}));
    }
  }
}

TEST_CASE("momenta and moments do not depend on the order of particles, at any SIMD level", "[sums][determinism]") {
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    CAPTURE(name(level));
    for (const Index n : {1, 2, 3, 5, 8, 13, 300, 1001}) {
      for (const double size : {1.0, 0x1p985, 0x1p-1000}) {
        ParticleSystem<double> s = crowd(n, Box{});
        for (Index i = 0; i < n; ++i) s.masses()[i] *= size;
        const auto expected = bits_of(momenta_of(s));
        for (const std::uint64_t seed : {0, 1, 2, 3}) {
          CAPTURE(n, size, seed);
          CHECK(bits_of(momenta_of(reordered(s, seed))) == expected);
        }
      }
    }
  }
}

TEST_CASE("what monitors tell does not depend on the order of particles", "[sums][determinism]") {
  for (const Box& box : {Box{}, Box::periodic({8, 16, 32})}) {
    for (const Index n : {2, 3, 7, 64, 66, 400}) {
      const ParticleSystem<double> s = crowd(n, box);
      const auto expected = bits_of(figures_of(s));
      for (const std::uint64_t seed : {0, 1, 2}) {
        const Threads threads(static_cast<int>(1 + seed));
        CAPTURE(n, seed, box.is_periodic());
        CHECK(bits_of(figures_of(reordered(s, seed))) == expected);
      }
    }
  }
}

TEST_CASE("a wide sum is the exact one, in any order, in lanes too", "[sums]") {
  Numbers numbers(4);
  for (const Index n : {1, 2, 3, 64, 1000, 5000}) {
    std::vector<double> all;
    while (std::ssize(all) < n) {
      all.push_back(numbers.next(20));
      if (std::ssize(all) % 3 != 0) all.push_back(-all.back() * (1 + 0x1p-20));
    }
    const double expected = exact_sum(all);
    for (int round = 0; round < 5; ++round) {
      WideSum<double> first, second;
      WideSum<Pack> lanes;
      WideSum<Quad> quad;
      for (std::size_t k = 0; k < all.size(); ++k) {
        (k % 2 == 0 ? first : second) += all[k];
        Pack pack(0.0);
        pack.lane[3] = all[k];
        pack.lane[5] = -all[k];
        lanes += pack;
        quad += Quad(all[k]);
      }
      first += second;
      CAPTURE(n, round);
      CHECK(first.value() == expected);
      CHECK(lanes.value().lane[3] == expected);
      CHECK(lanes.value().lane[5] == -expected);
      CHECK(lanes.lane(5).value() == -expected);
      CHECK(static_cast<double>(quad.value()) == expected);
      std::shuffle(all.begin(), all.end(), numbers.random());
    }
  }
  const auto sum = [](std::initializer_list<double> terms) {
    WideSum<double> all;
    for (const double x : terms) all += x;
    return all.value();
  };
  CHECK(sum({1, infinite, 2}) == infinite);
  CHECK(sum({1, -infinite, 2}) == -infinite);
  CHECK(std::isnan(sum({infinite, -infinite})));
  CHECK(std::isnan(sum({1, std::numeric_limits<double>::quiet_NaN()})));
}

/// Energy and virial of a force, ten numbers.
template <class F> std::vector<double> energy_and_virial(const F& force, const ParticleSystem<double>& s) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true, .virial = true});
  force.add_to(sink, s);
  std::vector<double> all = {sink.potential()};
  const Mat3<double> virial = sink.virial();
  all.insert(all.end(), virial.data(), virial.data() + 9);
  return all;
}

TEST_CASE("energies and virials of forces do not depend on the order of their terms", "[sums][determinism]") {
  const Index n = 400;
  const ParticleSystem<double> s = crowd(n, Box{});
  const UniformField field{.acceleration = {0.3, -0.7, 0.1}};
  const auto of_field = bits_of(energy_and_virial(field, s));
  HarmonicBond springs{.k = 0.3, .length = 0.1};
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"harmonic", {2.5, 0.7}}};
  topology->angle_kinds = {{"harmonic", {1.5, 1.9}}};
  std::vector<std::array<Index, 2>> pairs;
  for (Index i = 0; i + 2 < n; ++i) {
    pairs.push_back({i, i + 1});
    topology->bonds.push_back({{i, i + 1}, 0});
    topology->angles.push_back({{i, i + 1, i + 2}, 0});
  }
  const auto of_terms = [&] {
    ParticleSystem<double> bound = s;
    bound.set_topology(std::make_shared<const Topology>(*topology));
    springs.tied = Tied<2>(pairs);
    std::vector<double> all = energy_and_virial(springs, s);
    const std::vector<double> bonded = energy_and_virial(Bonded{}, bound);
    all.insert(all.end(), bonded.begin(), bonded.end());
    return all;
  };
  const std::vector<double> expected = of_terms();
  CHECK(*std::min_element(expected.begin(), expected.end()) != 0);
  Numbers numbers(6);
  int plain_differs = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ParticleSystem<double> other = reordered(s, seed);
    CHECK(bits_of(energy_and_virial(field, other)) == of_field);
    std::shuffle(pairs.begin(), pairs.end(), numbers.random());
    std::shuffle(topology->bonds.begin(), topology->bonds.end(), numbers.random());
    std::shuffle(topology->angles.begin(), topology->angles.end(), numbers.random());
    const Threads threads(static_cast<int>(seed));
    CHECK(bits_of(of_terms()) == bits_of(expected));
    const auto plain = [](const ParticleSystem<double>& of) {
      double sum = 0;
      for (Index i = 0; i < n; ++i) sum += of.masses()[i] * of.positions()[i][0];
      return sum;
    };
    plain_differs += plain(s) == plain(other) ? 0 : 1;
  }
  CHECK(plain_differs > 0);  // else nothing is shown
}

TEST_CASE("an escape is told alike in any order of particles", "[sums][stop]") {
  const auto found = [](const ParticleSystem<double>& s) {
    Simulation<double> sim(s, compose(test::kinetic_potential(), schemes::verlet), 0x1p-3);
    sim.stop_when(farther_than(300), 1);
    return sim.run(100'000).message;
  };
  const ParticleSystem<double> s = crowd(40, Box{});
  const std::string expected = found(s);
  CHECK(expected.find("escape of ") != std::string::npos);
  for (const std::uint64_t seed : {0, 1, 2}) CHECK(found(reordered(s, seed)) == expected);
}

TEST_CASE("the crowds of these tests are such that plain sums depend on the order", "[sums]") {
  int different = 0;
  for (const Index n : {7, 64, 400}) {
    const ParticleSystem<double> s = crowd(n, Box{});
    different += plain_momentum(s) == plain_momentum(reordered(s, 1)) ? 0 : 1;
  }
  CHECK(different >= 2);
}

}  // namespace noether::test
