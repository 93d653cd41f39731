#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# packages.sh BUILD FOLDER: cpack makes the Debian packages; checks each one's files.
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
expect libosgskin0.4 libosgSkin.so.0.4 libosgSkinRig.so.0.4 libosgSkinMotion.so.0.4 libosgSkinGpu.so.0.4
expect osgskin-serializers osgdb_serializers_osgskin.so
expect libosgskinimport0.4 libosgSkinImport.so.0.4
expect libosgskin-dev include/osgSkin/DeformableSkin include/osgSkinImport/ImportMesh osgSkinConfig.cmake \
  OsgTargets.cmake pkgconfig/osgSkin.pc libosgSkin.so include/osgSkinBind/Bind \
  include/osgSkinCharacter/LoadCharacter osgSkinBindTargets.cmake pkgconfig/osgSkinCharacter.pc libosgSkinBind.so
expect libosgskinbind0.4 libosgSkinBind.so.0.4 libosgSkinCharacter.so.0.4
expect osgskin-plugin osgdb_skin.so
expect osgskin-binder osgdb_binder_osgskin.so
expect osgskin-tools bin/osgskinbake bin/osgskinviewer bin/osgskincrowd bin/osgskinrecipes bin/osgskinthrow \
  share/osgskin/thrower.skin
grep -qE 'gmp|mpfr|assimp|cgal' "$folder/libosgskin0.4.depends" &&
  fail "the runtime's package needs what only binding and importing need"
# Packages under the MIT licence neither hold nor need one under the GPL.
for package in libosgskin0.4 osgskin-serializers libosgskinimport0.4 libosgskinbind0.4 libosgskin-dev osgskin-plugin \
  osgskin-tools; do
  grep -qE 'binder|gmp|mpfr' "$folder/$package.depends" && fail "$package needs a package under the GPL"
  grep -q binder "$folder/$package.txt" && fail "$package holds the binder"
done
grep -q 'osgskin-binder' <<<"$(dpkg-deb -f "$folder"/packages/osgskin-plugin_*.deb Recommends)" ||
  fail "the plug-in does not recommend the binder"
grep -q 'libosgskin0.4' "$folder/libosgskinbind0.4.depends" || fail "binding needs the runtime"
grep -q 'libosgskinbind0.4' "$folder/osgskin-plugin.depends" || fail "the plug-in needs the kits"
grep -q generator "$folder/osgskin-tools.txt" && fail "osgskin-tools holds sources"
if command -v help2man >/dev/null; then
  [ "$(grep -c 'man/man1/osgskin.*\.1' "$folder/osgskin-tools.txt")" -eq 5 ] || fail "a man page is missing"
fi
echo "Eight packages"
