#include "integrators/lie/dexp.hpp"

#include <array>
#include <utility>

namespace noether {

namespace {

/// From sum_(j <= k) B_j/(j! (k + 1 - j)!) = 0.
std::array<Quad, most_dexp_terms + 1> dexp_weights() {
  std::array<Quad, most_dexp_terms + 2> factorial{};
  factorial[0] = Quad(1);
  for (std::size_t k = 1; k < factorial.size(); ++k) factorial[k] = factorial[k - 1] * Quad(static_cast<double>(k));
  std::array<Quad, most_dexp_terms + 1> weights{};
  weights[0] = Quad(1);
  for (std::size_t k = 1; k < weights.size(); ++k) {
    Quad sum(0);
    for (std::size_t j = 0; j < k; ++j) sum += weights[j] / factorial[k + 1 - j];
    weights[k] = k > 1 && k % 2 == 1 ? Quad(0) : -sum;
  }
  return weights;
}

}  // namespace

Quad dexp_weight(int k) {
  static const std::array<Quad, most_dexp_terms + 1> weights = dexp_weights();
  return weights[static_cast<std::size_t>(k)];
}

template <class Real>
void InverseDexp<Real>::apply(LieField<Real>& group, const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) {
  if (terms_ == 0) {
    out = v;
    return;
  }
  out.resize(v.size());
  for (int k = 1; k <= terms_; ++k) {
    group.bracket(u, k == 1 ? v : nested_, next_);
    std::swap(nested_, next_);
    const Real weight = static_cast<Real>(dexp_weight(k));
    if (weight == Real(0)) continue;
    const Vector<Real>& before = k == 1 ? v : out;
    for (Index i = 0; i < out.size(); ++i) out[i] = before[i] + weight * nested_[i];
  }
}

template class InverseDexp<double>;
template class InverseDexp<Quad>;

}  // namespace noether
