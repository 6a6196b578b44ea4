// Checkpoints as files of any bytes.

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  noether::test::add_seed(*argc, *argv, noether::test::with_hash(noether::test::sample_checkpoint_content()));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_checkpoint({reinterpret_cast<const char*>(data), size});
  return 0;
}
