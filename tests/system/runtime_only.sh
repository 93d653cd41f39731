#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# runtime_only.sh BUILD SOURCE FOLDER: the runtime, the rig kit and the serializers, built where CGAL and Assimp
# cannot be found and installed alone, name neither, and play a character that BUILD's .skin plug-in
# has saved.
set -euo pipefail
build=$1 source=$2 folder=$3
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder/installed" "$folder/play"
mkdir -p "$folder"
# The folder is kept from run to run, so that only what has changed is built again.
cmake --preset runtime-only --no-warn-unused-cli -S "$source" -B "$folder/build" -DCMAKE_EXPORT_COMPILE_COMMANDS=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON \
  >"$folder/configure.txt"
cmake --build "$folder/build" >"$folder/build.txt"
cmake --install "$folder/build" --component runtime --prefix "$folder/installed" \
  >"$folder/install.txt"

runtime=$(find "$folder/installed" -name 'libosgSkin.so.*' -type f)
rig=$(find "$folder/installed" -name 'libosgSkinRig.so.*' -type f)
serializers=$(find "$folder/installed" -name osgdb_serializers_osgskin.so)
[ "$(find "$folder/installed" -type f | wc -l)" -eq 3 ] || fail "more than the three libraries is installed"
for file in "$runtime" "$rig" "$serializers" "$build"/lib/libosgSkin.so "$build"/lib/libosgSkinRig.so \
  "$build"/lib/osgPlugins-*/osgdb_serializers_osgskin.so; do
  needed=$(readelf -d "$file" | grep NEEDED)
  case $file in *serializers*) ;; *) grep -q libosgDB.so <<<"$needed" && fail "$file needs osgDB" ;; esac
  grep -qiE 'cgal|gmp|mpfr|assimp|osgSkin(Bind|Import|Character)' <<<"$needed" && fail "$file needs $needed"
done
echo "No library names CGAL, GMP, MPFR or Assimp"

for extension in osgb osgt osgx; do
  saved="$folder/thrower.$extension"
  rm -f "$saved"
  OSG_LIBRARY_PATH="$build/lib" osgconv "$source/data/thrower.skin" "$saved" >/dev/null
  echo "thrower.$extension"
  env -u LD_LIBRARY_PATH OSG_LIBRARY_PATH="$(dirname "$runtime")" \
    "$source/tests/system/viewer.sh" "$saved" "$folder/play/$extension"
done
