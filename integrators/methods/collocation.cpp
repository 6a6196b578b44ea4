#include "integrators/methods/collocation.hpp"

#include "integrators/methods/dense_factors.hpp"
#include "integrators/methods/step_ladder.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace noether {

namespace {

constexpr auto lanes = static_cast<Index>(lane_count);
/// Steps that are so many times shorter than the longest one may be deep in the field of a body.
constexpr double short_step = 64;
/// A step is made again if the one that meets the tolerance is shorter by more than this factor.
constexpr double accepted = 0.6;

template <class Real> Real rounded(const Quad& x, Real& low) {
  const Real high = static_cast<Real>(x);
  low = static_cast<Real>(x - Quad(high));
  return high;
}

}  // namespace

template <class Real> StageTable<Real>::StageTable(const CollocationTable& table) {
  stages = static_cast<int>(table.stages());
  const auto twice_all = table.twice();
  const auto twice_last = table.twice_end(), legendre = table.last_coefficient();
  for (std::size_t i = 0; i < table.stages(); ++i) {
    c[i] = rounded(table.c[i], c_low[i]);
    ends[0][i] = rounded(table.b[i], ends[1][i]);
    ends[2][i] = rounded(twice_last[i], ends[3][i]);
    last[i] = static_cast<Real>(legendre[i]);
    Quad weight = 1;
    for (std::size_t j = 0; j < table.stages(); ++j) {
      a[j][i] = static_cast<Real>(table.a[i][j]);
      twice[j][i] = static_cast<Real>(twice_all[i][j]);
      if (j != i) weight /= table.c[i] - table.c[j];
    }
    barycentric[i] = static_cast<Real>(weight);
  }
  // What rounding has taken from a row goes to its own stage, where it is lost least.
  for (std::size_t i = 0; i < table.stages(); ++i) {
    Quad left = 0, left_twice = 0;
    for (std::size_t j = 0; j < table.stages(); ++j) {
      left += table.a[i][j] - Quad(a[j][i]);
      left_twice += twice_all[i][j] - Quad(twice[j][i]);
    }
    a[i][i] += static_cast<Real>(left);
    twice[i][i] += static_cast<Real>(left_twice);
  }
  Matrix<Quad> all(stages, stages);
  for (Index i = 0; i < stages; ++i) {
    for (Index j = 0; j < stages; ++j) all(i, j) = table.a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  if (table.c[0] > Quad(0)) {
    DenseFactors<Quad> factors;
    factors.resize(stages);
    factors.compute(all);
    Vector<Quad> in_rest;
    factors.solve(Vector<Quad>::Ones(stages), in_rest);
    for (Index i = 0; i < stages; ++i) resting[static_cast<std::size_t>(i)] = static_cast<Real>(in_rest[i]);
  }
  for (std::size_t i = table.stages(); i < lane_count; ++i) {
    c[i] = c[0];
    c_low[i] = c_low[0];
    for (std::size_t j = 0; j < table.stages(); ++j) {
      a[j][i] = a[j][0];
      twice[j][i] = twice[j][0];
    }
  }
}

template <class Real>
Collocation<Real>::Collocation(const MethodInfo& info, const MethodOptions& options, const CollocationTable& table,
                               bool symplectic)
    : name_(info.name),
      table_(table),
      order_(table.order),
      adaptive_(info.is_adaptive(options)),
      symplectic_(symplectic),
      rtol_(options.rtol.value_or(info.rtol)),
      first_(options.first.value_or(0)),
      form_(options.jacobian) {
  // The last of s Legendre coefficients falls as h^(s-1), the error of a step as h^(2 s).
  const double s = table_.stages;
  const double floor = std::is_same_v<Real, double> ? 1e-16 : 1e-30;
  target_ = 3e-2 * std::pow(std::max(rtol_, floor), (s - 1) / (2 * s));
  rejecting_ = target_ / std::pow(accepted, std::max(table_.stages - 1, 1));
  settled_ = std::max(adaptive_ ? 1e-3 * rtol_ : 0.0, std::is_same_v<Real, double> ? 0x1p-54 : 1e-33);
  // What is left by sweeps that are not made has one sign from step to step. With eight stages it is mostly far below
  // what is asked, and nobody sees it in 1e6 steps; with fewer, at longer steps, it would be a drift.
  foreseen_ = settled_ * (table_.stages == lane_count ? 1 : 0x1p-6);
}

template <class Real> MethodClaims Collocation<Real>::claims() const {
  return {.name = name_,
          .order = order_,
          .adaptive = adaptive_,
          .symplectic = symplectic_,
          .reversible = symplectic_,
          .keeps_angular_momentum = symplectic_};
}

template <class Real> void Collocation<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims claims = f.claims();
  second_order_ = claims.second_order;
  with_velocities_ = second_order_ && claims.velocity_dependent;
  n_ = second_order_ ? f.size() / 2 : f.size();
  particles_ = second_order_ ? f.particles() : 0;
  any_origin_ = adaptive_ && claims.any_origin && std::is_same_v<Real, double>;
  longest_ = 0;
  const auto padded = static_cast<std::size_t>((n_ + 7) / 8 * 8);
  for (auto* all : {&rates_, &previous_, &trial_, &q_, &v_}) all->assign(lane_count * padded, Real(0));
  for (auto* all : {&last_, &largest_}) all->assign(padded, Real(0));
  in_turn_ = f.stages_in_turn();
  for (auto* all : {&known_q_, &known_v_}) all->assign(in_turn_ ? lane_count * padded : 0, Real(0));
  low_.assign(static_cast<std::size_t>(f.size()), Real(0));
  stage_.resize(f.size());
  sums_ = {n_};
  weights_h_ = weights_h_old_ = 0;
  next_ = h_ = 0;
  swept_ = 0;
  system_.reset();
}

