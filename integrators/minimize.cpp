#include "integrators/minimize.hpp"

#include "engine/not_finite.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace noether {

void MinimizeOptions::check() const {
  if (!(max_force > 0 && std::isfinite(max_force)))
    refuse_field("max_force", max_force, "can never be reached; a force above 0 is expected");
  if (steps < 1) refuse_field("steps", static_cast<double>(steps), "is too few; 1 or more is expected");
  if (!(max_displacement >= 0))
    refuse_field("max_displacement", max_displacement, "is not a valid length; 0 or more is expected");
}

namespace {

/// Mixing and time step of the method, as its authors give them.
constexpr double alpha_start = 0.25, alpha_factor = 0.99, longer = 1.1, halved = 0.5;
/// Steps downhill before the time step grows.
constexpr int patience = 5;
/// What is left of an old curvature after a step, and the largest time step times omega.
constexpr double memory = 0.998, safe = 1.5;
/// Displacements below this part of what is allowed are too short to tell a curvature from rounding.
constexpr double resolved = 1e-8;
/// Overlapping particles have parted if the largest force falls to so small a part of itself in one step.
constexpr double dissolved = 1e-4;
/// Steps taken back in a row before it is given up.
constexpr int most_retreats = 60;

/// So many steps downhill in a row are looked at where particles are held back; then the time step is at most so many
/// first ones, by the forces there are.
constexpr int long_held = 128;
constexpr double longest_held = 1e3;

/// Squares between these are neither lost nor infinite.
constexpr double least_square = 1e-280, most_square = 1e280;

template <class Size> double largest(Index count, const Size& size_of) {
  struct Largest {
    double value = 0;
    Largest& operator+=(const Largest& other) {
      value = std::isnan(other.value) ? other.value : std::max(value, other.value);
      return *this;
    }
  };
  return reduce(count, Largest{},
                [&](Index begin, Index end) {
                  Largest most;
                  for (Index i = begin; i < end; ++i) most += Largest{size_of(i)};
                  return most;
                })
      .value;
}

double largest_norm(const VectorColumn<double>& column) {
  const double square = largest(column.size(), [&](Index i) { return norm2(column[i]); });
  if (square > least_square && square < most_square) return std::sqrt(square);
  return largest(column.size(), [&](Index i) {
    const Vec3<double> x = column[i];
    return std::hypot(x[0], x[1], x[2]);
  });
}

/// The sum of products of two columns, each divided by a number that keeps their squares in range.
double product(const VectorColumn<double>& a, double a_scale, const VectorColumn<double>& b, double b_scale) {
  const double scale = a_scale * b_scale;
  const bool divides_last = scale > least_square && scale < most_square;
  const double sum = reduce(a.size(), 0.0, [&](Index begin, Index end) {
    double part = 0;
    if (divides_last) {
      for (Index i = begin; i < end; ++i) part += dot(a[i], b[i]);
    } else {
      for (Index i = begin; i < end; ++i) part += dot(Vec3<double>(a[i] / a_scale), Vec3<double>(b[i] / b_scale));
    }
    return part;
  });
  return divides_last ? sum / scale : sum;
}

/// A twentieth of the distance that particles have on the average in the space they take; in open space, where they may
/// all stand in one place, at least a hundredth of the range of their forces.
double usual_displacement(const ParticleSystem<double>& s, double range) {
  double widest = 0;
  for (int k = 0; k < 3; ++k) {
    const double* x = s.positions().component(k);
    const auto [low, high] = std::minmax_element(x, x + s.size());
    widest = std::max(widest, s.box().is_periodic() ? s.box().edges()[k] : *high - *low);
  }
  const double least = s.box().is_periodic() ? 0 : 0.01 * range;
  if (!(widest > 0)) return least > 0 ? least : 1;
  return std::max(least, 0.05 * widest / std::cbrt(static_cast<double>(s.size())));
}

/// One minimization on its way.
class Descent {
 public:
  Descent(ParticleSystem<double>& s, const AnyForce<double>& forces, const MinimizeOptions& options,
          MinimizeAlong* along)
      : s_(s), forces_(forces), options_(options), along_(along), f_(s.size()), v_(s.size()), still_(s.size()) {
    if (along_ != nullptr) along_->bind(s_);
    bind_force(forces_, s_);
    const double range = forces_.claims().range;
    workspace_.put(NeighborList(range));
    reach_ = options.max_displacement > 0 ? options.max_displacement : usual_displacement(s, range);
  }

