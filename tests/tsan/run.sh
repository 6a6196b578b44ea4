#!/usr/bin/env bash
# Builds the tests of the folders with parallel loops by clang with the thread sanitizer, and runs the fast ones on four
# threads.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folders="engine forces integrators determinism"

skip() {
  echo "skipped: $1"
  exit 77
}
command -v clang++ >/dev/null || skip "there is no clang++"
echo 'int main() {}' | clang++ -x c++ -fsanitize=thread - -o /dev/null 2>/dev/null || skip "clang++ has no thread sanitizer"
export OMP_NUM_THREADS=4 TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1"

# Two threads that add to one number must be found, and taken where the number is atomic.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
adding_to() {
  echo "#include <atomic>
#include <thread>
$1 sum{0};
int main() {
  const auto add = [] { for (int k = 0; k < 100000; ++k) sum += k % 2; };
  std::thread other(add);
  add();
  other.join();
  return sum == 0; }" |
    clang++ -x c++ -std=c++20 -pthread -fsanitize=thread -O1 - -o "$scratch/add" && "$scratch/add" >/dev/null 2>&1
}
adding_to "std::atomic<int>" || { echo "the thread sanitizer sees a race where there is none"; exit 1; }
! adding_to int || { echo "the thread sanitizer does not see a race"; exit 1; }

targets=$(printf 'test_%s ' $folders)
cmake --preset tsan >/dev/null
cmake --build --preset tsan -j 2 --target $targets
for target in $targets; do
  "build/tsan/tests/$target" "~[nightly]~[slow]~[matrix]"
done
