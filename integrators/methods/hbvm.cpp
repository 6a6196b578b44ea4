#include "integrators/methods/hbvm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// Numbers of nodes that are tried where rounding is to decide.
constexpr std::array<int, 6> node_ladder = {8, 16, 24, 32, 48, 64};

/// Coefficients of the last step that the next one begins from.
int coefficients_ahead(int nodes, int coefficients) { return std::min({coefficients + 1, nodes, lane_count}); }

template <class Real> constexpr double line_rounding = std::is_same_v<Real, double> ? 0x1p-54 : 1e-33;

}  // namespace

template <class Real>
Hbvm<Real>::Hbvm(const MethodInfo& info, const MethodOptions& options, int nodes, int coefficients)
    : name_(info.name),
      coefficients_(coefficients),
      fixed_nodes_(nodes),
      form_(options.jacobian),
      kept_(options.own.as<LineInvariants>()) {
  table_ = &line_table<Real>(nodes > 0 ? nodes : node_ladder.front(), coefficients);
}

template <class Real> MethodClaims Hbvm<Real>::claims() const {
  const bool gauss = fixed_nodes_ == coefficients_ && !kept_.any();
  return {.name = name_,
          .order = 2 * coefficients_,
          .symplectic = gauss,
          .reversible = true,
          .keeps_angular_momentum = gauss || kept_.keeps("angular_momentum"),
          .energy_exact = fixed_nodes_ == 0 && (!kept_.any() || kept_.keeps("energy")),
          .exact_degree = kept_.any() ? 0 : 2 * fixed_nodes_ / coefficients_,
          .conservative_only = true,
          .of_momenta = true};
}

template <class Real> void Hbvm<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims claims = f.claims();
  kept_.bind(f, name_, coefficients_);
  second_order_ = claims.second_order && !kept_.any();
  halves_ = claims.second_order && kept_.any();
  two_kinds_ = halves_ || claims.canonical;
  n_ = second_order_ ? f.size() / 2 : f.size();
  const auto padded = static_cast<std::size_t>((n_ + 7) / 8 * 8);
  for (auto* all : {&g_, &fresh_, &part_, &q_, &v_, &previous_}) all->assign(lane_count * padded, Real(0));
  low_.assign(static_cast<std::size_t>(f.size()), Real(0));
  state_.resize(f.size());
  sums_ = {n_, coefficients_};
  h_ = ahead_ratio_ = 0;
  swept_ = true;
  system_.reset();
  use_nodes(fixed_nodes_ > 0 ? fixed_nodes_ : node_ladder.front());
}

template <class Real> void Hbvm<Real>::use_nodes(int nodes) {
  table_ = &line_table<Real>(nodes, coefficients_);
  if (rates_.size() < table_->eights.size() * g_.size()) rates_.resize(table_->eights.size() * g_.size(), Real(0));
  at_nodes_.assign(table_->eights.size(), nullptr);
}

template <class Real> StepResult Hbvm<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  const Place at{f, t, y, h};
  if (kept_.any()) kept_.start(f, t, y);
  predict(at);
  bool by_newton = false;
  while (true) {
    if (!solve(at, by_newton)) {
      made.failure = Failure{Outcome::Kind::solver_failure, -1, "coefficients",
                             fmt::format("the coefficients of '{}' do not converge with a step of {:.6g}; give a "
                                         "shorter one",
                                         name_, h)};
      return made;
    }
    by_newton = !swept_;
    if (fixed_nodes_ > 0 || has_enough(table_->nodes)) break;
    const auto more = std::upper_bound(node_ladder.begin(), node_ladder.end(), table_->nodes);
    if (more == node_ladder.end()) {
      ++f.evaluations().unsettled;  // forces with a kink, or a step far too long
      break;
    }
    use_nodes(*more);
  }
  finish(y, h);
  return made;
}

/// Coefficients of the last step, continued; without one, the rates at hand.
template <class Real> void Hbvm<Real>::predict(const Place& at) {
  if (h_ == 0) {
    std::fill(g_.begin(), g_.end(), Real(0));
    if (second_order_) {
      at.f.acceleration(at.t, at.y, moved_);
    } else {
      at.f.rate(at.t, at.y, moved_);
    }
    for (Index i = 0; i < n_; ++i) g_[static_cast<std::size_t>(lane_count * i)] = moved_[i];
    return;
  }
  const double ratio = at.h / h_;
  if (ratio != ahead_ratio_) ahead_ = legendre_ahead(coefficients_ahead(table_->nodes, coefficients_), Real(ratio));
  ahead_ratio_ = ratio;
  for (auto& row : ahead_) std::fill(row.begin() + coefficients_, row.end(), Real(0));
  sums_.combine(previous_.data(), ahead_, g_.data());
}

