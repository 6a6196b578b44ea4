#pragma once
/// What multistep methods remember: the last few vectors, and sums with their rounding errors.

#include "engine/saved_state.hpp"
#include "integrators/vector_field.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace noether {

template <class Real> void save_vector(SavedState& saved, const std::string& name, const Vector<Real>& v) {
  save_value(saved, name, std::vector<Real>(v.data(), v.data() + v.size()));
}
/// @throws Error  if the saved vector is shorter
template <class Real> void load_vector(const SavedState& saved, const std::string& name, Vector<Real>& v) {
  std::vector<Real> values;
  load_value(saved, name, values);
  for (Index i = 0; i < v.size(); ++i) v[i] = detail::element(values, static_cast<std::size_t>(i));
}

/// The last vectors of a run, the newest first.
template <class Real> class History {
 public:
  /// Makes room for `most` vectors of `size` numbers and forgets all.
  void bind(std::size_t most, Index size) {
    kept_.assign(most, Vector<Real>(size));
    count_ = 0;
  }
  void forget() { count_ = 0; }
  std::size_t count() const { return count_; }
  const Vector<Real>& operator[](std::size_t ago) const { return kept_[ago]; }
  Vector<Real>& newest() { return kept_.front(); }

  /// The vector to be filled: it becomes the newest, and the oldest of a full history is lost.
  Vector<Real>& push() {
    std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
    count_ = std::min(count_ + 1, kept_.size());
    return kept_.front();
  }

  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "/count", count_);
    for (std::size_t j = 0; j < count_; ++j) save_vector(saved, prefix + "/" + std::to_string(j), kept_[j]);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    load_value(saved, prefix + "/count", count_);
    if (count_ > kept_.size()) throw Error("a saved history is longer than the method's own");
    for (std::size_t j = 0; j < count_; ++j) load_vector(saved, prefix + "/" + std::to_string(j), kept_[j]);
  }

 private:
  std::vector<Vector<Real>> kept_;
  std::size_t count_ = 0;
};

/// A vector with the rounding errors of the sums it went through: value + low is the sum.
template <class Real> struct CompensatedVector {
  Vector<Real> value, low;

  void resize(Index n) {
    value.resize(n);
    low.resize(n);
  }
  void set(const Vector<Real>& x) {
    value = x;
    low.setZero();
  }
  /// value_i + low_i += x.
  void add(Index i, const Real& x) {
    const Real sum = value[i] + x, part = sum - value[i];
    const Real error = low[i] + ((value[i] - (sum - part)) + (x - part));
    value[i] = sum + error;
    low[i] = error - (value[i] - sum);
  }
  void save(SavedState& saved, const std::string& prefix) const {
    save_vector(saved, prefix + "/value", value);
    save_vector(saved, prefix + "/low", low);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    load_vector(saved, prefix + "/value", value);
    load_vector(saved, prefix + "/low", low);
  }
};

}  // namespace noether
