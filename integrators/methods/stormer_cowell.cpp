#include "integrators/methods/stormer_cowell.hpp"

#include "integrators/methods/difference_formulas.hpp"

namespace noether {

namespace {

/// Weights of accelerations in a summed formula: its differences from number `from` on, `count` of them.
template <class Real> std::vector<Real> summed_weights(const std::vector<Quad>& c, int from, int count) {
  return as_real<Real>(ordinates({c.begin() + from, c.begin() + from + count}));
}

}  // namespace

// Summed, a formula loses as many of its first differences as it is summed times: D^0 and D^1 become S and D.
template <class Real>
StormerCowell<Real>::StormerCowell(std::string_view name, int order)
    : name_(name),
      order_(order),
      next_position_(summed_weights<Real>(differences::stoermer(order), 2, order - 2)),
      position_(summed_weights<Real>(differences::cowell(order + 2), 2, order)),
      velocity_(summed_weights<Real>(differences::adams_moulton(order + 1), 1, order)) {}

template <class Real> void StormerCowell<Real>::bind(const VectorField<Real>& f) {
  const Index half = f.size() / 2;
  pulls_.bind(static_cast<std::size_t>(order_), half);
  starter_.bind(f.size());
  sum_.resize(half);
  sums_.resize(half);
  y_.resize(f.size());
  a_.resize(half);
  past_.resize(half);
  h_ = 0;
}

template <class Real>
StepResult StormerCowell<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  const Index half = a_.size();
  const std::size_t needed = velocity_.size();
  const Real step(h);
  if (h != h_) {
    pulls_.forget();
    h_ = h;
    h2_ = step * step;
  }
  const auto remember = [&](const Real& when) {
    f.acceleration(when, y, a_);
    Vector<Real>& newest = pulls_.push();
    for (Index i = 0; i < half; ++i) newest[i] = h2_ * a_[i];
  };
  if (pulls_.count() == 0) {
    y_.set(y);
    remember(t);
  }
  if (pulls_.count() < needed) {
    starter_.go(f, t, y_, h);
    y = y_.value;
    remember(t + step);
    if (pulls_.count() == needed) set_up_sums(h);
    return {.h = h};
  }
  past(next_position_);
  for (Index i = 0; i < half; ++i) y[i] = sums_.value[i] + (sums_.low[i] + past_[i]);
  remember(t + step);
  past(velocity_);
  for (Index i = 0; i < half; ++i) {
    sum_.add(i, pulls_[0][i]);
    sums_.add(i, sum_.value[i]);
    sums_.add(i, sum_.low[i]);
    y[half + i] = (sum_.value[i] + (sum_.low[i] + past_[i])) / step;
  }
  return {.h = h};
}

/// past_ = sum w_j h^2 a_(n-j), the oldest first: their weights are the least.
template <class Real> void StormerCowell<Real>::past(const std::vector<Real>& weights) {
  const Index half = a_.size();
  past_.setZero();
  for (std::size_t j = weights.size(); j-- > 0;) {
    const Real* pull = pulls_[j].data();
    for (Index i = 0; i < half; ++i) past_[i] += weights[j] * pull[i];
  }
}

/// D and S at the present point, from where the start has arrived.
template <class Real> void StormerCowell<Real>::set_up_sums(double h) {
  const Index half = a_.size();
  const Real step(h);
  // h v = D + ...,  q = S - D + ...
  past(velocity_);
  for (Index i = 0; i < half; ++i) {
    sum_.value[i] = step * y_.value[half + i];
    sum_.low[i] = step * y_.low[half + i];
    sum_.add(i, -past_[i]);
  }
  past(position_);
  for (Index i = 0; i < half; ++i) {
    sums_.value[i] = y_.value[i];
    sums_.low[i] = y_.low[i];
    sums_.add(i, -past_[i]);
    sums_.add(i, sum_.value[i]);
    sums_.add(i, sum_.low[i]);
  }
}

template <class Real> void StormerCowell<Real>::moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  if (pulls_.count() == 0) return;
  y_.set(y);
  f.acceleration(t, y, a_);
  for (Index i = 0; i < a_.size(); ++i) pulls_.newest()[i] = h2_ * a_[i];
  if (pulls_.count() == velocity_.size()) set_up_sums(h_);
}

template <class Real> void StormerCowell<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "step", h_);
  pulls_.save(saved, prefix + "pulls");
  if (pulls_.count() == 0) return;
  if (pulls_.count() < velocity_.size()) {
    y_.save(saved, prefix + "start");
  } else {
    sum_.save(saved, prefix + "sum");
    sums_.save(saved, prefix + "sums");
  }
}

template <class Real> void StormerCowell<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "step", h_);
  h2_ = Real(h_) * Real(h_);
  pulls_.load(saved, prefix + "pulls");
  if (pulls_.count() == 0) return;
  if (pulls_.count() < velocity_.size()) {
    y_.load(saved, prefix + "start");
  } else {
    sum_.load(saved, prefix + "sum");
    sums_.load(saved, prefix + "sums");
  }
}

template class StormerCowell<double>;
template class StormerCowell<Quad>;

}  // namespace noether