template <class Real>
double Collocation<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (next_ == 0)
    next_ = first_ > 0 ? std::copysign(first_, h)
                       : first_step(f, t, y, order_, Tolerance(std::max(rtol_, 1e-14), 1e-300), h);
  return shorter(next_, h);
}

template <class Real>
StepResult Collocation<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  if (any_origin_ && std::abs(next_) < longest_ / short_step) follow(f, y);
  while (true) {
    made.h = adaptive_ ? next_step(f, t, y, h) : h;
    predict(f, t, y, made.h);
    const bool converged = sweep(f, t, y, made.h) == Sweeps::converged;
    if (!adaptive_) {
      if (!converged && !iterate(f, t, y, h)) {
        made.failure = Failure{Outcome::Kind::solver_failure, -1, "stages",
                               fmt::format("the stages of '{}' do not converge with a step of {:.6g}; give a shorter "
                                           "one{}",
                                           name_, h, table_.stages > 2 ? ", or adaptive steps" : "")};
        return made;
      }
      break;
    }
    // The last coefficient falls as h^(s-1): this factor brings it to its target.
    const double rough = converged ? roughness(y, made.h) : std::numeric_limits<double>::infinity();
    const double room = std::clamp(target_ / rough, 1e-300, 1e300);
    const double factor = near_root(room, std::max(table_.stages - 1, 1));
    next_ = made.h * (converged ? std::clamp(factor, 0.2, 3.0) : 0.5);
    if (std::abs(next_) > longest_) longest_ = std::abs(next_);
    if (converged && factor > accepted) break;
    ++made.rejected;
    made.failure = underflow(static_cast<double>(t), next_);
    if (made.failure) break;
  }
  if (!made.failure) finish(y, made.h);
  if constexpr (std::is_same_v<Real, double>) {
    if (origin_.in_use()) origin_.leave(made.failure ? 0 : made.h, y, low_.data());
  }
  return made;
}

/// Makes the next step relative to a body, where that is worth it.
template <class Real> void Collocation<Real>::follow(VectorField<Real>& f, Vector<Real>& y) {
  if constexpr (std::is_same_v<Real, double>) {
    if (origin_.is_worth_it(f.scales(y, rtol_), y)) origin_.enter(y, low_.data());
  }
}

/// Stages begin where the polynomial of the last step leads; without one, with the rates at hand.
template <class Real>
void Collocation<Real>::predict(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (h_ == 0) {
    for (Index i = 0; i < n_; ++i) {
      for (Index k = 0; k < lanes; ++k) {
        q_[static_cast<std::size_t>(lanes * i + k)] = y[i];
        v_[static_cast<std::size_t>(lanes * i + k)] = second_order_ ? y[n_ + i] : Real(0);
      }
    }
    const std::array<Real, lane_count> times = [&] {
      std::array<Real, lane_count> all{};
      all.fill(t);
      return all;
    }();
    sums_.take(f.rates({times.data(), q_.data(), v_.data(), 1, second_order_}, trial_.data()), rates_.data());
    return;
  }
  extrapolate(h);
}

