#pragma once
/// The structure of an HDF5 file, read byte by byte and not by HDF5, which does not look at all of it.

#include "io/hdf5_fault.hpp"

#include <cstdint>
#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// What a walk through a file has found.
struct Hdf5Walk {
  std::optional<Hdf5Fault> fault;  ///< the first one; the walk ends there
  std::vector<ByteRange> unused;   ///< what no reader needs, in order; complete where there is no fault
  /// Datasets whose header has rows of which none has been written. A writer that was killed within its first write to
  /// the header leaves that; in a complete file it is a fault.
  std::vector<Hdf5Fault> unwritten;
};

/// Follows every address from the superblock to the last piece of data: groups, headers of objects, trees, heaps.
///
/// Counts, sizes, neighbors and reserved bytes are what the format demands, every address lies within the file, and no
/// piece overlaps another. Numbers in datasets and attributes are not looked at. It knows the format that noether
/// writes (superblock 0 with headers, trees and attributes of version 1); a file with another superblock is not walked.
/// What others have added to the root of a run.h5 is not walked, and counts as unused.
/// The states in which a killed writer may leave a tree are sound: readers find in them what was there before.
/// @throws never
/// The format is that of the HDF5 File Format Specification, version 3.
Hdf5Walk walk_hdf5(std::istream& file, std::uint64_t size);
/// The same; nothing of a file that cannot be read.
Hdf5Walk walk_hdf5(const std::filesystem::path& file);

/// A fault in one line.
std::string to_text(const Hdf5Fault& fault);

}  // namespace noether::io
