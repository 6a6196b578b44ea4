#pragma once
/// How run.h5 reaches the disk: through a driver of HDF5 that writes in such an order that the file on disk is, at
/// every moment, the file as of its last flush. A process may be killed and a disk may run full at any time.

#include <cstdint>
#include <filesystem>

namespace noether::io {

/// An id of HDF5, whose header only sources see.
using Hdf5Id = std::int64_t;

/// The file as the driver holds it.
class OrderedFile;

/// Chooses the driver, and what it counts on, in a list of file access. @return whether HDF5 took it
bool use_ordered_driver(Hdf5Id access);

/// The driver's side of an open file; the file must have been opened with this driver.
OrderedFile* ordered_file(Hdf5Id file);

/// Why a write has failed (errno), or 0. From then on nothing is written any more: the file stays as of its last flush.
int write_error(const OrderedFile& file) noexcept;

/// Of the object headers, the one at this address is written after all others, or before them where datasets get
/// shorter.
void write_last(OrderedFile& file, std::uint64_t header);

/// The next flushes make datasets shorter: what points at data is written before what holds the data.
/// Space that gets free is not to be used again before the file has been closed.
void begin_cut(OrderedFile& file) noexcept;

/// How many bytes a file should have, by its own superblock; as many as it has, if it is no HDF5 file. @throws never
std::uint64_t expected_size(const std::filesystem::path& file);

/// From now on nothing reaches the disk: what is written is kept in memory, and lost when the file is closed.
void keep_in_memory(OrderedFile& file) noexcept;

}  // namespace noether::io
