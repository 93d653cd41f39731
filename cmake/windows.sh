#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# windows.sh FOLDER [CTEST ARGUMENT...]: builds what is under the MIT licence for Windows with Debian's MinGW-w64,
# and runs the unit tests under wine. Libraries are built from Debian's source packages. FOLDER (5 GB) keeps
# everything: a second run builds only what has changed.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$osgskin_root/cmake/setup.sh"
osgskin_install g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine64 cmake ninja-build pkg-config dpkg-dev \
  libglm-dev nlohmann-json3-dev libstb-dev libcli11-dev libutfcpp-dev assimp-testmodels

mkdir -p "$1"/{source,build,lists/partial,prefix/{bin,include,share}}
folder=$(cd "$1" && pwd)
shift
prefix=$folder/prefix
export PKG_CONFIG_LIBDIR=$prefix/lib/pkgconfig # not this machine's
export WINEPREFIX=$folder/wine WINEDEBUG=-all WINEPATH="Z:${prefix//\//\\}\\bin"

# Libraries of headers alone, and DLLs of the compiler.
cp -r /usr/include/{glm,nlohmann,stb,CLI,utf8,utf8.h} "$prefix/include"
cp -r /usr/share/cmake "$prefix/share"
cp /usr/lib/gcc/x86_64-w64-mingw32/*-posix/lib{stdc++-6,gcc_s_seh-1}.dll \
  /usr/x86_64-w64-mingw32/lib/{libwinpthread-1,zlib1}.dll "$prefix/bin"

# osgskin_source PACKAGE: unpacks a source package. The list of sources is FOLDER's own.
osgskin_source() {
  [ ! -d "$folder/source/$1" ] || return 0
  local apt=(-o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o Dir::State::Lists="$folder/lists" -o APT::Sandbox::User=root -qq)
  if [ ! -e "$folder/sources.list" ]; then
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg]" \
      "http://deb.debian.org/debian bookworm main" >"$folder/sources.list"
    apt-get "${apt[@]}" update
  fi
  (cd "$folder/source" && apt-get "${apt[@]}" source "$1" >"$1.log" && mv "$1"-*/ "$1")
}

# osgskin_cross NAME SOURCE OPTION...: configures and builds the targets, and shows how far it is.
osgskin_cross() {
  local build=$folder/build/$1 log=$folder/build/$1.log
  echo "Building $1"
  cmake -S "$2" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$osgskin_root/cmake/mingw.cmake" \
    -DCMAKE_FIND_ROOT_PATH="$prefix" -DCMAKE_INSTALL_PREFIX="$prefix" "${@:3}" >"$log" 2>&1 &&
    NINJA_STATUS='at %p after %e s: ' cmake --build "$build" --target "${targets[@]}" 2>&1 |
    tee -a "$log" | osgskin_progress || {
    grep -m 20 -A 5 -E 'error|FAILED' "$log" >&2
    echo "The build failed; all of it is in $log" >&2
    exit 1
  }
}

# osgskin_library PACKAGE OPTION...: builds and installs a library once, or the parts of it in `parts`.
osgskin_library() {
  local name=$1
  shift
  [ ! -e "$folder/build/$name.installed" ] || return 0
  osgskin_cross "$name" "$folder/source/$name" "$@"
  local part
  for part in "${parts[@]}"; do
    cmake --install "$folder/build/$name/$part" >>"$folder/build/$name.log"
  done
  touch "$folder/build/$name.installed"
}

for package in googletest highway meshoptimizer onetbb draco minizip assimp openscenegraph; do
  osgskin_source "$package"
done
targets=(all) parts=(.)
osgskin_library googletest -DBUILD_GMOCK=OFF
osgskin_library highway -DBUILD_TESTING=OFF -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_CONTRIB=OFF
osgskin_library meshoptimizer
osgskin_library onetbb -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_ENABLE_IPO=OFF
osgskin_library draco
# Debian's Assimp has no minizip of its own, and its minizip is not for Windows. IFC takes longest to build.
mkdir -p "$folder/source/assimp/contrib/unzip"
(cd "$folder/source/minizip" && cp crypt.h ioapi.[ch] unzip.[ch] ../assimp/contrib/unzip)
touch "$folder/source/assimp/contrib/unzip/crypt.c"
osgskin_library assimp -DASSIMP_NO_EXPORT=ON -DASSIMP_BUILD_TESTS=OFF -DASSIMP_BUILD_ASSIMP_TOOLS=OFF \
  -DASSIMP_WARNINGS_AS_ERRORS=OFF -DASSIMP_INSTALL_PDB=OFF -DASSIMP_BUILD_{IFC,STEP}_IMPORTER=OFF
# C++14, because windows.h has a byte beside std::byte.
libraries=(OpenThreads osg osgUtil osgDB osgText osgGA osgViewer osgAnimation osgShadow)
targets=("${libraries[@]}" osgdb_osg osgdb_serializers_{osg,osganimation})
parts=("${libraries[@]/#/src/}" src/osgPlugins/osg src/osgWrappers/serializers/{osg,osgAnimation})
osgskin_library openscenegraph -DBUILD_OSG_APPLICATIONS=OFF -DBUILD_OSG_PLUGINS_BY_DEFAULT=OFF \
  -DBUILD_OSG_PLUGIN_OSG=ON -DOSG_DETERMINE_WIN_VERSION=OFF -DCMAKE_CXX_STANDARD=14 -DCMAKE_CXX_FLAGS=-w

targets=(all quick_tests)
osgskin_cross osgskin "$osgskin_root" -DOSGSKIN_BINDER=OFF -DOSGSKIN_UNITY=ON -DOSGSKIN_WERROR=ON
ctest --test-dir "$folder/build/osgskin" --no-tests=error -j "$(nproc)" -L quick -E _NOT_BUILT "$@"
