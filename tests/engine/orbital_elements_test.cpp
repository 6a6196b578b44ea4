#include "engine/orbital_elements.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace noether {
namespace {

template <class Real> double relative(const Vec3<Real>& a, const Vec3<Real>& b) {
  using std::sqrt;
  return static_cast<double>(sqrt(norm2(a - b) / norm2(b)) / std::numeric_limits<Real>::epsilon());
}

double error_in_ulps(const Vec3<double>& rounded, const Vec3<Quad>& exact) {
  const Vec3<Quad> wide{Quad(rounded[0]), Quad(rounded[1]), Quad(rounded[2])};
  return static_cast<double>(sqrt(norm2(wide - exact) / norm2(exact))) / std::numeric_limits<double>::epsilon();
}

/// Elements of a state and back: the larger relative change of x and v, in units of rounding.
template <class Real> double there_and_back(const OrbitalElements<Real>& o, const Real& mu) {
  const auto [x, v] = state_from_elements(o, mu);
  const auto [y, w] = state_from_elements(elements_from_state<Real>(x, v, mu), mu);
  return std::max(relative(y, x), relative(w, v));
}

/// Kepler's equation in Quad, of an anomaly that came from a state.
Quad kepler_residual(const Vec3<Quad>& x, const Quad& a, const Quad& e, const Quad& M) {
  const Quad cosine = (Quad(1) - sqrt(norm2(x)) / a) / e;
  const Quad E = acos(cosine);
  return E - e * sin(E) - M;
}

}  // namespace

TEST_CASE("elements to state and back is exact to rounding for every eccentricity", "[orbital_elements]") {
  const double below = 1 - 1e-12, above = 1 + 1e-12;
  for (const double e : {0.0, 1e-12, 1e-6, 0.1, 0.5, 0.9, 0.999, 1 - 1e-6, below, above, 1 + 1e-6, 1.1, 2.0, 1e4}) {
    const double a = e < 1 ? 1.5 : -1.5;
    // e itself is known to rounding only, so near a parabola 1 - e is not known better.
    const double bound = 40 / std::min(1.0, std::abs(1 - e));
    for (const double M : {0.0, 1e-12, 1e-5, 0.1, 1.0, 3.0, 5.0, 6.0}) {
      CAPTURE(e, M);
      CHECK(there_and_back<Quad>({Quad(a), Quad(e), Quad(0.3), Quad(2), Quad(4), Quad(M)}, Quad(2)) < bound);
      CHECK(there_and_back<double>({a, e, 0.3, 2, 4, M}, 2) < bound);
    }
  }
}

TEST_CASE("elements come back as they were given", "[orbital_elements]") {
  const OrbitalElements<Quad> o{Quad(3), Quad(0.25), Quad(1.25), Quad(5), Quad(2.5), Quad(6)};
  const auto [x, v] = state_from_elements(o, Quad(0.7));
  const OrbitalElements<Quad> p = elements_from_state<Quad>(x, v, Quad(0.7));
  const Quad ulps = Quad(64) * std::numeric_limits<Quad>::epsilon();
  CHECK(abs(p.a - o.a) < ulps);
  CHECK(abs(p.e - o.e) < ulps);
  CHECK(abs(p.inc - o.inc) < ulps);
  CHECK(abs(p.Omega - o.Omega) < ulps);
  CHECK(abs(p.omega - o.omega) < ulps);
  CHECK(abs(p.M - o.M) < ulps);
}

TEST_CASE("Kepler's equation is solved to rounding up to e = 1 - 1e-12", "[orbital_elements]") {
  for (const double e : {0.1, 0.9, 0.999999, 1 - 1e-12}) {
    for (const double M : {1e-6, 1e-3, 0.5, 2.0, 3.0}) {
      CAPTURE(e, M);
      const auto state = state_from_elements<Quad>({Quad(1), Quad(e), Quad(0), Quad(0), Quad(0), Quad(M)}, Quad(1));
      // The arc cosine of this check loses digits where the orbit is near its pericenter.
      CHECK(abs(kepler_residual(state.first, Quad(1), Quad(e), Quad(M))) < Quad(1e-27));
    }
  }
}

TEST_CASE("a double state is the Quad state to rounding, at the pericenter of a needle too", "[orbital_elements]") {
  for (const double e : {0.0, 0.5, 0.99, 1 - 1e-12, 1 + 1e-12, 2.0}) {
    for (const double M : {1e-15, 1e-9, 1e-4, 0.5, 2.5}) {
      const double a = e < 1 ? 1 : -1;
      const auto narrow = state_from_elements<double>({a, e, 0.5, 1, 2, M}, 1);
      const auto wide = state_from_elements<Quad>({Quad(a), Quad(e), Quad(0.5), Quad(1), Quad(2), Quad(M)}, Quad(1));
      CAPTURE(e, M);
      CHECK(error_in_ulps(narrow.first, wide.first) < 8);
      CHECK(error_in_ulps(narrow.second, wide.second) < 8);
    }
  }
}

