#!/usr/bin/env bash
# Builds the tests of the folders with parallel loops by clang with the thread sanitizer, and runs the fast ones on four
# threads. Archer tells the sanitizer what OpenMP's barriers order; without it every parallel loop would look like a race.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folders="engine forces integrators determinism"

skip() {
  echo "skipped: $1"
  exit 77
}
command -v clang++ >/dev/null || skip "there is no clang++"
archer=$(clang++ -print-file-name=libarcher.so)
[ -e "$archer" ] || archer=$(find /usr/lib/llvm-*/lib -name libarcher.so 2>/dev/null | sort | tail -n 1)
[ -e "$archer" ] || skip "there is no libarcher.so, the bridge between OpenMP and the thread sanitizer"
echo 'int main() {}' | clang++ -x c++ -fopenmp -fsanitize=thread - -o /dev/null 2>/dev/null ||
  skip "clang++ has no OpenMP, or no thread sanitizer"
export OMP_NUM_THREADS=4 OMP_WAIT_POLICY=passive OMP_TOOL_LIBRARIES="$archer"
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1"

# A loop with a race must be found, and a sum by reduction taken.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
loop() {
  echo "int main() { int sum = 0;
#pragma omp parallel for $1
  for (int k = 0; k < 100000; ++k) sum += k; return sum == 0; }" |
    clang++ -x c++ -fopenmp -fsanitize=thread -O1 - -o "$scratch/loop" && "$scratch/loop" >/dev/null 2>&1
}
loop "reduction(+ : sum)" || { echo "the thread sanitizer sees a race where there is none"; exit 1; }
! loop "" || { echo "the thread sanitizer does not see a race"; exit 1; }

targets=$(printf 'test_%s ' $folders)
cmake --preset tsan >/dev/null
cmake --build --preset tsan -j 2 --target $targets
for target in $targets; do
  "build/tsan/tests/$target" "~[nightly]~[slow]~[matrix]"
done
