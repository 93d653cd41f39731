#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run.sh BUILD SOURCE FOLDER: installs BUILD, moves the installed tree, and uses it from its new
# location through CMake, pkg-config, osgskinbake and OSG's plug-in search.
set -euo pipefail
build=$1 source=$2 folder=$3
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder/project"
cmake --install "$build" --prefix "$folder/first" >"$folder/install.txt"
mv "$folder/first" "$folder/moved"
prefix="$folder/moved"
lib=$(dirname "$(find "$prefix" -name 'libosgSkin.so')")
unset LD_LIBRARY_PATH

echo "No path of the build or of the first place is left"
grep -rlE "$build|$source|$folder/first" "$prefix" --include='*.cmake' --include='*.pc' &&
  fail "a configuration file names a folder that may be gone"
for file in "$lib"/*.so "$lib"/osgPlugins-*/*.so "$prefix"/bin/*; do
  readelf -d "$file" | grep -E 'R(UN)?PATH' | grep -v '\[\$ORIGIN' && fail "$file has a fixed path"
done

echo "A project of ten lines, by find_package"
sed -n '/\[readme\]/,/\[readme\]/p' "$source/examples/osgskinthrow/ThrowScene.cpp" \
  >"$folder/project/readme.inc"
[ -s "$folder/project/readme.inc" ] || fail "the example's [readme] marks are gone"
cmake -S "$source/tests/downstream" -B "$folder/project" -DCMAKE_PREFIX_PATH="$prefix" \
  >"$folder/configure.txt"
cmake --build "$folder/project" >"$folder/build.txt"
"$folder/project/downstream" "$source/data"

echo "An OpenSceneGraph in its own prefix is linked from there"
found() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
own="$folder/own"
mkdir -p "$own/include" "$own/lib"
cp -rs "$(found OSG_INCLUDE_DIR)"/osg* "$(found OPENTHREADS_INCLUDE_DIR)"/OpenThreads "$own/include"
cp -s "$(dirname "$(found OSG_LIBRARY_RELEASE)")"/lib{osg,OpenThreads}*.so "$own/lib"
cmake -G "Unix Makefiles" -S "$source/tests/downstream/game" -B "$folder/game" \
  -DCMAKE_PREFIX_PATH="$prefix;$own" >"$folder/own.txt"
link=$(cat "$folder/game/CMakeFiles/game.dir/link.txt")
for library in libosgAnimation.so libosg.so libOpenThreads.so; do
  grep -q "$own/lib/$library" <<<"$link" || fail "$library is not linked from $own: $link"
done
grep -q "$own/include" "$folder/game/CMakeFiles/game.dir/flags.make" || fail "its headers are not used"

echo "A component that is none is refused"
sed 's/COMPONENTS osgSkinCharacter)$/COMPONENTS osgSkinNone)/' "$source/tests/downstream/CMakeLists.txt" \
  >"$folder/CMakeLists.txt"
cp "$source/tests/downstream/main.cpp" "$folder"
cmake -S "$folder" -B "$folder/none" -DCMAKE_PREFIX_PATH="$prefix" >"$folder/none.txt" 2>&1 &&
  fail "find_package accepted osgSkinNone"
grep -q "osgSkinNone was not built" "$folder/none.txt" || fail "find_package did not say why"

echo "The runtime, by pkg-config"
cat >"$folder/runtime.cpp" <<'CODE'
#include <osgSkin/DeformableSkin>
int main() { return osg::ref_ptr<osgSkin::DeformableSkin>(new osgSkin::DeformableSkin)->getEager(); }
CODE
export PKG_CONFIG_PATH="$lib/pkgconfig"
for kit in osgSkin osgSkinRig osgSkinMotion osgSkinGpu osgSkinBind osgSkinImport osgSkinCharacter; do pkg-config --print-errors --exists "$kit"; done
# shellcheck disable=SC2046 # options, one per word
c++ -std=c++17 "$folder/runtime.cpp" -o "$folder/runtime" \
  $(pkg-config --cflags --libs osgSkin openscenegraph) -Wl,-rpath,"$lib"
"$folder/runtime"

echo "The programs and plug-ins"
version=$(sed -n 's/^#define OSGSKIN_VERSION "\(.*\)"/\1/p' "$source/nodekits/osgSkin/include/osgSkin/Version")
for program in bake crowd recipes throw viewer; do
  "$prefix/bin/osgskin$program" --help >"$folder/help.txt"
  [ "$("$prefix/bin/osgskin$program" --version)" = "osgskin$program (osgSkin) $version" ] ||
    fail "osgskin$program --version"
done
mv "$prefix/share/osgskin/thrower.skin" "$folder/thrower.skin"
OSG_LIBRARY_PATH="$lib" "$prefix/bin/osgskincrowd" --count 1 --time 1 >"$folder/crowd.txt" 2>&1 &&
  fail "osgskincrowd does not show the installed thrower"
mv "$folder/thrower.skin" "$prefix/share/osgskin"
OSG_LIBRARY_PATH="$lib" "$prefix/bin/osgskincrowd" --count 1 --time 1 >"$folder/crowd.txt"
(cd "$folder" && OSG_LIBRARY_PATH="$lib" osgconv "$source/data/thrower.skin" thrower.osgb)
grep -q osgSkin::DeformableSkin "$folder/thrower.osgb" || fail "the character was not saved"
