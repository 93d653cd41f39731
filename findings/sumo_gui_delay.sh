#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# SUMO 1.15.0, sumo-gui: --delay is, by its help, "FLOAT in ms as delay between simulation steps", and
# so reads the window's field. With steps of 0.1 s it waits a tenth of that: the delay is for a
# second of simulation. 1000 is real time at any step length. Needs Debian's sumo and Xvfb.
. "$(dirname "$0")/common.sh"
debian_package sumo 1.15.0+dfsg-1+deb12u1
cat >street.nod.xml <<'END'
<nodes><node id="a" x="0" y="0"/><node id="b" x="50" y="0"/></nodes>
END
cat >street.edg.xml <<'END'
<edges><edge id="ab" from="a" to="b"/></edges>
END
netconvert -n street.nod.xml -e street.edg.xml -o street.net.xml >/dev/null 2>&1

run() { # STEP-LENGTH END: milliseconds
  local begin
  begin=$(date +%s%N)
  sumo-gui -n street.net.xml --step-length "$1" --end "$2" --delay 200 --start -Q >/dev/null 2>&1
  echo $((($(date +%s%N) - begin) / 1000000))
}
export -f run
display() { "$here/../cmake/with_display.sh" 800x600 bash -c "run $*"; }
step() { # STEP-LENGTH END-OF-5-STEPS END-OF-25-STEPS
  local each=$((($(display "$1" "$3") - $(display "$1" "$2")) / 20))
  if [ $each -gt 140 ] && [ $each -lt 280 ]; then each=200; fi
  if [ $each -gt 5 ] && [ $each -lt 60 ]; then each=20; fi
  echo "steps of $1 s, --delay 200: about $each ms a step"
}
{ step 1 5 25 && step 0.1 0.5 2.5; } >seen
expect <<'END'
steps of 1 s, --delay 200: about 200 ms a step
steps of 0.1 s, --delay 200: about 20 ms a step
END
