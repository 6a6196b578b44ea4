// The one main of all test programs.

#define CATCH_CONFIG_RUNNER  // version 2 defines its runner in this file only; version 3 ignores it
#include "tests/support/catch.hpp"

int main(int argc, char** argv) { return Catch::Session().run(argc, argv); }
