#pragma once
/// Rows on their way into a growing dataset: written many at a time, because a call of HDF5 costs microseconds.

#include "io/hdf5_file.hpp"

#include <span>
#include <utility>
#include <vector>

namespace noether::io {

/// A dataset of numbers that grows by rows; rows wait in memory until there are 64 KiB of them, or `write_out()`.
template <class Number> class BufferedDataset {
 public:
  BufferedDataset() = default;
  explicit BufferedDataset(Hdf5Dataset dataset) : dataset_(std::move(dataset)) {}

  /// Adds one row. @throws FileError if the disk refuses
  void append(std::span<const Number> row) {
    waiting_.insert(waiting_.end(), row.begin(), row.end());
    if (waiting_.size() >= enough) write_out();
  }
  void append(const Number& row) { append(std::span(&row, 1)); }

  /// Hands the rows that wait to HDF5. @throws FileError if the disk refuses
  void write_out() {
    if (waiting_.empty()) return;
    dataset_.append(waiting_);
    waiting_.clear();
  }

 private:
  static constexpr std::size_t enough = 65536 / sizeof(Number);

  Hdf5Dataset dataset_;
  std::vector<Number> waiting_;
};

}  // namespace noether::io
