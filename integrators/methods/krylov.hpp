#pragma once
/// Linear systems M x = b solved with products M v only.

#include "integrators/vector_field.hpp"

#include <functional>

namespace noether {

/// out = M v
template <class Real> using LinearMap = std::function<void(const Vector<Real>& v, Vector<Real>& out)>;

/// How accurately a system is to be solved, and how accurate products with its matrix are.
struct KrylovAccuracy {
  double residual = 1e-12;  ///< |b - M x| / |b| that is asked for
  double product = 0;       ///< error of M v, relative to |M| |v|
  Index cycle = 30;         ///< directions of a cycle of GMRES
};

/// x with |b - M x| <= residual |b|, or as near as errors of the products let it come.
///
/// A cycle of GMRES is all that small systems and those near the identity need; where it is not enough, BiCGSTAB, of
/// short recurrences, goes on from there, and so on in turn. The residual is that of x itself, not of the recurrences.
/// No preconditioner: the number of products grows as the square root of the condition number, at best.
/// @return whether x was found, in at most some 20000 products
/// @cost memory of a cycle of vectors and some 15 more, allocated by each call
/// @source SaadSchultz1986, Vorst1992
template <class Real>
bool solve_by_krylov(const LinearMap<Real>& map, const Vector<Real>& b, const KrylovAccuracy& accuracy,
                     Vector<Real>& x);

extern template bool solve_by_krylov(const LinearMap<double>&, const Vector<double>&, const KrylovAccuracy&,
                                     Vector<double>&);
extern template bool solve_by_krylov(const LinearMap<Quad>&, const Vector<Quad>&, const KrylovAccuracy&, Vector<Quad>&);

}  // namespace noether
