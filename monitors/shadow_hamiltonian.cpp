#include "monitors/shadow_hamiltonian.hpp"

#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace noether {

namespace {

constexpr std::int64_t highest_order = 40;
/// What differences of an energy in double cannot explain.
constexpr double largest_gradient_error = 1e-6;

/// C(n, k), exact in a double for all that is asked here.
double binomial(std::int64_t n, std::int64_t k) {
  double result = 1;
  for (std::int64_t i = 1; i <= k; ++i) result = result * static_cast<double>(n - k + i) / static_cast<double>(i);
  return result;
}

[[noreturn]] void refuse_saved() { throw Error("the saved window of a shadow Hamiltonian is inconsistent"); }

/// (q' - q) . (p' + p) of the variables (q, p) of a system.
template <class Real> Real difference_of_variables(const std::vector<Real>& older, const std::vector<Real>& newer) {
  const std::size_t n = newer.size() / 2;
  return sum_over<Real>(static_cast<Index>(n), [&](Index at) {
    const auto i = static_cast<std::size_t>(at);
    return (newer[i] - older[i]) * (newer[n + i] + older[n + i]);
  });
}

/// (q' - q) . (p' + p) of one particle without its mass, or of one body's turn, in differences.
template <class Real, int width = 3> struct Difference {
  const RowColumn<Real, width>&x_old, &v_old, &x_new, &v_new;

  Real at(Index i) const {
    Real sum(0);
    for (int c = 0; c < width; ++c) {
      sum += (x_new.component(c)[i] - x_old.component(c)[i]) * (v_new.component(c)[i] + v_old.component(c)[i]);
    }
    return sum;
  }
};

/// Whether a magnetic field is part of the momenta: the map shows p/m = v + q A/m in the place of v.
template <class Real> bool has_field_momenta(const Snapshot<Real>& now) {
  const ParticleSystem<Real>&seen = now.state(), &mapped = now.mapped();
  for (Index i = 0; i < seen.size(); ++i) {
    const Vec3<Real> v = seen.velocities()[i], x = seen.positions()[i];
    if (v != mapped.velocities()[i] && x == mapped.positions()[i]) return true;
  }
  return false;
}

}  // namespace

double shadow_weight(std::int64_t k, std::int64_t a, std::int64_t b) {
  return ((b - a) % 2 == 1 ? 1 : -1) * binomial(k, a) * binomial(k, b);
}

template <class Real> void ShadowHamiltonian<Real>::check() const {
  std::int64_t before = 0;
  for (const std::int64_t order : orders) {
    if (order > before && order % 2 == 0 && order <= highest_order) {
      before = order;
      continue;
    }
    refuse_field("orders", static_cast<double>(order),
                 fmt::format("is not a valid list of orders; even numbers from 2 to {}, ascending, are expected",
                             highest_order));
  }
  if (orders.empty()) refuse_field("orders", "[]", "is an empty list; even numbers such as [4, 8, 12] are expected");
}

template <class Real> std::string ShadowHamiltonian<Real>::cost(Index coordinates, std::int64_t cadence) const {
  const std::int64_t row = steps_in_a_row();
  const std::string when = cadence <= row ? "each step" : fmt::format("each of {} steps in {}", row, cadence);
  return fmt::format("{} products of {} numbers and the energies of the kicks at {}; keeps {} numbers", row - 1,
                     coordinates, when, 2 * coordinates * row);
}

template <class Real> void ShadowHamiltonian<Real>::observe(const Snapshot<Real>& now) {
  if (samples_ == 0 && points_.empty()) begin(now);
  append(now);
  values_.clear();
  if (points_.size() < static_cast<std::size_t>(steps_in_a_row())) return;
  const Real h(now.state().clock().dt());
  if (weights_.empty()) lay_out_weights();
  for (std::size_t at = 0; at < orders.size(); ++at) values_.push_back(value(at, h));
  take(now.time());
  // Velocities that leave the constraints a little hide what forces of constraints do along them.
  const bool comparable = constraint_tolerance_ == 0 && now.state().variables().empty();
  if (comparable && std::has_single_bit(static_cast<std::uint64_t>(samples_))) compare_force_and_energy(now);
}

