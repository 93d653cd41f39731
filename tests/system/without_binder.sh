#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# without_binder.sh BUILD SOURCE FOLDER: installs all of BUILD but the binder, the only part under the
# GPL. Characters with painted weights load and play as they do with it, in processes that load no
# library under the GPL; a mesh without them is refused with the name of the package. The binder is
# then installed beside, and used.
set -euo pipefail
build=$1 source=$2 folder=$3
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder"
for component in runtime serializers import bind plugin programs; do
  cmake --install "$build" --component $component --prefix "$folder/installed" >>"$folder/install.txt"
done
find "$folder/installed" -name '*binder*' | grep . && fail "another component holds the binder"
cmake --preset mit --no-warn-unused-cli -S "$source" -B "$folder/build" -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON >"$folder/configure.txt"
unset LD_LIBRARY_PATH
lib=$(dirname "$(find "$folder/installed" -name 'libosgSkin.so.*' -type f)")
export OSG_LIBRARY_PATH="$lib"

# traced COMMAND...: runs it, and lists the libraries that its process loads in $folder/loaded.
traced() {
  rm -f "$folder"/loaded*
  LD_DEBUG=files LD_DEBUG_OUTPUT="$folder/loaded" "$@" || return
  cat "$folder"/loaded.* | sed -n 's/.*calling init: //p' >"$folder/loaded"
  grep -q libosgSkinCharacter "$folder/loaded" || fail "the list of loaded libraries is not whole"
}
gpl='osgdb_binder|CGAL|libgmp|libmpfr'

# A VRM file is a GLB file with its own extension.
/usr/bin/env python3 - "$source/tests/data/rig/tube.gltf" "$folder/tube.vrm" <<'CODE'
import base64, json, struct, sys
model = json.load(open(sys.argv[1]))
data = base64.b64decode(model["buffers"][0].pop("uri").split(",")[1])
model["extensionsUsed"] = ["VRMC_vrm"]
model["extensions"] = {"VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": {}}}}
text = json.dumps(model).encode()
text += b" " * (-len(text) % 4)
data += b"\0" * (-len(data) % 4)
chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
open(sys.argv[2], "wb").write(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
CODE

# An FBX file with weights, and a motion for its two joints.
cat >"$folder/bend.bvh" <<'BVH'
HIERARCHY
ROOT low
{
 OFFSET 0 0 0
 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
 JOINT high
 {
  OFFSET 0 1 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  End Site
  {
   OFFSET 0 1 0
  }
 }
}
MOTION
Frames: 6
Frame Time: 0.1
BVH
for degrees in 0 10 20 30 40 50; do echo "0 0 0 0 0 0 $degrees 0 0"; done >>"$folder/bend.bvh"
echo '{"osgskin": 1, "mesh": "'"$source"'/tests/data/rig/strip_binary.fbx", "motions": [{"file": "bend.bvh"}]}' \
  >"$folder/strip.skin"

for model in "$source/tests/data/rig/tube.gltf" "$folder/tube.vrm" "$folder/strip.skin"; do
  name=$(basename "$model")
  traced "$folder/installed/bin/osgskinbake" "$model" --quiet --out "$folder/$name.%d.obj"
  grep -E "$gpl" "$folder/loaded" && fail "loading $name loads a library under the GPL"
  cmp -s "$folder/$name.0.obj" "$folder/$name.5.obj" && fail "$name does not move"
  "$build/bin/osgskinbake" "$model" --quiet --out "$folder/whole.%d.obj"
  cmp <(grep '^v' "$folder/$name.5.obj") <(grep '^v' "$folder/whole.5.obj") || fail "$name differs from the same with the binder"
  traced osgconv "${model%.skin}.skin" "$folder/$name.osgb" >"$folder/convert.txt" 2>&1 || fail "osgconv: $(cat "$folder/convert.txt")"
  grep -E "$gpl" "$folder/loaded" && fail "converting $name loads a library under the GPL"
  echo "$name"
done

refused() {
  "$@" >"$folder/refused.txt" 2>&1 && fail "$* needs no binder"
  grep -q "needs the plug-in osgdb_binder_osgskin (package osgskin-binder), which is not installed" "$folder/refused.txt" ||
    fail "$* does not name the package: $(cat "$folder/refused.txt")"
}
bake="$folder/installed/bin/osgskinbake"
refused "$bake" "$source/data/thrower.skin"
refused "$bake" --bind smooth "$source/tests/data/rig/tube.gltf"
refused "$bake" --shapes fast "$source/tests/data/rig/tube.gltf"
echo '{"osgskin": 1, "mesh": "'"$source"'/data/thrower.obj", "skeleton": {"fit": true}}' >"$folder/fit.skin"
refused "$bake" "$folder/fit.skin"
cat "$folder/refused.txt"

cmake --install "$build" --component binder --prefix "$folder/installed" >>"$folder/install.txt"
traced "$bake" "$source/data/thrower.skin" --quiet --rest "$folder/thrower.obj"
grep -q "$folder/installed/.*/osgdb_binder_osgskin.so" "$folder/loaded" || fail "the installed binder is not used"
env -u OSG_LIBRARY_PATH "$bake" "$source/data/thrower.skin" --quiet --rest "$folder/thrower.obj" ||
  fail "the binder is not found beside the libraries"
echo "With the binder, the thrower loads"
