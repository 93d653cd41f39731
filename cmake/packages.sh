#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# packages.sh FOLDER [BUILD]: makes debian/'s packages in FOLDER, and lets lintian check them. With BUILD, a build
# folder of the preset release or ci, they hold what is built there: that takes a minute, but has no hardening flags.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$osgskin_root/cmake/setup.sh"
osgskin_install $osgskin_build_packages $osgskin_package_packages

mkdir -p "$1"
folder=$(cd "$1" && pwd)
built=${2:+$(cd "$2" && pwd)}
rm -rf "$folder/osgskin" "$folder"/*.{deb,changes,buildinfo}
mkdir "$folder/osgskin"
cd "$osgskin_root"
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$folder/osgskin"
cd "$folder/osgskin"

# osgskin_pack_built: configures, points the install rules at BUILD, and calls that built.
osgskin_pack_built() {
  local made=$PWD/obj-$(dpkg-architecture -qDEB_HOST_MULTIARCH)
  cmake -G Ninja -B "$made" -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON -DOSGSKIN_TESTS=OFF &&
    find "$made" -name cmake_install.cmake \
      -exec sed -i "s|$made/lib|$built/lib|g; s|$made/bin|$built/bin|g" {} + &&
    dh_listpackages >debian/debhelper-build-stamp
}
# BUILD has no debug symbols, so no packages of these.
[ -z "$built" ] || export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-} noautodbgsym"
echo "Making Debian packages"
{ [ -z "$built" ] || osgskin_pack_built; } >"$folder/build.log" 2>&1 &&
  dpkg-buildpackage -b -us -uc ${built:+--no-pre-clean} >>"$folder/build.log" 2>&1 || {
  tail -n 60 "$folder/build.log" >&2
  echo "The packages failed; all of it is in $folder/build.log" >&2
  exit 1
}
cd "$folder"
rm -rf osgskin
lintian --fail-on error,warning osgskin_*.changes
ls *.deb