/// The polynomial of the last step at x_i = 1 + c_i h / h_old, by Lagrange's formula.
template <class Real> void Collocation<Real>::extrapolate(double h) {
  const bool known = h == weights_h_ && h_ == weights_h_old_;
  if (!known) sums_.extrapolation(table_.stages, table_.c, table_.barycentric, Real(h) / Real(h_), weights_);
  weights_h_ = h;
  weights_h_old_ = h_;
  has_twice_ahead_ = has_twice_ahead_ && known;
  if (!is_straight()) return sums_.combine(previous_.data(), weights_, rates_.data());
  if (!has_twice_ahead_)
    StageArithmetic<Real>{lane_count}.combine(weights_[0].data(), table_.twice, twice_ahead_[0].data());
  has_twice_ahead_ = true;
}

/// Whether the first positions of a step come straight from the rates of the last one: nobody asks for the rates
/// between them, and the product of both matrices costs less than going through it with every variable.
template <class Real> bool Collocation<Real>::is_straight() const {
  return second_order_ && !with_velocities_ && (!adaptive_ || n_ > 2 * lanes) && unseen_sweeps() > 0;
}

template <class Real>
void Collocation<Real>::form_positions(const Real* rates, const StageMatrix<Real>& twice, const Vector<Real>& y,
                                       double h, Real* q) {
  sums_.positions(rates, twice, table_.c, table_.c_low, y.data(), low_.data(), y.data() + n_, h, q);
}

template <class Real> void Collocation<Real>::form_velocities(const Real* rates, const Vector<Real>& y, double h) {
  sums_.values(rates, table_.a, y.data() + n_, low_.data() + n_, h, v_.data());
}

/// Positions (and velocities) of all stages from their rates.
template <class Real> void Collocation<Real>::form_states(const Real* rates, const Vector<Real>& y, double h, Real* q) {
  if (!second_order_) {
    sums_.values(rates, table_.a, y.data(), low_.data(), h, q);
    return;
  }
  form_positions(rates, table_.twice, y, h, q);
  if (with_velocities_) form_velocities(rates, y, h);
}

/// h sum_i b_i L(Q_i, V_i), which the step makes stationary.
/// @source MarsdenWest2001
template <class Real> Real Collocation<Real>::action(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  form_positions(previous_.data(), table_.twice, y, h_, q_.data());
  form_velocities(previous_.data(), y, h_);
  Real sum(0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(table_.stages); ++k) {
    take_stage(k);
    sum += table_.ends[0][k] * f.lagrangian(t + table_.c[k] * Real(h_), stage_);
  }
  return Real(h_) * sum;
}

/// Those that are no longer, to the last bit, where they were evaluated: the first ones come to rest a sweep or two
/// before the last. (To leave out others that have moved by less than a bit would be an error of one sign, and a
/// drift.)
template <class Real> std::uint8_t Collocation<Real>::stages_to_evaluate(int round, const Real* q) {
  constexpr std::uint8_t all = 0xff;
  if (!in_turn_) return all;
  std::uint8_t moved = sums_.moved(q, known_q_.data());
  if (with_velocities_) moved |= sums_.moved(v_.data(), known_v_.data());
  return round == 1 ? all : moved;
}

