// Tables of the sites of a rigid body, in CSV.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_body_sites({reinterpret_cast<const char*>(data), size});
  return 0;
}
