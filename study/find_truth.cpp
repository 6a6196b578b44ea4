#include "study/find_truth.hpp"

#include "integrators/all_methods.hpp"
#include "study/position_error.hpp"
#include "study/truth_by_splitting.hpp"
#include "study/wide_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace noether {

namespace {

using Seconds = std::chrono::duration<double>;

double since(std::chrono::steady_clock::time_point begin) {
  return Seconds(std::chrono::steady_clock::now() - begin).count();
}

/// Largest |x| and largest |v| of a system; 0 where there is none.
std::pair<double, double> sizes(const Vector<Quad>& y, bool second_order) {
  const Index half = second_order ? y.size() / 2 : y.size();
  double first = 0, second = 0;
  for (Index i = 0; i < y.size(); ++i) {
    double& size = i < half ? first : second;
    size = std::max(size, std::abs(static_cast<double>(y[i])));
  }
  return {first, second};
}

/// One run in extended precision that stops at every moment of a sampling.
struct WideRun {
  std::vector<Vector<Quad>> y, rate;
  std::int64_t evaluations = 0;
  std::string failure;  ///< empty: it came to the end
};

/// Where a wide run stands when its wall time is over, in words.
std::string too_slow(double reached, double seconds, double budget) {
  return fmt::format(
      "extended precision would take about {:.0f} s, beyond its budget of {:.0f} s; give a shorter --until",
      seconds / std::max(reached, 1e-6), budget);
}

/// @param most  evaluations, beyond which it is no use
/// @param tell  is told which share of the sampling is done, if there is one
WideRun run_wide(const WideScene& wide, const Sampling& sampling, const MethodChoice& choice, double budget,
                 double most, const std::function<void(double)>& tell) {
  WideRun run;
  const auto field = wide.field->clone();
  const auto method = make_method<Quad>(*choice.info, choice.options);
  Vector<Quad> y, rate;
  field->bind(wide.start);
  method->bind(*field);
  field->gather(wide.start, y);
  // As if nobody had ever been wrapped, as positions of runs are recorded.
  const Index n = wide.start.size();
  for (int k = 0; k < 3; ++k) {
    for (Index i = 0; i < n; ++i) y[k * n + i] = wide.start.unwrapped(i)[k];
  }
  rate.resize(y.size());
  // What is left to the moment is a rounding error of time in doubles: a line leads there.
  const auto keep = [&](const Quad& t, const Quad& goal) {
    field->rate(t, y, rate);
    run.y.push_back(y);
    for (Index i = 0; i < y.size(); ++i) run.y.back()[i] += (goal - t) * rate[i];
    run.rate.push_back(rate);
  };
  const auto begin = std::chrono::steady_clock::now();
  Quad t(sampling.start);
  keep(t, t);
  for (int j = 1; j <= sampling.samples; ++j) {
    const Quad goal = sampling.clock_time(j);
    while (true) {
      const double left = static_cast<double>(goal - t);
      if (!(left > 1e-12 * sampling.interval)) break;
      const StepResult made = method->step(*field, t, y, left);
      if (made.failure || !(made.h > 0)) {
        run.failure = made.failure ? made.failure->message : "no step was made";
        return run;
      }
      t += Quad(made.h);
      run.evaluations = field->evaluations().force;
      if (static_cast<double>(run.evaluations) > most) {
        run.failure = "it takes too many evaluations";
        return run;
      }
      const double reached = static_cast<double>(t - Quad(sampling.start)) / sampling.end(), spent = since(begin);
      if (tell) tell(std::max(reached, spent / budget));
      if (spent > budget || (spent > 0.1 * budget && spent > 2 * reached * budget)) {
        run.failure = too_slow(reached, spent, budget);
        return run;
      }
    }
    keep(t, goal);
  }
  return run;
}

/// A method that a truth is found by: the run itself, and what stands beside it.
struct Way {
  MethodChoice finest, rougher, finer;  ///< the run; the same method rougher and finer, where no other one can be had
  std::vector<MethodChoice> others;     ///< of another family, the finer last
};

/// The ways that are worth trying, the best first.
std::vector<Way> ways_of(const WideScene& wide, const TruthOptions& options) {
  Vector<Quad> y;
  const auto field = wide.field->clone();
  field->bind(wide.start);
  field->gather(wide.start, y);
  const auto [x, v] = sizes(y, field->claims().second_order);
  const double size = v > 0 && x > 0 ? std::min(x, v) : std::max(x, v), scale = size > 0 ? 0.1 * size : 1;
  const bool particles = field->particles() > 0;
  const auto choice = [&](std::string_view name, double rtol) {
    return MethodChoice{methods::find(name),
                        {.rtol = rtol, .atol = particles ? std::nullopt : std::optional(rtol * scale)}};
  };
  std::vector<Way> all;
  for (const auto& [name, coarse] : {std::pair("gragg_bulirsch_stoer", 1e-20), std::pair("dop853", 1e-18)}) {
    const double first = options.rtol.value_or(coarse);
    all.push_back({.finest = choice(name, first / 30),
                   .rougher = choice(name, first),
                   .finer = choice(name, first / 1000),
                   .others = {choice("gauss_8", 1e-18), choice("gauss_8", 1e-21)}});
  }
  return all;
}

/// A method of another family may take so many times the evaluations of the first: where it takes more it iterates in
/// vain, as on stiff systems.
constexpr std::int64_t patience = 4;

constexpr std::string_view no_truth = "invariants";

double distance(const WideRun& a, const WideRun& b, PositionError& error) {
  error.set_scale(a.y);
  double worst = 0;
  for (std::size_t j = 0; j < a.y.size(); ++j) worst = std::max(worst, error(b.y[j], a.y[j]));
  return worst;
}

/// States by one way, with their distance from what another method finds, or, where that does not come to the end, the
/// same at another tolerance; without an error where two runs have not come to the end.
Truth drive(const WideScene& wide, const Way& way, const Sampling& sampling, PositionError& error, double budget,
            const TruthOptions& options) {
  Truth truth{.name = std::string(no_truth)};
  const auto begin = std::chrono::steady_clock::now();
  const auto run = [&](const MethodChoice& choice, double most = std::numeric_limits<double>::infinity()) {
    most = std::min(most, options.most_evaluations - truth.evaluations);
    WideRun made = run_wide(wide, sampling, choice, budget - since(begin), most, options.tell);
    truth.seconds = since(begin);
    truth.evaluations += static_cast<double>(made.evaluations);
    if (!made.failure.empty() && !truth.error) truth.note = made.failure;
    return made;
  };
  const auto told = [&](const MethodChoice& finest, const MethodChoice& beside) {
    truth.note = fmt::format("{} in extended precision, rtol {:.0e}, checked against {} at {:.0e}", finest.info->name,
                             *finest.options.rtol, beside.info == finest.info ? "itself" : beside.info->name,
                             *beside.options.rtol);
  };
  WideRun finest = run(way.finest);
  if (!finest.failure.empty()) return truth;
  for (const MethodChoice& other : way.others) {
    const WideRun beside = run(other, static_cast<double>(patience * finest.evaluations));
    if (!beside.failure.empty()) break;
    truth.error = distance(finest, beside, error);
    told(way.finest, other);
    if (*truth.error < options.agreement) break;
  }
  if (!truth.error) {
    const WideRun rougher = run(way.rougher);
    if (!rougher.failure.empty()) return truth;
    truth.error = distance(finest, rougher, error);
    told(way.finest, way.rougher);
    if (*truth.error >= options.agreement) {
      WideRun finer = run(way.finer);
      if (finer.failure.empty()) {
        truth.error = distance(finer, finest, error);
        told(way.finer, way.finest);
        finest = std::move(finer);
      }
    }
  }
  truth.y = std::move(finest.y);
  truth.rate = std::move(finest.rate);
  return truth;
}

void set_energies(Truth& truth, WideScene& wide, const Sampling& sampling) {
  ParticleSystem<Quad> s = wide.start;
  if (s.size() == 0) return;
  s.clock() = Clock<Quad>::free(0);
  wide.field->bind(s);
  for (std::size_t j = 0; j < truth.y.size(); ++j) {
    const Vector<Quad>& y = truth.y[j];
    wide.field->scatter(y, s);
    s.wrap();
    s.clock().set_stage_offset(sampling.clock_time(static_cast<int>(j)));
    truth.energy.push_back(wide.field->energy(s).total());
  }
}

}  // namespace

