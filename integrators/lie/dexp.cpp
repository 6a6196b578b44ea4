#include "integrators/lie/dexp.hpp"

#include <array>
#include <utility>

namespace noether {

namespace {

/// B_k/k!, from sum_(j <= k) B_j/(j! (k + 1 - j)!) = 0.
template <class Real> std::array<Real, most_dexp_terms + 1> dexp_weights() {
  std::array<Real, most_dexp_terms + 2> factorial{};
  factorial[0] = Real(1);
  for (std::size_t k = 1; k < factorial.size(); ++k) factorial[k] = factorial[k - 1] * Real(static_cast<double>(k));
  std::array<Real, most_dexp_terms + 1> weights{};
  weights[0] = Real(1);
  for (std::size_t k = 1; k < weights.size(); ++k) {
    Real sum(0);
    for (std::size_t j = 0; j < k; ++j) sum += weights[j] / factorial[k + 1 - j];
    weights[k] = k > 1 && k % 2 == 1 ? Real(0) : -sum;
  }
  return weights;
}

}  // namespace

template <class Real>
void InverseDexp<Real>::apply(LieField<Real>& group, const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) {
  // In 113 bits, so that the numbers of the recursion are rounded once.
  static const auto wide = dexp_weights<Quad>();
  out = v;
  if (terms_ == 0) return;
  nested_ = v;
  for (int k = 1; k <= terms_; ++k) {
    group.bracket(u, nested_, next_);
    std::swap(nested_, next_);
    const Real weight = static_cast<Real>(wide[static_cast<std::size_t>(k)]);
    if (weight == Real(0)) continue;
    for (Index i = 0; i < out.size(); ++i) out[i] += weight * nested_[i];
  }
}

template class InverseDexp<double>;
template class InverseDexp<Quad>;

}  // namespace noether
