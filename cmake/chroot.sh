#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# chroot.sh SUITE FOLDER [CTEST ARGUMENT...]: builds on another Debian (sid, testing, trixie), in a chroot that
# mmdebstrap makes, and runs the tests of the kits there. Warnings are errors. Needs root. FOLDER (4 GB a suite)
# keeps everything: a second run builds only what has changed, with the packages of the first.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$osgskin_root/cmake/setup.sh"
suite=$1
mkdir -p "$2"
root=$(cd "$2" && pwd)/$suite
shift 2

if [ ! -e "$root.made" ]; then
  osgskin_install mmdebstrap
  packages=$(echo $osgskin_build_packages $osgskin_test_packages $osgskin_show_packages | tr ' ' ,)
  # A mirror that lags behind is new enough.
  mmdebstrap --variant=apt --aptopt='Acquire::Check-Valid-Until "false"' --include="$packages" "$suite" "$root"
  touch "$root.made"
fi
chroot "$root" dpkg-query -W -f '${Package} ${Version}\n' g++ libcgal-dev libeigen3-dev libassimp-dev \
  libopenscenegraph-dev libglm-dev libhwy-dev libtbb-dev libmeshoptimizer-dev libdraco-dev

mkdir -p "$root/osgskin" "$root/build"
# The mounts end with the shell.
# shellcheck disable=SC2016 # expanded by that shell
unshare --mount bash -euc '
  mount --bind "$1" "$2/osgskin"
  mount --rbind /dev "$2/dev"
  mount -t proc proc "$2/proc"
  exec chroot "$2" bash -euc "
    cmake --preset ci -S /osgskin -B /build
    cmake --build /build --target tests/unit/all osgskinbake osgdb_skin osgdb_serializers_osgskin
    ctest --test-dir /build/tests/unit --no-tests=error --output-on-failure -j$(nproc) -E _NOT_BUILT \"\$@\"" \
    ctest "${@:3}"' bash "$osgskin_root" "$root" "$@"
