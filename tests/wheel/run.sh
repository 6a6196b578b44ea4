#!/usr/bin/env bash
# Makes a wheel by `./noether wheel` and tries it where nothing else is: on a bare system made by debootstrap that gets a
# Python and no compiler; without root, debootstrap or a network for it, in a virtual environment of this system. The line
# that begins with "tried:" says which of the two it was; docs/nightly.md repeats it.
#     run.sh [WHEEL]      of a wheel that is there, nothing is made
set -eu
[ $# = 0 ] || wheel=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
  echo "skipped: $1"
  exit 77
}
fail() {
  echo "failed: $*"
  exit 1
}
[ $# = 1 ] || command -v apt-get >/dev/null ||
  skip "the wheel's HDF5 is built from a source package of Debian's, and there is no apt-get"
scratch=$(mktemp -d)
bare=$scratch/bare
cleanup() {
  umount "$bare/proc" 2>/dev/null || true
  rm -rf "$scratch"
}
trap cleanup EXIT
python3 -m venv "$scratch/probe" >/dev/null 2>&1 || skip "python3 makes no virtual environments; Debian's package is python3-venv"
"$scratch/probe/bin/pip" download --quiet --no-deps --retries 1 --timeout 15 -d "$scratch/probe" nanobind >/dev/null 2>&1 ||
  skip "no index of Python packages is reachable"

if [ $# = 0 ]; then
  wheel=$(./noether wheel | tail -n 1)
  [ -f "$wheel" ] || fail "./noether wheel printed no file: '$wheel'"
fi

# ---- what is in it ------------------------------------------------------------------------------------------------

python3 -m zipfile -l "$wheel" | awk 'NR > 1 { print $1 }' >"$scratch/list"
for path in noether/__init__.py noether/share/noether/suite/kepler.toml noether/licences/hdf5 \
  noether/examples/figure_eight/scene.toml noether/examples/outer_solar_system/outer_planets.csv; do
  grep -qxF "$path" "$scratch/list" || fail "the wheel has no $path"
done
grep -qE '^noether/_core\..*so$' "$scratch/list" || fail "the wheel has no module"
! grep -E '\.(png|cpp|hpp|a|h5)$|__pycache__|\.out/' "$scratch/list" || fail "the wheel has what nobody needs"
grafted=$(grep -cE '^noether\.libs/.*\.so' "$scratch/list") || true
[ "$grafted" -le 3 ] || fail "the wheel brings $grafted libraries of the system along"
[ "$(stat -c %s "$wheel")" -le 8000000 ] || fail "the wheel has $(stat -c %s "$wheel") bytes"

# ---- where nothing else is ----------------------------------------------------------------------------------------

digest=$(sed -n 's/^sha256:/sha256:/p' examples/figure_eight/README.md | head -n 1)
[ -n "$digest" ] || fail "the README of figure_eight names no digest"
version=$(sed -nE 's/^project\(noether VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)

# Installed, and the first run, in under a minute; the same bits from the object, the function and the program, whose
# file h5py and the program read.
try() {  # try FOLDER: the wheel lies in FOLDER
  cat <<END
set -eu
cd $1
python3 -m venv fresh
start=\$(date +%s)
fresh/bin/pip install --quiet --disable-pip-version-check ./$(basename "$wheel")
cat >first.py <<'CODE'
import noether as nt

report = nt.run(nt.example("figure_eight"))
print(report.digest)
assert report.frames.positions.shape[1:] == (3, 3), report.frames.positions.shape
CODE
fresh/bin/python first.py | grep -xF "$digest"
took=\$((\$(date +%s) - start))
echo "installed and run in \$took s"
[ \$took -lt 60 ]
export PATH=\$PWD/fresh/bin:\$PATH
noether --version | grep -F "noether $version "
noether run fresh/lib/python3*/site-packages/noether/examples/figure_eight/scene.toml --out here | grep -xF "$digest"
noether verify here/run.h5
noether list forces | grep -q gravity
python -c "import h5py; assert h5py.File('here/run.h5')['particles']"
python - <<'CODE'
import importlib, time

import numpy

start = time.perf_counter()
import noether

print(f"import in {1000 * (time.perf_counter() - start):.0f} ms beside NumPy")
CODE
END
}

bare_system() {
  [ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null || return 1
  local suite mirror
  suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  mirror=$(sed -nE 's/^(deb|URIs:) +(\[[^]]*\] +)?(http[^ ]+).*/\3/p' /etc/apt/sources.list \
    /etc/apt/sources.list.d/* 2>/dev/null | head -n 1)
  [ -n "$suite" ] || return 1
  debootstrap --variant=minbase --include=ca-certificates,python3,python3-venv "$suite" "$bare" ${mirror:+"$mirror"} \
    >"$scratch/debootstrap.log" 2>&1 || {
    tail -n 3 "$scratch/debootstrap.log"
    return 1
  }
  mount -t proc proc "$bare/proc" 2>/dev/null || true
  cp /etc/ssl/certs/ca-certificates.crt "$bare/etc/ssl/certs/"  # a network may have certificates of its own
  cp /etc/resolv.conf "$bare/etc/" 2>/dev/null || true
}

in_bare() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C PIP_CERT=/etc/ssl/certs/ca-certificates.crt \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    ${PIP_INDEX_URL:+PIP_INDEX_URL="$PIP_INDEX_URL"} chroot "$bare" "$@"
}

# A wheel made by a Python before 3.12 is for that version: the bare system must have the same.
abi=$(sed -E 's/.*-(cp[0-9]+)-(cp[0-9]+|abi3)-.*/\1 \2/' <<<"$(basename "$wheel")")
fits() {
  "$@" -c "import sys; tag = 'cp%d%d' % sys.version_info[:2]; abi = '$abi'.split()
sys.exit(not (tag == abi[0] or abi[1] == 'abi3' and sys.version_info >= (3, 12)))"
}

if bare_system && fits in_bare python3; then
  echo "tried: installed on a bare system"
  ! in_bare sh -c 'command -v gcc cc g++ cmake' || fail "the bare system has a compiler"
  mkdir "$bare/tmp/try"
  cp "$wheel" "$bare/tmp/try/"
  try /tmp/try | in_bare sh || fail "the installed wheel"
else
  echo "tried: in a virtual environment"
  echo "a bare system needs root, debootstrap, a network, and a Python of the wheel's version"
  mkdir "$scratch/try"
  cp "$wheel" "$scratch/try/"
  (cd "$scratch" && try "$scratch/try" | sh) || fail "the installed wheel"
fi
echo "the wheel works"