template <class Real> void ShadowHamiltonian<Real>::begin(const Snapshot<Real>& now) {
  const EnergyTerms<Real>& energy = now.energy();
  const double t = static_cast<double>(energy.kinetic), u = static_cast<double>(energy.potential);
  scale_ = std::max(std::abs(t + u), 1e-3 * (t + std::abs(u)));
  if (scale_ == 0) scale_ = 1;
  time_unit_ = std::string(now.units().time);
  // Positions are rounded at every step, so that momentum times distance is uncertain in proportion.
  const ParticleSystem<Real>& s = now.state();
  const auto& momenta = std::as_const(now.mapped()).velocities();  // by mass
  double distance = sum_over<double>(s.size(), [&](Index i) {
    using std::sqrt;
    return static_cast<double>(s.masses()[i] * sqrt(norm2(s.positions()[i]) * norm2(momenta[i])));
  });
  if (has_bodies(s)) {  // |q| |p| = 2 |S|
    const auto& spin = s.template column<BodySpin>();
    distance += sum_over<double>(s.size(), [&](Index i) {
      using std::sqrt;
      return 2 * static_cast<double>(sqrt(norm2(Vec3<Real>(spin[i]))));
    });
  }
  const std::vector<Real>& y = s.variables();
  for (std::size_t i = 0; i < y.size() / 2; ++i) {
    distance += std::abs(static_cast<double>(y[i]) * static_cast<double>(y[y.size() / 2 + i]));
  }
  const auto epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());
  noise_ = 8 * epsilon * (distance / std::abs(s.clock().dt()) + t + std::abs(u)) / scale_;
  wear_ = 4 * epsilon * (t + std::abs(u)) / scale_;
  first_step_ = now.step();
  constraint_tolerance_ = now.claims().constraint_tolerance;
}

/// How far rounding alone explains that values differ: where they are taken, and what has become of the run.
template <class Real> double ShadowHamiltonian<Real>::rounding() const {
  const std::int64_t steps = points_.empty() ? 0 : points_.back().step - first_step_;
  return noise_ + wear_ * std::sqrt(static_cast<double>(steps));
}

/// Differences of the energy along a displacement of every particle, against the force: a few looks find what is none.
/// Forces of constraints and of magnetic fields are no gradients, but do no work along the velocities.
template <class Real> void ShadowHamiltonian<Real>::compare_force_and_energy(const Snapshot<Real>& now) {
  using std::abs, std::sqrt;
  const ParticleSystem<Real>& s = now.state();
  const VectorColumn<Real>& a = now.accelerations();
  // Along the force turned by some angle in each plane, which both a force too long and one askew betray.
  const bool constrained = now.claims().constraints > 0, in_field = has_field_momenta(now);
  const auto direction = [&](Index i) {
    if (constrained || in_field) return Vec3<Real>(s.velocities()[i]);
    const Vec3<Real> f = a[i];
    return Vec3<Real>(f[0] + Real(0.7) * f[1] - Real(0.4) * f[2], f[1] - Real(0.7) * f[0] + Real(0.3) * f[2],
                      f[2] + Real(0.4) * f[0] - Real(0.3) * f[1]);
  };
  Real length(0), distance(0);
  for (Index i = 0; i < s.size(); ++i) {
    length = std::max(length, sqrt(norm2(direction(i))));
    distance = std::max(distance, sqrt(norm2(s.positions()[i])));
  }
  const auto [work, size] = sums_over<Real, 2>(s.size(), [&](Index i) {
    const Vec3<Real> d = direction(i);
    return std::array<Real, 2>{s.masses()[i] * dot(Vec3<Real>(a[i]), d),
                               s.masses()[i] * sqrt(norm2(Vec3<Real>(a[i])) * norm2(d))};
  });
  if (!(size > Real(0)) || !(distance > Real(0))) return;
  const auto potential_at = [&](const Real& epsilon) {
    ParticleSystem<Real> moved = s;
    for (Index i = 0; i < s.size(); ++i) moved.positions().add(i, epsilon * direction(i));
    return now.energy_of(moved).potential;
  };
  // Central differences of fourth order, over longer and shorter ways: one of them lies between the system's smallest
  // length and what rounding allows.
  double least = std::numeric_limits<double>::infinity();
  for (Real e = distance / length * Real(1e-2); e > distance / length * Real(1e-8); e *= Real(0.1)) {
    const Real near = potential_at(e) - potential_at(-e), far = potential_at(Real(2) * e) - potential_at(Real(-2) * e);
    const Real slope = (Real(8) * near - far) / (Real(12) * e);
    const double error = static_cast<double>(abs(slope + work) / size);
    if (std::isfinite(error)) least = std::min(least, error);
  }
  if (std::isfinite(least)) gradient_error_ = std::max(gradient_error_, least);
}

