#!/usr/bin/env bash
# Builds the source package for aarch64, by a cross compiler on a bare system made by debootstrap, and runs an example there
# under qemu: its digest is that of every other processor, for kernels are those of the level base. Without optimization,
# which changes no bits.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
  echo "skipped: $1"
  exit 77
}
fail() {
  echo "failed: $*"
  exit 1
}
[ "$(id -u)" = 0 ] || skip "a bare system is made by root"
command -v debootstrap >/dev/null || skip "there is no debootstrap"
scratch=$(mktemp -d)
bare=$scratch/bare
cleanup() {
  umount "$bare/proc" 2>/dev/null || true
  rm -rf "$scratch"
}
trap cleanup EXIT

python3 -m venv "$scratch/tools" >/dev/null 2>&1 || skip "python3 makes no virtual environments; Debian's package is python3-venv"
"$scratch/tools/bin/pip" install --quiet --retries 1 --timeout 15 scikit-build-core >/dev/null 2>&1 ||
  skip "no index of Python packages is reachable"
"$scratch/tools/bin/python" -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1], {})' \
  "$scratch" >/dev/null || fail "the source package cannot be made"
[ "$(stat -c %s "$scratch"/noether-*.tar.gz)" -le 4000000 ] || fail "the source package is larger than 4 MB"
! tar -tzf "$scratch"/noether-*.tar.gz | grep -E '/build/|/\.git/|\.png$' || fail "the source package has what builds need not"

# ---- a bare system with a cross compiler --------------------------------------------------------------------------

[ "$(. /etc/os-release && echo "${ID:-}")" = debian ] || skip "the libraries of arm64 are had from Debian's mirrors"
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(sed -nE 's/^(deb|URIs:) +(\[[^]]*\] +)?(http[^ ]+).*/\3/p' /etc/apt/sources.list /etc/apt/sources.list.d/* \
  2>/dev/null | head -n 1)
debootstrap --variant=minbase "$suite" "$bare" ${mirror:+"$mirror"} >"$scratch/debootstrap.log" 2>&1 || {
  tail -n 3 "$scratch/debootstrap.log"
  skip "debootstrap makes no bare system here"
}
apt-config dump | grep -E '^Acquire::https?::.*Proxy' >"$bare/etc/apt/apt.conf.d/90proxy" || true
mount -t proc proc "$bare/proc" 2>/dev/null || true
mkdir "$bare/source"
tar -xzf "$scratch"/noether-*.tar.gz -C "$bare/source" --strip-components=1

in_bare() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} chroot "$bare" sh -euc "$1"
}
in_bare "dpkg --add-architecture arm64
  apt-get update
  apt-get install -y --no-install-recommends g++-aarch64-linux-gnu cmake ninja-build qemu-user libeigen3-dev libgomp1:arm64 \
    libcli11-dev libtomlplusplus-dev:arm64 libhwy-dev:arm64 libfmt-dev:arm64 libhdf5-dev:arm64 libssl-dev:arm64 \
    zlib1g-dev:arm64" >"$scratch/apt.log" 2>&1 || {
  tail -n 20 "$scratch/apt.log"
  fail "apt cannot install the cross compiler and the libraries of arm64"
}

# ---- the build, and what it builds ---------------------------------------------------------------------------------

in_bare "cmake -G Ninja -S /source -B /build -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
    -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG='-O0 -DNDEBUG' -DNOETHER_TESTS=OFF -DNOETHER_EXAMPLES=OFF -DNOETHER_BENCH=OFF \
    -DNOETHER_WERROR=OFF
  ninja -C /build -j $(nproc) noether" >"$scratch/build.log" 2>&1 || {
  grep -E 'FAILED|error' "$scratch/build.log" | head -n 20
  tail -n 5 "$scratch/build.log"
  fail "the build for aarch64"
}
file=$bare/build/cli/noether
[ "$(od -An -tx1 -j18 -N2 "$file" | tr -d ' ')" = b700 ] || fail "the program is not one of aarch64"

digest=$(sed -n 's/^sha256:/sha256:/p' examples/figure_eight/README.md | head -n 1)
[ -n "$digest" ] || fail "the README of figure_eight names no digest"
in_bare "qemu-aarch64 /build/cli/noether --version
  cd /tmp
  qemu-aarch64 /build/cli/noether run /source/examples/figure_eight/scene.toml --out here" >"$scratch/run.log" 2>&1 || {
  cat "$scratch/run.log"
  fail "the program under qemu"
}
cat "$scratch/run.log"
grep -qxF "$digest" "$scratch/run.log" || fail "figure_eight ends in other bits on aarch64"
in_bare "qemu-aarch64 /build/cli/noether verify /tmp/here/run.h5"
echo "the source package builds for aarch64, and runs there to the same bits"
