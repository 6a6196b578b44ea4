#!/usr/bin/env bash
# Builds the tests of some folders by clang with the address and undefined behavior sanitizers, without OpenMP, and runs the
# fast ones. Not the list of neighbors: against all pairs, without optimization, it takes over five minutes.
#     tests/asan/run.sh FOLDER...
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if ! command -v clang++ >/dev/null; then
  echo "skipped: there is no clang++"
  exit 77
fi
folders="$*"
NOETHER_WERROR=ON cmake --preset asan >/dev/null
cmake --build --preset asan --target $(printf 'test_%s ' $folders)
ctest --preset asan -j "$(nproc)" -R "^(${folders// /|})\\." -E "^engine\\.neighbor_list\$"
