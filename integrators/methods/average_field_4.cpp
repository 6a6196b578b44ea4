#include "integrators/methods/average_field_4.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace noether {

namespace {

constexpr int fewest_nodes = 8, most_nodes = 64;

}  // namespace

template <class Real>
AverageField4<Real>::AverageField4(const MethodInfo& info, const MethodOptions& /*options*/) : name_(info.name) {}

template <class Real> MethodClaims AverageField4<Real>::claims() const {
  return {.name = name_,
          .order = 4,
          .reversible = true,
          .energy_exact = true,
          .conservative_only = true,
          .of_momenta = true};
}

template <class Real> void AverageField4<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  if (!f.has_derivative()) {
    throw SchemeMismatch(
        fmt::format("method '{}' needs exact derivatives of the forces, and those of '{}' are not known; "
                    "use 'hbvm_2', which has the same order without",
                    name_, field.name));
  }
  second_order_ = field.second_order;
  rated_ = second_order_ ? f.size() / 2 : f.size();
  const auto padded = static_cast<std::size_t>((f.size() + 7) / 8 * 8);
  for (auto* all : {&line_, &states_}) all->assign(lane_count * padded, Real(0));
  rates_.assign(most_nodes * padded, Real(0));
  low_.assign(static_cast<std::size_t>(f.size()), Real(0));
  for (auto* v : {&slope_, &fresh_, &average_, &middle_, &product_, &update_}) v->setZero(f.size());
  sums_ = {f.size(), 1};
  table_ = &line_table<Real>(fewest_nodes, 1);
}

/// The average of f along the line.
template <class Real>
void AverageField4<Real>::average(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const LineTable<Real>& table = *table_;
  for (Index i = 0; i < y.size(); ++i) line_[static_cast<std::size_t>(lane_count * i)] = slope_[i];
  average_.setZero();
  for (std::size_t e = 0; e < table.eights.size(); ++e) {
    const auto& nodes = table.eights[e];
    std::array<Real, lane_count> times{};
    for (std::size_t k = 0; k < lane_count; ++k) times[k] = t + nodes.c[k] * Real(h);
    sums_.values(line_.data(), nodes.path, y.data(), low_.data(), h, states_.data());
    Real* const own = rates_.data() + e * states_.size();
    const Real* const rates = f.rates({times.data(), states_.data(), nullptr, nodes.nodes, second_order_}, own);
    if (rates != own) std::copy_n(rates, lane_count * rated_, own);
    const Index first = second_order_ ? rated_ : 0;
    for (Index i = 0; i < rated_; ++i) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(nodes.nodes); ++k) {
        average_[first + i] += nodes.onto[k][0] * own[lane_count * static_cast<std::size_t>(i) + k];
      }
    }
  }
  for (Index i = 0; second_order_ && i < rated_; ++i) {
    average_[i] = y[rated_ + i] + (Real(h) * slope_[rated_ + i] / Real(2) + low_[static_cast<std::size_t>(rated_ + i)]);
  }
}

template <class Real>
double AverageField4<Real>::improve(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  average(f, t, y, h);
  const Real half(h / 2), twelfth = Real(h) * Real(h) / Real(12);
  middle_ = y + half * slope_;
  f.derivative(t + half, middle_, Real(0), average_, product_);
  f.derivative(t + half, middle_, Real(0), product_, fresh_);
  double worst = 0;
  for (Index begin = 0, count = y.size() / 2; begin < y.size(); begin += count) {
    double change = 0, size = 0;
    for (Index i = begin; i < begin + count; ++i) {
      fresh_[i] = average_[i] - twelfth * fresh_[i];
      update_[i] = fresh_[i] - slope_[i];
      change = std::max(change, std::abs(static_cast<double>(update_[i])));
      size = std::max(size, std::abs(static_cast<double>(fresh_[i])));
      if (!std::isfinite(static_cast<double>(fresh_[i]))) return std::numeric_limits<double>::infinity();
    }
    if (size > 0) worst = std::max(worst, change / size);
  }
  return worst;
}

template <class Real>
bool AverageField4<Real>::sweep(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  constexpr int most = 300, patience = 6;
  const auto rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  double before = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int round = 1; round <= most; ++round) {
    const double change = improve(f, t, y, h);
    if (!std::isfinite(change)) return false;
    slope_ = fresh_;
    if (change <= rounding / 4) return true;
    stalled = round > 2 && change >= before ? stalled + 1 : 0;  // as in the sweeps of `Hbvm`
    if (stalled > 0 && change < (stalled > 1 ? 4096 : 64) * rounding) return true;
    if (stalled > 1 && round > patience) return false;
    before = change;
  }
  return false;
}

