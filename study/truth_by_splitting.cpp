#include "study/truth_by_splitting.hpp"

#include "engine/bodies.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/particle_vector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

namespace noether {

namespace {

/// Two runs that agree so well need no third: errors of runs in double precision are larger.
constexpr double agreement_of_schemes = 1e-15;
constexpr std::string_view first_scheme = "sofroniou_spaletta_10_s35", other_scheme = "kahan_li_10_s33";

/// One run that stops at every moment of a sampling.
struct SplitRun {
  std::vector<Vector<Quad>> y, rate;
  std::vector<Quad> energy;
  bool whole = false;  ///< it came to the end in time
};

/// @param evaluations  of forces, of all runs; they are counted on
SplitRun run_along(const WideScene& wide, const Sampling& sampling, std::string_view scheme, std::int64_t steps,
                   std::chrono::steady_clock::time_point deadline, double most, double& evaluations) {
  SplitRun run;
  const double before = evaluations;
  Composition<AnyHamiltonian<Quad>> along(*wide.splitting, *schemes::find(scheme));
  ParticleSystem<Quad> s = wide.start;
  s.clock() = Clock<Quad>::fixed(sampling.start, sampling.interval / static_cast<double>(steps));
  along.bind(s);
  ParticleSystem<Quad> seen = s;
  VectorColumn<Quad> a(s.size());
  const auto keep = [&] {
    along.settle(s, seen, {}, {}, true);
    along.accelerations(seen, a);
    run.energy.push_back(along.energy(seen).total());
    detail::gather_particles(seen, run.y.emplace_back());
    Vector<Quad>& rate = run.rate.emplace_back(run.y.back());
    const Index n = s.size();
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < n; ++i) run.y.back()[k * n + i] = seen.unwrapped(i)[k];
      std::copy_n(seen.velocities().component(k), n, rate.data() + k * n);
      std::copy_n(a.component(k), n, rate.data() + (3 + k) * n);
    }
    if (!has_bodies(seen)) return;
    // Moments differ by rounding errors alone, in which nothing turns.
    run.y.back().conservativeResize(10 * n);
    rate.conservativeResize(10 * n);
    rate.tail(4 * n).setZero();
    for (int k = 0; k < 4; ++k) {
      std::copy_n(std::as_const(seen).column<BodyOrientation>().component(k), n, run.y.back().data() + (6 + k) * n);
    }
  };
  keep();
  for (int j = 1; j <= sampling.samples; ++j) {
    for (std::int64_t k = 0; k < steps; ++k) {
      if (along.advance(s, {.steps = 1}).failure != nullptr) return run;
      evaluations = before + static_cast<double>(along.evaluations().force);
      if (evaluations > most || std::chrono::steady_clock::now() > deadline) return run;
    }
    keep();
  }
  run.whole = true;
  return run;
}

double distance(const SplitRun& a, const SplitRun& b, PositionError& error) {
  error.set_scale(a.y);
  double worst = 0;
  for (std::size_t j = 0; j < a.y.size(); ++j) worst = std::max(worst, error(b.y[j], a.y[j]));
  return worst;
}

}  // namespace

Truth truth_by_splitting(const WideScene& wide, const Sampling& sampling, const TruthOptions& options,
                         PositionError& error) {
  Truth truth{.name = "invariants",
              .note = "extended precision would take longer than its budget; give a shorter --until"};
  const auto begin = std::chrono::steady_clock::now();
  const auto deadline = begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                    std::chrono::duration<double>(options.budget));
  for (std::int64_t steps = 2;; steps *= 2) {
    const auto along = [&](std::string_view scheme) {
      return run_along(wide, sampling, scheme, steps, deadline, options.most_evaluations, truth.evaluations);
    };
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (options.tell) options.tell(spent.count() / options.budget);
    SplitRun run = along(first_scheme);
    if (!run.whole) break;
    const SplitRun beside = along(other_scheme);
    if (!beside.whole) break;
    const double apart = distance(run, beside, error);
    if (truth.error && !(apart < *truth.error)) break;
    truth.error = apart;
    truth.note =
        fmt::format("{} of the splitting itself in extended precision, {} steps per moment, checked against {}",
                    first_scheme, steps, other_scheme);
    truth.y = std::move(run.y);
    truth.rate = std::move(run.rate);
    truth.energy = std::move(run.energy);
    if (apart < agreement_of_schemes) break;
  }
  truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!truth.error || !(*truth.error < 1e-3)) {
    return {.name = truth.name, .note = truth.note, .seconds = truth.seconds, .evaluations = truth.evaluations};
  }
  truth.kind = TruthKind::quad;
  truth.name = fmt::format("{} in quad", first_scheme);
  return truth;
}

}  // namespace noether