  Minimized run() {
    if (!evaluate()) return ended(std::move(*failure_));
    begin();
    while (largest_ > options_.max_force) {
      if (made_ == options_.steps) return ended(unfinished());
      steer();
      if (!(dt_ > 0 && std::isfinite(dt_))) return ended(stalled());
      advance();
      before_ = f_;
      const double before = largest_;
      if (evaluate()) {
        retreats_ = 0;
        largest_ < dissolved* before ? begin() : limit_step(largest_ / before);
      } else if (++retreats_ > most_retreats || made_ == options_.steps || !retreat()) {
        return ended(std::move(*failure_));
      }
    }
    if (auto lost = not_finite(s_)) return ended(std::move(*lost));
    return {made_, largest_, overlap_};
  }

 private:
  Minimized ended(Failure failure) const { return {made_, largest_, std::move(failure)}; }

  Failure unfinished() const {
    return {.quantity = "force",
            .message = fmt::format("the largest force is {:.6g} after {} steps of the minimization, above max_force = "
                                   "{:.6g}; give more steps, or a better start",
                                   largest_, made_, options_.max_force)};
  }

  /// Time steps have grown, or shrunk, beyond all numbers: nothing moves any more.
  Failure stalled() const {
    return {.quantity = "force",
            .message = fmt::format("the largest force stays at {:.6g}, above max_force = {:.6g}: no step downhill "
                                   "changes it any more, after {} steps; give a larger max_force, or a better start",
                                   largest_, options_.max_force, made_)};
  }

  /// Forces at the present positions. @return whether they can be computed
  bool evaluate() {
    ForceSink<double> sink(f_, s_, {}, &workspace_);
    forces_.add_to(sink, s_);
    ++made_;
    failure_ = overlap_ = {};
    // Forces of an overlap show the way out of it.
    (sink.failure() && sink.failure()->kind == Outcome::Kind::overlap ? overlap_ : failure_) = sink.failure();
    if (along_ != nullptr && !failure_) {
      // At rest: what holds particles of a temperature on their circles is no force downhill.
      with_velocities(still_, [&] { along_->constrain(s_, f_); });
      failure_ = along_->take_failure();  // of the step that led here as well
    }
    if (failure_) return false;
    for (Index i = 0; i < s_.size(); ++i) f_.set(i, std::as_const(s_).masses()[i] * std::as_const(f_)[i]);
    const double largest = largest_norm(f_);
    if (std::isfinite(largest)) {
      largest_ = largest;
      return true;
    }
    for (Index i = 0; i < s_.size() && !failure_; ++i) {
      if (std::as_const(f_)[i].allFinite()) continue;
      failure_ = Failure{
          .particle = i,
          .quantity = "force",
          .message = fmt::format("the force on '{}' is not finite; move it away from its neighbors", s_.name(i))};
    }
    if (!failure_) failure_ = Failure{.quantity = "force", .message = "a force is beyond the range of numbers"};
    return false;
  }

  /// From rest, with a time step by which a particle with the median force moves a tenth of what it may.
  void begin() {
    rest();
    curvature_ = 0;
    dt_ = first_step();
  }
  double first_step() const {
    std::vector<double> sizes;
    for (Index i = 0; i < f_.size(); ++i) {
      const double size = std::sqrt(norm2(f_[i] / largest_)) * largest_;
      if (size > 0) sizes.push_back(size);
    }
    if (sizes.empty()) return 1;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return std::sqrt(0.1 * reach_ / *middle);
  }

  /// Velocities and time step by the power of the forces.
  void steer() {
    const double fastest = largest_norm(v_);
    if (fastest == 0 || product(f_, largest_, v_, fastest) > 0) {
      if (++downhill_ > patience) {
        dt_ *= longer;
        alpha_ *= alpha_factor;
        // Where particles are held back all the while, a longer time step moves them no further.
        if (held_back_ && downhill_ % long_held == 0) dt_ = std::min(dt_, longest_held * first_step());
      }
    } else {
      shift(-dt_ / 2);
      rest();
    }
  }
  void rest() {
    v_.set_zero();
    downhill_ = 0;
    dt_ *= halved;
    alpha_ = alpha_start;
  }