/// Adds the present point to the window, with its products with all points before it.
template <class Real> void ShadowHamiltonian<Real>::append(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.mapped();
  const bool goes_on = !points_.empty() && points_.back().step + 1 == now.step() &&
                       points_.back().x.size() == s.size() && points_.back().variables.size() == s.variables().size();
  if (!goes_on) points_.clear();
  if (points_.size() == static_cast<std::size_t>(steps_in_a_row())) {
    std::rotate(points_.begin(), points_.begin() + 1, points_.end());  // the oldest one's memory serves the newest
  } else {
    points_.emplace_back();
  }
  Point& point = points_.back();
  point.step = now.step();
  point.x = s.positions();
  if (s.box().is_periodic()) {
    for (Index i = 0; i < s.size(); ++i) point.x.set(i, s.unwrapped(i));
  }
  point.v = s.velocities();
  point.variables = s.variables();
  if (s.low_words() != nullptr) point.x_low = s.low_words()->x;
  if (has_bodies(s)) {
    point.turn = s.template column<BodyOrientation>();
    point.twist = RowColumn<Real, 4>(s.size());
    const auto& spin = s.template column<BodySpin>();
    for (Index i = 0; i < s.size(); ++i) {
      const Quaternion<Real> q = std::as_const(point.turn)[i];
      point.twist.set(i, quaternion_product<Real>(quaternion<Real>(Real(0), Real(2) * Vec3<Real>(spin[i])), q));
    }
  }
  point.action = now.action() + (now.settling_action() - settling_);
  settling_ = now.settling_action();
  point.products.clear();
  Real action(0);
  for (std::int64_t age = 1; age < static_cast<std::int64_t>(points_.size()); ++age) {
    action += aged(age - 1).action;
    point.products.push_back(difference(aged(age), point, s.masses(), action));
  }
}

/// w(newer, older) = (q' - q) . (p' + p) - 2 S.
template <class Real>
Real ShadowHamiltonian<Real>::difference(const Point& older, const Point& newer, const ScalarColumn<Real>& masses,
                                         const Real& action) const {
  const Difference<Real> high{older.x, older.v, newer.x, newer.v}, low{older.x_low, older.v, newer.x_low, newer.v};
  const bool compensated = newer.x_low.size() == masses.size() && older.x_low.size() == masses.size();
  Real sum = sum_over<Real>(masses.size(), [&](Index i) { return masses[i] * high.at(i); });
  if (compensated) sum += sum_over<Real>(masses.size(), [&](Index i) { return masses[i] * low.at(i); });
  const Difference<Real, 4> turns{older.turn, older.twist, newer.turn, newer.twist};
  if (newer.turn.size() > 0) sum += sum_over<Real>(newer.turn.size(), [&](Index i) { return turns.at(i); });
  if (!newer.variables.empty()) sum += difference_of_variables(older.variables, newer.variables);
  return sum - Real(2) * action;
}

