#!/usr/bin/env bash
# Makes Debian packages of a build folder and tries them where nothing else is: on a bare system made by debootstrap, where
# apt installs them with what they depend on; without root, debootstrap or a network, unpacked into a folder. The line that
# begins with "tried:" says which of the two it was; docs/nightly.md repeats it.
#     run.sh BUILD_FOLDER VERSION
set -eu
build=$1 version=$2

skip() {
  echo "skipped: $1"
  exit 77
}
fail() {
  echo "failed: $*"
  exit 1
}
for tool in cpack dpkg-deb dpkg-shlibdeps dpkg-query; do
  command -v $tool >/dev/null || skip "there is no $tool"
done

scratch=$(mktemp -d)
bare=$scratch/bare
cleanup() {
  umount "$bare/proc" 2>/dev/null || true
  rm -rf "$scratch"
}
trap cleanup EXIT

cd "$build"
cpack -G DEB -B "$scratch/packages" >"$scratch/cpack.log" 2>&1 || {
  cat "$scratch/cpack.log"
  fail "cpack"
}
architecture=$(dpkg --print-architecture)
program=$scratch/packages/noether_${version}_$architecture.deb
library=$scratch/packages/noether-dev_${version}_$architecture.deb
[ -f "$program" ] && [ -f "$library" ] || fail "cpack made $(cd "$scratch/packages" && echo *.deb)"

# ---- what is in them ----------------------------------------------------------------------------------------------

# has DEB PATH...
has() {
  local deb=$1 path list
  shift
  list=$(dpkg-deb --fsys-tarfile "$deb" | tar -t)
  for path in "$@"; do
    grep -qxF "./usr/$path" <<<"$list" || fail "$(basename "$deb") has no $path"
  done
  ! grep -E '\.out/|run\.h5$|/build/' <<<"$list" || fail "$(basename "$deb") has what runs or builds left behind"
}
documents=share/doc/noether
has "$program" bin/noether share/man/man1/noether.1.gz share/noether/suite/kepler.toml $documents/copyright \
  $documents/changelog.gz $documents/README.md $documents/CITATION.cff $documents/docs/scenes.md \
  $documents/examples/figure_eight/scene.toml $documents/examples/template_project/CMakeLists.txt
has "$library" include/noether/noether.hpp include/noether/engine/simulation.hpp lib/libnoether_engine.a \
  lib/cmake/noether/noetherConfig.cmake share/doc/noether-dev/copyright
for deb in "$program" "$library"; do
  [ "$(dpkg-deb -f "$deb" Version)" = "$version" ] || fail "$(basename "$deb") says version $(dpkg-deb -f "$deb" Version)"
done

# The manual page has every command of the help, and roff shows it as it stands there.
dpkg-deb -x "$program" "$scratch/unpacked"
page=$(gzip -dc "$scratch/unpacked/usr/share/man/man1/noether.1.gz")
for command in $("$build/cli/noether" help | sed -n '/^Subcommands/,$s/^  \([a-z]*\) .*/\1/p'); do
  grep -qx ".SH ${command^^}" <<<"$page" || fail "the manual page has no '$command'"
done
grep -q 'threads to use; the bits do not depend on it' <<<"$page" || fail "the manual page lacks the options of run"

# noether-dev depends on a package for everything that its own noetherConfig.cmake looks for, and on nothing else.
dpkg-deb -x "$library" "$scratch/library"
config=$scratch/library/usr/lib/cmake/noether/noetherConfig.cmake
needed=$({
  echo g++ cmake
  awk '/if\((OFF|0|FALSE)\)/ { off = 1 } /endif/ { off = 0 } !off' "$config" |
    sed -nE 's/^ *find_dependency\(([A-Za-z0-9]+).*/\1/p' | while read -r name; do
    case $name in
      Eigen3) echo libeigen3-dev ;;
      fmt) echo libfmt-dev ;;
      Threads | OpenMP) ;;  # the compiler has them
      ZLIB) echo zlib1g-dev ;;
      OpenSSL) echo libssl-dev ;;
      HDF5) echo libhdf5-dev ;;
      *) echo "no-package-of-$name" ;;
    esac
  done
} | tr ' ' '\n' | sort -u)
named=$(dpkg-deb -f "$library" Depends | tr ',' '\n' | sed 's/^ *//; s/ .*//' | sort -u)
[ "$named" = "$needed" ] || fail "noether-dev depends on" $named "where its noetherConfig.cmake needs" $needed

# ---- on a bare system ---------------------------------------------------------------------------------------------

