#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# static.sh BUILD SOURCE FOLDER: builds all that is under the MIT licence as archives (preset static),
# installs them, and builds a program against them by CMake and by pkg-config, with the shared
# OpenSceneGraph of this machine. Without any plug-in on its path it reads a walker, a saved and a
# painted character, and deforms and draws them exactly as the same program does with BUILD's shared
# libraries. A second run in FOLDER compiles only what has changed.
set -euo pipefail
build=$1 source=$2 folder=$3
fail() {
  echo "FAILED: $1"
  exit 1
}

mkdir -p "$folder"
find "$folder" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
unset LD_LIBRARY_PATH OSG_LIBRARY_PATH
cmake --preset static -S "$source" -B "$folder/build" >"$folder/configure.txt"
# One target builds all that its macro names, USE_OSGSKIN_SERIALIZERS() here.
cmake --build "$folder/build" --target osgdb_serializers_osgskin >"$folder/build.txt" || fail "the serializers' static build"
[ -n "$(find "$folder/build" -name 'libosgdb_serializers_osgskinmotion.a')" ] ||
  fail "the target osgdb_serializers_osgskin does not build the serializers of walkers"
cmake --build "$folder/build" >"$folder/build.txt" || { tail -n 20 "$folder/build.txt"; fail "the static build"; }
cmake --install "$folder/build" --prefix "$folder/static" >"$folder/install.txt"
cmake --install "$build" --prefix "$folder/shared" >>"$folder/install.txt"
[ -e "$folder/static/share/doc/osgSkin/LICENSES/NOTICES.txt" ] || fail "the static tree holds no notices"
find "$folder/static" -name '*.so*' | grep . && fail "the static tree holds shared libraries"

for kind in static shared; do
  cmake -S "$source/tests/downstream/static" -B "$folder/$kind-project" -DCMAKE_PREFIX_PATH="$folder/$kind" \
    >"$folder/configure.txt"
  cmake --build "$folder/$kind-project" >"$folder/build.txt"
done
lib=$(dirname "$(find "$folder/static" -name libosgSkin.a)")
# shellcheck disable=SC2046 # options, one per word
PKG_CONFIG_PATH="$lib/pkgconfig" c++ -std=c++17 "$source/tests/downstream/static/main.cpp" -o "$folder/by-pkg-config" \
  $(PKG_CONFIG_PATH="$lib/pkgconfig" pkg-config --cflags --libs osgdb_skin openscenegraph-osgViewer)

shared=$(dirname "$(find "$folder/shared" -name libosgSkin.so)")
(
  export OSG_LIBRARY_PATH=$shared
  osgconv "$source/data/thrower.skin" "$folder/thrower.osgb"
  "$folder/shared/bin/osgskinbake" "$source/data/pedestrian.skin" --walker "$folder/walker.osgb"
) >"$folder/convert.txt"
files=("$folder/walker.osgb" "$folder/thrower.osgb" "$source/tests/data/rig/tube.gltf.skin")
play() { # PROGRAM: prints what it plays
  "$source/cmake/with_display.sh" 640x480 "$1" "${files[@]}" || fail "$1 does not play all files"
}
OSG_LIBRARY_PATH=$shared play "$folder/shared-project/play" >"$folder/expected.txt"
for program in static-project/play by-pkg-config; do
  ldd "$folder/$program" | grep -i osgskin && fail "$program needs a shared library of osgSkin"
  play "$folder/$program" >"$folder/found.txt"
  cmp "$folder/expected.txt" "$folder/found.txt" || fail "$program deforms or draws otherwise"
done
"$folder/static-project/play" "$source/data/thrower.skin" >"$folder/found.txt" 2>"$folder/refused.txt" &&
  fail "a skin without painted weights loads without the binder"
grep -q osgskin-binder "$folder/refused.txt" || fail "its error does not name the binder"
echo "The same $(grep -c ' ' "$folder/expected.txt") vertices and the same pixels"