template <class Real> void ShadowHamiltonian<Real>::lay_out_weights() {
  for (const std::int64_t order : orders) {
    const std::int64_t k = order / 2;
    std::vector<Real>& weights = weights_.emplace_back();
    for (std::int64_t lag = 1; lag <= k; ++lag) {
      for (std::int64_t a = 0; a + lag <= k; ++a) weights.emplace_back(shadow_weight(k, a, a + lag));
    }
  }
}

template <class Real> Real ShadowHamiltonian<Real>::value(std::size_t at, const Real& h) const {
  const std::int64_t k = orders[at] / 2;
  auto weight = weights_[at].begin();
  Real sum(0);
  for (std::int64_t lag = 1; lag <= k; ++lag) {
    Real same_lag(0);
    for (std::int64_t a = 0; a + lag <= k; ++a) {
      same_lag += *weight++ * aged(a).products[static_cast<std::size_t>(lag - 1)];
    }
    sum += same_lag / Real(static_cast<double>(lag));
  }
  return sum / (h * Real(binomial(2 * k, k)));
}

template <class Real> void ShadowHamiltonian<Real>::take(double time) {
  if (figures_.empty()) {
    figures_.resize(values_.size());
    for (std::size_t k = 0; k < values_.size(); ++k) figures_[k].first = values_[k];
  }
  ++samples_;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    Figures& f = figures_[k];
    const Real change = values_[k] - f.first, from_mean = change - f.mean;
    f.mean += from_mean / Real(static_cast<double>(samples_));
    f.squares += from_mean * (change - f.mean);
    f.errors.add(time, static_cast<double>(change) / scale_);
  }
}

template <class Real> double ShadowHamiltonian<Real>::fluctuation(std::size_t at) const {
  if (samples_ == 0) return 0;
  using std::sqrt;
  return static_cast<double>(sqrt(figures_[at].squares / Real(static_cast<double>(samples_)))) / scale_;
}

template <class Real> std::vector<Series> ShadowHamiltonian<Real>::series() const {
  if (values_.empty()) return {};
  std::vector<double> now, flatness;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    now.push_back(static_cast<double>(values_[k]));
    flatness.push_back(fluctuation(k));
  }
  const std::vector<Index> shape = {static_cast<Index>(orders.size())};
  return {{"value", "energy", shape, now, {}, orders}, {"fluctuation", "1", shape, flatness, {}, orders}};
}

template <class Real> MonitorReport ShadowHamiltonian<Real>::report() const {
  MonitorReport report;
  report.samples = samples_;
  if (samples_ == 0) report.verdict = verdict();
  if (samples_ == 0) return report;
  const SeriesStatistics& errors = figures_[best()].errors;
  report.first = static_cast<double>(figures_[best()].first);
  report.last = static_cast<double>(figures_[best()].first) + scale_ * errors.last();
  report.worst = errors.worst();
  report.rms = errors.rms();
  report.scale = scale_;
  report.slope = errors.slope();
  if (const auto line = errors.line()) report.slope_error = line->error;
  report.slope_unit = time_unit_ == "1" ? "1" : "1/" + time_unit_;
  report.orders = orders;
  for (std::size_t k = 0; k < orders.size(); ++k) report.fluctuation.push_back(fluctuation(k));
  report.best_order = orders[best()];
  report.verdict = verdict();
  return report;
}

template <class Real> std::size_t ShadowHamiltonian<Real>::best() const {
  std::size_t least = 0;
  for (std::size_t k = 1; k < figures_.size(); ++k) {
    if (fluctuation(k) < fluctuation(least)) least = k;
  }
  return least;
}