# What is run there, as root of a system, or below a folder: the program in a scene, and the template built against it.
digest=$(sed -n 's/^sha256:/sha256:/p' "$scratch/unpacked/usr/$documents/examples/figure_eight/README.md" | head -n 1)
template=$(sed -n 's/^sha256:/sha256:/p' "$scratch/unpacked/usr/$documents/examples/template_project/README.md" | head -n 1)
[ -n "$digest" ] && [ -n "$template" ] || fail "the examples' READMEs name no digests"

try() {  # try ROOT: ROOT/usr has both packages; a prefix of "" is the system itself
  cat <<END
set -eu
mkdir -p /tmp/try && cd /tmp/try
$1/usr/bin/noether --version | grep -F "noether $version "
$1/usr/bin/noether run $1/usr/$documents/examples/figure_eight/scene.toml --out here | grep -xF "$digest"
$1/usr/bin/noether verify here/run.h5
END
}

bare_system() {
  [ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null || return 1
  local suite mirror
  suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  mirror=$(sed -nE 's/^(deb|URIs:) +(\[[^]]*\] +)?(http[^ ]+).*/\3/p' /etc/apt/sources.list \
    /etc/apt/sources.list.d/* 2>/dev/null | head -n 1)
  [ -n "$suite" ] || return 1
  debootstrap --variant=minbase "$suite" "$bare" ${mirror:+"$mirror"} >"$scratch/debootstrap.log" 2>&1 || {
    tail -n 3 "$scratch/debootstrap.log"
    return 1
  }
}

in_bare() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} chroot "$bare" "$@"
}

if bare_system; then
  echo "tried: installed on a bare system"
  cp "$program" "$library" "$bare/tmp/"
  apt-config dump | grep -E '^Acquire::https?::.*Proxy' >"$bare/etc/apt/apt.conf.d/90proxy" || true
  mount -t proc proc "$bare/proc" 2>/dev/null || true
  in_bare apt-get install -y --no-install-recommends "/tmp/$(basename "$program")" >"$scratch/apt.log" 2>&1 || {
    tail -n 20 "$scratch/apt.log"
    fail "apt cannot install the program"
  }
  try "" | in_bare sh || fail "the installed program"
  in_bare apt-get install -y --no-install-recommends make "/tmp/$(basename "$library")" >"$scratch/apt.log" 2>&1 || {
    tail -n 20 "$scratch/apt.log"
    fail "apt cannot install the library"
  }
  in_bare sh -c "cmake -S /usr/$documents/examples/template_project -B /tmp/template >/tmp/log 2>&1 &&
    cmake --build /tmp/template >>/tmp/log 2>&1 || { cat /tmp/log; exit 1; }
    /tmp/template/my_orbits" | grep -xF "$template" || fail "the template project against the installed library"
else
  echo "tried: unpacked into a folder"
  echo "a bare system needs root, debootstrap and a network"
  unpacked=$scratch/unpacked
  dpkg-deb -x "$library" "$unpacked"
  # Every library that the program loads belongs to a package that the control file names, or that comes with one.
  depends=$(dpkg-deb -f "$program" Depends | tr ',' '\n' | sed 's/^ *//; s/ .*//')
  for package in $(objdump -p "$unpacked/usr/bin/noether" | sed -n 's/^ *NEEDED *//p' | while read -r name; do
    path=$(ldd "$unpacked/usr/bin/noether" | awk -v name="$name" '$1 == name { print $3 }')
    [ -n "$path" ] || continue  # the loader itself
    { dpkg-query -S "$path" || dpkg-query -S "$(readlink -f "$path")" || dpkg-query -S "${path#/usr}" ||
      dpkg-query -S "/usr$path"; } 2>/dev/null | head -n 1 | cut -d: -f1
  done | sort -u); do
    grep -qxF "$package" <<<"$depends" || fail "the package does not depend on $package"
  done
  ! objdump -p "$unpacked/usr/bin/noether" | grep -E 'R(UN)?PATH' || fail "the program has a path to libraries in it"
  try "$unpacked" | sed "s|/tmp/try|$scratch/try|" | sh || fail "the unpacked program"
  generator="Unix Makefiles"
  ! command -v ninja >/dev/null || generator=Ninja
  cmake -G "$generator" -S "$unpacked/usr/$documents/examples/template_project" -B "$scratch/template" \
    -DCMAKE_PREFIX_PATH="$unpacked/usr" >"$scratch/log" 2>&1 && cmake --build "$scratch/template" >>"$scratch/log" 2>&1 || {
    cat "$scratch/log"
    fail "the template project against the unpacked library"
  }
  "$scratch/template/my_orbits" | grep -xF "$template" || fail "the template project prints something else"
fi
echo "both packages work"
