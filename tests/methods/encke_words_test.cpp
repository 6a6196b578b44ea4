/// Beginning and end of a step of Encke's method, eight bodies in lanes: against arcs one by one, and bit for bit.

#include "integrators/kepler_double_double.hpp"
#include "integrators/kepler_tangent.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/encke_simd.hpp"
#include "integrators/methods/encke_words_simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

using namespace noether;

namespace {

constexpr std::size_t lanes = 8;

template <class Check> void words_at_each_level(const Check& check) {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    INFO(name(level));
    check();
  }
}

void put(EightWords& words, std::size_t lane, const DoubleDouble& value) {
  words[0][lane] = value.high;
  words[1][lane] = value.low;
}
DoubleDouble get(const EightWords& words, std::size_t lane) { return {words[0][lane], words[1][lane]}; }

EnckeWeights weights() {
  EnckeWeights w;
  const CollocationTable& table = gauss_table(lanes);
  const auto last = table.last_coefficient();
  for (std::size_t i = 0; i < lanes; ++i) {
    put(w.end, i, DoubleDouble(table.b[i]));
    w.last[i] = static_cast<double>(last[i]);
  }
  return w;
}

/// Eight bodies on ellipses of e from 0 to 0.7 about mu near 1, some of the numbers with a second word, and the rates
/// of their stages; the arcs of the stages are found.
struct Step {
  double h;
  std::array<EnckeBody, lanes> bodies;
  EnckeEight eight;
  alignas(64) EightWords primary = {}, tau = {};

  explicit Step(double length) : h(length) {
    for (std::size_t k = 0; k < 6; ++k) put(primary, k, {0.01 * (1.0 + static_cast<double>(k)), 1e-19});
    for (std::size_t i = 0; i < lanes; ++i) tau[0][i] = h * static_cast<double>(gauss_table(lanes).c[i]);
    for (std::size_t m = 0; m < lanes; ++m) {
      const double number = static_cast<double>(m), e = 0.1 * number, turn = 0.7 * number;
      const double v = std::sqrt((1 + e) / (1 - e));
      const std::array<double, 6> state = {(1 - e) * std::cos(turn), (1 - e) * std::sin(turn), 0.1,
                                           -v * std::sin(turn),      v * std::cos(turn),       0};
      put(eight.mu, m, {1 + 0.01 * number, 1e-17 * number});
      put(eight.share, m, {0.001 * (1 + number), 1e-20 * number});
      for (std::size_t k = 0; k < 6; ++k)
        put(eight.at[k], m, DoubleDouble::sum(primary[0][k] + state[k], 1e-18 * number));
    }
    encke_word_kernels().relate(&eight, 1, primary);
    find();
  }
  void find() {
    for (std::size_t m = 0; m < lanes; ++m) begin(m);
    encke_kernels().orbits(bodies.data(), lanes, tau);
    for (std::size_t m = 0; m < lanes; ++m) {
      eight.last_s[m] = bodies[m].last_s;
      eight.last_r[m] = bodies[m].last_r;
      eight.last_eta[m] = bodies[m].last_eta;
    }
    std::array<const EnckeBody*, lanes> all{};
    for (std::size_t m = 0; m < lanes; ++m) all[m] = &bodies[m];
    encke_word_kernels().sum(all.data(), weights(), eight);
  }
  void begin(std::size_t m) {
    EnckeBody& body = bodies[m];
    body.mu = eight.mu[0][m];
    for (std::size_t k = 0; k < 3; ++k) {
      body.x0[k] = eight.own[k][0][m];
      body.v0[k] = eight.own[k + 3][0][m];
    }
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t i = 0; i < lanes; ++i)
        body.rate[k][i] = 1e-3 * std::sin(static_cast<double>(1 + m + 3 * k) * (1 + static_cast<double>(i)));
    }
  }
  unsigned advance() { return encke_word_kernels().advance(eight, h, tau[0][lanes - 1]); }
  Vec3<DoubleDouble> own(std::size_t m, std::size_t first) const {
    return {get(eight.own[first], m), get(eight.own[first + 1], m), get(eight.own[first + 2], m)};
  }
};

Vec3<double> high(const Vec3<DoubleDouble>& a) { return {a[0].high, a[1].high, a[2].high}; }

}  // namespace

TEST_CASE("bodies in lanes move along arcs in double-double with their departures, forth and back", "[encke][lanes]") {
  words_at_each_level([] {
    for (const double h : {0.02, 0.3, 0.5, -0.4}) {
      Step step(h);
      CAPTURE(h);
      CHECK((step.advance() & 0x1fU) == 0);  // up to e = 0.4
      for (std::size_t m = 0; m < 5; ++m) {
        const Vec3<DoubleDouble> x = step.own(m, 0), v = step.own(m, 3);
        const DoubleDouble mu = get(step.eight.mu, m);
        const auto arc = kepler_arc(x, v, mu, DoubleDouble(h));
        KeplerChange sum;
        for (std::size_t k = 0; k < 3; ++k) {
          sum.x[static_cast<Index>(k)] = step.eight.sums[k][0][m];
          sum.v[static_cast<Index>(k)] = step.eight.sums[k + 3][0][m];
        }
        const KeplerTangent tangent(high(x), high(v), mu.high, h, arc.s.high);
        const Vec3<double> away = h * tangent.position(sum), faster = h * tangent.velocity(sum);
        for (Index k = 0; k < 3; ++k) {
          CAPTURE(m, k);
          const auto off = [&](std::size_t row, const DoubleDouble& along) {
            return (get(step.eight.moved[row], m) - along).high;
          };
          const auto axis = static_cast<std::size_t>(k);
          CHECK(std::abs(off(axis, arc.dx[k]) - away[k]) < 1e-18);
          CHECK(std::abs(off(axis + 3, arc.dv[k]) - faster[k]) < 3e-18);
        }
      }
    }
  });
}

