#include "engine/sums.hpp"
#include "study/method_traits.hpp"
#include "study/trait_problems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace noether {

namespace gravity_traits {

namespace {

using traits::Walk;

constexpr int some_steps = 12;
constexpr double duration = 15;  // over shorter ones single rungs have errors that happen to be small
constexpr double long_step = 1;  // so long that what a method does to areas and energies is above all rounding
constexpr double never = std::numeric_limits<double>::infinity();

/// Positions and momenta of all bodies, body by body.
using Phase = std::vector<Quad>;

/// Masses that are powers of 2, so that momenta of two words are velocities of two words.
ParticleSystem<double> star_and_planets() {
  ParticleSystem<double> s;
  s.add("star", 1, {0.01, -0.02, 0.005}, {0.003, 0.001, -0.002});
  s.add("inner", 0x1p-6, {1, 0.1, 0.05}, {-0.1, 0.98, 0.08});
  s.add("outer", 0x1p-5, {-0.3, 2.2, -0.2}, {-0.68, -0.05, 0.07});
  return s;
}

Phase phase_of(const ParticleSystem<double>& s) {
  const auto* low = s.low_words();
  Phase z;
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      z.push_back(Quad(s.positions().component(k)[i]) + (low != nullptr ? Quad(low->x.component(k)[i]) : Quad(0)));
    }
    for (int k = 0; k < 3; ++k) {
      const Quad v = Quad(s.velocities().component(k)[i]) + (low != nullptr ? Quad(low->v.component(k)[i]) : Quad(0));
      z.push_back(Quad(s.masses()[i]) * v);
    }
  }
  return z;
}
Phase phase_of(const ParticleSystem<Quad>& s) {
  Phase z;
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) z.push_back(s.positions().component(k)[i]);
    for (int k = 0; k < 3; ++k) z.push_back(s.masses()[i] * s.velocities().component(k)[i]);
  }
  return z;
}

double put_in_two(const Quad& value, double& low) {
  const auto high = static_cast<double>(value);
  low = static_cast<double>(value - Quad(high));
  return high;
}

/// The system at a point of its phase space, in two words.
ParticleSystem<double> system_at(const Phase& z) {
  ParticleSystem<double> s = star_and_planets();
  s.keep_low_words(true);
  auto& low = *s.low_words();
  auto at = z.begin();
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) s.positions().component(k)[i] = put_in_two(*at++, low.x.component(k)[i]);
    for (int k = 0; k < 3; ++k) {
      s.velocities().component(k)[i] = put_in_two(*at++ / Quad(s.masses()[i]), low.v.component(k)[i]);
    }
  }
  return s;
}

double distance(const Phase& a, const Phase& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double difference = std::abs(static_cast<double>(a[k] - b[k]));
    if (!std::isfinite(difference)) return never;
    worst = std::max(worst, difference);
  }
  return worst;
}

/// A method at work on the system.
class Journey {
 public:
  Journey(const KnownMethod& known, const Phase& from, double h)
      : walk_(traits::integrator_of<double>(known, Gravity{.G = 1}), system_at(from), h) {}

  bool go(std::int64_t steps) { return walk_.go(steps); }
  Phase phase() { return phase_of(walk_.particles()); }
  std::int64_t evaluations() const { return walk_.evaluations(); }

 private:
  Walk<double> walk_;
};

/// Where a method is after some steps; empty if it cannot make them.
std::optional<Phase> walked(const KnownMethod& known, const Phase& from, double h, std::int64_t steps) {
  Journey journey(known, from, h);
  if (!journey.go(steps)) return std::nullopt;
  return journey.phase();
}

Phase start() { return phase_of(star_and_planets()); }

/// The system at the end, to 26 digits.
Phase truth() {
  constexpr int steps = 480;
  const KnownMethod gauss{.info = methods::find("gauss_8")};
  Walk<Quad> walk(traits::integrator_of<Quad>(gauss, Gravity{.G = 1}), star_and_planets().as<Quad>(), duration / steps);
  walk.go(steps);
  return phase_of(walk.particles());
}

/// Slope of the errors over a ladder of 3, 4, 6, 8, ... steps, the finest three above what rounding leaves of the
/// departures of planets, which are doubles.
std::optional<double> measured_order(const KnownMethod& known) {
  constexpr double floor = 2e-16, coarse = 1e-3;
  const Phase right = truth();
  std::vector<std::pair<double, double>> rungs;
  for (std::int64_t n = 3; n <= 1024; n = n % 3 == 0 ? n / 3 * 4 : n / 2 * 3) {
    const double h = duration / static_cast<double>(n);
    const std::optional<Phase> end = walked(known, start(), h, n);
    const double error = end ? distance(*end, right) : never;
    if (error < floor) break;
    if (error < coarse) rungs.emplace_back(std::log(h), std::log(error));
  }
  if (rungs.size() < 3) return std::nullopt;
  rungs.erase(rungs.begin(), rungs.end() - 3);
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [u, w] : rungs) x += u, y += w, xx += u * u, xy += u * w;
  return (3 * xy - x * y) / (3 * xx - x * x);
}

/// Forces a step, if every step costs the same, at two lengths of the step.
std::optional<double> measured_evaluations(const KnownMethod& known) {
  std::optional<std::int64_t> each;
  for (const double h : {0.01, 0.25}) {
    Journey journey(known, start(), h);
    for (int n = 0; n < 8; ++n) {
      const std::int64_t before = journey.evaluations();
      if (!journey.go(1)) return std::nullopt;
      const std::int64_t made = journey.evaluations() - before;
      if (each && *each != made) return std::nullopt;
      each = made;
    }
  }
  return static_cast<double>(*each);
}

