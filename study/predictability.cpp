#include "study/predictability.hpp"

#include "engine/sums.hpp"
#include "study/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace noether {

namespace {

constexpr double first_distance = 1e-10, last_distance = 1e-3;
constexpr double fewest_e_foldings = 3;    ///< that a rate is fitted over
constexpr std::size_t fewest_moments = 5;  ///< the same
constexpr double moment_growth = 1.05;     ///< of the time from one moment to the next
constexpr double first_moment = 0x1p-24;   ///< of the whole time, where steps are chosen by a tolerance
/// Growth in a step, as a logarithm, above which it may be that of an unstable step and not that of the motion.
constexpr double doubtful_growth = 0.02;
constexpr int finest_part = 64;  ///< of the step, that such a growth is looked at with

/// A number from -1 to 1 that looks like chance.
double shake(Index i) {
  const double x = std::sin(static_cast<double>(i + 1) * 12.9898) * 43758.5453;
  return 2 * (x - std::floor(x)) - 1;
}

/// Root mean square of the coordinates of a state: those about their mean where there are several particles.
double size_of_state(const Vector<double>& y, Index particles) {
  const Index count = particles > 0 ? 3 * particles : y.size();
  const bool about_mean = particles > 1;
  std::vector<double> means(3, 0.0);
  for (Index k = 0; k < 3 && about_mean; ++k) {
    const double all = sum_over<double>(particles, [&](Index i) { return y[k * particles + i]; });
    means[static_cast<std::size_t>(k)] = all / static_cast<double>(particles);
  }
  const double all = sum_over<double>(count, [&](Index i) {
    const double x = y[i] - (about_mean ? means[static_cast<std::size_t>(i / particles)] : 0);
    return x * x;
  });
  return std::sqrt(all / static_cast<double>(std::max<Index>(count, 1)));
}

double distance_of_states(const Vector<double>& a, const Vector<double>& b, Index particles) {
  const Index count = particles > 0 ? 3 * particles : a.size();
  const double squares = sum_over<double>(count, [&](Index i) { return (a[i] - b[i]) * (a[i] - b[i]); });
  return std::sqrt(squares / static_cast<double>(std::max<Index>(count, 1)));
}

/// The scene with another start: coordinates moved a little; with constraints, which positions must obey, all
/// velocities scaled.
Scene moved_scene(const Scene& scene, double by) {
  Scene moved = scene;
  ParticleSystem<double>& s = moved.particles;
  for (double& y : s.variables()) y += by * shake(&y - s.variables().data());
  if (s.size() == 0) return moved;
  const bool constrained = !scene.hamiltonian.constraints.empty();
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> noise(shake(3 * i), shake(3 * i + 1), shake(3 * i + 2));
    if (constrained) {
      s.velocities().set(i, (1 + first_distance) * Vec3<double>(s.velocities()[i]));
    } else {
      s.positions().set(i, Vec3<double>(s.positions()[i]) + by * noise);
    }
  }
  if (!constrained) s.wrap();
  return moved;
}

/// Two runs side by side.
class TwoRuns {
 public:
  /// @param parts  that steps of one length are divided into
  TwoRuns(const Scene& scene, double end, double size, int parts)
      : particles_(scene.particles.size()), start_(scene.integrator.start), adaptive_(scene.integrator.adaptive()) {
    const Candidate who{adaptive_ ? "dop853" : scene.integrator.method, adaptive_ ? "dop853" : scene.integrator.method,
                        false, adaptive_};
    const double step = scene.integrator.step / parts;
    const Setting setting{.step = adaptive_ ? 0 : step, .tolerance = adaptive_ ? 1e-12 : 0};
    step_ = step;
    // With constraints the first moment is what growth is measured from: the same for all parts.
    next_ = adaptive_ ? first_moment * end : scene.hamiltonian.constraints.empty() ? 1 : parts;
    end_ = end;
    one_.emplace(assemble(variant(scene, who, setting)));
    other_.emplace(assemble(variant(moved_scene(scene, first_distance * size), who, setting)));
  }

