# SPDX-License-Identifier: MIT
# Sourced by examples/run, tests/run and .ci/run: functions that install missing packages and build.

osgskin_build_packages="g++ cmake ninja-build pkg-config libopenscenegraph-dev openscenegraph
  libglm-dev libcgal-dev libeigen3-dev libassimp-dev nlohmann-json3-dev libstb-dev
  libcli11-dev libhwy-dev libtbb-dev libmeshoptimizer-dev libdraco-dev"
osgskin_show_packages="xvfb imagemagick libgl1-mesa-dri"
osgskin_test_packages="libgtest-dev libbenchmark-dev libegl-dev libegl1 binutils dpkg-dev file locales assimp-testmodels python3"

# osgskin_install PACKAGE...: installs the Debian packages that are missing.
osgskin_install() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q '^install ok installed' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "Installing Debian packages: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These Debian packages are missing, and neither root nor sudo is at hand:" >&2
      echo "  apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "Could not install: ${missing[*]}" >&2
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

# osgskin_build PRESET [CMAKE OPTION...]: configures and builds, quietly unless it fails.
osgskin_build() {
  local preset=$1
  shift
  echo "Building (preset $preset)"
  cmake --preset "$preset" "$@" >"$osgskin_root/build-$preset.log" 2>&1 &&
    cmake --build --preset "$preset" >>"$osgskin_root/build-$preset.log" 2>&1 || {
    tail -n 60 "$osgskin_root/build-$preset.log" >&2
    echo "The build failed; all of it is in $osgskin_root/build-$preset.log" >&2
    return 1
  }
  rm -f "$osgskin_root/build-$preset.log"
}
