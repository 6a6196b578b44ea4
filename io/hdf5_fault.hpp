#pragma once
/// A place in an HDF5 file, and what is wrong there.

#include <cstdint>
#include <string>

namespace noether::io {

/// Bytes of a file, from `begin` to before `end`.
struct ByteRange {
  std::uint64_t begin = 0, end = 0;
};

/// What is wrong with the structure of a file, and where.
struct Hdf5Fault {
  std::uint64_t byte = 0;
  std::string what;
};

}  // namespace noether::io