/// Sweeps until the rates stand still: until what the next sweep would change is below rounding, or no less than what
/// this one has. Steps take about as many sweeps as the one before: only the last three of these are looked at, which
/// saves a tenth of the time, and a step ends at most one sweep earlier than the last.
template <class Real>
typename Collocation<Real>::Sweeps Collocation<Real>::sweep(VectorField<Real>& f, const Real& t, const Vector<Real>& y,
                                                            double h) {
  using std::isfinite;
  const int most = adaptive_ ? 60 : 300;  // steps of one length have only a dear way out
  const int patience =
      swept_ == 0 && h_ != 0 ? 2 : 6;  // where the last step has not converged, this one may not either
  const int unseen = unseen_sweeps();
  const bool straight = h_ != 0 && is_straight();
  std::array<Real, lane_count> times{};
  for (std::size_t k = 0; k < lane_count; ++k) times[k] = t + table_.c[k] * Real(h);
  Real* const place = f.place_of_stages();
  Real* const q = place != nullptr ? place : q_.data();
  const Real* rates = rates_.data();
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most; ++round) {
    if (straight && round == 1) {
      form_positions(previous_.data(), twice_ahead_, y, h, q);
    } else {
      form_states(rates, y, h, q);
    }
    const std::uint8_t wanted = stages_to_evaluate(round, q);
    const Real* const fresh = f.rates(
        {times.data(), q, with_velocities_ ? v_.data() : nullptr, table_.stages, second_order_, wanted}, trial_.data());
    rates = round < unseen ? fresh : rates_.data();
    if (round < unseen) continue;
    swept_ = round;
    const auto [change, size] = sums_.take(fresh, rates_.data());
    if (round == unseen) continue;  // the rates before were not kept
    // Rates may happen to vanish in one sweep, on the way to others.
    const double relative = size > Real(0) ? static_cast<double>(change / size) : change > Real(0) ? 1.0 : 0.0;
    if (!isfinite(size + change)) return Sweeps::diverged;
    const double shrinks = round == unseen + 1 ? 1.0 : relative / before;
    if (relative <= settled_ || relative * std::min(shrinks, 1.0) * 0.5 < foreseen_) return Sweeps::converged;
    if (round > std::max(2, unseen + 1) && shrinks >= 1) {
      // At rounding level it no longer shrinks; above, it never will.
      const double noise = std::is_same_v<Real, double> ? 1e-12 : 1e-28;
      if (relative < noise || is_rounding(y, rates_of(), h, static_cast<double>(change))) return Sweeps::converged;
      if (round > patience) return Sweeps::diverged;
    }
    before = relative;
  }
  return Sweeps::diverged;
}

/// Rates of all stages by Newton's iteration. All of them begin where the step begins, and at rest: the first update
/// then leads to the stages of the linear problem, and on stiff springs from there to the nearest solution; stages that
/// begin where velocities lead end far away.
/// @return whether they were found
template <class Real>
bool Collocation<Real>::iterate(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const auto stages = static_cast<std::size_t>(table_.stages);
  if (!system_) system_.emplace(f, table_.stages, table_.a, table_.twice, form_);
  update_.resize(table_.stages * n_);
  std::array<Real, lane_count> times{};
  for (std::size_t k = 0; k < lane_count; ++k) times[k] = t + table_.c[k] * Real(h);
  const auto restart = [&] {
    std::fill(rates_.begin(), rates_.end(), Real(0));
    update_.setZero();
    for (std::size_t k = 0; second_order_ && k < stages; ++k) {
      update_.segment(static_cast<Index>(k) * n_, n_) = -table_.resting[k] / Real(h) * y.tail(n_);
    }
    add_update(y, h);
  };
  const auto correct = [&]() -> std::optional<UpdateSize> {
    const Real* const fresh = f.rates(
        {times.data(), q_.data(), second_order_ ? v_.data() : nullptr, table_.stages, second_order_}, trial_.data());
    for (std::size_t k = 0; k < stages; ++k) {
      for (Index i = 0; i < n_; ++i) {
        const std::size_t at = lane_count * static_cast<std::size_t>(i) + k;
        update_[static_cast<Index>(k) * n_ + i] = fresh[at] - rates_[at];
      }
    }
    if (!system_->solve(f, update_)) return {};
    add_update(y, h);
    return size_of_update(y, h);
  };
  const auto renew = [&] {
    for (std::size_t k = 0; k < stages; ++k) {
      take_stage(k);
      system_->evaluate_at(f, static_cast<int>(k), times[k], stage_);
    }
    return system_->factorize(h);
  };
  swept_ = 0;
  restart();
  system_->evaluate(f, t, y);
  return system_->factorize(h) && !newton_to_rounding<Real>(correct, restart, renew);
}

/// Adds the update to the rates, and takes positions and velocities of all stages from them.
template <class Real> void Collocation<Real>::add_update(const Vector<Real>& y, double h) {
  for (int k = 0; k < table_.stages; ++k) {
    for (Index i = 0; i < n_; ++i) rates_[static_cast<std::size_t>(lanes * i + k)] += update_[k * n_ + i];
  }
  StageStates<Real>{nullptr, nullptr, nullptr, table_.stages}.fill_lanes(n_, rates_.data());
  form_states(rates_.data(), y, h, q_.data());
  if (second_order_) form_velocities(rates_.data(), y, h);
}

/// One stage as a field sees it.
template <class Real> void Collocation<Real>::take_stage(std::size_t k) {
  for (Index i = 0; i < n_; ++i) {
    const std::size_t at = lane_count * static_cast<std::size_t>(i) + k;
    stage_[i] = q_[at];
    if (second_order_) stage_[n_ + i] = v_[at];
  }
}

