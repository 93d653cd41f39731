#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# with_display.sh WIDTHxHEIGHT COMMAND...: runs COMMAND on a separate X display, and exits with its
# exit status. Xvfb chooses the display number and reports when it is ready, so several of these can
# start at the same time.
set -euo pipefail
size=$1
shift

work=$(mktemp -d)
stop() {
  if [ -n "${server:-}" ]; then
    kill "$server" 2>/dev/null || true
    wait "$server" 2>/dev/null || true
  fi
  rm -rf "$work"
}
trap stop EXIT

mkfifo "$work/number"
exec 3<>"$work/number"
Xvfb -displayfd 3 -screen 0 "${size}x24" -nolisten tcp -noreset >"$work/log" 2>&1 &
server=$!
if ! read -r -t 60 number <&3; then
  cat "$work/log" >&2
  echo "with_display.sh: Xvfb did not start" >&2
  exit 1
fi
exec 3>&-
DISPLAY=:$number "$@"
