#include "integrators/varied_field.hpp"

#include <algorithm>

namespace noether {

template <class Real> FieldClaims VariedField<Real>::claims() const {
  const FieldClaims inside = field_->claims();
  return {.name = inside.name,
          .variables = true,
          .second_order = inside.second_order,
          .canonical = inside.canonical,
          .velocity_dependent = inside.velocity_dependent,
          .time_dependent = inside.time_dependent,
          .dissipative = inside.dissipative,
          .symplectic = inside.symplectic,
          .no_action = "changes of a state have no action"};
}

template <class Real> void VariedField<Real>::bind(const ParticleSystem<Real>& s) {
  NOETHER_EXPECTS(static_cast<Index>(s.variables().size()) == size(), "there are variables for all changes");
}

template <class Real> void VariedField<Real>::gather(const ParticleSystem<Real>& s, Vector<Real>& y) const {
  y.resize(size());
  std::copy(s.variables().begin(), s.variables().end(), y.data());
}
template <class Real> void VariedField<Real>::scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const {
  std::copy_n(y.data(), y.size(), s.variables().begin());
}

template <class Real> void VariedField<Real>::take(const Vector<Real>& all, Index k, Vector<Real>& one) const {
  const Index n = field_->size(), part = halves_ ? n / 2 : n;
  one.resize(n);
  for (Index at = 0; at < n / part; ++at)
    std::copy_n(all.data() + (at * (1 + changes_) + k) * part, part, one.data() + at * part);
}
template <class Real> void VariedField<Real>::put(const Vector<Real>& one, Index k, Vector<Real>& all) const {
  const Index n = field_->size(), part = halves_ ? n / 2 : n;
  all.resize(size());
  for (Index at = 0; at < n / part; ++at)
    std::copy_n(one.data() + at * part, part, all.data() + (at * (1 + changes_) + k) * part);
}

template <class Real> void VariedField<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  field_->forget_failure();
  take(y, 0, state_);
  rate_.resize(state_.size());
  field_->rate(t, state_, rate_);
  put(rate_, 0, dy);
  for (Index k = 1; k <= changes_; ++k) {
    take(y, k, change_);
    field_->derivative(t, state_, Real(0), change_, rate_);
    put(rate_, k, dy);
  }
  this->note(field_->failure());
}

template <class Real> void VariedField<Real>::accelerate(const Real& t, const Vector<Real>& y, Vector<Real>& a) {
  const Index half = field_->size() / 2;
  field_->forget_failure();
  take(y, 0, state_);
  rate_.resize(half);
  field_->acceleration(t, state_, rate_);
  a.resize((1 + changes_) * half);
  std::copy_n(rate_.data(), half, a.data());
  for (Index k = 1; k <= changes_; ++k) {
    take(y, k, change_);
    field_->derivative(t, state_, Real(0), change_, rate_);
    std::copy_n(rate_.data() + half, half, a.data() + k * half);
  }
  this->note(field_->failure());
}

template class VariedField<double>;
template class VariedField<Quad>;

}  // namespace noether
