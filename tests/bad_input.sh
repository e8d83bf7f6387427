#!/bin/sh
# Bad input, odd input, bad places to write to, Ctrl-C: one line on standard error and exit code 1 or 2, nothing that
# looks finished; or a terrain of which verify finds no promise broken.
set -u
verb="build -q" made=to/terrain/layer.json
. "$TOP_SRCDIR/tests/refuse.sh"
trap 'umount "$scratch/disk" 2>/dev/null; rm -rf "$scratch"' EXIT
# builds DEM OPTION...: it does, and every promise holds against the source.
builds() {
    rm -rf to
    "$scree" build -q -o to "$@" >out 2>err || fail "build $*: does not build"
    [ ! -s err ] || fail "build $*: nothing was expected on stderr"
    "$scree" verify to --against "$1" >out 2>err || fail "build $*: verify is not content"
}
# grid COLUMNS ROWS [ODD]: an ASCII grid with these heights but one, in degrees.
grid() {
    printf 'ncols %d\nnrows %d\nxllcorner 10\nyllcorner 45\ncellsize 0.05\nNODATA_value -9999\n' "$1" "$2"
    awk -v c="$1" -v r="$2" -v odd="${3-}" 'BEGIN {
        for (y = 0; y < r; y++)
            for (x = 0; x < c; x++) print odd != "" && x == int(c / 2) && y == int(r / 2) ? odd : 100.5 + x * y % 17
    }'
    cat >"grid$1x$2${3-}.prj" <<EOF
GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]
EOF
}
for size in '1 1' '2 2' '1 9' '40 30'; do
    # shellcheck disable=SC2086 # two words on purpose
    grid $size >"grid${size% *}x${size#* }.asc"
done
good=grid40x30.asc

# What is no raster, or only the beginning of one.
refuses 1 'nothing.tif' nothing.tif -o to
: >empty.tif
refuses 1 'empty.tif' empty.tif -o to
echo 'not a raster' >text.tif
refuses 1 'text.tif' text.tif -o to
refuses 1 'nothing.tif' $good nothing.tif -o to
"$TOP_BUILDDIR/tests/fractal_dem" -o whole.tif --size 300 --rows 200 >out 2>err || fail 'no GeoTIFF to cut'
size_bytes=$(wc -c <whole.tif)
for bytes in 1 8 100 500 $((size_bytes / 2)) $((size_bytes - 1)); do
    head -c "$bytes" whole.tif >cut.tif
    refuses 1 'cut.tif' cut.tif -o to
done

# What is a raster, but not of heights on Earth.
grid 40 30 -9999 | sed '7,$s/.*/-9999/' >grid40x30void.asc
cp grid40x30.prj grid40x30void.prj
refuses 1 'holds no height' grid40x30void.asc -o to
grid 40 30 -32767 >grid40x30-32767.asc
refuses 1 '-a_nodata -32767' grid40x30-32767.asc -o to
# transform NAME 'GEOTRANSFORM': the good raster elsewhere.
transform() {
    cat >"$1.vrt" <<EOF
<VRTDataset rasterXSize="40" rasterYSize="30">
  <SRS dataAxisToSRSAxisMapping="2,1">EPSG:4326</SRS>
  <GeoTransform>$2</GeoTransform>
  <VRTRasterBand dataType="${3-Float32}" band="1">
    <SimpleSource><SourceFilename relativeToVRT="1">$good</SourceFilename><SourceBand>1</SourceBand></SimpleSource>
  </VRTRasterBand>
</VRTDataset>
EOF
}
transform flat '10, 0, 0, 45, 0, -0.05'
refuses 1 'no size' flat.vrt -o to
transform line '10, 0.05, 0.05, 45, 0.05, 0.05'
refuses 1 'no size' line.vrt -o to
transform nan 'nan, 0.05, 0, 45, 0, -0.05'
refuses 1 'geotransform' nan.vrt -o to
transform vast '1e300, 1e300, 0, 45, 0, -1e300'
refuses 1 'geotransform' vast.vrt -o to
transform far '1000, 0.05, 0, 4500, 0, -0.05'
refuses 1 'not on Earth' far.vrt -o to