template <class Real> std::string ShadowHamiltonian<Real>::verdict() const {
  if (samples_ < 2) return "too short to tell";
  const double least = fluctuation(best()), last = fluctuation(orders.size() - 1);
  const std::string best_of = fmt::format("order {} fluctuates by {:.1e}", orders[best()], least);
  if (gradient_error_ > largest_gradient_error) {
    return fmt::format("force is not a gradient: it differs from that of its energy by {:.1e} of its size",
                       gradient_error_);
  }
  if (!std::isfinite(least)) return "step too large: the values left the range of double precision";
  if (least <= rounding()) return "kept to rounding: " + best_of;
  const std::string no_order = fmt::format("no order fluctuates less than {:.1e}", least);
  // An asymptotic series that is used beyond its smallest term grows, or stays where it is.
  const std::size_t third_last = orders.size() < 3 ? 0 : orders.size() - 3;
  const bool grows = last > 1.2 * least, stays = orders.size() > 1 && least > 0.8 * fluctuation(third_last);
  if (stays && least < 100 * constraint_tolerance_) {
    return fmt::format("constraints not converged: they are solved to {:.1e}, and {}", constraint_tolerance_, no_order);
  }
  if (grows) {
    return fmt::format("step too large: {}, and higher orders by more, not less ({:.1e} at {})", best_of, last,
                       orders.back());
  }
  if (least > 0.01) return "step too large: " + no_order;
  if (stays && fluctuation(0) > 1.2 * least) return fmt::format("step too large: {}, at however high order", no_order);
  if (stays) return "not symplectic: " + no_order;  // what no series describes is the same at every order
  return "kept: " + best_of + ", less with every order";
}

template <class Real> void ShadowHamiltonian<Real>::save(SavedState& saved, const std::string& prefix) const {
  const auto name = [&](const std::string& key) { return prefix + "/" + key; };
  std::vector<Real> columns, numbers;
  std::vector<std::int64_t> shape;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Point& point = points_[p];
    shape.insert(shape.end(), {point.step, point.x.size(), point.x_low.size()});
    for (const VectorColumn<Real>* column : {&point.x, &point.v, &point.x_low}) {
      for (int c = 0; c < 3; ++c)
        columns.insert(columns.end(), column->component(c), column->component(c) + column->size());
    }
    columns.push_back(point.action);
    columns.insert(columns.end(), point.products.begin(), point.products.begin() + static_cast<std::ptrdiff_t>(p));
  }
  for (const Figures& f : figures_) numbers.insert(numbers.end(), {f.first, f.mean, f.squares});
  if (const std::vector<Real> of_bodies = turns(); !of_bodies.empty()) save_value(saved, name("turns"), of_bodies);
  if (!points_.empty() && !points_.front().variables.empty()) {
    std::vector<Real> of_system;
    for (const Point& point : points_)
      of_system.insert(of_system.end(), point.variables.begin(), point.variables.end());
    save_value(saved, name("variables"), of_system);
  }
  save_value(saved, name("shape"), shape);
  save_value(saved, name("columns"), columns);
  save_value(saved, name("numbers"), numbers);
  for (std::size_t k = 0; k < figures_.size(); ++k) figures_[k].errors.save(saved, name("errors_" + std::to_string(k)));
  save_value(saved, name("samples"), samples_);
  save_value(saved, name("settling"), settling_);
  save_value(saved, name("first_step"), first_step_);
  save_value(saved, name("figures"), std::array{scale_, noise_, wear_, gradient_error_, constraint_tolerance_});
  save_value(saved, name("time_unit"), time_unit_);
}

template <class Real> void ShadowHamiltonian<Real>::load(const SavedState& saved, const std::string& prefix) {
  const auto name = [&](const std::string& key) { return prefix + "/" + key; };
  std::vector<Real> columns, numbers;
  std::vector<std::int64_t> shape;
  std::array<double, 5> figures{};
  load_value(saved, name("shape"), shape);
  load_value(saved, name("columns"), columns);
  load_value(saved, name("numbers"), numbers);
  load_value(saved, name("samples"), samples_);
  load_value(saved, name("settling"), settling_);
  load_value(saved, name("first_step"), first_step_);
  load_value(saved, name("figures"), figures);
  load_value(saved, name("time_unit"), time_unit_);
  scale_ = figures[0];
  noise_ = figures[1];
  wear_ = figures[2];
  gradient_error_ = figures[3];
  constraint_tolerance_ = figures[4];
  const std::size_t most = static_cast<std::size_t>(steps_in_a_row()), count = shape.size() / 3;
  if (shape.size() % 3 != 0 || count > most || (samples_ > 0) != !numbers.empty()) refuse_saved();
  if (!numbers.empty() && numbers.size() != 3 * orders.size()) refuse_saved();
  figures_.assign(numbers.size() / 3, {});
  for (std::size_t k = 0; k < figures_.size(); ++k) {
    figures_[k].first = numbers[3 * k];
    figures_[k].mean = numbers[3 * k + 1];
    figures_[k].squares = numbers[3 * k + 2];
    figures_[k].errors.load(saved, name("errors_" + std::to_string(k)));
  }
  load_points(shape, columns);
  if (saved.contains(name("turns"))) {
    std::vector<Real> of_bodies;
    load_value(saved, name("turns"), of_bodies);
    load_turns(of_bodies);
  }
  if (saved.contains(name("variables"))) {
    std::vector<Real> of_system;
    load_value(saved, name("variables"), of_system);
    load_variables(of_system);
  }
  values_.clear();
}

