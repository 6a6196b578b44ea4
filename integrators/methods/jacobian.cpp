#include "integrators/methods/jacobian.hpp"

#include "engine/saved_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace noether {

namespace {

/// Coordinates of particles up to which their matrix is dense by default.
constexpr Index most_dense = 300;

/// Relative length that central differences are taken over: the cube root of rounding.
template <class Real> double difference_length() {
  return std::cbrt(static_cast<double>(std::numeric_limits<Real>::epsilon()));
}

/// Columns in groups, greedily: no two of a group have a row in common.
std::vector<std::vector<Index>> grouped(const Sparsity& pattern) {
  std::vector<std::vector<Index>> groups;
  std::vector<std::vector<bool>> taken;
  for (std::size_t j = 0; j < pattern.size(); ++j) {
    const auto fits = [&](const std::vector<bool>& rows_taken) {
      return std::none_of(pattern[j].begin(), pattern[j].end(),
                          [&](Index i) { return rows_taken[static_cast<std::size_t>(i)]; });
    };
    const auto place = std::find_if(taken.begin(), taken.end(), fits) - taken.begin();
    const auto at = static_cast<std::size_t>(place);
    if (at == taken.size()) {
      groups.emplace_back();
      taken.emplace_back(pattern.size(), false);
    }
    groups[at].push_back(static_cast<Index>(j));
    for (const Index i : pattern[j]) taken[at][static_cast<std::size_t>(i)] = true;
  }
  return groups;
}

template <class Real> [[noreturn]] void refuse_sparse(const VectorField<Real>& f, const FieldClaims& claims) {
  const std::string forces = claims.second_order && !claims.velocity_dependent ? f.forces_without_tangent() : "";
  const std::string why = forces.empty() ? fmt::format(
                                               "'{}' does not declare where its Jacobian can be nonzero, so it "
                                               "has no sparse one",
                                               claims.name)
                                         : fmt::format(
                                               "a sparse Jacobian needs derivatives of the secants of every "
                                               "force, but {} has none",
                                               forces);
  throw SchemeMismatch(why + "; use jacobian = \"matrix_free\" or \"dense\"", {.key = "jacobian"});
}

}  // namespace

template <class Real> void Jacobian<Real>::bind(const VectorField<Real>& f, const JacobianUse& use) {
  const FieldClaims claims = f.claims();
  size_ = f.size();
  second_order_ = claims.second_order;
  velocity_dependent_ = claims.velocity_dependent;
  time_dependent_ = claims.time_dependent;
  pattern_ = f.sparsity();
  const TangentPattern tangent = velocity_dependent_ ? TangentPattern::none : f.tangent_pattern();
  const bool known = second_order_ ? tangent != TangentPattern::none : !pattern_.empty();
  const bool usual = second_order_ ? tangent == TangentPattern::sparse && size_ / 2 > most_dense : known;
  form_ = use.form.value_or(usual ? JacobianForm::sparse : JacobianForm::dense);
  if (sparse() && !known) refuse_sparse(f, claims);
  residual_ = use.rounding ? 1e3 * static_cast<double>(std::numeric_limits<Real>::epsilon()) : 1e-8;
  tolerance_ = use.tolerance;
  groups_.clear();
  factorized_ = ready_ = false;
  for (Vector<Real>* v : {&up_, &down_, &direction_}) v->setZero(size_);
  if (sparse()) return bind_sparse();
  if (!matrix_free()) return bind_dense(claims);
  for (Vector<Real>* v : {&point_, &product_}) v->setZero(size_);
  scale_.setOnes(size_);
}

template <class Real> void Jacobian<Real>::bind_dense(const FieldClaims& claims) {
  // Velocities move particles, and need not be found; nor do forces that do not feel them.
  const Index columns = second_order_ && !claims.velocity_dependent ? size_ / 2 : size_;
  for (Index j = 0; j < columns; ++j) groups_.push_back({j});
  J_.setZero(size_, size_);
  for (Index i = 0; second_order_ && i < size_ / 2; ++i) J_(i, size_ / 2 + i) = Real(1);
  const Index n = second_order_ ? size_ / 2 : size_;
  dense_.resize(n, n);
  half_.resize(n);
  factors_.resize(n);
}

template <class Real> void Jacobian<Real>::bind_sparse() {
  sparse_factors_.forget();
  if (second_order_) {
    half_.resize(size_ / 2);
    return;
  }
  if (static_cast<Index>(pattern_.size()) != size_) {
    throw Error(fmt::format("a sparsity of {} columns was given for {} variables", pattern_.size(), size_));
  }
  groups_ = grouped(pattern_);
  std::vector<Eigen::Triplet<Real>> places;
  for (Index j = 0; j < size_; ++j) {
    for (const Index i : pattern_[static_cast<std::size_t>(j)]) places.emplace_back(i, j, Real(0));
    places.emplace_back(j, j, Real(0));
  }
  entries_.resize(size_, size_);
  entries_.setFromTriplets(places.begin(), places.end());
  entries_.makeCompressed();
  matrix_ = entries_;
  half_.resize(size_);
}

