// The one main of all test programs.

#define CATCH_CONFIG_RUNNER  // version 2 defines its runner in this file only; version 3 ignores it
#include "tests/support/catch.hpp"

/// Where the address sanitizer looks for leaks: HDF5 itself forgets a few hundred bytes when it opens a damaged file.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }  // NOLINT: the sanitizer's own name

int main(int argc, char** argv) { return Catch::Session().run(argc, argv); }