/// What the update has done to positions and velocities, of the stage where that is most.
template <class Real> UpdateSize Collocation<Real>::size_of_update(const Vector<Real>& y, double h) {
  UpdateSize worst;
  moved_.resize(n_);
  from_.resize(n_);
  const auto add = [&](const StageMatrix<Real>& weights, std::size_t k, double factor, Index begin) {
    moved_.setZero();
    for (int j = 0; j < table_.stages; ++j) {
      moved_ += weights[static_cast<std::size_t>(j)][k] * update_.segment(j * n_, n_);
    }
    const UpdateSize size = update_size(moved_.data(), factor, from_.data(), stage_.data() + begin, n_);
    // What is no number is larger than any.
    if (!(size.whole <= worst.whole)) worst.whole = size.whole;
    if (!(size.each <= worst.each)) worst.each = size.each;
  };
  for (std::size_t k = 0; k < static_cast<std::size_t>(table_.stages); ++k) {
    take_stage(k);
    from_ = y.head(n_);
    if (second_order_) {
      // Positions are a sum with h v, which may be far larger than what is left.
      from_ = from_.cwiseAbs() + Real(std::abs(h)) * y.tail(n_).cwiseAbs();
      add(table_.twice, k, h * h, 0);
      from_ = y.tail(n_);
    }
    add(table_.a, k, h, second_order_ ? n_ : 0);
  }
  return worst;
}

template <class Real> void Collocation<Real>::finish(Vector<Real>& y, double h) {
  Real *q = second_order_ ? y.data() : nullptr, *q_low = second_order_ ? low_.data() : nullptr;
  const Index v = second_order_ ? n_ : 0;
  sums_.finish(rates_.data(), table_.ends, h, q, q_low, y.data() + v, low_.data() + v);
  std::swap(previous_, rates_);
  h_ = h;
}

/// The largest last Legendre coefficient of a rate, relative to the rate; vectors of particles as wholes. One that
/// would reject the step does not count where it moves nothing: a force that fades away is rough to its end.
template <class Real> double Collocation<Real>::roughness(const Vector<Real>& y, double h) {
  sums_.coefficient(rates_.data(), table_.last, last_.data(), largest_.data());
  const Index groups = particles_ > 0 ? particles_ : n_;
  double worst = 0;
  for (Index g = 0; g < groups; ++g) {
    double last2 = 0, size2 = 0;
    for (auto i = static_cast<std::size_t>(g); i < static_cast<std::size_t>(n_);
         i += static_cast<std::size_t>(groups)) {
      const auto last = static_cast<double>(last_[i]), size = static_cast<double>(largest_[i]);
      last2 += last * last;
      size2 += size * size;
    }
    if (!(last2 > worst * size2)) continue;
    if (last2 > rejecting_ * rejecting_ * size2 && is_rounding(y, rates_of(), h, std::sqrt(last2))) continue;
    worst = last2 / size2;
  }
  return std::sqrt(worst);
}

template <class Real>
void Collocation<Real>::go_on_from(const AlignedVector<Real>& low, const AlignedVector<Real>& rates, double h) {
  std::copy(low.begin(), low.end(), low_.begin());
  std::copy(rates.begin(), rates.end(), previous_.begin());
  h_ = h;
  swept_ = 0;
}

template <class Real> void Collocation<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "next", next_);
  save_value(saved, prefix + "h", h_);
  save_value(saved, prefix + "swept", std::int64_t{swept_});
  save_value(saved, prefix + "longest", longest_);
  save_value(saved, prefix + "low", std::vector<Real>(low_.begin(), low_.end()));
  save_value(saved, prefix + "previous", std::vector<Real>(previous_.begin(), previous_.end()));
}

template <class Real> void Collocation<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "next", next_);
  load_value(saved, prefix + "h", h_);
  std::int64_t swept = 0;
  load_value(saved, prefix + "swept", swept);
  swept_ = static_cast<int>(swept);
  if (saved.contains(prefix + "longest")) load_value(saved, prefix + "longest", longest_);
  const auto load_all = [&](const std::string& name, AlignedVector<Real>& into) {
    std::vector<Real> read;
    load_value(saved, prefix + name, read);
    for (std::size_t k = 0; k < into.size(); ++k) into[k] = detail::element(read, k);
  };
  load_all("low", low_);
  load_all("previous", previous_);
}

template struct StageTable<double>;  // gravity_gauss.cpp has one too
template class Collocation<double>;
template class Collocation<Quad>;

}  // namespace noether