  void advance() {
    if (along_ != nullptr) saved_.assign_state(s_);
    v_.add_scaled(dt_, f_);
    if (along_ != nullptr) with_velocities(v_, [&] { along_->project_velocities(s_, dt_); });
    const double fastest = largest_norm(v_);
    const double speed = fastest * std::sqrt(product(v_, fastest, v_, fastest));
    const double force = std::sqrt(product(f_, largest_, f_, largest_));
    const double along = alpha_ * speed / force;
    for_blocks(v_.size(), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        v_.set(i, (1 - alpha_) * std::as_const(v_)[i] + along * (std::as_const(f_)[i] / largest_));
      }
    });
    held_back_ = largest_norm(v_) * dt_ > reach_;
    for (Index i = 0; held_back_ && i < v_.size(); ++i) {
      const Vec3<double> v = std::as_const(v_)[i];
      const double way = std::hypot(v[0], v[1], v[2]) * dt_;
      if (way > reach_) v_.set(i, v * (reach_ / way));
    }
    shift(dt_);
  }
  /// Keeps the time step below the limit 2/omega of the stiffest motion that was seen of late, omega^2 being
  /// |f - f_before| / |x - x_before|. Where a particle was held back the forces change too much to tell.
  /// @param fallen  part of the largest force that is left
  void limit_step(double fallen) {
    if (fallen < 0.5) curvature_ *= fallen;
    before_.add_scaled(-1, f_);
    const double change = largest_norm(before_), fastest = largest_norm(v_);
    if (held_back_ || change == 0 || fastest * dt_ < resolved * reach_) return;
    const double ratio = std::sqrt(product(before_, change, before_, change) / product(v_, fastest, v_, fastest));
    curvature_ = std::max(memory * curvature_, ratio * (change / fastest) / dt_);
    dt_ = std::min(dt_, safe / std::sqrt(curvature_));
  }
  /// Takes the last step back. @return whether the forces are those from before
  bool retreat() {
    if (along_ != nullptr) {
      s_.assign_state(saved_);  // exactly, whatever became of the step
    } else {
      shift(-dt_);
    }
    rest();
    return evaluate();
  }
  /// x += h v
  void shift(double h) {
    with_velocities(v_, [&] { along_ != nullptr ? along_->advance_positions(s_, h) : s_.advance_positions(h); });
  }
  /// Acts where the particles have velocities `v`, those of the descent or none.
  template <class Act> void with_velocities(VectorColumn<double>& v, const Act& act) {
    std::swap(s_.velocities(), v);
    act();
    std::swap(s_.velocities(), v);
  }

  ParticleSystem<double>& s_;
  AnyForce<double> forces_;
  const MinimizeOptions& options_;
  MinimizeAlong* along_;
  Workspace workspace_;
  VectorColumn<double> f_, v_, still_, before_;
  ParticleSystem<double> saved_;  ///< before the last step along constraints
  double reach_ = 0, dt_ = 0, alpha_ = alpha_start, largest_ = 0;
  double curvature_ = 0;    ///< largest of late [mass/time^2]
  bool held_back_ = false;  ///< whether a particle would have gone too far in the last step
  int downhill_ = 0, retreats_ = 0;
  std::int64_t made_ = 0;
  std::optional<Failure> failure_, overlap_;
};

}  // namespace

Minimized minimize(ParticleSystem<double>& s, const AnyForce<double>& forces, const MinimizeOptions& options,
                   MinimizeAlong* along) {
  options.check();
  if (s.bodies() != nullptr) throw Error("some particles are rigid bodies, which a minimization cannot turn");
  const ForceClaims claims = forces.claims();
  if (claims.velocity_dependent || claims.time_dependent || claims.dissipative) {
    throw Error("a force depends on velocities or time, so there is no minimum to move to; leave it out");
  }
  return Descent(s, forces, options, along).run();
}

}  // namespace noether
