#include "integrators/lie/linear_rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace noether {

namespace {

/// Product of two square matrices, summed in one order.
template <class Real>
void multiply_small(const SmallMatrix<Real>& A, const SmallMatrix<Real>& B, SmallMatrix<Real>& out) {
  const Index n = A.rows();
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) {
      Real sum = A(i, 0) * B(0, k);
      for (Index j = 1; j < n; ++j) sum += A(i, j) * B(j, k);
      out(i, k) = sum;
    }
  }
}

/// Leaves A^-1 B in B, by Gauss's elimination; A is near the unit matrix, so that no row needs another place.
template <class Real> void solve_small(SmallMatrix<Real>& A, SmallMatrix<Real>& B) {
  const Index n = A.rows();
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j) {
      const Real factor = A(j, i) / A(i, i);
      for (Index k = i + 1; k < n; ++k) A(j, k) -= factor * A(i, k);
      for (Index k = 0; k < n; ++k) B(j, k) -= factor * B(i, k);
    }
  }
  for (Index i = n - 1; i >= 0; --i) {
    for (Index k = 0; k < n; ++k) {
      for (Index j = i + 1; j < n; ++j) B(i, k) -= A(i, j) * B(j, k);
      B(i, k) /= A(i, i);
    }
  }
}

/// An element of Y^T Y - 1.
template <class Real> Real defect_at(const SmallMatrix<Real>& Y, Index i, Index k) {
  Real sum = i == k ? Real(-1) : Real(0);
  for (Index j = 0; j < Y.rows(); ++j) sum += Y(j, i) * Y(j, k);
  return sum;
}

/// Y (3 - Y^T Y)/2: orthogonal to the square of the error of Y.
template <class Real> void orthogonalize(SmallMatrix<Real>& Y, SmallMatrix<Real>& work, SmallMatrix<Real>& defect) {
  const Index n = Y.rows();
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) defect(i, k) = defect_at(Y, i, k);
  }
  multiply_small(Y, defect, work);
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) Y(i, k) -= work(i, k) / Real(2);
  }
}

template <class Real> void to_matrix(const Vector<Real>& u, SmallMatrix<Real>& A) {
  const Index n = A.rows();
  Index at = 0;
  for (Index i = 0; i < n; ++i) {
    A(i, i) = Real(0);
    for (Index k = i + 1; k < n; ++k, ++at) {
      A(i, k) = u[at];
      A(k, i) = -u[at];
    }
  }
}

template <class Real> void from_matrix(const SmallMatrix<Real>& A, Vector<Real>& u) {
  Index at = 0;
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index k = i + 1; k < A.rows(); ++k, ++at) u[at] = A(i, k);
  }
}

/// Rows of y as a matrix.
template <class Real> void rows_into(const Vector<Real>& y, SmallMatrix<Real>& Y) {
  const Index n = Y.rows();
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) Y(i, k) = y[n * i + k];
  }
}
template <class Real> void rows_of(const SmallMatrix<Real>& Y, Vector<Real>& y) {
  const Index n = Y.rows();
  y.resize(n * n);
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) y[n * i + k] = Y(i, k);
  }
}

}  // namespace

