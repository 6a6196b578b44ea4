#include "integrators/all_schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <string>

namespace noether {
namespace {

using namespace noether::test;

/// Errors below which the digits of a table may show: it violates the conditions of its order by its last digit times
/// the step. Order 8 and more are printed with 19 digits at least, odd orders with 17, the others with 14.
double digits_floor(const Scheme& scheme) {
  const int order = scheme.order.classical;
  return order >= 8 ? 1e-17 : order % 2 == 1 ? 1e-15 : 1e-12;
}

long kicks(const Scheme& scheme) {
  return std::count_if(scheme.word.begin(), scheme.word.end(), [](const Stage& stage) { return stage.letter == 'B'; });
}

/// Errors from coarse to fine, until the floor or about `budget` kicks.
template <class Error>
std::vector<ErrorPoint> climb(const Scheme& scheme, double duration, long budget, const Error& error) {
  std::vector<ErrorPoint> points;
  for (const long n : ladder(4, std::max(16L, budget / kicks(scheme)))) {
    points.push_back({duration / static_cast<double>(n), error(duration / static_cast<double>(n), n)});
    if (points.back().error < digits_floor(scheme)) break;
  }
  return points;
}

double measured_order(const Scheme& scheme, const std::vector<ErrorPoint>& points) {
  return fitted_slope(finest(points, digits_floor(scheme), 1e-2));
}

void check_order(const Scheme& scheme, const std::vector<ErrorPoint>& points) {
  const auto used = finest(points, digits_floor(scheme), 1e-2);
  INFO(scheme.name << " claims order " << scheme.order.classical << ", measured " << fitted_slope(used) << "\n"
                   << to_text(points));
  CHECK(used.size() == 3);
  CHECK(std::fabs(fitted_slope(used) - scheme.order.classical) < 0.2);
}

TEST_CASE("every scheme has its order on the potential of Henon and Heiles", "[order]") {
  const auto start = particle_in_plane(0.1, 0.05, 0.3, 0.4).as<Quad>();
  const double duration = 3;
  const PhasePoint<Quad> exact = henon_heiles_flow(motion_of(start), duration);
  for (const Scheme* scheme : schemes::all()) {
    check_order(*scheme, climb(*scheme, duration, 6000, [&](double dt, long n) {
      const auto hamiltonian = kinetic_potential<Quad>(HenonHeilesField{});
      return distance(motion_of(run(hamiltonian, *scheme, start, dt, n)), exact);
    }));
  }
}

TEST_CASE("every scheme has its order on a Kepler orbit of eccentricity 0.6", "[order][slow]") {
  const auto start = kepler_pair(0.6, 1.0).as<Quad>();
  const double duration = 3;
  const PhasePoint<Quad> exact = kepler_motion(start, Quad(duration));
  for (const Scheme* scheme : schemes::all()) {
    check_order(*scheme, climb(*scheme, duration, 6000, [&](double dt, long n) {
      const auto hamiltonian = kinetic_potential<Quad>(Gravity{});
      return distance(relative_motion(run(hamiltonian, *scheme, start, dt, n)), exact);
    }));
  }
}

TEST_CASE("every scheme has its order on a driven oscillator: kicks see the time of their stage", "[order]") {
  const auto start = particle_in_plane(0.4, 0, -0.3, 0).as<Quad>();
  const HarmonicField spring{.k = 1};
  const OscillatingField drive{.acceleration = {0.7, 0, 0}, .omega = 2.25, .phase = 0.5};
  const double duration = 3;
  const PhasePoint<Quad> exact = driven_motion(motion_of(start), spring, drive, Quad(duration));
  for (const Scheme* scheme : schemes::all()) {
    check_order(*scheme, climb(*scheme, duration, 2000, [&](double dt, long n) {
      const auto hamiltonian = kinetic_potential<Quad>(spring, drive);
      return distance(motion_of(run(hamiltonian, *scheme, start, dt, n)), exact);
    }));
  }
}

TEST_CASE("one digit changed in a table is seen in the measured order", "[order]") {
  const auto start = particle_in_plane(0.1, 0.05, 0.3, 0.4).as<Quad>();
  const double duration = 3;
  const PhasePoint<Quad> exact = henon_heiles_flow(motion_of(start), duration);
  for (const Scheme* scheme : {&schemes::pefrl, &schemes::kahan_li_8_s17, &schemes::srkn14a}) {
    Scheme broken = *scheme;
    broken.word = Word{};
    const std::size_t last = scheme->word.size() - 1;
    for (std::size_t k = 0; k <= last; ++k) {  // stages 2 and 4, mirrored, by 1e-5: sums and symmetry stay
      const bool more = k == 2 || k == last - 2, less = k == 4 || k == last - 4;
      broken.word.push_back({scheme->word[k].letter, scheme->word[k].weight + Quad(more ? 1e-5 : less ? -1e-5 : 0.0)});
    }
    const auto points = climb(broken, duration, 6000, [&](double dt, long n) {
      const auto hamiltonian = kinetic_potential<Quad>(HenonHeilesField{});
      return distance(motion_of(run(hamiltonian, broken, start, dt, n)), exact);
    });
    INFO(scheme->name << "\n" << to_text(points));
    CHECK(measured_order(*scheme, points) < 2.5);
  }
}

/// A drive that looks at the time of the whole step instead of the stage.
struct SteppedField {
  OscillatingField drive;
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::cos;
    const Real t = s.time() - s.clock().fraction() * Real(s.clock().dt());
    for (Index i = 0; i < s.size(); ++i) {
      out.acceleration(i, Vec3<Real>(Real(drive.acceleration[0]) * cos(Real(drive.omega) * t), Real(0), Real(0)));
    }
  }
};

TEST_CASE("kicks that do not see the time of their stage are seen in the measured order", "[order]") {
  const auto start = particle_in_plane(0.4, 0, -0.3, 0).as<Quad>();
  const HarmonicField spring{.k = 1};
  const OscillatingField drive{.acceleration = {0.7, 0, 0}, .omega = 2.25};
  const PhasePoint<Quad> exact = driven_motion(motion_of(start), spring, drive, Quad(3));
  const auto points = climb(schemes::yoshida_4, 3, 2000, [&](double dt, long n) {
    const auto hamiltonian = kinetic_potential<Quad>(spring, SteppedField{drive});
    return distance(motion_of(run(hamiltonian, schemes::yoshida_4, start, dt, n)), exact);
  });
  CHECK(measured_order(schemes::yoshida_4, points) < 2.2);
}

}  // namespace
}  // namespace noether
