#include "study/stability_limit.hpp"

#include "study/trait_problems.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace noether {

namespace {

using traits::Walk;

constexpr double farthest = 12;

/// Growth a step that shows in double precision, and growth that is more than rounding in extended precision.
constexpr double some_growth = 1e-15, any_growth = 1e-24;

/// Where growth of any size is asked for, before the scan begins.
constexpr double first_look = 0.01;

/// Real matrix ((qq, qp), (pq, pp)) that takes (q, p) of the oscillator over a step.
struct StepMatrix {
  Quad qq, qp, pq, pp;

  /// How far the larger eigenvalue lies outside the unit circle; 0: not.
  double growth() const {
    const Quad half = (qq + pp) / Quad(2), determinant = qq * pp - qp * pq, root = half * half - determinant;
    const Quad radius = root > Quad(1e-28) ? abs(half) + sqrt(root) : sqrt(abs(determinant));
    return std::max(0.0, static_cast<double>(radius - Quad(1)));
  }
};

template <class Real> ParticleSystem<Real> on_spring(double x, double v) {
  return traits::one_particle(x, 0, v, 0).as<Real>();
}

std::pair<Quad, Quad> point_of(const ParticleSystem<Quad>& s) { return {s.positions()[0][0], s.velocities()[0][0]}; }

/// Whether some steps of h omega = z can be made in double precision.
bool can_step(const KnownMethod& known, double z) {
  Walk<double> walk(traits::integrator_of<double>(known, HarmonicField{.k = 1}), on_spring<double>(1, 0), z);
  return walk.go(64);
}

/// The matrix of one step of h omega = z; empty if the step cannot be made.
std::optional<StepMatrix> step_matrix(const KnownMethod& known, double z) {
  std::pair<Quad, Quad> ends[2];
  for (int k = 0; k < 2; ++k) {
    Walk<Quad> walk(traits::integrator_of<Quad>(known, HarmonicField{.k = 1}), on_spring<Quad>(1 - k, k), z);
    if (!walk.go(1)) return std::nullopt;
    ends[k] = point_of(walk.particles());
  }
  return StepMatrix{ends[0].first, ends[1].first, ends[0].second, ends[1].second};
}

/// Growth a step of what is left of a run on the spring once all that is spurious has decayed; empty as long as more
/// than two modes are seen, or a step cannot be made.
std::optional<double> principal_growth(const KnownMethod& known, double z) {
  Walk<Quad> walk(traits::integrator_of<Quad>(known, HarmonicField{.k = 1}), on_spring<Quad>(1, 0), z);
  std::pair<Quad, Quad> seen[4];
  for (int k = 0; k < 4; ++k) {
    if (!walk.go(k == 0 ? 100 : 1)) return std::nullopt;
    seen[k] = point_of(walk.particles());
  }
  // M with seen[k + 1] = M seen[k] for k = 0, 1; the last one is the proof.
  const auto [a, c] = seen[0];
  const auto [b, d] = seen[1];
  const auto [e, g] = seen[2];
  const Quad determinant = a * d - b * c;
  const StepMatrix m{(b * d - e * c) / determinant, (a * e - b * b) / determinant, (d * d - g * c) / determinant,
                     (a * g - b * d) / determinant};
  const Quad miss = abs(m.qq * e + m.qp * g - seen[3].first) + abs(m.pq * e + m.pp * g - seen[3].second);
  if (!(static_cast<double>(miss) < 1e-3 * any_growth)) return std::nullopt;
  return m.growth();
}

/// Whether a run whose first steps were disturbed grows, or cannot go on.
bool grows_in_a_run(const KnownMethod& known, double z, std::int64_t steps) {
  Walk<double> walk(traits::integrator_of<double>(known, traits::ShakenSpring{.end = 20.5 * z}),
                    on_spring<double>(1, 0), z);
  constexpr std::int64_t window = 400;
  double before = 0, largest = 0;
  for (std::int64_t done = 0; done < steps; done += window) {
    largest = 0;
    for (std::int64_t n = 0; n < window; ++n) {
      if (!walk.go(1)) return true;
      const auto& s = walk.particles();
      const double size = std::hypot(s.positions()[0][0], s.velocities()[0][0]);
      if (size < 1e-30) return false;
      largest = std::max(largest, size);
    }
    if (done == steps / 2 / window * window) before = largest;
    if (!(largest < 1e9)) return true;
  }
  return !(largest < 1.3 * before);
}

/// Between two arguments, the first of which is outside a set and the other in it, where the set begins.
double edge_between(const std::function<bool(double)>& inside, double below, double above, int halvings = 30) {
  for (int k = 0; k < halvings; ++k) {
    const double middle = (below + above) / 2;
    (inside(middle) ? above : below) = middle;
  }
  return above;
}

/// Zero of an entry of the matrix between two steps where its signs differ.
double zero_of(const KnownMethod& known, Quad StepMatrix::*entry, double below, double above) {
  const bool negative = (*step_matrix(known, below)).*entry < Quad(0);
  return edge_between(
      [&](double z) {
        const auto m = step_matrix(known, z);
        return !m || ((*m).*entry < Quad(0)) != negative;
      },
      below, above);
}

/// Where, between two steps, a symmetric method has a gap of instability, however low: (trace/2)^2 - 1 = qp pq there,
/// so it lies between the zeros of the two.
std::optional<double> gap_between(const KnownMethod& known, const StepMatrix& m, const StepMatrix& next, double below,
                                  double above) {
  if (std::abs(static_cast<double>(m.qq - m.pp)) > any_growth) return std::nullopt;
  std::optional<double> first, second;
  for (Quad StepMatrix::*entry : {&StepMatrix::qp, &StepMatrix::pq}) {
    if ((m.*entry < Quad(0)) == (next.*entry < Quad(0))) continue;
    (first ? second : first) = zero_of(known, entry, below, above);
  }
  if (first && second && std::abs(*first - *second) < 1e-9) return std::nullopt;  // a full turn: no gap
  return second ? std::min(first, second) : first;
}

/// Growth at the first look that is more than the digits of its table explain.
bool always_grows(const KnownMethod& known, double growth) {
  return growth > std::max(any_growth, std::pow(10.0, 1 - known.printed_digits()));
}

/// Where steps in double precision, which ask less of an iteration than extended ones, can no longer be made.
double limit_of_iteration(const KnownMethod& known, double from, double step) {
  double z = from;
  while (z <= farthest && can_step(known, z + step)) z += step;
  return edge_between([&](double at) { return !can_step(known, at); }, z, z + step);
}

StabilityLimit limit_of_map(const KnownMethod& known, double step) {
  const auto unstable = [&](double z) { return step_matrix(known, z)->growth() > some_growth; };
  double below = first_look;
  std::optional<StepMatrix> last = step_matrix(known, below);
  if (!last || always_grows(known, last->growth())) return {0};
  for (int k = 1; first_look + k * step <= farthest; ++k) {
    const double z = first_look + k * step;
    const auto m = step_matrix(known, z);
    if (m) {
      if (const auto gap = gap_between(known, *last, *m, below, z)) return {*gap};
    }
    if (!m) return {limit_of_iteration(known, below, step), true};
    if (m->growth() > some_growth) return {edge_between(unstable, below, z)};
    last = m, below = z;
  }
  return {std::numeric_limits<double>::infinity()};
}

StabilityLimit limit_of_runs(const KnownMethod& known, double step) {
  const auto unstable = [&](double z, std::int64_t steps) {
    return principal_growth(known, z).value_or(0) > some_growth || grows_in_a_run(known, z, steps);
  };
  if (always_grows(known, principal_growth(known, first_look).value_or(0))) return {0};
  for (int k = 1; k * step <= farthest; ++k) {
    if (!unstable(k * step, 1600)) continue;
    const double edge = edge_between([&](double z) { return unstable(z, 32'000); }, (k - 1) * step, k * step, 10);
    return {edge, !can_step(known, edge + step)};
  }
  return {std::numeric_limits<double>::infinity()};
}

}  // namespace

std::optional<StabilityLimit> stability_limit_of(const KnownMethod& known) {
  if (known.info != nullptr && !known.info->fixed) return std::nullopt;
  const bool with_past = known.info != nullptr && known.info->family == "multistep";
  const bool iterates = known.info != nullptr && known.info->evaluations == 0;
  const double step = iterates ? 0.05 : with_past ? 0.005 : 0.002;
  return with_past ? limit_of_runs(known, step) : limit_of_map(known, step);
}

}  // namespace noether