template <class Real> void Jacobian<Real>::evaluate(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  ++f.evaluations().jacobian;
  factorized_ = ready_ = false;
  if (matrix_free()) {
    time_ = t;
    point_ = y;
    set_scale();
    return;
  }
  if (sparse() && second_order_) {
    f.secant_tangent(t, y, y, tangent_);
    entries_ = Real(2) * tangent_.matrix();
    return;
  }
  if (!sparse() && f.jacobian(t, y, J_)) return;
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    if (!f.has_derivative()) {
      differences(f, t, y, group);
      continue;
    }
    for (const Index j : groups_[group]) direction_[j] = Real(1);
    f.derivative(t, y, Real(0), direction_, up_);
    for (const Index j : groups_[group]) direction_[j] = Real(0);
    store(group, up_);
  }
}

template <class Real> void Jacobian<Real>::store(std::size_t group, const Vector<Real>& column) {
  for (const Index j : groups_[group]) {
    if (sparse()) {
      for (const Index i : pattern_[static_cast<std::size_t>(j)]) entries_.coeffRef(i, j) = column[i];
    } else {
      for (Index i = second_order_ ? size_ / 2 : 0; i < size_; ++i) J_(i, j) = column[i];
    }
  }
}

/// A length of y_j that central differences are taken over: the cube root of rounding, relative to y_j, or where that
/// is small, to the others of its kind.
template <class Real> double Jacobian<Real>::increment(const Vector<Real>& y, Index j) const {
  const Index half = second_order_ ? size_ / 2 : size_, begin = j < half ? 0 : half;
  double most = 0;
  for (Index i = begin; i < begin + half && i < size_; ++i) most = std::max(most, std::abs(static_cast<double>(y[i])));
  if (most == 0) most = 1;
  const double size = std::max(std::abs(static_cast<double>(y[j])), (second_order_ ? 1e-2 : 1e-6) * most);
  return difference_length<Real>() * size;
}

template <class Real>
void Jacobian<Real>::differences(VectorField<Real>& f, const Real& t, const Vector<Real>& y, std::size_t group) {
  const std::vector<Index>& columns = groups_[group];
  Vector<Real>& moved = direction_;
  moved = y;
  for (const Index j : columns) moved[j] = y[j] + Real(increment(y, j));
  f.rate(t, moved, up_);
  for (const Index j : columns) moved[j] = y[j] - Real(increment(y, j));
  f.rate(t, moved, down_);
  for (Index i = 0; i < size_; ++i) up_[i] = up_[i] - down_[i];
  for (const Index j : columns) {
    // The lengths as they came out, so that their own rounding does no harm.
    const Real width = (y[j] + Real(increment(y, j))) - (y[j] - Real(increment(y, j)));
    if (sparse()) {
      for (const Index i : pattern_[static_cast<std::size_t>(j)]) entries_.coeffRef(i, j) = up_[i] / width;
    } else {
      for (Index i = second_order_ ? size_ / 2 : 0; i < size_; ++i) J_(i, j) = up_[i] / width;
    }
  }
  moved.setZero();
}

template <class Real>
void Jacobian<Real>::time_derivative(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h,
                                     Vector<Real>& out) {
  out.resize(size_);
  if (!time_dependent_) {
    out.setZero();
  } else if (f.has_derivative()) {
    f.derivative(t, y, Real(1), direction_, out);
  } else {
    const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
    const Real step(
        std::max(std::sqrt(std::sqrt(rounding)) * std::abs(h), 16 * rounding * std::abs(static_cast<double>(t))));
    f.rate(t + step, y, up_);
    f.rate(t - step, y, down_);
    const Real width = (t + step) - (t - step);
    for (Index i = 0; i < size_; ++i) out[i] = (up_[i] - down_[i]) / width;
  }
}

template <class Real> bool Jacobian<Real>::factorize(const Real& a, const Real& b) {
  a_ = a;
  b_ = b;
  weights_ = second_order_ ? std::array<Real, 3>{a * a, a * b, b * b} : std::array<Real, 3>{a, b, Real(0)};
  return compute();
}

template <class Real> bool Jacobian<Real>::factorize_half(const Real& a, const Real& b, const Real& c) {
  NOETHER_EXPECTS(second_order_, "a system of first order has no matrix of half the size");
  weights_ = {a, b, c};
  return compute();
}

