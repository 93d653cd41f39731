#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# example.sh PROGRAM DATA FOLDER CYCLES RIG: presses every key of osgskinviewer, and checks its
# effect in the pictures or in the program's output; then shows a character saved by CYCLES
# (osgskin_cycles), the rigged model RIG, and a figure whose origin is not at its feet. Needs a
# display.
set -euo pipefail
program=$1 data=$2 folder=$3 cycles=$4 rig=$5
fail() {
  echo "FAILED: $1"
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder"
cat >"$folder/two.skin" <<END
{ "osgskin": 1, "mesh": "$data/thrower.obj", "skeleton": "$data/thrower.bvh", "motions": [
  { "file": "$data/throw.bvh", "name": "throw" },
  { "file": "$data/throw.bvh", "name": "late throw", "skipFrames": 150 } ] }
END

# First the line of text is hidden: every later difference is in the scene.
seen='in234gbtjJk1uwxxccwkth.,><0m'
said='r-+ '
"$program" "$folder/two.skin" --motion throw --joint LeftHand --at 1.1 --paused \
  --shapes fast --muscles on --window 0 0 320 280 --keys "$seen$said" \
  --out "$folder" >"$folder/says.txt"
keys="$seen$said"
[ "$(wc -l <"$folder/says.txt")" -eq $((${#keys} + 1)) ] || fail "a picture is missing"

picture() { printf '%s/viewer_%02d.png' "$folder" "$1"; }
for ((i = 1; i <= ${#seen}; ++i)); do
  changed=$(compare -metric AE -fuzz 3% "$(picture $((i - 1)))" "$(picture "$i")" null: 2>&1 || true)
  [ "${changed%.*}" -gt 5 ] || fail "key ${seen:i-1:1} changes $changed pixels of picture $i"
done
line() { sed -n "$(($1 + 1))p" "$folder/says.txt" | sed "s/.*: \('.' \)\?//"; }
for ((i = ${#seen} + 1; i <= ${#keys}; ++i)); do
  [ "$(line $((i - 1)))" != "$(line "$i")" ] || fail "key '${keys:i-1:1}' changes nothing"
done
grep -q "'m' late throw 0.00" "$folder/says.txt" || fail "m does not go to the next motion"
grep -q "osgSkin without shapes" "$folder/says.txt" || fail "4 does not take the shapes off"
grep -q "'u' .*muscles tensed" "$folder/says.txt" || fail "u does not tense muscles"
grep -q "'n' .*normals rotated" "$folder/says.txt" || fail "n does not turn normals"
grep -q "x-1" "$folder/says.txt" || fail "r does not turn the time round"

"$program" --out "$folder" --keys '?' 2>"$folder/error.txt" && fail "an unknown key was taken"
grep -q "no key '?'" "$folder/error.txt" || fail "an unknown key is not named"
"$program" --motion none --out "$folder" 2>"$folder/error.txt" && fail "an unknown motion"
grep -q 'no motion is called "none"' "$folder/error.txt" || fail "the motion is not named"
for at in nan inf 1e308; do
  "$program" --at "$at" --out "$folder" 2>"$folder/error.txt" && fail "--at $at was taken"
  grep -q "expected at most a million seconds" "$folder/error.txt" || fail "--at $at is not named"
done
"$program" --help | grep -q 'space  play, pause' || fail "--help does not list the keys"

# Any character is accepted: a rigged model with its own name or the pseudo-loader's, a saved scene.
"$cycles" "$data/thrower.skin" "$folder/saved.osgb" 1 1 >/dev/null || fail "no scene is saved"
for file in "$rig" "$rig.skin" "$folder/saved.osgb"; do
  mkdir -p "$folder/any"
  "$program" "$file" --keys k --window 0 0 320 280 --out "$folder/any" \
    >"$folder/any.txt" 2>"$folder/error.txt" || fail "$file is refused: $(cat "$folder/error.txt")"
  colours=$(identify -format %k "$folder/any/viewer_00.png")
  [ "$colours" -gt 50 ] || fail "$file: $colours colours, no figure"
  changed=$(compare -metric AE -fuzz 3% "$folder"/any/viewer_0[01].png null: 2>&1 || true)
  [ "${changed%.*}" -gt 5 ] || fail "$file has no skeleton to see"
done
"$program" "$folder/saved.osgb" --keys 2g --out "$folder/any" >"$folder/any.txt"
grep -q "blending\|regions" "$folder/any.txt" && fail "a scene's mesh is gone, yet a peer deforms it"
"$program" "$data/thrower.obj" --out "$folder/any" 2>"$folder/error.txt" && fail "a plain mesh"
grep -q 'thrower.obj: no mesh with bones' "$folder/error.txt" || fail "a plain mesh is not named"

# The floor is under the feet, wherever the files' origin is: the picture stays the same.
awk '$1 == "v" { $3 -= 0.9 } { print }' "$data/thrower.obj" >"$folder/low.obj"
awk '$1 == "OFFSET" && !done { $3 -= 0.9; done = 1 } { print }' "$data/thrower.bvh" >"$folder/low.bvh"
echo '{ "osgskin": 1, "mesh": "low.obj", "skeleton": "low.bvh" }' >"$folder/low.skin"
echo "{ \"osgskin\": 1, \"mesh\": \"$data/thrower.obj\", \"skeleton\": \"$data/thrower.bvh\" }" \
  >"$folder/feet.skin"
for name in low feet; do
  "$program" "$folder/$name.skin" --keys i --window 0 0 320 280 --out "$folder/$name" >/dev/null
done
changed=$(compare -metric AE -fuzz 3% "$folder"/{low,feet}/viewer_01.png null: 2>&1 || true)
[ "${changed%.*}" -lt 200 ] || fail "the floor is elsewhere where the origin is: $changed pixels"

# The camera frames the figure, wherever a ball flies: wireframe changes many pixels in the middle.
mkdir -p "$folder/home"
"$program" --paused --keys iw --window 0 0 320 280 --out "$folder/home" >/dev/null
read -r width height x y < <(convert "$folder"/home/viewer_0[12].png -compose difference -composite \
  -colorspace gray -threshold 3% -trim -format '%w %h %X %Y\n' info: | tr -d +)
[ "$height" -ge 150 ] && [ "$y" -gt 0 ] && [ $((y + height)) -lt 280 ] || fail "$height pixels of 280 tall at $y"
[ "$x" -gt 40 ] && [ $((x + width)) -lt 280 ] || fail "the figure is at $x, $width pixels wide, of 320"

# A paused skin takes no time, and never a negative one.
"$program" --paused --times --keys iiii --window 0 0 320 280 --out "$folder" >"$folder/times.txt"
grep -c 'the skin [0-9.]* ms$' "$folder/times.txt" | grep -qx 5 || fail "times: $(cat "$folder/times.txt")"
echo "Every key does what it is for, every character is shown, and stands on its floor"