/// Newton's iteration with the matrix of f's linear part: I - h J / 2 + (h J)^3 / 24.
template <class Real>
bool AverageField4<Real>::iterate(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const Index n = y.size();
  const auto factorize = [&](const Vector<Real>& at) {
    ++f.evaluations().jacobian;
    static_cast<void>(f.jacobian(t, at, J_));
    matrix_ = J_ * J_ * J_ * (Real(h) * Real(h) * Real(h) / Real(24)) - J_ * Real(h / 2);
    for (Index i = 0; i < n; ++i) matrix_(i, i) += Real(1);
    return factors_.compute(matrix_);
  };
  const auto restart = [&] { slope_.setZero(); };
  const auto correct = [&]() -> std::optional<UpdateSize> {
    static_cast<void>(improve(f, t, y, h));
    factors_.solve(update_, fresh_);
    slope_ += fresh_;
    middle_ = y + Real(h) * slope_;
    fresh_ *= Real(h);
    return update_size(fresh_, y, middle_, second_order_);
  };
  const auto renew = [&] {
    middle_ = y + Real(h / 2) * slope_;
    return factorize(middle_);
  };
  restart();
  return factorize(y) && !newton_to_rounding<Real>(correct, restart, renew);
}

/// As that of `Hbvm`: by the last two coefficients of the rates that the nodes know.
template <class Real> bool AverageField4<Real>::has_enough_nodes() const {
  // Of y = (q, p) the halves have units of their own.
  return second_order_ ? has_enough_nodes(0, rated_)
                       : has_enough_nodes(0, rated_ / 2) && has_enough_nodes(rated_ / 2, rated_);
}
template <class Real> bool AverageField4<Real>::has_enough_nodes(Index begin, Index end) const {
  const LineTable<Real>& table = *table_;
  double worst = 0, largest = 0;
  for (int m = table.nodes - 2; m < table.nodes; ++m) {
    for (Index i = begin; i < end; ++i) {
      Real sum(0);
      for (std::size_t e = 0; e < table.eights.size(); ++e) {
        const Real* const rates = rates_.data() + e * states_.size() + lane_count * static_cast<std::size_t>(i);
        for (std::size_t k = 0; k < lane_count; ++k) {
          sum += table.spectrum[static_cast<std::size_t>(m)][e][k] * rates[k];
          largest = std::max(largest, std::abs(static_cast<double>(rates[k])));
        }
      }
      worst = std::max(worst, std::abs(static_cast<double>(sum)));
    }
  }
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2048;
  return worst <= largest * std::pow(rounding, (table.nodes - 1.0) / (2.0 * table.nodes - 1));
}

template <class Real>
StepResult AverageField4<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  f.rate(t, y, slope_);
  for (int nodes = fewest_nodes;; nodes *= 2) {
    table_ = &line_table<Real>(nodes, 1);
    if (!sweep(f, t, y, h) && !iterate(f, t, y, h)) {
      made.failure = Failure{
          Outcome::Kind::solver_failure, -1, "slope",
          fmt::format("the slope of '{}' does not converge with a step of {:.6g}; give a shorter one", name_, h)};
      return made;
    }
    if (has_enough_nodes()) break;
    if (nodes < most_nodes) continue;
    ++f.evaluations().unsettled;  // forces with a kink, or a step far too long
    break;
  }
  std::fill(line_.begin(), line_.end(), Real(0));
  for (Index i = 0; i < y.size(); ++i) line_[static_cast<std::size_t>(lane_count * i)] = slope_[i];
  sums_.finish(line_.data(), table_->word_ends, h, nullptr, nullptr, y.data(), low_.data());
  return made;
}

template <class Real> void AverageField4<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "low", std::vector<Real>(low_.begin(), low_.end()));
}

template <class Real> void AverageField4<Real>::load(const SavedState& saved, const std::string& prefix) {
  std::vector<Real> read;
  load_value(saved, prefix + "low", read);
  for (std::size_t k = 0; k < low_.size(); ++k) low_[k] = detail::element(read, k);
}

template class AverageField4<double>;
template class AverageField4<Quad>;

}  // namespace noether