template <class Real> bool Jacobian<Real>::compute() {
  factorized_ = ready_ = true;
  if (matrix_free()) return true;
  if (sparse()) return compute_sparse();
  const auto& [p, q, r] = weights_;
  const Index n = dense_.rows(), shift = second_order_ ? n : 0;
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) dense_(i, j) = -q * J_(shift + i, shift + j);
    for (Index i = 0; second_order_ && i < n; ++i) dense_(i, j) -= r * J_(shift + i, j);
    dense_(j, j) += p;
  }
  return factors_.compute(dense_);
}

template <class Real> bool Jacobian<Real>::compute_sparse() {
  if (!have_same_pattern(matrix_, entries_)) {
    matrix_ = entries_;
    sparse_factors_.forget();
  }
  const Real weight = second_order_ ? weights_[2] : weights_[1];
  for (Index k = 0; k < entries_.nonZeros(); ++k) matrix_.valuePtr()[k] = -weight * entries_.valuePtr()[k];
  for (Index j = 0; j < matrix_.cols(); ++j) matrix_.coeffRef(j, j) += weights_[0];
  return sparse_factors_.compute(matrix_);
}

/// x <- M^-1 x; a copy, and a run that goes on from a file, make their factors here, the same ones.
template <class Real> bool Jacobian<Real>::solve_half(VectorField<Real>& f, Vector<Real>& x) {
  NOETHER_EXPECTS(factorized_, "a system is solved before its matrix is factorized");
  if (matrix_free()) return solve_matrix_free(f, x);
  if (!ready_ || (sparse() && !sparse_factors_.ready())) compute();
  if (sparse()) {
    sparse_factors_.solve(x, half_);
  } else {
    factors_.solve(x, half_);
  }
  x.swap(half_);
  return true;
}

template <class Real> bool Jacobian<Real>::solve(VectorField<Real>& f, Vector<Real>& x) {
  if (!second_order_) return solve_half(f, x);
  const Index n = size_ / 2;
  Vector<Real>& v = velocities_;
  v.resize(n);
  for (Index i = 0; i < n; ++i) v[i] = a_ * x[n + i];
  if (matrix_free()) {
    for (Index i = 0; i < n; ++i) direction_[i] = b_ * x[i];
    multiply(f, direction_, product_);
    direction_.setZero();
    for (Index i = 0; i < n; ++i) v[i] += product_[n + i];
  } else if (sparse()) {
    v += b_ * (entries_ * x.head(n));
  } else {
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i) v[i] += b_ * J_(n + i, j) * x[j];
    }
  }
  if (!solve_half(f, v)) return false;
  for (Index i = 0; i < n; ++i) {
    x[i] = (x[i] + b_ * v[i]) / a_;
    x[n + i] = v[i];
  }
  return true;
}

/// out = J v at the point that is kept, exact or by central differences, one for each kind of variables: as far along v
/// as moves none of them by more than the cube root of rounding of the largest.
template <class Real> void Jacobian<Real>::multiply(VectorField<Real>& f, const Vector<Real>& v, Vector<Real>& out) {
  if (f.has_derivative()) {
    ++f.evaluations().force;
    f.derivative(time_, point_, Real(0), v, out);
    return;
  }
  const Index half = second_order_ ? size_ / 2 : size_;
  out.setZero(size_);
  for (Index begin = 0; begin < size_; begin += half) {
    const Real move = v.segment(begin, half).cwiseAbs().maxCoeff();
    if (!(move > Real(0))) continue;
    const Real most = point_.segment(begin, half).cwiseAbs().maxCoeff();
    const Real step = Real(difference_length<Real>()) * (most > Real(0) ? most : Real(1)) / move;
    moved_ = point_;
    moved_.segment(begin, half) += step * v.segment(begin, half);
    f.rate(time_, moved_, up_);
    moved_ = point_;
    moved_.segment(begin, half) -= step * v.segment(begin, half);
    f.rate(time_, moved_, down_);
    out += (up_ - down_) / (step + step);
  }
}

template <class Real> double Jacobian<Real>::product_error(const VectorField<Real>& f) {
  return f.has_derivative() ? 0 : std::pow(difference_length<Real>(), 2);
}

