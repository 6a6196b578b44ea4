#include "forces/gr_potential.hpp"
#include "forces/oblateness.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

using Matrix = std::vector<std::vector<Quad>>;

/// Component `d` of (x, v) of all particles: first all positions, then all velocities.
Quad get(const ParticleSystem<Quad>& s, std::size_t d) {
  const std::size_t half = 3 * static_cast<std::size_t>(s.size());
  const auto i = static_cast<Index>(d % half / 3);
  const auto k = static_cast<Index>(d % 3);
  return d < half ? s.positions()[i][k] : s.velocities()[i][k];
}
void shift(ParticleSystem<Quad>& s, std::size_t d, const Quad& by) {
  const std::size_t half = 3 * static_cast<std::size_t>(s.size());
  Vec3<Quad> e = Vec3<Quad>::Zero();
  e[static_cast<Index>(d % 3)] = by;
  const auto i = static_cast<Index>(d % half / 3);
  if (d < half) {
    s.positions()[i] += e;
  } else {
    s.velocities()[i] += e;
  }
}

/// Derivative of `steps` settled steps by central differences of order 2: errors of 1e-20.
template <class H>
Matrix derivative(const H& hamiltonian, const Scheme& scheme, const ParticleSystem<Quad>& start, double dt, int steps) {
  const Quad delta(1e-10);
  const std::size_t size = 6 * static_cast<std::size_t>(start.size());
  Matrix m(size, std::vector<Quad>(size));
  for (std::size_t column = 0; column < size; ++column) {
    auto plus = start, minus = start;
    shift(plus, column, delta);
    shift(minus, column, -delta);
    plus = run(hamiltonian, scheme, plus, dt, steps);
    minus = run(hamiltonian, scheme, minus, dt, steps);
    for (std::size_t row = 0; row < size; ++row) {
      m[row][column] = (get(plus, row) - get(minus, row)) / (Quad(2) * delta);
    }
  }
  return m;
}

/// Largest entry of M^T J M - factor J over the largest mass, J the form sum m dv ^ dx of momenta p = m v.
double defect(const Matrix& m, const ParticleSystem<Quad>& s, const Quad& factor = Quad(1)) {
  const std::size_t half = m.size() / 2;
  Quad worst(0), scale(0);
  for (Index i = 0; i < s.size(); ++i) scale = std::max(scale, s.masses()[i]);
  for (std::size_t a = 0; a < m.size(); ++a) {
    for (std::size_t b = 0; b < m.size(); ++b) {
      Quad form(0);
      for (std::size_t d = 0; d < half; ++d) {
        form += s.masses()[static_cast<Index>(d / 3)] * (m[d][a] * m[d + half][b] - m[d + half][a] * m[d][b]);
      }
      if (a + half == b) form -= factor * s.masses()[static_cast<Index>(a / 3)];
      if (b + half == a) form += factor * s.masses()[static_cast<Index>(b / 3)];
      worst = std::max(worst, Quad(abs(form)));
    }
  }
  return static_cast<double>(worst / scale);
}

template <class H>
double defect(const H& hamiltonian, const Scheme& scheme, const ParticleSystem<Quad>& s, double dt, int steps) {
  return defect(derivative(hamiltonian, scheme, s, dt, steps), s);
}

bool takes_inexact_kicks(const Scheme& scheme) {
  return (scheme.is_composition() || scheme.exact.find('B') == std::string_view::npos) &&
         scheme.scheme_class != SchemeClass::rkn;
}

TEST_CASE("every scheme over kinetic and potential energy is symplectic", "[conservation][symplectic]") {
  const auto start = planets(0.1, 1).as<Quad>();
  for (const Scheme* scheme : schemes::all()) {
    INFO(scheme->name);
    CHECK(defect(kinetic_potential<Quad>(Gravity{}), *scheme, start, 0.2, 2) < 1e-16);
  }
}

