/// The stages of Encke's method in lanes, against the solver of Kepler's equation and its derivative one by one.

#include "integrators/kepler.hpp"
#include "integrators/kepler_tangent.hpp"
#include "integrators/methods/encke_simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

using namespace noether;

namespace {

constexpr std::array<double, 8> stage_parts = {0.02, 0.1, 0.24, 0.41, 0.59, 0.76, 0.9, 0.98};

/// At pericenter of an orbit of semi-major axis 1 (below 0: a hyperbola) about mu = 1.25, turned out of the plane.
EnckeBody encke_body(double e) {
  EnckeBody body;
  body.mu = 1.25;
  const double q = std::abs(1 - e), v = std::sqrt(body.mu * (1 + e) / q);
  const std::array<double, 3> x = {0.6 * q, 0.8 * q, 0}, w = {-0.64 * v, 0.48 * v, 0.6 * v};
  for (std::size_t k = 0; k < 3; ++k) {
    body.x0[k] = x[k];
    body.v0[k] = w[k];
  }
  return body;
}

template <class Check> void at_each_level(const Check& check) {
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    const test::AtLevel at(level);
    INFO(name(level));
    check();
  }
}

}  // namespace

TEST_CASE("arcs in lanes are those of the solver, forth and back, or say that they are not", "[encke][lanes]") {
  at_each_level([] {
    int found = 0;
    for (const double e : {0.0, 0.3, 0.7, 1.4}) {
      for (const double h : {0.05, 0.4, -0.4, 1.2, 5.0}) {
        EnckeBody body = encke_body(e);
        alignas(64) EightWords times = {};
        const auto& tau = times[0];
        for (std::size_t i = 0; i < 8; ++i) times[0][i] = h * stage_parts[i];
        encke_kernels().orbits(&body, 1, times);
        const unsigned missed = body.missed;
        const Vec3<double> x(body.x0[0], body.x0[1], body.x0[2]), v(body.v0[0], body.v0[1], body.v0[2]);
        for (std::size_t i = 0; i < 8; ++i) {
          CAPTURE(e, h, i);
          if ((missed >> i & 1U) != 0) continue;
          ++found;
          const KeplerArc<double> arc = kepler_arc(x, v, body.mu, tau[i]);
          const std::array<double, 8> upper = KeplerTangent(x, v, body.mu, tau[i], arc.s).upper();
          const Vec3<double> place = x + arc.dx;
          const double r = std::sqrt(norm2(place));
          for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(body.orbit[k][i] - place[static_cast<Index>(k)]) < 4e-15 * std::max(r, 1.0));
          for (std::size_t k = 0; k < 8; ++k)
            CHECK(std::abs(body.upper[k][i] - upper[k]) < 1e-12 * (1 + std::abs(upper[k])));
          CHECK(std::abs(body.inverse_r2[i] * r * r - 1) < 1e-13);
          CHECK(std::abs(body.mu_r3[i] * r * r * r / body.mu - 1) < 1e-13);
        }
        const bool short_arc = std::abs(h) < 0.1 && e < 0.5;
        if (short_arc) CHECK(missed == 0);
        if (h == 5.0 && e == 0.0) CHECK((missed >> 7U & 1U) == 1);  // beyond two radians
      }
    }
    CHECK(found > 60);
  });
}

TEST_CASE("a body at the centre has no arc in lanes", "[encke][lanes]") {
  at_each_level([] {
    EnckeBody body = encke_body(0.2);
    for (double& x : body.x0) x = 0;
    alignas(64) EightWords tau = {};
    std::copy(stage_parts.begin(), stage_parts.end(), tau[0]);
    encke_kernels().orbits(&body, 1, tau);
    CHECK(body.missed == 0xff);
  });
}

TEST_CASE("attraction in lanes is Newton's, and pulls of both bodies cancel", "[encke][lanes]") {
  at_each_level([] {
    std::array<EnckeBody, 2> bodies = {encke_body(0.1), encke_body(0.1)};
    const std::array<double, 2> gm = {1e-3, 2e-3};
    for (std::size_t m = 0; m < 2; ++m) {
      EnckeBody& body = bodies[m];
      body.gm = gm[m];
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 8; ++i)
          body.orbit[k][i] = body.x0[k] + static_cast<double>(m * (k + 1)) + stage_parts[i];
      }
      for (std::size_t i = 0; i < 8; ++i) {
        const double r2 = body.orbit[0][i] * body.orbit[0][i] + body.orbit[1][i] * body.orbit[1][i] +
                          body.orbit[2][i] * body.orbit[2][i];
        body.inverse_r2[i] = 1 / r2;
        body.mu_r3[i] = body.mu / (r2 * std::sqrt(r2));
      }
    }
    alignas(64) std::array<double, 64> weights{};
    encke_kernels().depart(bodies.data(), 2, weights.data(), 0.1);  // no rates: no departures
    const double strongest = encke_kernels().attract(bodies.data(), 2);
    double largest = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      const auto at = [&](std::size_t m) {
        return Vec3<double>(bodies[m].place[0][i], bodies[m].place[1][i], bodies[m].place[2][i]);
      };
      const auto over_cube = [](const Vec3<double>& d) { return Vec3<double>(d / std::pow(norm2(d), 1.5)); };
      const Vec3<double> apart = at(1) - at(0);
      largest = std::max(largest, (gm[0] + gm[1]) / std::pow(norm2(apart), 1.5));
      const Vec3<double> on_first = gm[1] * (over_cube(apart) - over_cube(at(1))),
                         on_second = gm[0] * (-over_cube(apart) - over_cube(at(0)));
      for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(i, k);
        CHECK(bodies[0].away[k][i] == 0);
        CHECK(bodies[0].place[k][i] == bodies[0].orbit[k][i]);
        CHECK(std::abs(bodies[0].fresh[k][i] - on_first[static_cast<Index>(k)]) < 1e-17);
        CHECK(std::abs(bodies[1].fresh[k][i] - on_second[static_cast<Index>(k)]) < 1e-17);
      }
    }
    CHECK(std::abs(strongest / largest - 1) < 1e-14);
  });
}

TEST_CASE("what rounding takes from mu pulls towards the heaviest body", "[encke][lanes]") {
  at_each_level([] {
    EnckeBody body = encke_body(0.1);
    body.mu_low = 3e-17;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 8; ++i) body.orbit[k][i] = body.x0[k] + stage_parts[i];
    }
    alignas(64) std::array<double, 64> weights{};
    encke_kernels().depart(&body, 1, weights.data(), 0.1);
    encke_kernels().attract(&body, 1);
    for (std::size_t i = 0; i < 8; ++i) {
      const Vec3<double> at(body.orbit[0][i], body.orbit[1][i], body.orbit[2][i]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double pull = -3e-17 * body.orbit[k][i] / std::pow(norm2(at), 1.5);
        CAPTURE(i, k);
        CHECK(std::abs(body.fresh[k][i] - pull) < 1e-14 * std::abs(pull));
      }
    }
  });
}
