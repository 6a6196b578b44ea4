#!/usr/bin/env bash
# Builds the tests of some folders by clang without OpenMP and without HDF5, and runs the fast ones.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folders="engine forces integrators io scene"

command -v clang++ >/dev/null || {
  echo "skipped: there is no clang++"
  exit 77
}
cmake --preset minimal >/dev/null
cmake --build --preset minimal -j 2 --target $(printf 'test_%s ' $folders)
ctest --preset minimal -j 2 -R "^(${folders// /|})\\."