TEST_CASE("every scheme over Kepler arcs is symplectic in the inertial momenta, in all coordinates",
          "[conservation][symplectic][slow]") {
  const auto start = planets(0.1, 2).as<Quad>();
  for (const Scheme* scheme : schemes::all()) {
    INFO(scheme->name);
    CHECK(defect(wisdom_holman<Quad>({.coordinates = Coordinates::jacobi}), *scheme, start, 0.2, 1) < 1e-16);
    if (!takes_inexact_kicks(*scheme)) continue;
    for (const Coordinates coordinates : {Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
      CHECK(defect(wisdom_holman<Quad>({.coordinates = coordinates}), *scheme, start, 0.2, 1) < 1e-16);
    }
  }
}

TEST_CASE("corrected steps and kernels are symplectic, the lazy kernel only nearly", "[conservation][symplectic]") {
  const auto start = planets(0.1, 2).as<Quad>();
  const auto arcs = wisdom_holman<Quad>({});
  const auto made = [&](const Scheme& scheme, const CompositionOptions& options) {
    return defect(arcs, processed(scheme, options), start, 0.2, 1);
  };
  CHECK(made(schemes::verlet, {.corrector = 5}) < 1e-16);
  CHECK(made(schemes::verlet_aba, {.corrector = 5, .kernel = StepKernel::modified}) < 1e-16);
  CHECK(made(schemes::verlet_aba, {.corrector = 5, .kernel = StepKernel::composed, .second_corrector = true}) < 1e-16);
  CHECK(made(schemes::saba_3, {.kernel = StepKernel::modified}) < 1e-16);
  const CompositionOptions lazy{.corrector = 5, .kernel = StepKernel::lazy};
  CHECK(made(schemes::verlet_aba, lazy) > 1e-12);
  CHECK(made(schemes::verlet_aba, lazy) < 1e-4);
  CHECK_FALSE(compose(arcs, schemes::verlet_aba, lazy).claims().symplectic);
  CHECK(compose(arcs, schemes::verlet_aba, {.corrector = 5, .kernel = StepKernel::modified}).claims().symplectic);
}

TEST_CASE("Kepler arcs with further forces are symplectic", "[conservation][symplectic]") {
  const auto start = planets(0.1, 2).as<Quad>();
  ForceField<Quad> field;
  field.add(HarmonicField{0.3}).add(OscillatingField{{0.1, 0.2, -0.1}, 2.0, 0.4});
  for (const Coordinates coordinates :
       {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    const auto hamiltonian = wisdom_holman_over({.coordinates = coordinates}, field);
    CHECK(defect(hamiltonian, schemes::verlet, start, 0.2, 2) < 1e-16);
    CHECK(defect(hamiltonian, schemes::abah_8_6_4, start, 0.2, 1) < 1e-16);
  }
  field.add(GrPotential{.c = 5}).add(Oblateness{.J2 = 0.1, .J4 = -0.05, .radius = 0.5, .axis = {0.1, 0.2, 1}});
  const auto arcs = wisdom_holman_over({}, field);
  const CompositionOptions modified{.corrector = 5, .kernel = StepKernel::modified};
  CHECK(defect(arcs, processed(schemes::verlet_aba, modified), start, 0.2, 1) < 1e-16);
  CHECK(compose(arcs, schemes::verlet_aba, modified).claims().symplectic);
}

/// No gradient: it has a curl of 1e-9.
struct CurlingForce {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    Gravity{}.add_to(out, s);
    const Vec3<Real> x = s.positions()[1];
    out.acceleration(1, Real(1e-9) * Vec3<Real>(-x[1], x[0], Real(0)));
  }
};

TEST_CASE("what is not symplectic is found: a force with a curl, and drag by exactly its factor",
          "[conservation][symplectic]") {
  const auto start = planets(0.1, 1).as<Quad>();
  CHECK(defect(kinetic_potential<Quad>(CurlingForce{}), schemes::verlet, start, 0.2, 2) > 1e-12);
  const double rate = 0.05, dt = 0.2;
  const auto damped = test::damped(kinetic_potential<Quad>(Gravity{}), {.rate = rate});
  const Matrix m = derivative(damped, schemes::verlet, start, dt, 2);
  CHECK(defect(m, start) > 1e-3);
  CHECK(defect(m, start, exp(Quad(-2 * rate) * Quad(dt))) < 1e-16);
}

}  // namespace
}  // namespace noether
