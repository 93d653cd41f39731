#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# gltf_validator.sh FOLDER: installs Khronos' glTF validator and three-vrm in FOLDER/node_modules,
# where the tests find them, unless they are already there. If that is not possible, prints the
# reason and succeeds; the tests are then skipped.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$osgskin_root/cmake/setup.sh"
folder=$1
version=2.0.0-dev.3.10
three_vrm=3.5.5

grep -qs "\"version\": \"$version\"" "$folder/node_modules/gltf-validator/package.json" &&
  grep -qs "\"version\": \"$three_vrm\"" "$folder/node_modules/@pixiv/three-vrm/package.json" && exit 0
# Some Node.js packages include npm, and conflict with Debian's own.
if ! command -v npm >/dev/null && ! osgskin_install nodejs npm; then
  echo "No npm: the glTF validator's test will be skipped" >&2
  exit 0
fi
mkdir -p "$folder"
if ! log=$(npm install --prefix "$folder" --no-save --no-audit --no-fund --ignore-scripts \
  --fetch-retries 1 --fetch-timeout 30000 "gltf-validator@$version" \
  three@0.187.0 "@pixiv/three-vrm@$three_vrm" 2>&1); then
  echo "npm could not install gltf-validator@$version and three-vrm@$three_vrm, so their tests will be skipped:" \
    "$(grep -m 1 -i err <<<"$log")" >&2
fi
