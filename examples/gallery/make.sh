#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# make.sh [BUILD]: draws the moving pictures of the gallery and the picture of the tutorial into
# examples/pictures/gallery, through Xvfb, with the programs of BUILD (build/release). Takes two minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=$(realpath "${1:-build/release}")
if [ -z "${OSGSKIN_GALLERY:-}" ]; then
  OSGSKIN_GALLERY=1 OSG_LIBRARY_PATH="$build/lib" exec cmake/with_display.sh 1600x1600 "$0" "$build"
fi

bin=$build/bin out=$PWD/examples/pictures/gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out" "$work"/{throw,crowd,street,face,fit,osgskin,linear,dual,muscles}

# moving NAME DELAY PICTURE...: a loop of pictures, DELAY hundredths of a second each.
moving() {
  convert -delay "$2" -loop 0 "${@:3}" -resize "${SIZE:-240x180}" -quality 75 "$out/$1.webp"
  echo "examples/pictures/gallery/$1.webp: $(stat -c %s "$out/$1.webp") bytes"
}
# A part of each picture in a folder: cut FOLDER WIDTHxHEIGHT+X+Y
cut() { mogrify -crop "$2" +repage "$work/$1"/viewer_*.png; }
# The steps of osgskinviewer are pictures of their own.
view() { "$bin/osgskinviewer" "${@:2}" --paused --out "$work/$1" >"$work/$1/log.txt"; }

"$bin/osgskinthrow" --out "$work/throw" --frames 43:202:5 --window 0 0 640 480 >"$work/log.txt"
mogrify -crop 480x360+40+40 +repage "$work"/throw/*.png
moving throw 8 "$work"/throw/*.png

"$bin/osgskinrecipes" makeFace --characters "$work" --out "$work/face" >"$work/log.txt" 2>&1
rm "$work/face/makeFace.png"
view face "$work/face.osgb" --keys 'i]]]][[[' --window 0 0 1600 1600
cut face 188x141+706+166
moving face 16 "$work"/face/viewer_0[1-8].png

# A crowd of COUNT, in two clips: crowd NAME COUNT
crowd() {
  "$bin/osgskincrowd" "$work/walker.skin" --gpu --count "$2" --out "$work/crowd" --frames 0:59:6 \
    --window 0 0 480 360 >"$work/log.txt"
  moving "$1" 10 "$work"/crowd/*.png
}
crowd crowd 300
crowd crowd10000 10000

"$bin/osgskincrowd" --street 2000 --out "$work/street" --frames 60:117:6 --window 0 0 640 360 >"$work/log.txt"
SIZE=640x360 moving street 10 "$work"/street/*.png

# Both forearms bend by 110 degrees and straighten again.
python3 - data/throw.bvh "$work/flex.bvh" <<'PYTHON'
import math, re, sys
head = open(sys.argv[1]).read().split("MOTION")[0]
joints = re.findall(r"(?:ROOT|JOINT) (\S+)", head)
with open(sys.argv[2], "w") as out:
    out.write(head + "MOTION\nFrames: 30\nFrame Time: 0.0333333\n")
    for frame in range(30):
        bend = 55 * (1 - math.cos(2 * math.pi * frame / 30))
        first = {"LeftArm": 40, "LeftForeArm": bend, "RightArm": -40, "RightForeArm": -bend}
        out.write("0 0.97 0 " + " ".join(f"{first.get(joint, 0)} 0 0" for joint in joints) + "\n")
PYTHON
cat >"$work/flex.skin" <<SKIN
{ "osgskin": 1, "mesh": "$PWD/data/thrower.obj", "skeleton": "$PWD/data/thrower.bvh",
  "motions": [ { "file": "flex.bvh", "name": "flex" } ] }
SKIN
steps=$(printf '.%.0s' {1..30})
for method in osgskin:i1 linear:i2 dual:i3 muscles:iu; do
  name=${method%:*}
  view "$name" "$work/flex.skin" --muscles "$([ "$name" = muscles ] && echo on || echo off)" \
    --keys "${method#*:}$steps" --window 0 0 900 900
  cut "$name" 220x330+500+70
done
# The same steps of several methods side by side: beside METHOD...
beside() {
  for step in {03..31..2}; do
    convert "${@/%//viewer_$step.png}" +append +repage "beside_$step.png"
  done
}
(cd "$work" && beside osgskin muscles)
moving muscles 7 "$work"/beside_*.png
(cd "$work" && beside osgskin linear dual)
moving methods 7 "$work"/beside_*.png

echo "{ \"osgskin\": 1, \"mesh\": \"$PWD/data/thrower.obj\", \"skeleton\": { \"fit\": true } }" >"$work/fit.skin"
view fit "$work/fit.skin" --keys ikkg --window 0 0 900 900
cut fit 700x800+100+50
convert "$work"/fit/viewer_0[124].png +append -resize 480x -quality 75 "$out/fit.webp"
