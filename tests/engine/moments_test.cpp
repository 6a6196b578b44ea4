/// Sums over particles in lanes against 113 bits, at every SIMD level, for full and partly filled registers.

#include "engine/moments_simd.hpp"
#include "engine/particle_system.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <random>

namespace noether::test {
namespace {

/// Particles whose masses, positions and velocities are of very different sizes, and cancel.
ParticleSystem<double> crowd(Index n, double size = 1) {
  std::mt19937_64 random(static_cast<unsigned>(n));
  const auto number = [&] {
    const double part = static_cast<double>(random() >> 11U) * 0x1p-52 - 1;
    return std::ldexp(part, static_cast<int>(random() % 41) - 20);
  };
  ParticleSystem<double> s;
  for (Index i = 0; i < n; ++i) {
    const double m = i % 5 == 4 ? 0 : size * std::abs(number());
    const double x = number(), y = number(), z = number(), u = number(), v = number(), w = number();
    s.add("", m, {x, y, z}, {u, v, w});
    if (i % 3 == 2) s.add("", m, {x, y, z}, {-u, -v, -w});
  }
  return s;
}

struct Exact {
  Quad sum = 0, size = 0;
  void add(const Quad& term) {
    sum += term;
    size += abs(term);
  }
};

/// What twice the digits of a double leave open after so many additions.
void check(const WideSums& sums, const Exact (&exact)[3], Index n) {
  for (int k = 0; k < 3; ++k) {
    CAPTURE(k, n);
    const Quad found = Quad(sums.high[k]) + Quad(sums.low[k]);
    const Quad bound = Quad(static_cast<double>(n * n) * 0x1p-104) * exact[k].size;
    CHECK(abs(found - exact[k].sum) <= bound);
  }
}

void check_sums(const ParticleSystem<double>& s) {
  const auto &x = s.positions(), &v = s.velocities();
  Exact moments[3], angular[3];
  for (Index i = 0; i < s.size(); ++i) {
    const Quad m(s.masses()[i]);
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      moments[k].add(m * Quad(x.component(k)[i]));
      angular[k].add(m * Quad(x.component(a)[i]) * Quad(v.component(b)[i]));
      angular[k].add(-m * Quad(x.component(b)[i]) * Quad(v.component(a)[i]));
    }
  }
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    CAPTURE(name(level));
    WideSums sums{};
    const double* const positions[3] = {x.component(0), x.component(1), x.component(2)};
    moment_kernels().weighted({s.size(), s.masses().data(), {positions[0], positions[1], positions[2]}}, sums);
    check(sums, moments, s.size());
    moment_kernels().crossed({s.size(), s.masses().data(), {v.component(0), v.component(1), v.component(2)}}, positions,
                             sums);
    check(sums, angular, s.size());
  }
}

TEST_CASE("moments of particles are summed to twice the digits of a double", "[moments]") {
  for (const Index n : {1, 2, 3, 5, 6, 8, 11, 12, 13, 100}) check_sums(crowd(n));
}

TEST_CASE("masses of any size leave no product of their halves beyond the doubles", "[moments]") {
  check_sums(crowd(6, 0x1p900));
  check_sums(crowd(6, 0x1p-700));
}

TEST_CASE("nobody has no moments", "[moments]") {
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    WideSums sums{{1, 1, 1}, {1, 1, 1}};
    moment_kernels().weighted({0, nullptr, {nullptr, nullptr, nullptr}}, sums);
    for (int k = 0; k < 3; ++k) CHECK((sums.high[k] == 0 && sums.low[k] == 0));
  }
}

}  // namespace
}  // namespace noether::test