/// x <- M^-1 x with products: J (r v, q v) = (., B q v + A r v), in multiples of `scale_`.
template <class Real> bool Jacobian<Real>::solve_matrix_free(VectorField<Real>& f, Vector<Real>& x) {
  const Real p = weights_[0], q = weights_[1], r = weights_[2];
  const Index n = x.size();
  const auto scale = scale_.tail(n).array();
  const LinearMap<Real> map = [&](const Vector<Real>& v, Vector<Real>& out) {
    late_ = scale * v.array();
    if (second_order_) direction_.head(n) = r * late_;
    if (velocity_dependent_ || !second_order_) direction_.tail(n) = q * late_;
    multiply(f, direction_, product_);
    out = p * v - (product_.tail(n).array() / scale).matrix();
  };
  x.array() /= scale;
  const bool found = solve_by_krylov(map, x, {.residual = residual_, .product = product_error(f)}, half_);
  direction_.setZero();
  if (found) x = (half_.array() * scale).matrix();
  return found;
}

/// What systems are solved in multiples of: errors that are equally tolerable.
template <class Real> void Jacobian<Real>::set_scale() {
  scale_.setOnes(size_);
  if (!tolerance_) return;
  for (Index i = 0; i < size_; ++i) {
    scale_[i] = Real(tolerance_->absolute(false) + tolerance_->rtol * std::abs(static_cast<double>(point_[i])));
  }
  const Real least = scale_.maxCoeff() * Real(std::numeric_limits<double>::epsilon());
  if (least > Real(0) && std::isfinite(static_cast<double>(least))) {
    scale_ = scale_.cwiseMax(least);
  } else {
    scale_.setOnes();
  }
}

/// What is saved of J: its elements, or the point where it is meant.
template <class Real> template <class Self> auto Jacobian<Real>::kept(Self& self) {
  if (self.matrix_free()) return std::span(self.point_.data(), static_cast<std::size_t>(self.point_.size()));
  if (self.sparse()) return std::span(self.entries_.valuePtr(), static_cast<std::size_t>(self.entries_.nonZeros()));
  return std::span(self.J_.data(), static_cast<std::size_t>(self.J_.size()));
}

template <class Real> void Jacobian<Real>::save(SavedState& saved, const std::string& prefix) const {
  const auto values = kept(*this);
  save_value(saved, prefix + (matrix_free() ? "point" : "elements"), std::vector<Real>(values.begin(), values.end()));
  if (matrix_free()) save_value(saved, prefix + "time", std::vector<Real>{time_});
  if (sparse() && second_order_) save_pattern(saved, prefix);
  save_value(saved, prefix + "weights", std::vector<Real>{a_, b_, weights_[0], weights_[1], weights_[2]});
  save_value(saved, prefix + "factorized", factorized_);
}

template <class Real> void Jacobian<Real>::load(const SavedState& saved, const std::string& prefix) {
  std::vector<Real> elements, weights, time;
  load_value(saved, prefix + (matrix_free() ? "point" : "elements"), elements);
  if (matrix_free()) load_value(saved, prefix + "time", time);
  if (sparse() && second_order_) load_pattern(saved, prefix);
  load_value(saved, prefix + "weights", weights);
  load_value(saved, prefix + "factorized", factorized_);
  std::size_t at = 0;
  for (Real& value : kept(*this)) value = detail::element(elements, at++);
  if (matrix_free()) {
    time_ = detail::element(time, 0);
    set_scale();
  }
  a_ = detail::element(weights, 0);
  b_ = detail::element(weights, 1);
  for (std::size_t k = 0; k < 3; ++k) weights_[k] = detail::element(weights, 2 + k);
  ready_ = false;
}

/// Where the elements of A are, which it tells itself.
template <class Real> void Jacobian<Real>::save_pattern(SavedState& saved, const std::string& prefix) const {
  std::vector<std::int64_t> rows, columns;
  for (Index j = 0; j < entries_.outerSize(); ++j) {
    for (typename Eigen::SparseMatrix<Real>::InnerIterator at(entries_, j); at; ++at) {
      rows.push_back(at.row());
      columns.push_back(j);
    }
  }
  save_value(saved, prefix + "rows", rows);
  save_value(saved, prefix + "columns", columns);
}

template <class Real> void Jacobian<Real>::load_pattern(const SavedState& saved, const std::string& prefix) {
  std::vector<std::int64_t> rows, columns;
  load_value(saved, prefix + "rows", rows);
  load_value(saved, prefix + "columns", columns);
  std::vector<Eigen::Triplet<Real>> places;
  const auto n = static_cast<std::int64_t>(size_ / 2);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::int64_t row = detail::element(rows, k), column = columns[k];
    if (row < 0 || column < 0 || row >= n || column >= n) {
      throw Error(
          fmt::format("the saved Jacobian has an element ({}, {}), but {} x {} were expected", row, column, n, n));
    }
    places.emplace_back(row, column, Real(0));
  }
  entries_.resize(n, n);
  entries_.setFromTriplets(places.begin(), places.end());
}

template class Jacobian<double>;
template class Jacobian<Quad>;

}  // namespace noether
