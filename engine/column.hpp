#pragma once
/// Columns: one array per quantity, aligned and padded for vector loops, addressed per particle or as a whole.

#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace noether {

/// Hands out memory on 64-byte boundaries, the width of the widest vector register and of a cache line.
template <class T> struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};

  AlignedAllocator() = default;
  template <class U> AlignedAllocator(const AlignedAllocator<U>& /*other*/) {}  // NOLINT: converting by design

  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), alignment)); }
  void deallocate(T* p, std::size_t /*n*/) { ::operator delete(p, alignment); }
  template <class U> bool operator==(const AlignedAllocator<U>& /*other*/) const { return true; }
};

template <class T> using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// Sets numbers to 0; a number type may bring a quicker way of its own.
template <class T> void set_to_zero(T* numbers, std::size_t count) { std::fill_n(numbers, count, T(0)); }

/// Makes numbers a copy of others; in place where there are as many.
template <class T> void copy_numbers(const AlignedVector<T>& from, AlignedVector<T>& to) {
  if (to.size() != from.size()) {
    to = from;
    return;
  }
  // Not by memmove, which for a few bodies reads wider words than those just written, and waits for them.
  using Numbers = Eigen::Array<T, Eigen::Dynamic, 1>;
  const auto count = static_cast<Index>(from.size());
  Eigen::Map<Numbers, Eigen::Aligned64>(to.data(), count) =
      Eigen::Map<const Numbers, Eigen::Aligned64>(from.data(), count);
}

/// One number per particle, shape (n).
template <class T> class ScalarColumn {
 public:
  static constexpr int width = 1;

  explicit ScalarColumn(Index n = 0) : values_(static_cast<std::size_t>(n)) {}

  Index size() const { return static_cast<Index>(values_.size()); }
  T operator[](Index i) const { return values_[static_cast<std::size_t>(i)]; }
  T& operator[](Index i) { return values_[static_cast<std::size_t>(i)]; }
  const T* data() const { return values_.data(); }
  T* data() { return values_.data(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  /// As of wider columns; there is component 0 alone.
  const T* component(int /*0*/) const { return values_.data(); }
  T* component(int /*0*/) { return values_.data(); }

  /// The whole column as an Eigen vector, shape (n, 1).
  auto all() const { return Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, 1>>(values_.data(), size()); }
  auto all() { return Eigen::Map<Eigen::Matrix<T, Eigen::Dynamic, 1>>(values_.data(), size()); }

  /// Becomes a copy of another. @cost no allocation where sizes agree
  void assign(const ScalarColumn& other) { copy_numbers(other.values_, values_); }
  void append(const T& value) { values_.push_back(value); }
  void erase(Index i) { values_.erase(values_.begin() + i); }

 private:
  AlignedVector<T> values_;
};

/// A row of `w` numbers per particle, shape (n, w): all first ones, then all second ones, and so on, each run padded to
/// a multiple of eight; not of numbers that fill a cache line each.
template <class Real, int w> class RowColumn {
 public:
  static constexpr int width = w;
  using Vector = Eigen::Matrix<Real, w, 1>;
  using Row = Eigen::Map<Vector, Eigen::Unaligned, Eigen::InnerStride<>>;
  using Block = Eigen::Matrix<Real, Eigen::Dynamic, w>;

  explicit RowColumn(Index n = 0)
      : size_(n), stride_(padded(n)), values_(static_cast<std::size_t>(w * stride_), Real(0)) {}

  Index size() const { return size_; }
  /// Distance between the first and the second number of one particle, in elements.
  Index stride() const { return stride_; }

  Vector operator[](Index i) const {
    const Real* p = values_.data() + i;
    if constexpr (w == 3) return Vector(p[0], p[stride_], p[2 * stride_]);
    Vector row;
    for (int k = 0; k < w; ++k) row[k] = p[k * stride_];
    return row;
  }
  Row operator[](Index i) { return Row(values_.data() + i, Eigen::InnerStride<>(stride_)); }
  void set(Index i, const Vector& v) {
    Real* p = values_.data() + i;
    for (int k = 0; k < w; ++k) p[k * stride_] = v[k];
  }
  void add(Index i, const Vector& v) {
    Real* p = values_.data() + i;
    for (int k = 0; k < w; ++k) p[k * stride_] += v[k];
  }

  const Real* component(int k) const { return values_.data() + k * stride_; }
  Real* component(int k) { return values_.data() + k * stride_; }

  /// The whole column as an Eigen matrix, shape (n, w).
  auto all() const {
    return Eigen::Map<const Block, Eigen::Aligned64, Eigen::OuterStride<>>(values_.data(), size_, w,
                                                                           Eigen::OuterStride<>(stride_));
  }
  auto all() {
    return Eigen::Map<Block, Eigen::Aligned64, Eigen::OuterStride<>>(values_.data(), size_, w,
                                                                     Eigen::OuterStride<>(stride_));
  }

  /// Adds `h` times another column of the same size; with the same stride in one loop, padding, which stays 0,
  /// included.
  void add_scaled(const Real& h, const RowColumn& other) {
    if (stride_ != other.stride_) return add_scaled(h, other, 0, size_);
    for (Index i = 0; i < w * stride_; ++i)
      values_[static_cast<std::size_t>(i)] += h * other.values_[static_cast<std::size_t>(i)];
  }
  /// The same for the particles of [begin, end).
  void add_scaled(const Real& h, const RowColumn& other, Index begin, Index end) {
    for (int k = 0; k < w; ++k) {
      Real* mine = component(k);
      const Real* theirs = other.component(k);
      for (Index i = begin; i < end; ++i) mine[i] += h * theirs[i];
    }
  }

  /// Becomes a copy of another. @cost no allocation where sizes agree
  void assign(const RowColumn& other) {
    copy_numbers(other.values_, values_);
    size_ = other.size_;
    stride_ = other.stride_;
  }

  void set_zero() { set_to_zero(values_.data(), values_.size()); }
  /// The same for the particles of [begin, end).
  void set_zero(Index begin, Index end) {
    for (int k = 0; k < w; ++k) set_to_zero(component(k) + begin, static_cast<std::size_t>(end - begin));
  }

  /// @cost O(1) on the average: the stride grows by half and may stay above what the size needs
  void append(const Vector& v) {
    if (size_ == stride_) lay_out(padded(size_ + size_ / 2 + 1));
    set(size_++, v);
  }
  void erase(Index i) {
    for (Index j = i; j + 1 < size_; ++j) set(j, static_cast<const RowColumn&>(*this)[j + 1]);
    set(--size_, Vector::Zero());
  }
  /// Gives back what `append` has taken ahead.
  void trim() {
    if (stride_ != padded(size_)) lay_out(padded(size_));
  }

 private:
  static constexpr Index padding = sizeof(Real) < 64 ? 8 : 1;
  static Index padded(Index n) { return (n + padding - 1) / padding * padding; }

  void lay_out(Index stride) {
    AlignedVector<Real> values(static_cast<std::size_t>(w * stride), Real(0));
    for (int k = 0; k < w; ++k) std::copy_n(component(k), size_, values.data() + k * stride);
    values_ = std::move(values);
    stride_ = stride;
  }

  Index size_;
  Index stride_;
  AlignedVector<Real> values_;
};

/// One vector per particle, shape (n, 3).
template <class Real> using VectorColumn = RowColumn<Real, 3>;

}  // namespace noether
