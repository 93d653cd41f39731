#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# gltf_validator.sh FOLDER: installs Khronos' glTF validator in FOLDER/node_modules, where the tests
# find it, unless it is already there. If that is not possible, prints the reason and succeeds; the
# test is then skipped.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$osgskin_root/cmake/setup.sh"
folder=$1
version=2.0.0-dev.3.10

grep -qs "\"version\": \"$version\"" "$folder/node_modules/gltf-validator/package.json" && exit 0
# Some Node.js packages include npm, and conflict with Debian's own.
if ! command -v npm >/dev/null && ! osgskin_install nodejs npm; then
  echo "No npm: the glTF validator's test will be skipped" >&2
  exit 0
fi
mkdir -p "$folder"
if ! log=$(npm install --prefix "$folder" --no-save --no-audit --no-fund --ignore-scripts \
  --fetch-retries 1 --fetch-timeout 30000 "gltf-validator@$version" 2>&1); then
  echo "npm could not install gltf-validator@$version, so its test will be skipped:" \
    "$(grep -m 1 -i err <<<"$log")" >&2
fi
