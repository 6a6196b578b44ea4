// Structures: LAMMPS data, extended XYZ, .gro, each input as all three.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_structure({reinterpret_cast<const char*>(data), size});
  return 0;
}