template <class Real> bool Hbvm<Real>::solve(const Place& at, bool by_newton) {
  if (!by_newton && sweep(at)) {
    swept_ = true;
    return true;
  }
  swept_ = false;
  return iterate(at);
}

/// Positions (and velocities) at eight nodes from the coefficients.
template <class Real> void Hbvm<Real>::form_states(const Place& at, std::size_t eight, Real* q) {
  const auto& nodes = table_->eights[eight];
  if (!second_order_) return sums_.values(g_.data(), nodes.path, at.y.data(), low_.data(), at.h, q);
  sums_.positions(g_.data(), nodes.bend, nodes.c, nodes.c_low, at.y.data(), low_.data(), at.y.data() + n_, at.h, q);
}

template <class Real> const Real* Hbvm<Real>::rates_at(const Place& at, std::size_t eight) {
  const auto& nodes = table_->eights[eight];
  std::array<Real, lane_count> times{};
  for (std::size_t k = 0; k < lane_count; ++k) times[k] = at.t + nodes.c[k] * Real(at.h);
  Real* const place = halves_ ? nullptr : at.f.place_of_stages();
  Real* const q = place != nullptr ? place : q_.data();
  form_states(at, eight, q);
  Real* const own = rates_.data() + eight * g_.size();
  const bool second = second_order_ || halves_;
  const Real* rates = at.f.rates({times.data(), q, nullptr, nodes.nodes, second}, own);
  if (halves_) {  // q' = v, and v' behind it
    const Index half = lane_count * n_ / 2;
    std::copy_n(rates, half, part_.data());
    std::copy_n(part_.data(), half, own + half);
    std::copy_n(q + half, half, own);
    rates = own;
  }
  if (kept_.any()) kept_.add(nodes, q, rates);
  if (rates == own || table_->eights.size() == 1) return rates;
  std::copy_n(rates, lane_count * n_, own);  // the field's own place is needed for the next eight
  return own;
}

/// The coefficients of the rates along the path.
template <class Real> void Hbvm<Real>::evaluate(const Place& at) {
  if (kept_.any()) kept_.begin();
  for (std::size_t e = 0; e < table_->eights.size(); ++e) {
    at_nodes_[e] = rates_at(at, e);
    AlignedVector<Real>& into = e == 0 ? fresh_ : part_;
    sums_.combine(at_nodes_[e], table_->eights[e].onto, into.data());
    if (e == 0) continue;
    for (std::size_t k = 0; k < fresh_.size(); ++k) fresh_[k] += part_[k];
  }
  if (kept_.any()) kept_.correct(fresh_.data());
}

/// Goes on to the coefficients of the rates along the path. @return their largest change and size; of the half, q or v,
/// that has changed most
template <class Real> std::array<Real, 2> Hbvm<Real>::take(const Place& at) {
  const bool at_once = table_->eights.size() == 1 && !kept_.any();
  if (at_once) {
    at_nodes_[0] = rates_at(at, 0);
  } else {
    evaluate(at);
  }
  const auto of = [&](const StageArithmetic<Real>& sums, Index begin) {
    Real* const into = g_.data() + lane_count * begin;
    if (!at_once) return sums.take(fresh_.data() + lane_count * begin, into);
    return sums.take_combined(at_nodes_[0] + lane_count * begin, table_->eights[0].onto, into);
  };
  if (!two_kinds_) return of(sums_, 0);
  const StageArithmetic<Real> half{n_ / 2, coefficients_};
  const auto q = of(half, 0), v = of(half, half.n);
  return !(q[0] * v[1] <= v[0] * q[1]) ? q : v;
}

/// Until what the next sweep would change is below rounding, or no less than what this one has. Errors may turn as they
/// shrink, so that one sweep in between does not: only two in a row are taken for the end of it.
template <class Real> bool Hbvm<Real>::sweep(const Place& at) {
  using std::isfinite;
  constexpr int most = 300;
  const int patience = swept_ ? 6 : 2;  // where the last step has not converged, this one may not either
  double before = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int round = 1; round <= most; ++round) {
    const auto [change, size] = take(at);
    if (!isfinite(size + change)) return false;
    const double relative = size > Real(0) ? static_cast<double>(change / size) : change > Real(0) ? 1.0 : 0.0;
    const double shrinks = round == 1 ? 1.0 : relative / before;
    const double left = relative * std::min(shrinks, 1.0) * 0.5;
    if (relative <= line_rounding<Real> || left < line_rounding<Real> * 0x1p-6) return true;
    stalled = round > 2 && shrinks >= 1 ? stalled + 1 : 0;
    if (stalled > 0) {
      const double noise = stalled > 1 ? 0x1p18 * line_rounding<Real> : 0x1p8 * line_rounding<Real>;
      if (relative < noise || is_rounding(at.y, rates_of(), at.h, static_cast<double>(change))) return true;
      if (stalled > 1 && round > patience) return false;
    }
    before = relative;
  }
  return false;
}

