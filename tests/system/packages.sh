#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# packages.sh BUILD SOURCE FOLDER: makes the Debian packages with what BUILD holds, checks each one's files and
# licences, and those of each component of `cmake --install`. In a new Debian that holds two packages and what they
# need, a saved character plays.
set -euo pipefail
build=$1 source=$2 folder=$3
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder"
"$source/cmake/packages.sh" "$folder/packages" "$build" >"$folder/packages.txt" ||
  { cat "$folder/packages.txt"; fail "packages.sh, or lintian complains"; }

# expect PACKAGE FILE...: the package contains these files, and licences.
expect() {
  local package=$1 deb
  shift
  deb=$(find "$folder/packages" -maxdepth 1 -name "${package}_*.deb")
  [ -n "$deb" ] || fail "there is no package $package"
  dpkg-deb -c "$deb" >"$folder/$package.txt"
  for file in "$@" "doc/$package/copyright" "doc/$package/NOTICES.txt"; do
    grep -q "$file" "$folder/$package.txt" || fail "$package does not hold $file"
  done
  dpkg-deb -f "$deb" Depends >"$folder/$package.depends"
  echo "$package needs $(cat "$folder/$package.depends")"
}
expect libosgskin0.4 libosgSkin.so.0.4 libosgSkinRig.so.0.4 libosgSkinMotion.so.0.4 libosgSkinGpu.so.0.4
expect osgskin-serializers osgdb_serializers_osgskin.so osgdb_serializers_osgskinmotion.so
expect libosgskinimport0.4 libosgSkinImport.so.0.4
expect libosgskin-dev include/osgSkin/DeformableSkin include/osgSkinImport/ImportMesh osgSkinConfig.cmake \
  OsgTargets.cmake pkgconfig/osgSkin.pc libosgSkin.so include/osgSkinBind/Bind include/osgSkinMotion/ClipPlayer \
  include/osgSkinCharacter/LoadCharacter osgSkinBindTargets.cmake pkgconfig/osgSkinCharacter.pc libosgSkinBind.so
expect libosgskinbind0.4 libosgSkinBind.so.0.4 libosgSkinCharacter.so.0.4
expect osgskin-plugin osgdb_skin.so
expect osgskin-binder osgdb_binder_osgskin.so
expect osgskin-tools bin/osgskinbake bin/osgskinviewer bin/osgskincrowd bin/osgskinrecipes bin/osgskinthrow \
  share/osgskin/thrower.skin
[ "$(find "$folder/packages" -name '*.deb' | wc -l)" -eq 8 ] || fail "more than eight packages"
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
[ "$(grep -c 'man/man1/osgskin.*\.1' "$folder/osgskin-tools.txt")" -eq 5 ] || fail "a man page is missing"
echo "Eight packages"

for component in runtime serializers import dev bind plugin programs binder; do
  expected="LICENSE LICENSES/Apache-2.0.txt"
  [ $component = programs ] && expected+=" LICENSES/CC0-1.0.txt"
  [ $component = binder ] && expected+=" LICENSES/GPL-3.0-or-later.txt"
  expected+=" LICENSES/MIT.txt LICENSES/NOTICES.txt"
  cmake --install "$build" --component $component --prefix "$folder/tree/$component" >"$folder/install.txt"
  found=$(cd "$folder/tree/$component/share/doc/osgSkin" && find . -type f -printf '%P\n' | LC_ALL=C sort | xargs)
  [ "$found" = "$expected" ] || fail "the tree of $component holds $found, expected $expected"
done
echo "Eight components with their licences"

# A new Debian, in which a saved character plays. Its programs draw on a display outside of it.
root=$folder/root
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
unshare --mount mount -t tmpfs none /mnt 2>"$folder/mount.txt" ||
  { echo "A new Debian is left out, since mounts are not allowed: $(cat "$folder/mount.txt")"; exit 77; }
OSG_LIBRARY_PATH="$build/lib" osgconv "$source/data/thrower.skin" "$folder/thrower.osgb" >"$folder/convert.txt"
mmdebstrap --variant=apt --include=openscenegraph --customize-hook="copy-in $folder/packages /" \
  --customize-hook='chroot "$1" sh -c "apt-get install -y --no-install-recommends \
    /packages/libosgskin0.4_*.deb /packages/osgskin-serializers_*.deb"' \
  "$suite" "$root" >"$folder/root.txt" 2>&1 || { tail -n 30 "$folder/root.txt"; fail "a new Debian"; }
cp "$folder/thrower.osgb" "$root"
mkdir "$folder/bin"
printf '#!/bin/sh\nexec chroot "%s" osgviewer "$@"\n' "$root" >"$folder/bin/osgviewer"
chmod +x "$folder/bin/osgviewer"
env -u LD_LIBRARY_PATH -u OSG_LIBRARY_PATH PATH="$folder/bin:$PATH" \
  "$source/tests/system/viewer.sh" /thrower.osgb "$folder/play"
rm -rf "$root"
echo "A saved character plays where only its packages are installed"
