#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# viewer.sh FILE FOLDER: osgviewer plays FILE in a real window under Xvfb. Two pictures at different
# times must differ, the whole figure must be in view, and the console must stay silent.
set -euo pipefail
file=$1 folder=$2
mkdir -p "$folder"
export file folder

"$(dirname "${BASH_SOURCE[0]}")/../../cmake/with_display.sh" 800x800 bash -c '
  osgviewer --window 0 0 800 800 "$file" >"$folder/console.txt" 2>&1 &
  viewer=$!
  for attempt in $(seq 60); do
    sleep 0.5
    import -window root "$folder/first.png"
    [ "$(identify -format %k "$folder/first.png")" -gt 50 ] && break
  done
  for attempt in $(seq 10); do # a busy machine may draw more slowly
    sleep 0.5
    import -window root "$folder/second.png"
    changed=$(compare -metric AE -fuzz 5% "$folder/first.png" "$folder/second.png" null: 2>&1)
    [ "${changed%.*}" -gt 500 ] && break
  done
  kill "$viewer"
  wait "$viewer" || true
' 2>"$folder/xvfb.txt"

fail() {
  echo "FAILED: $1"
  exit 1
}
[ -s "$folder/console.txt" ] && { cat "$folder/console.txt"; fail "osgviewer wrote to the console"; }
[ "$(identify -format %k "$folder/first.png")" -gt 50 ] || fail "nothing was drawn"
changed=$(compare -metric AE -fuzz 5% "$folder/first.png" "$folder/second.png" null: 2>&1 || true)
[ "${changed%.*}" -gt 500 ] || fail "seconds apart, only $changed pixels differ"
for picture in first second; do
  # Regions that are neither background nor a ball, which may fly out of view, as WxH+X+Y; they must
  # not touch the window's border.
  background=$(convert "$folder/$picture.png" -format '%[pixel:p{0,0}]' info:)
  convert "$folder/$picture.png" -fuzz 5% -fill black -opaque "$background" -fuzz 0 -fill white +opaque black \
    -define connected-components:area-threshold=2000 -define connected-components:mean-color=true \
    -connected-components 8 "$folder/$picture-figure.png"
  box=$(convert "$folder/$picture-figure.png" -trim -format '%w %h %X %Y' info:)
  read -r width height x y <<<"${box//+/}"
  echo "$picture: figure of $width x $height at $x, $y"
  [ "$x" -gt 0 ] && [ "$y" -gt 0 ] && [ $((x + width)) -lt 800 ] && [ $((y + height)) -lt 800 ] ||
    fail "the figure is not wholly in view in $picture.png"
  [ "$height" -gt 250 ] || fail "the figure is only $height pixels tall in $picture.png"
done
echo "The figure moves, is in view, and osgviewer is silent"