# Options that make no sense.
refuses 2 'no option --frob' $good -o to --frob
refuses 2 'which DEM' -o to
refuses 2 'Name a folder' $good
refuses 2 'no-number' $good -o to --error no-number
refuses 2 'above 0' $good -o to --error 0
refuses 1 'larger than that of zoom' $good -o to --error-at 3=20000
refuses 2 'threads' $good -o to -j 0
refuses 2 '0 to 22' $good -o to --max-zoom 23
refuses 1 'finer than the finest' $good -o to --min-zoom 4 --max-zoom 3
refuses 2 'extent' $good -o to --te 10 45 10 45
refuses 2 'four numbers' $good -o to --te 10 45
refuses 1 'outside of --te' $good -o to --te 50 5 51 6
refuses 1 'no band 9' $good -o to -b 9
refuses 1 'EPSG:999999' $good -o to --s_srs EPSG:999999

# Places that cannot be written to.
: >file
refuses 1 'file' $good -o file
refuses 1 'file' $good -o file/under
mkdir -p taken/terrain/0/0/0.terrain
refuses 1 '0/0/0.terrain' $good -o taken
[ ! -e taken/terrain/layer.json ] || fail 'a build that failed left a layer.json'
if [ "$(id -u)" -eq 0 ] && mkdir disk && mount -t tmpfs -o size=64k tmpfs disk 2>err; then
    refuses 1 'No space left' $good -o disk/to --error 2000
    [ ! -e disk/to/terrain/layer.json ] || fail 'a build that failed left a layer.json'
    umount disk
else
    echo 'skipped: a full disk (takes root and a mount of tmpfs)'
fi

# Small rasters, odd types and odd places. (The curved roots of a geodetic terrain take a second: not all are.)
builds grid1x1.asc
builds grid2x2.asc --profile local
refuses 1 'at least 2 x 2' grid1x9.asc -o to --profile local
builds $good --profile local
for type in Byte UInt16 Int32 Float64; do
    transform "$type" '10, 0.05, 0, 45, 0, -0.05' "$type"
    builds "$type.vrt" --profile local
done
transform turned '10, 0.05, 0.02, 45, 0.02, 0.05' # and from south to north
builds turned.vrt
transform dateline '179, 0.05, 0, 45, 0, -0.05'
builds dateline.vrt --min-zoom 2 --max-zoom 4
transform pole '10, 0.05, 0, 90, 0, -0.05'
builds pole.vrt
transform globe '-180, 9, 0, 90, 0, -6'
builds globe.vrt --max-zoom 1

# Ctrl-C: 130, no layer.json, no half tile; the next build is as good as any.
"$TOP_BUILDDIR/tests/fractal_dem" -o large.tif --size 2000 >out 2>err || fail 'no large GeoTIFF'
rm -rf to
"$scree" build -q large.tif --error 4000 -o to >out 2>err &
build=$!
waited=0
while [ -z "$(find to -name '*.terrain' 2>/dev/null)" ] && [ $waited -lt 100 ]; do
    sleep 0.1
    waited=$((waited + 1))
done
kill -INT $build
wait $build
got=$?
[ $got -eq 130 ] || fail "an interrupted build: exit code $got, not 130"
[ "$(wc -l <err)" -eq 1 ] || fail 'an interrupted build: one line was expected on stderr'
[ -z "$(find to -type f ! -name '*.terrain' ! -name '*.scree')" ] || fail 'an interrupted build leaves more than tiles'
find to -name '*.terrain' -exec gzip -t -S .terrain {} + || fail 'an interrupted build leaves half a tile'
if ! "$scree" build -q $good -o to --profile local >out 2>err || ! "$scree" verify to --against $good >out 2>err; then
    fail 'after an interrupted build, the next does not work'
fi

exit $failed
