#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run_sumo.sh WALKER FOLDER: runs sumo-gui's 3D view with three people on a pavement, who stand, go at
# 0.7 m/s and at 1.4 m/s, each with a link to the walker's file. Needs Debian's packages sumo,
# imagemagick and xvfb, and no window. Writes to FOLDER alone: the scenario, sumo.log, and a picture of
# the screen each half second (0.png to 9.png).
set -euo pipefail
[ $# = 2 ] || { sed -n '3,6s/^# \?//p' "$0" >&2; exit 2; }
fail() { echo "run_sumo.sh: $*" >&2; exit 1; }
here=$(dirname "$(realpath "$0")")
[ -f "$1" ] || fail "$1: no such file, expected one that osgskinbake --faces -y --walker wrote"
walker=$(realpath "$1")
for program in sumo-gui netconvert import convert; do
  command -v "$program" >/dev/null || fail "no $program here, expected Debian's sumo and imagemagick"
done
export OSG_LIBRARY_PATH=${OSG_LIBRARY_PATH:-$(realpath "$here/../../build/release/lib")}
mkdir -p "$2" && cd "$2"
for person in stands strolls walks; do ln -sf "$walker" "$person.osgb"; done

cat >street.nod.xml <<END
<nodes><node id="west" x="0" y="0"/><node id="east" x="60" y="0"/></nodes>
END
cat >street.edg.xml <<END
<edges><edge id="street" from="west" to="east" numLanes="1" speed="13" sidewalkWidth="2"/></edges>
END
netconvert -n street.nod.xml -e street.edg.xml -o street.net.xml >netconvert.log 2>&1 ||
  { cat netconvert.log; fail "netconvert ends with an error"; }

type() { # NAME SPEED: a type has a file of its own, since sumo-gui loads each file once for all people
  echo "<vType id=\"$1\" vClass=\"pedestrian\" osgFile=\"$PWD/$1.osgb\" length=\"0.39\" width=\"0.57\"" \
    "height=\"1.81\" maxSpeed=\"$2\" speedFactor=\"1\"/>"
}
person() { # TYPE POSITION PLAN
  echo "<person id=\"$1\" type=\"$1\" depart=\"0\" departPos=\"$2\">$3</person>"
}
cat >people.rou.xml <<END
<routes>
$(type stands 1.4; type strolls 0.7; type walks 1.4)
$(person stands 7 '<stop lane="street_0" endPos="7" duration="60"/>')
$(person strolls 4 '<walk edges="street" arrivalPos="55"/>')
$(person walks 1 '<walk edges="street" arrivalPos="55"/>')
</routes>
END
cat >view.xml <<END
<viewsettings>
  <viewport x="7" y="-14" z="1.6" centerX="7" centerY="-5" centerZ="1" angle="0" zoom="100"/>
</viewsettings>
END

take() { # sumo-gui on this display, and pictures of it
  sumo-gui -n street.net.xml -r people.rou.xml -g view.xml --step-length 0.05 --delay 1000 \
    --osg-view --start --window-size 1200,900 >sumo.log 2>&1 &
  local gui=$!
  for _ in {1..120}; do # until the view has drawn its sky
    sleep 0.5
    import -window root 0.png
    [ "$(convert 0.png -format '%[hex:p{640,400}]' info:)" = 000000 ] || break
  done
  for picture in 0 1 2 3 4 5 6 7 8 9; do
    sleep 0.5
    import -window root "$picture.png"
    kill -0 $gui 2>/dev/null || { cat sumo.log; fail "sumo-gui has ended, see sumo.log"; }
  done
  kill $gui
}
export -f take fail
"$here/../../cmake/with_display.sh" 1280x1024 bash -ec take
echo "10 pictures in $PWD"