  double time() const { return adaptive_ ? done_ : done_ * step_; }
  bool at_end() const { return done_ >= last(); }
  /// @return whether both came to the next moment
  bool advance() {
    const double before = done_;
    done_ = std::min(next_, last());
    next_ = adaptive_ ? next_ * moment_growth : std::max(next_ + 1, std::floor(next_ * moment_growth));
    for (auto* sim : {&one_, &other_}) {
      const Outcome outcome =
          adaptive_ ? (**sim).run_until(start_ + done_) : (**sim).run(static_cast<std::int64_t>(done_ - before));
      if (!outcome.ok()) return false;
    }
    return true;
  }
  double evaluations() const { return static_cast<double>(one_->evaluations().force + other_->evaluations().force); }
  /// The same at the next moment, if steps go on as long.
  double evaluations_soon() const { return evaluations() * std::min(next_, last()) / std::max(done_, 1e-300); }
  double distance() {
    return distance_of_states(state_of(one_->particles()), state_of(other_->particles()), particles_);
  }

 private:
  double last() const { return adaptive_ ? end_ : std::max(1.0, std::round(end_ / step_)); }

  Index particles_;
  double start_, end_ = 0, step_ = 0;
  bool adaptive_;
  double done_ = 0, next_ = 1;  ///< moments: whole steps, or times from the start on [time]
  std::optional<Simulation<double>> one_, other_;
};

/// A straight line through the logarithm of the growth, each moment weighed by the time that it stands for.
/// @return its slope [1/time]
double fitted_rate(const Predictability& p, std::size_t first, std::size_t last) {
  const auto weight = [&](std::size_t k) {
    return (p.times[std::min(k + 1, last)] - p.times[std::max(k, first + 1) - 1]) / 2;
  };
  const auto mean = [&](const auto& value) {
    const auto count = static_cast<Index>(last - first + 1);
    const auto at = [&](Index k) { return first + static_cast<std::size_t>(k); };
    const double all = sum_over<double>(count, [&](Index k) { return weight(at(k)); });
    return sum_over<double>(count, [&](Index k) { return weight(at(k)) * value(at(k)); }) / all;
  };
  const double time = mean([&](std::size_t k) { return p.times[k]; });
  const double height = mean([&](std::size_t k) { return std::log(p.moment[k]); });
  const double common = mean([&](std::size_t k) { return (p.times[k] - time) * (std::log(p.moment[k]) - height); });
  const double square = mean([&](std::size_t k) { return (p.times[k] - time) * (p.times[k] - time); });
  return common / square;
}

/// The rate of an exponential growth, fitted from where the difference is ten times what it was at the start, when it
/// has turned into the direction that grows fastest, to where it is half of the largest it ever is: it saturates there,
/// or was followed no further. Leaves it alone where this stretch tells too little.
void fit_rate(Predictability& p) {
  const auto reached = [&](double wanted) {  // growth is the largest so far, so it never falls
    return static_cast<std::size_t>(std::lower_bound(p.growth.begin(), p.growth.end(), wanted) - p.growth.begin());
  };
  const std::size_t first = reached(10), last = reached(p.growth.back() / 2);
  if (last < first + fewest_moments - 1) return;
  const double e_foldings = std::log(p.growth[last] / p.growth[first]), rate = fitted_rate(p, first, last);
  if (e_foldings < fewest_e_foldings || !(rate > 0)) return;
  p.rate = rate;
  p.e_foldings = e_foldings;
}

/// Calls it chaotic where the difference has grown much, and more in the second half of the time than any power does.
void judge_growth(Predictability& p) {
  if (p.times.size() < 8) return;
  const std::size_t last = p.times.size() - 1;
  const auto middle = std::lower_bound(p.times.begin(), p.times.end(), p.times[last] / 2);
  const auto half = static_cast<std::size_t>(middle - p.times.begin());
  const double all = p.growth[last], second = all / std::max(p.growth[half], 1.0);
  if (!(all >= 1e3) || !(second > 20)) return;
  p.chaotic = true;
  p.rate = std::log(second) / (p.times[last] - p.times[half]);
  fit_rate(p);
}

