// Checkpoints of a run of which arrays were changed, as files whose hash fits may have them.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_checkpoint_state({reinterpret_cast<const char*>(data), size});
  return 0;
}
