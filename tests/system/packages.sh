#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# packages.sh BUILD FOLDER: cpack makes the three Debian packages; checks each one's files.
set -euo pipefail
build=$1 folder=$2
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder"
(cd "$build" && cpack -G DEB -B "$folder/packages") >"$folder/cpack.txt" 2>&1 ||
  { cat "$folder/cpack.txt"; fail "cpack"; }

# expect PACKAGE FILE...: the package contains these files.
expect() {
  local package=$1 deb
  shift
  deb=$(find "$folder/packages" -maxdepth 1 -name "${package}_*.deb")
  [ -n "$deb" ] || fail "there is no package $package"
  dpkg-deb -c "$deb" >"$folder/$package.txt"
  for file in "$@"; do
    grep -q "$file" "$folder/$package.txt" || fail "$package does not hold $file"
  done
  dpkg-deb -f "$deb" Depends >"$folder/$package.depends"
  echo "$package needs $(cat "$folder/$package.depends")"
}
expect libosgskin0.2 libosgSkin.so.0.2 libosgSkinRig.so.0.2 libosgSkinGpu.so.0.2 osgdb_serializers_osgskin.so
expect libosgskin-dev include/osgSkin/DeformableSkin include/osgSkinBind/Bind \
  include/osgSkinCharacter/LoadCharacter osgSkinConfig.cmake \
  OsgTargets.cmake pkgconfig/osgSkin.pc libosgSkin.so
expect osgskin-plugin osgdb_skin.so bin/osgskinbake libosgSkinBind.so.0.2 libosgSkinImport.so.0.2 \
  libosgSkinCharacter.so.0.2
grep -qE 'gmp|mpfr|assimp|cgal' "$folder/libosgskin0.2.depends" &&
  fail "the runtime's package needs what only binding and importing need"
grep -q 'libosgskin0.2' "$folder/osgskin-plugin.depends" || fail "the plug-ins need the runtime"
grep -qE 'osgSkinBind|osgdb_skin\.so' "$folder/libosgskin0.2.txt" && fail "libosgskin0.2 holds more"
echo "Three packages"