/// Largest entry of M^T J M - J, M the Jacobian of some steps by central differences of the fourth order, by momenta in
/// units of the masses: those of bodies differ by powers of 10.
double symplectic_defect(const KnownMethod& known) {
  constexpr double d = 0x1p-17;
  const Phase at = start();
  const ParticleSystem<double> bodies = star_and_planets();
  std::vector<Phase> m;  // m[k]: derivative along coordinate k
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double by = k % 6 < 3 ? d : d * bodies.masses()[static_cast<Index>(k / 6)];
    const auto moved = [&](double times) {
      Phase z = at;
      z[k] += Quad(times * by);
      return walked(known, z, long_step, some_steps);
    };
    const auto a = moved(-2), b = moved(-1), c = moved(1), e = moved(2);
    if (!a || !b || !c || !e) return never;
    Phase& column = m.emplace_back(at.size());
    for (std::size_t i = 0; i < at.size(); ++i)
      column[i] = ((*a)[i] - Quad(8) * (*b)[i] + Quad(8) * (*c)[i] - (*e)[i]) / (Quad(12) * Quad(by));
  }
  double worst = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    for (std::size_t l = 0; l < at.size(); ++l) {
      Quad area(0);
      for (std::size_t i = 0; i < at.size(); i += 6) {
        for (std::size_t j = i; j < i + 3; ++j) area += m[k][j] * m[l][j + 3] - m[k][j + 3] * m[l][j];
      }
      const bool same = k / 6 == l / 6 && k % 3 == l % 3;
      const Quad exact = !same || k == l ? Quad(0) : Quad(k < l ? 1 : -1);
      worst = std::max(worst, std::abs(static_cast<double>(area - exact)));
    }
  }
  return worst;
}

/// How far a run with its velocities turned ends from where it began.
double way_back(const KnownMethod& known) {
  const auto turned = [](Phase z) {
    for (std::size_t k = 0; k < z.size(); ++k) z[k] = k % 6 < 3 ? z[k] : -z[k];
    return z;
  };
  const auto there = walked(known, start(), long_step, some_steps);
  const auto back = there ? walked(known, turned(*there), long_step, some_steps) : std::nullopt;
  return back ? distance(turned(*back), start()) : never;
}

struct Momenta {
  Vec3<Quad> p = Vec3<Quad>::Zero(), l = Vec3<Quad>::Zero();
};
Momenta momenta_of(const Phase& z) {
  Momenta made;
  for (std::size_t i = 0; i < z.size(); i += 6) {
    const Vec3<Quad> x(z[i], z[i + 1], z[i + 2]), p(z[i + 3], z[i + 4], z[i + 5]);
    made.p += p;
    made.l += cross(x, p);
  }
  return made;
}
Quad energy_of(const Phase& z) {
  const ParticleSystem<double> bodies = star_and_planets();
  const auto part = [&](Index i, std::size_t first) {
    const std::size_t at = 6 * static_cast<std::size_t>(i) + first;
    return Vec3<Quad>(z[at], z[at + 1], z[at + 2]);
  };
  return sum_over<Quad>(bodies.size(), [&](Index i) {
    const Quad m = Quad(bodies.masses()[i]), kinetic = norm2(part(i, 3)) / (Quad(2) * m);
    const Quad pull = sum_over<Quad>(
        i, [&](Index j) { return m * Quad(bodies.masses()[j]) / sqrt(norm2(Vec3<Quad>(part(i, 0) - part(j, 0)))); });
    return kinetic - pull;
  });
}

/// Relative changes of momentum and angular momentum over some steps.
std::pair<double, double> momenta_lost(const KnownMethod& known) {
  const auto end = walked(known, start(), long_step, some_steps);
  if (!end) return {never, never};
  const Momenta before = momenta_of(start()), after = momenta_of(*end);
  const auto change = [](const Vec3<Quad>& a, const Vec3<Quad>& b) {
    return static_cast<double>(sqrt(norm2(Vec3<Quad>(a - b)) / norm2(b)));
  };
  return {change(after.p, before.p), change(after.l, before.l)};
}

/// Largest energy errors, relative, of the first and the last eighth of a hundred turns.
std::pair<double, double> energy_errors(const KnownMethod& known) {
  constexpr std::int64_t eighth = 79, looks = 39;
  Journey journey(known, start(), long_step);
  const Quad before = energy_of(start());
  std::array<double, 8> worst{};
  for (auto& largest : worst) {
    for (std::int64_t n = 0; n < looks; ++n) {
      if (!journey.go(eighth * (n + 1) / looks - eighth * n / looks)) return {0, never};
      const double error = std::abs(static_cast<double>(energy_of(journey.phase()) / before - Quad(1)));
      if (!(error < 0.5)) return {0, never};
      largest = std::max(largest, error);
    }
  }
  return {worst.front(), worst.back()};
}

}  // namespace

}  // namespace gravity_traits

MethodTraits measured_gravity_traits(const KnownMethod& known) {
  using namespace gravity_traits;
  // Rounding of two words comes to 1e-29 in sums, and to 1e-19 where doubles begin the last sweeps; differences divide
  // it by their width.
  constexpr double of_sums = 1e-26, of_steps = 1e-17, of_differences = 1e-11;
  MethodTraits traits;
  traits.fixed_steps = true;
  traits.order = measured_order(known);
  traits.evaluations = measured_evaluations(known);
  const auto [momentum, angular] = momenta_lost(known);
  traits.momentum = momentum < of_sums;
  traits.angular_momentum = angular < of_steps;
  traits.symplectic = symplectic_defect(known) < of_differences;
  traits.reversible = way_back(known) < of_steps;
  const auto [early, late] = energy_errors(known);
  traits.energy = late < of_steps ? EnergyError::kept : late < 1.5 * early ? EnergyError::bounded : EnergyError::drifts;
  return traits;
}

}  // namespace noether