/// The coefficients by Newton's iteration. It begins at rest, as that of `Collocation` does, so that its first update
/// leads to the path of the linear problem; a new matrix is that of the middle of the path.
template <class Real> bool Hbvm<Real>::iterate(const Place& at) {
  const auto S = static_cast<std::size_t>(coefficients_);
  if (!system_) {
    using Rates = typename StageSystem<Real>::Rates;
    system_.emplace(at.f, coefficients_, table_->once, table_->twice, form_,
                    halves_ ? Rates::all : Rates::accelerations);
  }
  update_.resize(coefficients_ * n_);
  const auto restart = [&] {
    std::fill(g_.begin(), g_.end(), Real(0));
    update_.setZero();
    for (std::size_t j = 0; second_order_ && j < S; ++j) {
      update_.segment(static_cast<Index>(j) * n_, n_) = -table_->resting[j] / Real(at.h) * at.y.tail(n_);
    }
    add_update();
  };
  const auto correct = [&]() -> std::optional<UpdateSize> {
    evaluate(at);
    for (std::size_t j = 0; j < S; ++j) {
      for (Index i = 0; i < n_; ++i) {
        const std::size_t k = lane_count * static_cast<std::size_t>(i) + j;
        update_[static_cast<Index>(j) * n_ + i] = fresh_[k] - g_[k];
      }
    }
    if (!system_->solve(at.f, update_)) return {};
    add_update();
    return size_of_update(at);
  };
  const auto renew = [&] {
    const std::size_t middle = static_cast<std::size_t>(table_->nodes) / 2;
    take_state(at, middle / lane_count, middle % lane_count, state_);
    system_->evaluate(at.f, at.t, state_);
    return system_->factorize(at.h);
  };
  restart();
  system_->evaluate(at.f, at.t, at.y);
  return system_->factorize(at.h) && !newton_to_rounding<Real>(correct, restart, renew);
}

template <class Real> void Hbvm<Real>::add_update() {
  for (Index j = 0; j < coefficients_; ++j) {
    for (Index i = 0; i < n_; ++i) g_[static_cast<std::size_t>(lane_count * i + j)] += update_[j * n_ + i];
  }
}

/// One node's state as a field sees it.
template <class Real>
void Hbvm<Real>::take_state(const Place& at, std::size_t eight, std::size_t lane, Vector<Real>& state) {
  form_states(at, eight, q_.data());
  if (second_order_) {
    sums_.values(g_.data(), table_->eights[eight].path, at.y.data() + n_, low_.data() + n_, at.h, v_.data());
  }
  for (Index i = 0; i < n_; ++i) {
    const std::size_t k = lane_count * static_cast<std::size_t>(i) + lane;
    state[i] = q_[k];
    if (second_order_) state[n_ + i] = v_[k];
  }
}

/// What the update has done to positions and velocities, at the node of the first eight where that is most.
template <class Real> UpdateSize Hbvm<Real>::size_of_update(const Place& at) {
  UpdateSize worst;
  moved_.resize(n_);
  from_.resize(n_);
  const auto& nodes = table_->eights.front();
  const Index count = two_kinds_ ? n_ / 2 : n_;
  const auto add = [&](const StageMatrix<Real>& weights, std::size_t k, double factor, Index begin) {
    moved_.setZero();
    for (int j = 0; j < coefficients_; ++j) {
      moved_ += weights[static_cast<std::size_t>(j)][k] * update_.segment(j * n_, n_);
    }
    for (Index i = 0; i < n_; i += count) {
      const UpdateSize size =
          update_size(moved_.data() + i, factor, from_.data() + i, state_.data() + begin + i, count);
      // What is no number is larger than any.
      if (!(size.whole <= worst.whole)) worst.whole = size.whole;
      if (!(size.each <= worst.each)) worst.each = size.each;
    }
  };
  for (std::size_t k = 0; k < static_cast<std::size_t>(nodes.nodes); ++k) {
    take_state(at, 0, k, state_);
    from_ = at.y.head(n_);
    if (second_order_) {
      // Positions are a sum with h v, which may be far larger than what is left.
      from_ = from_.cwiseAbs() + Real(std::abs(at.h)) * at.y.tail(n_).cwiseAbs();
      add(nodes.bend, k, at.h * at.h, 0);
      from_ = at.y.tail(n_);
    }
    add(nodes.path, k, at.h, second_order_ ? n_ : 0);
  }
  return worst;
}

