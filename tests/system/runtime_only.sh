#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# runtime_only.sh BUILD SOURCE FOLDER: configures the runtime, the rig, motion and GPU kits and the
# serializers with CGAL and Assimp hidden, and installs those of BUILD alone. They must not link
# either library. osgSkin and its serializers alone play a character saved by BUILD's .skin plug-in.
# A game that links only the motion kit, and so the rig kit, retargets a motion and plays it.
set -euo pipefail
build=$1 source=$2 folder=$3
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder"
cmake --preset runtime-only --no-warn-unused-cli -S "$source" -B "$folder/build" \
  -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON \
  >"$folder/configure.txt"
for component in runtime serializers; do
  cmake --install "$build" --component $component --prefix "$folder/installed" >>"$folder/install.txt"
done

runtime=$(find "$folder/installed" -name 'libosgSkin.so.*' -type f)
rig=$(find "$folder/installed" -name 'libosgSkinRig.so.*' -type f)
motion=$(find "$folder/installed" -name 'libosgSkinMotion.so.*' -type f)
gpu=$(find "$folder/installed" -name 'libosgSkinGpu.so.*' -type f)
serializers=$(find "$folder/installed" -name osgdb_serializers_osgskin.so)
walkers=$(find "$folder/installed" -name osgdb_serializers_osgskinmotion.so)
[ "$(find "$folder/installed" -type f ! -path '*/share/doc/*' | wc -l)" -eq 6 ] || fail "more than the six libraries is installed"
for file in "$runtime" "$rig" "$motion" "$gpu" "$serializers" "$walkers" "$build"/lib/libosgSkin.so "$build"/lib/libosgSkinRig.so \
  "$build"/lib/osgPlugins-*/osgdb_serializers_osgskin.so; do
  needed=$(readelf -d "$file" | grep NEEDED)
  case $file in *serializers*) ;; *) grep -q libosgDB.so <<<"$needed" && fail "$file needs osgDB" ;; esac
  grep -qiE 'cgal|gmp|mpfr|assimp|osgSkin(Bind|Import|Character)' <<<"$needed" && fail "$file needs $needed"
done
echo "No library names CGAL, GMP, MPFR or Assimp"

# A saved character that stays on the processor needs one of the kits.
rm "$rig" "$motion" "$gpu" "$walkers"
for extension in osgb osgt osgx; do
  saved="$folder/thrower.$extension"
  rm -f "$saved"
  OSG_LIBRARY_PATH="$build/lib" osgconv "$source/data/thrower.skin" "$saved" >/dev/null
  echo "thrower.$extension"
  env -u LD_LIBRARY_PATH OSG_LIBRARY_PATH="$(dirname "$runtime")" \
    "$source/tests/system/viewer.sh" "$saved" "$folder/play/$extension"
done

echo "A game that links osgSkinMotion alone"
for component in runtime dev; do
  cmake --install "$build" --component $component --prefix "$folder/development" >>"$folder/install.txt"
done
cmake -S "$source/tests/downstream/game" -B "$folder/game" \
  -DCMAKE_PREFIX_PATH="$folder/development" -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON >"$folder/game.txt"
cmake --build "$folder/game" >>"$folder/game.txt"
readelf -d "$folder/game/game" | grep NEEDED | grep -iE 'cgal|gmp|mpfr|assimp|osgDB|osgSkin(Bind|Import|Character)' &&
  fail "the game needs more than the runtime"
env -u LD_LIBRARY_PATH "$folder/game/game"
