#pragma once
/// What HDF5 says of a call that has failed.

#include <string>

namespace noether::io {

/// The innermost reason of the last failure, or the system's own words where HDF5 quotes them; empty if there is none.
/// HDF5 forgets it. @throws never
std::string take_hdf5_error();

}  // namespace noether::io
