// The structure of HDF5 files of any bytes.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_hdf5({reinterpret_cast<const char*>(data), size});
  return 0;
}
