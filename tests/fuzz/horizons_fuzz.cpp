// Vector tables of Horizons: the reader of bodies takes what has a line "$$SOE" for one.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_bodies({reinterpret_cast<const char*>(data), size});
  return 0;
}
