# SPDX-License-Identifier: MIT
# Sourced by examples/run, tests/run and .ci/run: functions that install missing packages and build.

# The whole build is configured at once, so that any target can be built later.
osgskin_build_packages="g++ cmake ninja-build pkg-config libopenscenegraph-dev openscenegraph
  libglm-dev libcgal-dev libeigen3-dev libassimp-dev nlohmann-json3-dev libstb-dev zlib1g-dev
  libcli11-dev libhwy-dev libtbb-dev libmeshoptimizer-dev libdraco-dev libgtest-dev
  libbenchmark-dev libegl-dev liblo-dev libbullet-dev"
osgskin_show_packages="xvfb imagemagick libgl1-mesa-dri"
osgskin_package_packages="dpkg-dev debhelper help2man lintian mmdebstrap"
osgskin_test_packages="libegl1 binutils dpkg-dev file locales assimp-testmodels python3"

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

# osgskin_build PRESET TARGET...: configures and builds, and shows how far it is.
osgskin_build() {
  local preset=$1 log
  shift
  log=$osgskin_root/build-$preset.log
  echo "Building (preset $preset)"
  cmake --preset "$preset" >"$log" 2>&1 &&
    NINJA_STATUS='at %p after %e s: ' cmake --build --preset "$preset" --target "$@" 2>&1 |
    tee -a "$log" | osgskin_progress || {
    tail -n 60 "$log" >&2
    echo "The build failed; all of it is in $log" >&2
    return 1
  }
  rm -f "$log"
}

# Shows Ninja's lines "at 35% after 72.5 s: ..." as one that changes; a new one for every 10 % if that
# is not on a terminal. Not by awk, which reads a pipe in large blocks.
osgskin_progress() {
  local line percent seconds shown=0 format='  %3d %%, %d.%d minutes\n' step=10
  [ ! -t 1 ] || { format='\r  %3d %%, %d.%d minutes' step=1; }
  while IFS= read -r line; do
    [[ $line =~ ^at\ +([0-9]+)%\ after\ ([0-9]+) ]] || continue
    percent=${BASH_REMATCH[1]} seconds=${BASH_REMATCH[2]}
    ((percent >= shown + step || (percent == 100 && shown < 100))) || continue
    shown=$percent
    # shellcheck disable=SC2059 # a format
    printf "$format" "$percent" $((seconds / 60)) $((seconds % 60 / 6))
  done
  [ ! -t 1 ] || [ "$shown" -eq 0 ] || echo
}
