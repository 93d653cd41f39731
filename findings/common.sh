# SPDX-License-Identifier: MIT
# For the findings: a temporary folder, pinned packages, and the comparison of what is seen.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# npm_packages NAME@VERSION...: installs them here, without their install scripts.
npm_packages() {
  echo '{ "type": "module" }' >package.json
  npm install --ignore-scripts --no-audit --no-fund --silent "$@"
  cp "$here/bar.mjs" .
  printf '%s\n' "$@"
}

# debian_package NAME VERSION: the installed package, or its files under $work/debian.
debian_package() {
  if [ "$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null)" != "$2" ]; then
    (mkdir -p debian && cd debian && apt-get download "$1=$2" >/dev/null 2>&1 && dpkg -x ./*.deb .) ||
      { echo "$1 $2 cannot be had here" >&2; exit 2; }
    PATH=$work/debian/usr/bin:$PATH
  fi
  echo "$1 $2"
}

# expect: compares the file "seen" with standard input; fails where the behaviour has changed.
expect() {
  cat seen
  diff -u - seen >difference || { echo "CHANGED:" && cat difference && exit 1; }
  echo "as written down"
}
