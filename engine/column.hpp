#pragma once
/// Columns: one array per quantity, aligned and padded for vector loops, addressed per particle or as a whole.

#include "engine/real.hpp"
#include "engine/types.hpp"

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
  explicit ScalarColumn(Index n = 0) : values_(static_cast<std::size_t>(n)) {}

  Index size() const { return static_cast<Index>(values_.size()); }
  T operator[](Index i) const { return values_[static_cast<std::size_t>(i)]; }
  T& operator[](Index i) { return values_[static_cast<std::size_t>(i)]; }
  const T* data() const { return values_.data(); }
  T* data() { return values_.data(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

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

/// One vector per particle, shape (n, 3): all x, then all y, then all z, each run padded to a multiple of eight; not of
/// numbers that fill a cache line each.
template <class Real> class VectorColumn {
 public:
  using Row = Eigen::Map<Vec3<Real>, Eigen::Unaligned, Eigen::InnerStride<>>;
  using Block = Eigen::Matrix<Real, Eigen::Dynamic, 3>;

  explicit VectorColumn(Index n = 0)
      : size_(n), stride_(padded(n)), values_(static_cast<std::size_t>(3 * stride_), Real(0)) {}

  Index size() const { return size_; }
  /// Distance between the x and the y of one particle, in elements.
  Index stride() const { return stride_; }

  Vec3<Real> operator[](Index i) const {
    const Real* p = values_.data() + i;
    return Vec3<Real>(p[0], p[stride_], p[2 * stride_]);
  }
  Row operator[](Index i) { return Row(values_.data() + i, Eigen::InnerStride<>(stride_)); }
  void set(Index i, const Vec3<Real>& v) {
    Real* p = values_.data() + i;
    p[0] = v[0];
    p[stride_] = v[1];
    p[2 * stride_] = v[2];
  }
  void add(Index i, const Vec3<Real>& v) {
    Real* p = values_.data() + i;
    p[0] += v[0];
    p[stride_] += v[1];
    p[2 * stride_] += v[2];
  }

  const Real* component(int k) const { return values_.data() + k * stride_; }
  Real* component(int k) { return values_.data() + k * stride_; }

  /// The whole column as an Eigen matrix, shape (n, 3).
  auto all() const {
    return Eigen::Map<const Block, Eigen::Aligned64, Eigen::OuterStride<>>(values_.data(), size_, 3,
                                                                           Eigen::OuterStride<>(stride_));
  }
  auto all() {
    return Eigen::Map<Block, Eigen::Aligned64, Eigen::OuterStride<>>(values_.data(), size_, 3,
                                                                     Eigen::OuterStride<>(stride_));
  }

  /// Adds `h` times another column of the same size; with the same stride in one loop, padding, which stays 0,
  /// included.
  void add_scaled(const Real& h, const VectorColumn& other) {
    if (stride_ != other.stride_) return add_scaled(h, other, 0, size_);
    for (Index i = 0; i < 3 * stride_; ++i)
      values_[static_cast<std::size_t>(i)] += h * other.values_[static_cast<std::size_t>(i)];
  }
  /// The same for the particles of [begin, end).
  void add_scaled(const Real& h, const VectorColumn& other, Index begin, Index end) {
    for (int k = 0; k < 3; ++k) {
      Real* mine = component(k);
      const Real* theirs = other.component(k);
      for (Index i = begin; i < end; ++i) mine[i] += h * theirs[i];
    }
  }

  /// Becomes a copy of another. @cost no allocation where sizes agree
  void assign(const VectorColumn& other) {
    copy_numbers(other.values_, values_);
    size_ = other.size_;
    stride_ = other.stride_;
  }

  void set_zero() { set_to_zero(values_.data(), values_.size()); }
  /// The same for the particles of [begin, end).
  void set_zero(Index begin, Index end) {
    for (int k = 0; k < 3; ++k) set_to_zero(component(k) + begin, static_cast<std::size_t>(end - begin));
  }

  /// @cost O(1) on the average: the stride grows by half and may stay above what the size needs
  void append(const Vec3<Real>& v) {
    if (size_ == stride_) lay_out(padded(size_ + size_ / 2 + 1));
    set(size_++, v);
  }
  void erase(Index i) {
    for (Index j = i; j + 1 < size_; ++j) set(j, static_cast<const VectorColumn&>(*this)[j + 1]);
    set(--size_, Vec3<Real>::Zero());
  }
  /// Gives back what `append` has taken ahead.
  void trim() {
    if (stride_ != padded(size_)) lay_out(padded(size_));
  }

 private:
  static constexpr Index padding = sizeof(Real) < 64 ? 8 : 1;
  static Index padded(Index n) { return (n + padding - 1) / padding * padding; }

  void lay_out(Index stride) {
    AlignedVector<Real> values(static_cast<std::size_t>(3 * stride), Real(0));
    for (int k = 0; k < 3; ++k) std::copy_n(component(k), size_, values.data() + k * stride);
    values_ = std::move(values);
    stride_ = stride;
  }

  Index size_;
  Index stride_;
  AlignedVector<Real> values_;
};

}  // namespace noether