/// As `predictability`, with steps of one length divided into parts.
std::optional<Predictability> follow(const Scene& scene, double end, double budget, double most, int parts,
                                     const std::function<void(double)>& tell, double* spent) {
  const double size = size_of_state(state_of(scene.particles), scene.particles.size());
  if (!(size > 0) || !(end > 0)) return {};
  const auto begin = std::chrono::steady_clock::now();
  Predictability found;
  bool failed = false;
  std::optional<TwoRuns> both;
  try {
    both.emplace(scene, end, size, parts);
    const bool constrained = !scene.hamiltonian.constraints.empty();
    double first = constrained ? 0 : both->distance(), largest = 0;
    while (!both->at_end()) {
      if (!both->advance()) break;
      const double distance = both->distance();
      if (!std::isfinite(distance)) break;
      if (first == 0) first = distance;
      if (first == 0) break;
      largest = std::max(largest, distance);
      found.times.push_back(both->time());
      found.growth.push_back(largest / first);
      found.moment.push_back(distance / first);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (distance > last_distance * size || seconds > budget || both->evaluations_soon() > most) break;
      if (tell) {
        const double grown = std::log(largest / first) / std::log(last_distance / first_distance);
        tell(std::max({seconds / budget, both->time() / end, grown, both->evaluations() / most}));
      }
    }
  } catch (const Error&) {
    failed = true;
  }
  if (both) found.evaluations = both->evaluations();
  if (spent != nullptr) *spent += found.evaluations;
  if (failed || found.times.empty()) return {};
  found.judged = found.growth.back() >= 1e3 || both->at_end();
  judge_growth(found);
  return found;
}

}  // namespace

double Predictability::factor(double time) const {
  if (times.empty()) return 1;
  const auto at = std::lower_bound(times.begin(), times.end(), time);
  if (at != times.end()) return std::max(1.0, growth[static_cast<std::size_t>(at - times.begin())]);
  const double later = time / times.back();
  const double more = chaotic ? std::exp(std::min(700.0, rate * (time - times.back()))) : later * later;
  return std::max(1.0, growth.back() * more);
}

double Predictability::time_of(double wanted) const {
  if (!chaotic) return std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (growth[k] >= wanted) return times[k];
  }
  return times.back() + std::log(wanted / growth.back()) / rate;
}

double Predictability::tenfold() const { return std::log(10.0) / rate; }

std::optional<Predictability> predictability(const Scene& scene, double end, double budget, double most,
                                             const std::function<void(double)>& tell, double* spent) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds_left = [&] {
    return budget - std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::optional<Predictability> first = follow(scene, end, budget, most, 1, tell, spent);
  if (!first || scene.integrator.adaptive()) return first;
  double all = first->evaluations;
  Predictability found = *first;
  for (int parts = 1;; parts *= 2) {
    const double steps = found.times.back() / (scene.integrator.step / parts);
    const bool is_doubtful = found.growth.back() >= 1e3 && std::log(found.growth.back()) > doubtful_growth * steps;
    if (!is_doubtful || parts == finest_part) break;
    if (!(seconds_left() > 0) || all >= most) break;
    const auto finer = follow(scene, end, seconds_left(), most - all, 2 * parts, {}, spent);
    if (!finer) break;
    all += finer->evaluations;
    const double time = first->times.back();
    const bool reached = finer->times.back() >= time - scene.integrator.step;
    if (!reached && finer->growth.back() < 1e3) break;  // cut short: it tells nothing
    found = *finer;
    if (reached && std::log(found.factor(time)) < std::log(first->growth.back()) / 2) {
      found.unstable_step = scene.integrator.step;
      break;
    }
  }
  found.evaluations = all;
  return found;
}

}  // namespace noether
