#pragma once
/// The inverse of the differential of the exponential.

#include "integrators/lie/lie_field.hpp"

namespace noether {

/// More brackets than this, and the series is its own rounding error.
inline constexpr int most_dexp_terms = 20;

/// The least number of nested brackets with which a method of an order keeps it: as many as its order less two, but no
/// odd number above one, since B_3, B_5, ... are 0.
/// @source MuntheKaas1999
constexpr int dexp_terms_for(int order) {
  const int terms = order > 2 ? order - 2 : 0;
  return terms > 1 && terms % 2 == 1 ? terms - 1 : terms;
}

/// B_k/k! for k up to `most_dexp_terms`, B_k Bernoulli's numbers, B_1 = -1/2.
Quad dexp_weight(int k);

/// dexp^-1_u v = sum_(k <= terms) B_k/k! [u, [u, ... [u, v]]], k brackets in each term.
template <class Real> class InverseDexp {
 public:
  explicit InverseDexp(int terms = 0) : terms_(terms) {}

  int terms() const { return terms_; }
  void bind(Index algebra) {
    nested_.resize(algebra);
    next_.resize(algebra);
  }
  /// @param out  neither u nor v
  /// @cost `terms` brackets
  void apply(LieField<Real>& group, const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out);

 private:
  int terms_;
  Vector<Real> nested_, next_;
};

extern template class InverseDexp<double>;
extern template class InverseDexp<Quad>;

}  // namespace noether