/// The variables of all points of the window, in a row.
template <class Real> void ShadowHamiltonian<Real>::load_variables(const std::vector<Real>& values) {
  if (points_.empty() || values.size() % points_.size() != 0) refuse_saved();
  const auto each = static_cast<std::ptrdiff_t>(values.size() / points_.size());
  auto next = values.begin();
  for (Point& point : points_) {
    point.variables.assign(next, next + each);
    next += each;
  }
}

/// The quaternions of bodies and their momenta at all points of the window, in a row.
template <class Real> std::vector<Real> ShadowHamiltonian<Real>::turns() const {
  std::vector<Real> all;
  for (const Point& point : points_) {
    for (const RowColumn<Real, 4>* column : {&point.turn, &point.twist}) {
      for (int c = 0; c < 4; ++c) all.insert(all.end(), column->component(c), column->component(c) + column->size());
    }
  }
  return all;
}

template <class Real> void ShadowHamiltonian<Real>::load_turns(const std::vector<Real>& turns) {
  auto next = turns.begin();
  for (Point& point : points_) {
    const Index n = point.x.size();
    if (turns.end() - next < 8 * n) refuse_saved();
    for (RowColumn<Real, 4>* column : {&point.turn, &point.twist}) {
      *column = RowColumn<Real, 4>(n);
      for (int c = 0; c < 4; ++c, next += n) std::copy_n(next, n, column->component(c));
    }
  }
}

/// The points of a window, from their shapes (step, particles, low words each) and all their numbers in a row.
template <class Real>
void ShadowHamiltonian<Real>::load_points(const std::vector<std::int64_t>& shape, const std::vector<Real>& numbers) {
  points_.clear();
  std::size_t at = 0;
  const auto next = [&] {
    if (at >= numbers.size()) refuse_saved();
    return numbers[at++];
  };
  for (std::size_t p = 0; p < shape.size() / 3; ++p) {
    Point point;
    point.step = shape[3 * p];
    const std::int64_t n = shape[3 * p + 1], low = shape[3 * p + 2];
    if (point.step != shape[0] + static_cast<std::int64_t>(p) || n != shape[1]) refuse_saved();
    if (n < 0 || static_cast<std::size_t>(n) > numbers.size() || (low != 0 && low != n)) refuse_saved();
    point.x = VectorColumn<Real>(n);
    point.v = VectorColumn<Real>(n);
    point.x_low = VectorColumn<Real>(low);
    for (VectorColumn<Real>* column : {&point.x, &point.v, &point.x_low}) {
      for (int c = 0; c < 3; ++c) std::generate_n(column->component(c), column->size(), next);
    }
    point.action = next();
    for (std::size_t m = 0; m < p; ++m) point.products.push_back(next());
    points_.push_back(std::move(point));
  }
}

template class ShadowHamiltonian<double>;
template class ShadowHamiltonian<Quad>;
template struct detail::MonitorModel<ShadowHamiltonian<double>, double>;
template struct detail::MonitorModel<ShadowHamiltonian<Quad>, Quad>;

}  // namespace noether
