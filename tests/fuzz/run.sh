#!/usr/bin/env bash
# Builds and runs a fuzz target: tests/fuzz/run.sh TARGET [SECONDS] [OPTION OF LIBFUZZER]...
# or builds them all:            tests/fuzz/run.sh --build
# It begins with the seeds of the target in a scratch folder. Inputs that are findings are kept in build/fuzz/findings.
set -eu
target=${1:?the name of a target, such as scene}
seconds=${2:-60}
shift $(($# < 2 ? $# : 2))
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if [ "$target" = --build ]; then
  program=fuzz_targets
elif [ -f "tests/fuzz/${target}_fuzz.cpp" ]; then
  program=${target}_fuzz
else
  echo "there is no target '$target'; expected one of:" tests/fuzz/*_fuzz.cpp >&2
  exit 2
fi
if ! command -v clang++ >/dev/null ||
  ! echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
    clang++ -x c++ -fsanitize=fuzzer,address,undefined - -o /dev/null 2>/dev/null; then
  echo "skipped: there is no clang++ with libFuzzer"
  exit 77
fi

mkdir -p build/fuzz/findings
{
  flock 9
  [ -f build/fuzz/build.ninja ] || cmake --preset fuzz >build/fuzz.log 2>&1 9>&- || { cat build/fuzz.log; exit 4; }
  cmake --build build/fuzz -j 2 --target "$program" >build/fuzz.log 2>&1 9>&- || { tail -50 build/fuzz.log; exit 4; }
} 9>build/fuzz.lock
[ "$target" != --build ] || exit 0

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/corpus" "$scratch/tmp" "$scratch/scenes"
seeds=(tests/fuzz/seeds/"$target"/*)
longest=4096
case $target in
  scene)
    build/fuzz/tests/fuzz/write_scenes "$scratch/scenes"
    seeds+=(tests/scenes/good/*.toml "$scratch"/scenes/bad/*.toml)
    ;;
  body_sites) seeds+=(tests/scenes/good/*.csv) ;;
  csv_bodies) seeds+=(tests/scenes/good/*.csv tests/scenes/bad/*.csv) ;;
  structure) seeds+=(tests/data/lammps/*.data) ;;
  horizons) seeds+=(tests/data/horizons/*.txt) longest=8192 ;;
  quantity) longest=64 ;;
  checkpoint | checkpoint_content) longest=65536 ;;
  checkpoint_state) longest=128 ;;
  hdf5) longest=16384 ;;
esac

for seed in "${seeds[@]}"; do
  [ ! -f "$seed" ] || cp "$seed" "$scratch/corpus/$(basename "$(dirname "$seed")")-$(basename "$seed")"
done
TMPDIR=$scratch/tmp "build/fuzz/tests/fuzz/${target}_fuzz" "$scratch/corpus" -max_total_time="$seconds" -timeout=5 \
  -max_len=$longest -artifact_prefix="build/fuzz/findings/$target-" -print_final_stats=1 -verbosity=1 "$@"
