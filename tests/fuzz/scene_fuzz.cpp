// Scenes with their --set, as tests/scenes writes them.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_scene({reinterpret_cast<const char*>(data), size});
  return 0;
}