Truth find_truth(const Scene& scene, const Sampling& sampling, const TruthOptions& options) {
  Truth truth{.name = std::string(no_truth)};
  WideScene wide = wide_scene(scene);
  truth.note = wide.field == nullptr ? wide.reason : "no method of high order is known in extended precision";
  if (wide.field == nullptr && !wide.splitting) return truth;
  PositionError error(scene.particles, about_center(scene));
  if (wide.splitting) return truth_by_splitting(wide, sampling, options, error);
  double spent = 0, evaluations = 0;
  for (const Way& way : ways_of(wide, options)) {
    TruthOptions left = options;
    left.most_evaluations -= evaluations;
    truth = drive(wide, way, sampling, error, options.budget - spent, left);
    truth.seconds = spent += truth.seconds;
    truth.evaluations = evaluations += truth.evaluations;
    if (truth.error) truth.kind = TruthKind::quad, truth.name = fmt::format("{} in quad", way.finest.info->name);
    if (truth.error || spent > options.budget / 2) break;
  }
  if (truth.error && *truth.error < 1e-3) {
    for (const SceneDecorator& one : scene.integrator.decorators)
      truth.note += fmt::format("; decorator '{}' is left out of it", one.name);
    set_energies(truth, wide, sampling);
    return truth;
  }
  if (truth.error) {
    truth.note = fmt::format(
        "two runs in extended precision differ by {:.1e}: the motion is too irregular for a reference over this time",
        *truth.error);
  }
  return Truth{
      .name = std::string(no_truth), .note = truth.note, .seconds = truth.seconds, .evaluations = truth.evaluations};
}

}  // namespace noether
