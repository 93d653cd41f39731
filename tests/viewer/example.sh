#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# example.sh PROGRAM DATA FOLDER: presses every key of osgskinviewer, and looks for what each one does
# in the pictures or in what the program says of them. Needs a display.
set -euo pipefail
program=$1 data=$2 folder=$3
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

# First the line of text goes: whatever differs from then on is in the scene.
seen='i23gbtjJk1wxxwkth.,><0m'
said='r-+ '
"$program" "$folder/two.skin" --motion throw --joint LeftHand --at 1.1 --paused \
  --width 320 --height 280 --keys "$seen$said" \
  --pictures "$folder" >"$folder/says.txt"
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
grep -q "x-1" "$folder/says.txt" || fail "r does not turn the time round"

"$program" --pictures "$folder" --keys '?' 2>"$folder/error.txt" && fail "an unknown key was taken"
grep -q "no key '?'" "$folder/error.txt" || fail "an unknown key is not named"
"$program" --motion none --pictures "$folder" 2>"$folder/error.txt" && fail "an unknown motion"
grep -q 'expected a motion called "none"' "$folder/error.txt" || fail "the motion is not named"
"$program" --help | grep -q 'space  play, pause' || fail "--help does not list the keys"
echo "Every key does what it is for"