TEST_CASE("a hyperbola obeys its own Kepler equation", "[orbital_elements]") {
  for (const double e : {1 + 1e-9, 1.5, 30.0}) {
    for (const double M : {0.2, 4.0, 500.0}) {
      CAPTURE(e, M);
      const auto state = state_from_elements<Quad>({Quad(-1), Quad(e), Quad(0), Quad(0), Quad(0), Quad(M)}, Quad(1));
      const Quad H = acosh((Quad(1) + sqrt(norm2(state.first))) / Quad(e));
      CHECK(abs((Quad(e) * sinh(H) - H) / Quad(M) - Quad(1)) < Quad(1e-28));
    }
  }
}

TEST_CASE("energy and angular momentum of a state are those of its elements", "[orbital_elements]") {
  for (const double e : {0.0, 0.3, 0.97, 1.4}) {
    const Quad a(e < 1 ? 2 : -2), mu(3), inc(0.8);
    const auto [x, v] = state_from_elements<Quad>({a, Quad(e), inc, Quad(1), Quad(2), Quad(0.7)}, mu);
    const Quad energy = norm2(v) / Quad(2) - mu / sqrt(norm2(x));
    const Vec3<Quad> h = cross<Quad>(x, v);
    CAPTURE(e);
    CHECK(abs(energy + mu / (Quad(2) * a)) < Quad(1e-31));
    CHECK(abs(norm2(h) - mu * a * (Quad(1) - Quad(e) * Quad(e))) < Quad(1e-31));
    CHECK(abs(h[2] - sqrt(norm2(h)) * cos(inc)) < Quad(1e-31));
  }
}

TEST_CASE("where an angle has no meaning it is 0 and the others carry the position", "[orbital_elements]") {
  const auto flat = state_from_elements<double>({1, 0.2, 0, 1.0, 0.5, 0.3}, 1);
  const auto o = elements_from_state<double>(flat.first, flat.second, 1);
  CHECK(o.inc == 0);
  CHECK(o.Omega == 0);
  CHECK(std::abs(o.omega - 1.5) < 1e-15);

  const auto circle = elements_from_state<double>(Vec3<double>(0, 1, 0), Vec3<double>(-1, 0, 0), 1);
  CHECK(circle.e == 0);
  CHECK(circle.omega == 0);
  CHECK(circle.M == std::numbers::pi / 2);

  const auto backwards = elements_from_state<double>(Vec3<double>(1, 0, 0), Vec3<double>(0, -1.1, 0), 1);
  CHECK(backwards.inc == std::numbers::pi);
  CHECK(backwards.Omega == 0);
}

TEST_CASE("a parabola and a straight line are told apart and do not throw", "[orbital_elements]") {
  const auto parabola = elements_from_state<double>(Vec3<double>(2, 0, 0), Vec3<double>(0, 1, 0), 1);
  CHECK(std::isinf(parabola.a));
  CHECK(parabola.e == 1);
  CHECK(std::isnan(parabola.M));
  CHECK(parabola.inc == 0);

  const auto line = elements_from_state<double>(Vec3<double>(1, 0, 0), Vec3<double>(0.5, 0, 0), 1);
  CHECK(line.e == 1);
  CHECK(std::isnan(line.inc));
  CHECK(std::isfinite(line.M));
}

TEST_CASE("elements that are no orbit are refused", "[orbital_elements]") {
  const auto refused = [](double a, double e, double mu = 1) {
    try {
      state_from_elements<double>({a, e, 0, 0, 0, 0}, mu);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string none =
      " is neither an ellipse nor a hyperbola; expected 0 <= e < 1 with a > 0, or e > 1 with a < 0";
  CHECK(refused(1, 1.5) ==
        "e = 1.5 does not fit a > 0, which means an ellipse; expected 0 <= e < 1, or a < 0 for a hyperbola");
  CHECK(refused(1, 1) == "e = 1" + none);
  CHECK(refused(-1, 1) == "e = 1" + none);
  CHECK(refused(1, -0.1) == "e = -0.1" + none);
  CHECK(refused(-1, 0.5) ==
        "a = -1 does not fit e < 1, which means an ellipse; expected a > 0, or e > 1 for a hyperbola");
  CHECK(refused(0, 0.5) ==
        "a = 0 is not a valid semi-major axis; expected a > 0 for an ellipse, a < 0 for a hyperbola");
  CHECK(refused(1, 0.1, 0) == "an orbit about G m = 0 is impossible; a mass above 0 is expected");
  CHECK(refused(1, std::nan("")) == "e = nan is not finite; a finite number is expected");
}

}  // namespace noether
