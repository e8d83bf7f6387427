#!/usr/bin/env bash
# Builds the sample and holds it against CesiumJS in a headless Chromium; see terrain.js for what is asked.
# Usage: run.sh TOP_SOURCE_DIR TOP_BUILD_DIR. Leaves pictures in TOP_BUILD_DIR/cesium.
# Where a tool is missing it says so and succeeds; a tool that is there and fails is a failure.
set -euo pipefail
top=$1 build=$2
work=$build/cesium

skip() {
    echo "check-cesium: skipped: $*"
    exit 0
}
for tool in node npm chromium gdalinfo gdal_translate gdaltransform; do
    command -v $tool >/dev/null || skip "$tool is not installed (./bootstrap extra installs it)"
done

mkdir -p "$work"
cp "$top/tests/cesium/package.json" "$work/"
if [ ! -e "$work/node_modules/cesium/Build/Cesium/Cesium.js" ] || [ ! -e "$work/node_modules/playwright-core" ]; then
    (cd "$work" && npm install --silent --no-audit --no-fund --no-package-lock >npm.log 2>&1) ||
        skip "npm could not install cesium and playwright-core: $(grep -m 1 -i err "$work/npm.log" || tail -n 1 "$work/npm.log")"
fi

dem=$top/samples/jacksboro.vrt
rm -rf "$work/terrain"
"$build/scree" build -q --error 4000 "$dem" -o "$work"
NODE_PATH=$work/node_modules node "$top/tests/cesium/terrain.js" "$dem" "$work" "$top/samples/cesium/serve.js"