TEST_CASE("arcs of bodies in lanes without departures are right to 1e-29", "[encke][lanes]") {
  words_at_each_level([] {
    for (const double h : {0.02, 0.3, 0.5, -0.4}) {
      Step step(h);
      for (auto& sum : step.eight.sums) std::memset(sum, 0, sizeof sum);
      const unsigned missed = step.advance();
      CHECK((missed & 0x1fU) == 0);
      for (std::size_t m = 0; m < lanes; ++m) {
        if ((missed >> m & 1U) != 0) continue;
        const auto arc = kepler_arc<Quad>(step.own(m, 0).cast<Quad>(), step.own(m, 3).cast<Quad>(),
                                          Quad(get(step.eight.mu, m)), Quad(h));
        for (Index k = 0; k < 3; ++k) {
          CAPTURE(h, m, k);
          const auto axis = static_cast<std::size_t>(k);
          CHECK(static_cast<double>(abs(Quad(get(step.eight.moved[axis], m)) - arc.dx[k])) < 1e-29);
          CHECK(static_cast<double>(abs(Quad(get(step.eight.moved[axis + 3], m)) - arc.dv[k])) < 4e-29);
        }
      }
    }
  });
}

TEST_CASE("arcs that lanes do not serve are left to others", "[encke][lanes]") {
  words_at_each_level([] {
    Step far(5);  // most of a turn
    CHECK((far.advance() & 1U) == 1);
    Step flat(0.3);
    put(flat.eight.own[2], 3, {1e-200, 0});  // its products would underflow
    flat.find();
    CHECK((flat.advance() >> 3 & 1U) == 1);
    Step level(0.3);
    put(level.eight.own[2], 3, {0, 0});
    level.find();
    CHECK((level.advance() >> 3 & 1U) == 0);
    Step central(0.3);
    for (auto& words : central.eight.own) put(words, 2, {0, 0});
    central.find();
    CHECK((central.advance() >> 2 & 1U) == 1);
  });
}

TEST_CASE("what rounding takes from weights of the end is in the second word of sums", "[encke][lanes]") {
  words_at_each_level([] {
    Step step(0.3);
    std::array<const EnckeBody*, lanes> all{};
    for (std::size_t m = 0; m < lanes; ++m) {
      for (auto& rate : step.bodies[m].rate) {
        for (std::size_t i = 0; i < lanes; ++i) rate[i] = static_cast<double>(i * i);
      }
      all[m] = &step.bodies[m];
    }
    encke_word_kernels().sum(all.data(), weights(), step.eight);
    Quad high(0), low(0);
    for (std::size_t i = 0; i < lanes; ++i) {
      const Quad b = gauss_table(lanes).b[i], rate(static_cast<double>(i * i));
      high += b * rate;
      low += (b - Quad(weights().end[0][i])) * rate;
    }
    REQUIRE(std::abs(static_cast<double>(low)) > 1e-18);
    for (std::size_t k = 0; k < 6; ++k) {
      CHECK(std::abs(step.eight.sums[k][0][5] - static_cast<double>(high)) < 2e-14);
      CHECK(std::abs(step.eight.sums[k][1][5] - static_cast<double>(low)) < 1e-29);
    }
  });
}

TEST_CASE("the centre of mass goes on evenly", "[encke][lanes]") {
  words_at_each_level([] {
    Step step(0.3);
    const auto center = [&](std::size_t k) {
      Quad sum(get(step.primary, k));
      for (std::size_t m = 0; m < lanes; ++m)
        sum += Quad(get(step.eight.share, m)) * (Quad(get(step.eight.at[k], m)) - Quad(get(step.primary, k)));
      return sum;
    };
    std::array<Quad, 6> before;
    for (std::size_t k = 0; k < 6; ++k) before[k] = center(k);
    step.advance();
    alignas(64) const std::array<double, lanes> push = {1e-5, 0, 0, 0, 2e-5};
    encke_word_kernels().place(&step.eight, 1, step.primary, push.data(), step.h);
    for (std::size_t k = 0; k < 6; ++k) {
      const Quad along = k < 3 ? Quad(step.h) * before[k + 3] : Quad(0);
      CAPTURE(k);
      CHECK(std::abs(static_cast<double>(center(k) - before[k] - along - Quad(push[k]))) < 1e-30);
    }
  });
}

TEST_CASE("steps of eight bodies have the same bits at every level", "[encke][lanes]") {
  std::vector<std::array<double, lanes>> first;
  words_at_each_level([&] {
    std::vector<std::array<double, lanes>> rows;
    const auto keep = [&](const double* row) {
      rows.emplace_back();
      std::copy_n(row, lanes, rows.back().data());
    };
    for (const double h : {0.02, 0.3, 0.5, -0.4}) {
      Step step(h);
      step.advance();
      alignas(64) const std::array<double, lanes> push{};
      encke_word_kernels().place(&step.eight, 1, step.primary, push.data(), h);
      for (const auto& words : {step.eight.at, step.eight.own, step.eight.moved, step.eight.sums}) {
        for (std::size_t k = 0; k < 6; ++k) keep(words[k][0]), keep(words[k][1]);
      }
      for (const EnckeBody& body : step.bodies) {
        for (const auto& row : body.orbit) keep(row);
        for (const auto& row : body.upper) keep(row);
      }
    }
    if (first.empty()) first = rows;
    REQUIRE(rows.size() == first.size());
    CHECK(std::memcmp(rows.data(), first.data(), rows.size() * sizeof rows[0]) == 0);
  });
}
