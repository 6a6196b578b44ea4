#!/usr/bin/env bash
# Builds the tests of the folders that ask for files by clang without OpenMP and without HDF5, and runs the fast ones. What
# computes is no other without HDF5, and tests/asan runs it without OpenMP.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folders="engine io scene"

command -v clang++ >/dev/null || {
  echo "skipped: there is no clang++"
  exit 77
}
cmake --preset minimal >/dev/null
cmake --build --preset minimal -j 2 --target $(printf 'test_%s ' $folders)
ctest --preset minimal -j 2 -R "^(${folders// /|})\\."