template <class Real> void exponential_of_skew(const SmallMatrix<Real>& A, SmallMatrix<Real>& out) {
  // Of degree m the approximant is off by m!^2/((2 m)! (2 m + 1)!) |A|^(2 m + 1): below rounding at |A| <= 1/2.
  constexpr int degree = std::is_same_v<Real, double> ? 8 : 14;
  const Index n = A.rows();
  double size = 0;
  for (Index i = 0; i < n; ++i) {
    double row = 0;
    for (Index k = 0; k < n; ++k) row += std::abs(static_cast<double>(A(i, k)));
    size = std::max(size, row);
  }
  const int halvings = size > 0.5 && std::isfinite(size) ? static_cast<int>(std::ceil(std::log2(size / 0.5))) : 0;
  const Real part(std::ldexp(1.0, -halvings));
  SmallMatrix<Real> X(n, n), power(n, n), next(n, n), below(n, n);
  out.setZero(n, n);
  below.setZero(n, n);
  power.setZero(n, n);
  for (Index i = 0; i < n; ++i) power(i, i) = Real(1);
  for (Index i = 0; i < n * n; ++i) X.data()[i] = part * A.data()[i];
  Real weight(1);  // m! (2 m - k)! / ((2 m)! k! (m - k)!)
  for (int k = 0; k <= degree; ++k) {
    for (Index i = 0; i < n * n; ++i) {
      out.data()[i] += weight * power.data()[i];
      below.data()[i] += (k % 2 == 0 ? weight : -weight) * power.data()[i];
    }
    weight = weight * Real(degree - k) / (Real(2 * degree - k) * Real(k + 1));
    multiply_small(power, X, next);
    power.swap(next);
  }
  solve_small(below, out);
  for (int k = 0; k < halvings; ++k) {
    multiply_small(out, out, next);
    out.swap(next);
    orthogonalize(out, next, power);
  }
}
template void exponential_of_skew(const SmallMatrix<double>&, SmallMatrix<double>&);
template void exponential_of_skew(const SmallMatrix<Quad>&, SmallMatrix<Quad>&);

template <class Real> void RotationField<Real>::act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) {
  to_matrix(u, A_);
  exponential_of_skew(A_, B_);
  rows_into(y, Y_);
  multiply_small(B_, Y_, C_);
  orthogonalize(C_, A_, B_);
  rows_of(C_, out);
}

template <class Real>
void RotationField<Real>::bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) {
  to_matrix(u, A_);
  to_matrix(v, B_);
  multiply_small(A_, B_, C_);
  multiply_small(B_, A_, Y_);
  C_ -= Y_;
  out.resize(algebra());
  from_matrix(C_, out);
}

template <class Real> void RotationField<Real>::bind(const ParticleSystem<Real>& s) {
  if (static_cast<Index>(s.variables().size()) == size() && s.size() == 0) return;
  throw Error(fmt::format("system '{}' has {} variables, but it was given {} and {} particles", this->claims().name,
                          size(), s.variables().size(), s.size()));
}
template <class Real> void RotationField<Real>::check_start(const ParticleSystem<Real>& s) const {
  Vector<Real> y;
  SmallMatrix<Real> Y(n_, n_);
  gather(s, y);
  rows_into(y, Y);
  double worst = 0;
  for (Index i = 0; i < n_; ++i) {
    for (Index k = 0; k <= i; ++k) {
      const double found = std::abs(static_cast<double>(defect_at(Y, i, k)));
      if (!(found <= worst)) worst = found;
    }
  }
  if (worst <= farthest_from_group) return;
  throw Error(fmt::format("the matrix Y of system '{}' is not a rotation: |Y^T Y - 1| is {:.3g}, but at most {:g} is "
                          "expected of a method on rotations",
                          this->claims().name, worst, farthest_from_group),
              {.key = "start"});
}
template <class Real> void RotationField<Real>::gather(const ParticleSystem<Real>& s, Vector<Real>& y) const {
  y.resize(size());
  for (Index i = 0; i < size(); ++i) y[i] = s.variables()[static_cast<std::size_t>(i)];
}
template <class Real> void RotationField<Real>::scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const {
  for (Index i = 0; i < size(); ++i) s.variables()[static_cast<std::size_t>(i)] = y[i];
}

template <class Real>
void RotationField<Real>::find_velocity(const Real& t, const Vector<Real>& /*y*/, Vector<Real>& a) {
  A_.setZero();
  rates(t, A_);
  a.resize(algebra());
  from_matrix(A_, a);
}

template <class Real> void RotationField<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  find_velocity(t, y, a_);
  to_matrix(a_, A_);
  rows_into(y, Y_);
  multiply_small(A_, Y_, C_);
  rows_of(C_, dy);
}

template class RotationField<double>;
template class RotationField<Quad>;

}  // namespace noether