/// The size of coefficient m of the rates, of the variable where it is largest, relative to the largest rate; of both
/// halves, q and v, which have units of their own, the larger.
template <class Real> double Hbvm<Real>::coefficient_size(int m) const {
  if (!two_kinds_) return coefficient_size(m, 0, n_);
  return std::max(coefficient_size(m, 0, n_ / 2), coefficient_size(m, n_ / 2, n_));
}
template <class Real> double Hbvm<Real>::coefficient_size(int m, Index begin, Index end) const {
  double worst = 0, largest = 0;
  const auto& weights = table_->spectrum[static_cast<std::size_t>(m)];
  for (Index i = begin; i < end; ++i) {
    Real sum(0);
    for (std::size_t e = 0; e < weights.size(); ++e) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(table_->eights[e].nodes); ++k) {
        const Real& rate = at_nodes_[e][lane_count * static_cast<std::size_t>(i) + k];
        sum += weights[e][k] * rate;
        largest = std::max(largest, std::abs(static_cast<double>(rate)));
      }
    }
    worst = std::max(worst, std::abs(static_cast<double>(sum)));
  }
  return largest > 0 ? worst / largest : 0;
}

/// Whether so many nodes integrate the rates to rounding. Coefficients fall like powers: where the last two that K
/// nodes know are below d, those from 2 K - S on, which K nodes mistake for the first S, are below
/// d^((2 K - S) / (K - 1)).
template <class Real> bool Hbvm<Real>::has_enough(int nodes) const {
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2048;
  const double allowed = std::pow(rounding, (nodes - 1.0) / (2.0 * nodes - coefficients_));
  return std::max(coefficient_size(nodes - 1), coefficient_size(nodes - 2)) < allowed;
}

/// The least number of nodes of the ladder, up to `most`, that would have been enough for the rates at hand.
template <class Real> int Hbvm<Real>::nodes_needed(int most) const {
  for (const int nodes : node_ladder) {
    if (nodes < most && has_enough(nodes)) return nodes;
  }
  return most;
}

template <class Real> void Hbvm<Real>::finish(Vector<Real>& y, double h) {
  Real *q = second_order_ ? y.data() : nullptr, *q_low = second_order_ ? low_.data() : nullptr;
  const Index v = second_order_ ? n_ : 0;
  const bool from_nodes = table_->eights.size() == 1 && swept_ && !kept_.any();
  if (from_nodes) {
    std::copy_n(at_nodes_.front(), lane_count * n_, part_.data());
    sums_.finish(part_.data(), table_->ends, h, q, q_low, y.data() + v, low_.data() + v);
  } else {
    std::fill(part_.begin(), part_.end(), Real(0));
    for (std::size_t i = 0; i < static_cast<std::size_t>(n_); ++i) {
      part_[lane_count * i] = g_[lane_count * i];
      if (coefficients_ > 1) part_[lane_count * i + 2] = g_[lane_count * i + 1];
    }
    sums_.finish(part_.data(), table_->word_ends, h, q, q_low, y.data() + v, low_.data() + v);
  }
  for (std::size_t e = 0; e < table_->eights.size(); ++e) {
    AlignedVector<Real>& into = e == 0 ? previous_ : part_;
    sums_.combine(at_nodes_[e], table_->eights[e].beyond, into.data());
    for (std::size_t k = 0; e > 0 && k < previous_.size(); ++k) previous_[k] += part_[k];
  }
  h_ = h;
  if (fixed_nodes_ == 0 && table_->nodes > node_ladder.front()) {
    const int fewer = nodes_needed(table_->nodes);
    if (fewer < table_->nodes) use_nodes(fewer);
  }
}

template <class Real> void Hbvm<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "h", h_);
  save_value(saved, prefix + "swept", swept_);
  save_value(saved, prefix + "nodes", std::int64_t{table_->nodes});
  save_value(saved, prefix + "low", std::vector<Real>(low_.begin(), low_.end()));
  save_value(saved, prefix + "previous", std::vector<Real>(previous_.begin(), previous_.end()));
}

template <class Real> void Hbvm<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "h", h_);
  load_value(saved, prefix + "swept", swept_);
  std::int64_t nodes = 0;
  load_value(saved, prefix + "nodes", nodes);
  use_nodes(static_cast<int>(nodes));
  const auto load_all = [&](const std::string& name, AlignedVector<Real>& into) {
    std::vector<Real> read;
    load_value(saved, prefix + name, read);
    for (std::size_t k = 0; k < into.size(); ++k) into[k] = detail::element(read, k);
  };
  load_all("low", low_);
  load_all("previous", previous_);
}

template class Hbvm<double>;
template class Hbvm<Quad>;

}  // namespace noether
