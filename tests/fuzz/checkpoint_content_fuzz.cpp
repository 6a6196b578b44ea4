// What a checkpoint holds before its hash, which is made to fit. HDF5 1.10 itself crashes on bytes that no hash guards:
// what this finds in HDF5 is none of noether's, what it finds above is. Go on past findings by
//     tests/fuzz/run.sh checkpoint_content 600 -fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  noether::test::add_seed(*argc, *argv, noether::test::sample_checkpoint_content());
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  noether::test::take_checkpoint_content({reinterpret_cast<const char*>(data), size});
  return 0;
}
