#!/bin/sh
# scree filter: a raster comes out with its pixels and CRS, smoothed, the same every time; what cannot be done is one
# line on standard error, exit code 1 or 2, and no file.
set -u
verb=filter made=to.tif
. "$TOP_SRCDIR/tests/refuse.sh"

"$TOP_BUILDDIR/tests/fractal_dem" -o dem.tif --size 600 --rows 301 --type Float32 --epsg 32611 --spacing-m 30 >out 2>err ||
    fail 'no DEM to work on'
cat >grid.asc <<EOG
ncols 5
nrows 4
xllcorner 10
yllcorner 45
cellsize 0.5
NODATA_value -9999
1 2 3 4 -9999
2 3 4 5 -9999
3 4 5 6 7
4 5 6 7 8
EOG

# The same pixels and CRS; smaller steps and deltas stay closer; the same bytes again.
does dem.tif -o to.tif
says '^to.tif: 600 x 301 posts; heights changed by RMS'
says 'are hill.*keep detail'
does dem.tif -o again.tif
cmp to.tif again.tif || failed=1
# rms: what the last filter changed
rms() { sed -n 's/.* changed by RMS \([^ ]*\) m.*/\1/p' out; }
# closer: the last filter changed less than $before
closer() {
    awk "BEGIN { exit !($(rms) < $before) }" || fail "$1: RMS $(rms) is not less than $before"
}
does dem.tif -o other.tif
before=$(rms)
does dem.tif -o other.tif --delta 1
closer '--delta 1'
does dem.tif -o other.tif --spline-steps 1
closer '--spline-steps 1'
does dem.tif -o other.tif --thresholds hill=0,0,0,0,0,0,0,0,0
closer '--thresholds'
does dem.tif -o other.tif --variant 1
cmp -s to.tif other.tif && fail '--variant 1: the same file'
does dem.tif -o other.tif --delta 0 --least 0 --thresholds hill=0,0,0,0,0,0,0,0,0
says 'RMS 0 m, at most 0 m'
does -q dem.tif -o other.tif
[ ! -s out ] || fail '-q: nothing was expected on stdout'
"$scree" build to.tif -o built -q --profile local --products terrain --error 1e5 2>err || fail 'it cannot be built'

# Posts without data stay so, unless they are given a height.
all='--delta 0 --least 0 --thresholds hill=0,0,0,0,0,0,0,0,0 --fill-distance -1'
does grid.asc -o grid.tif $all
says 'RMS 0 m'
does grid.tif -o grid2.tif $all
cmp grid.tif grid2.tif || fail 'a raster with a void is not what it was'
does grid.asc -o flat.tif $all --nodata-height 30
cmp -s grid.tif flat.tif && fail '--nodata-height changes nothing'
does dem.tif -o part.tif --te 400500 3800500 404000 3804000
says '117 x 117 posts'

# Land use: near what has to be kept less changes; waters are flat. Polygons in longitude and latitude, in the raster's
# CRS, invalid, outside, and without a geometry.
square() { # PROPERTIES X Y SIZE: in pixels from the south-western one
    awk -v p="$1" -v x="$2" -v y="$3" -v s="$4" 'BEGIN {
        x = 400000 + 30 * x - 15; y = 3800000 + 30 * y - 15; s *= 30
        printf "{\"type\":\"Feature\",\"properties\":{%s},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[", p
        printf "[%d,%d],[%d,%d],[%d,%d],[%d,%d],[%d,%d]]]}}", x, y, x + s, y, x + s, y + s, x, y + s, x, y }'
}
collection() {
    printf '{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:%s"}},"features":[' "$1"
    cat
    printf ']}'
}
{
    square '"class":"water"' 10 10 60 && echo ,
    square '"class":"bridge"' 200 100 10 && echo ,
    square '"class":"road","lanes":2' 205 105 80 && echo ,
    square '"class":"road"' 400 105 80 && echo ,
    square '"class":"meadow"' 10 10 60 && echo ,
    square '"class":"water"' 1000 1000 60
} | collection 32611 >use.json
does dem.tif -o used.tif --landuse use.json
says '^use.json: 1 water, 0 shore, 0 railway, 1 bridge, 2 road, 0 forest; 1 roads meet a bridge$'
says '^use.json: 1 lie outside of the raster$'
says ', 1.99 % are levelled$' # 3600 of 180600 posts
cmp -s to.tif used.tif && fail '--landuse changes nothing'
printf '# what is looked at\nrailway lanes=*\n\n bridge   class = bridge \n' >rules.txt
does dem.tif -o ruled.tif --landuse use.json --rules rules.txt
says '^use.json: 0 water, 0 shore, 1 railway, 1 bridge, 0 road, 0 forest; 0 roads'
says ' 3.54 % are railway' # 6400 of 180600 posts
{
    cat <<EOG
{"type":"Feature","properties":{"class":"forest"},"geometry":{"type":"Polygon","coordinates":
[[[-118.08,34.33],[-118.0,34.38],[-118.0,34.33],[-118.08,34.38],[-118.08,34.33]]]}},
{"type":"Feature","properties":{"class":"forest"},"geometry":null},
{"type":"Feature","properties":{"class":"railway"},"geometry":{"type":"LineString","coordinates":
[[-118.05,34.35],[-118.0,34.38]]}}
EOG
} | collection 4326 >degrees.json
does dem.tif -o wood.tif --landuse degrees.json
says '^degrees.json: 0 water, 0 shore, 1 railway, 0 bridge, 0 road, 1 forest'
says '^degrees.json: 1 are invalid and were repaired'
says '^degrees.json: 1 have no usable geometry'
does grid.asc -o grid2.tif --landuse degrees.json
says '2 lie outside of the raster'
refuses 1 'nothing.json' dem.tif -o to.tif --landuse nothing.json
head -c 300 use.json >cut.json
refuses 1 'cut.json' dem.tif -o to.tif --landuse cut.json
echo 'forest natural=wood' >wood.txt
refuses 1 'no rule fits' dem.tif -o to.tif --landuse use.json --rules wood.txt
for rule in 'water' 'water class' 'lake class=water' 'water =x' 'water class=' '=' 'x=y water'; do
    printf 'road class=road\n%s\n' "$rule" >rules.txt
    refuses 1 'rules.txt, line 2' dem.tif -o to.tif --landuse use.json --rules rules.txt
done
echo '# nothing' >rules.txt
refuses 1 'holds no rule' dem.tif -o to.tif --landuse use.json --rules rules.txt
refuses 1 'nothing.txt' dem.tif -o to.tif --landuse use.json --rules nothing.txt
refuses 2 'goes with --landuse' dem.tif -o to.tif --rules rules.txt

# build --filter, and verify: the same bytes as by way of a file, for what says how pixels are read (READ), how they
# are filtered (HOW), and where terrain lies (WHERE); and what was built keeps its promises. GDAL words a CRS with the
# members of its datum or without, depending on what it has seen before: that may differ.
alike() { # FOLDER FOLDER
    words='"crs_wkt"\|"projection"'
    for file in $(cd "$1" && find . -type f); do
        case $file in
        *.json) grep -v "$words" "$1/$file" >mine && grep -v "$words" "$2/$file" >theirs && cmp mine theirs ;;
        *) cmp "$1/$file" "$2/$file" ;;
        esac || return 1
    done
    [ "$(cd "$1" && find . | sort)" = "$(cd "$2" && find . | sort)" ]
}
builds() { # READ HOW WHERE BUILD DEM
    rm -rf one two
    # shellcheck disable=SC2086 # words on purpose
    {
        "$scree" filter "$5" $1 $2 -o way.tif -q && "$scree" build way.tif $3 $4 -o two -q &&
            "$scree" build "$5" $1 --filter $2 $3 $4 -o one -q
        [ $? -eq 0 ] && alike one two && "$scree" verify one --against "$5" $1 --filter $2 $3
    } >out 2>err || fail "build --filter: $*"
}
builds '' '' '' '--products terrain --max-zoom 9' dem.tif
builds '' '--landuse use.json --delta 1 --variant 1 --spline-steps 2 --least 0.1' \
    '--te 403000 3800000 408000 3805000' '--profile local' dem.tif
sed '1,/^NODATA/!s/ 5/ 900/g' grid.asc >feet.asc
echo '<PAMDataset><PAMRasterBand band="1"><UnitType>ft</UnitType></PAMRasterBand></PAMDataset>' >feet.asc.aux.xml
builds '--s_srs EPSG:4326 -a_nodata 900 --fill-distance -1' '--delta 0.5' \
    '--te 10.2 45.1 12 46.6 --nodata-height 3' '--products terrain' feet.asc
builds '--s_srs EPSG:32611+5715' '--delta 1' '' '--profile local' dem.tif
"$TOP_BUILDDIR/tests/fractal_las" -o cloud.las --points 5000 --spacing-m 30 || fail 'no cloud'
printf 'OFF\n4 2 0\n0 0 1\n90 0 2\n0 90 9\n90 90 3\n3 0 1 3\n3 0 3 2\n' >mesh.off
builds '--grid 2' '--delta 0.1' '' '--profile local' mesh.off
builds '--class 2 --grid 40' '--delta 3' '' '--profile local' cloud.las
"$scree" verify one --against cloud.las --class 2 --grid 40 >out 2>err && fail 'the filter changed nothing, says verify'
rm -rf one
"$scree" build dem.tif --filter --landuse use.json -o one --products terrain --max-zoom 6 >out 2>err || fail 'no build'
grep -q '^filtered: 600 x 301 posts; heights changed by RMS' err || fail 'build --filter does not tell'
grep -q '^use.json: 1 lie outside of the raster$' err || fail 'build --filter does not tell of land use'
verb=build made=one
refuses 2 '--delta goes with --filter' dem.tif -o one --delta 3
refuses 2 '--rules goes with --filter' dem.tif -o one --landuse use.json --rules rules.txt
refuses 2 '--rules goes with --landuse' dem.tif -o one --filter --rules rules.txt
refuses 2 '1 to 9' dem.tif -o one --filter --spline-steps 10
refuses 1 'dem.tif: to filter .* allow that with' dem.tif -o one --filter --filter-memory 4
refuses 1 '^scree build: nothing.json' dem.tif -o one --filter --landuse nothing.json
refuses 1 '^scree build: grid.asc: names no coordinate system' grid.asc -o one --filter
refuses 1 '^scree build: dem.tif: lies outside of --te' dem.tif -o one --filter --te 5 5 6 6
for verb in compare remesh; do refuses 2 '--least goes with --filter' dem.tif -o one --least 0.1; done
"$scree" verify two --against dem.tif --variant 1 >out 2>err
[ $? -eq 2 ] && grep -q 'goes with --filter' err || fail 'verify --variant without --filter'
verb=filter made=to.tif

# Depths become negative heights, whether GeoTIFF has a code for their CRS or no words at all; and stay so by way of a
# file and without one.
heights() { # WANTED ARGUMENT...
    wanted=$1
    shift
    rm -rf one
    "$scree" build "$@" -o one --profile local >out 2>err || fail "build $*: does not"
    grep -q -- "^$wanted m;" err || fail "build $*: heights are not $wanted"
}
cp grid.asc depth.asc
for axis in 5715 'LENGTHUNIT["foot",0.3048]' 'LENGTHUNIT["metre",1]'; do
    geographic='GEOGCRS["x",DATUM["World Geodetic System 1984",ELLIPSOID["x",6378137,298.257223563]],CS[ellipsoidal,2],
        AXIS["latitude",north],AXIS["longitude",east],UNIT["degree",0.0174532925199433],ID["EPSG",4326]]'
    depth="COMPOUNDCRS[\"x\",$geographic,VERTCRS[\"x\",VDATUM[\"of a lake\"],CS[vertical,1],AXIS[\"x\",down],$axis]]"
    wanted='-8 to -1'
    case $axis in
    5715) depth=EPSG:4326+5715 ;;
    *foot*) wanted='-2.4384 to -0.3048' ;;
    esac
    heights "$wanted" depth.asc --s_srs "$depth"
    heights "$wanted" depth.asc --s_srs "$depth" --filter $all
    does depth.asc -o depth.tif --s_srs "$depth" $all
    heights "$wanted" depth.tif
done

# Whose data they are goes with them.
names_surveyors() { grep -ao 'Surveyors of Nowhere' "$1" >out || fail "$1: the attribution is lost"; }
cp dem.tif named.tif
cat >named.tif.aux.xml <<EOG
<PAMDataset><Metadata><MDI key="ATTRIBUTION">Surveyors of Nowhere</MDI></Metadata></PAMDataset>
EOG
does named.tif -o to.tif
names_surveyors to.tif
"$scree" build named.tif --filter -o one -q --products terrain --max-zoom 6 || fail 'no build'
names_surveyors one/terrain/layer.json

# The tables of triangles, and the picture.
does dem.tif --report -q
[ "$(wc -l <out)" -eq 21 ] || fail 'not the tables'
says '^triangles, delta 4 m, 3 spline steps$'
[ "$(grep -c '[0-9][*]' out)" -eq 5 ] || fail 'the fewest are not marked'
awk 'NR > 2 && NR < 6 && !($2 > $5 && $6 > 1) { exit 1 }' out || fail 'filtering saves no triangles'
does dem.tif --report -q --te 403000 3800000 407000 3804000
mv out before
does dem.tif --report -q --te 403000 3800000 407000 3804000 --landuse use.json
cmp -s out before && fail 'land use changes no table'
does dem.tif --difference away.png
says '^600 x 301 posts'
[ "$(od -An -tx1 -N8 away.png | tr -d ' ')" = 89504e470d0a1a0a ] || fail 'away.png: no picture'
does dem.tif --difference nothing.png --delta 0 --least 0 --thresholds hill=0,0,0,0,0,0,0,0,0
[ "$(wc -c <nothing.png)" -lt "$(wc -c <away.png)" ] || fail 'a picture without differences is not all white'
refuses 1 'nowhere/away.png' dem.tif --difference nowhere/away.png

# The page for newcomers, as it is written; what make makes is there.
mkdir newcomer && ln -s "$TOP_BUILDDIR" newcomer/build
sed -n 's/^    //p' "$TOP_SRCDIR/docs/filter.md" | grep -v '^make ' >newcomer/page.sh
(cd newcomer && sh -e page.sh) >out 2>err || fail 'docs/filter.md: a command fails'
says '^landuse.geojson: 1 water, 0 shore, 1 railway, 1 bridge, 2 road, 1 forest; 2 roads meet a bridge$'
says '^All promises hold.$'
awk '/^qem / { n++; triangles[n] = $4 } END { exit !(n == 2 && triangles[1] > 2 * triangles[2]) }' out ||
    fail 'docs/filter.md: the meshes are not those of the page'
for makes in smooth.tif changed.png out/terrain/layer.json before/mesh-z0-qem.png after/mesh-z0-qem.png; do
    [ -s "newcomer/$makes" ] || fail "docs/filter.md: no $makes"
done

# Bad command lines.
refuses 2 'which DEM' -o to.tif
refuses 2 '-o names' dem.tif
refuses 2 'no option --frob' dem.tif -o to.tif --frob
refuses 2 '--delta wants metres' dem.tif -o to.tif --delta
refuses 2 'missing behind -o' dem.tif -o
refuses 2 'no option --filter' dem.tif -o to.tif --filter
for value in 0 10 -1 x '' 1.5; do refuses 2 '1 to 9' dem.tif -o to.tif --spline-steps "$value"; done
for value in -1 nan inf x ''; do
    refuses 2 'metres from 0' dem.tif -o to.tif --delta "$value"
    refuses 2 'metres from 0' dem.tif -o to.tif --least "$value"
done
for value in 0 3 x; do refuses 2 '1 or 2' dem.tif -o to.tif --variant "$value"; done
for value in hill hill= hill=1 hill=0,0,0,0,0,0,0,0 hill=0,0,0,0,0,0,0,0,0,0 hill=0,0,0,0,0,0,0,0,-1 \
    hill=0,0,0,0,0,0,0,0,nan mountain=0,0,0,0,0,0,0,0,0 =0,0,0,0,0,0,0,0,0 hil=0,0,0,0,0,0,0,0,0; do
    refuses 2 'CLASS=T0' dem.tif -o to.tif --thresholds "$value"
done
refuses 2 'megabytes' dem.tif -o to.tif --filter-memory 0
refuses 2 '--config' dem.tif -o to.tif --config KEY
refuses 2 'extent' dem.tif -o to.tif --te 1 1 1 1

# What is no raster, or none that can be taken as it is.
refuses 1 'nothing.tif' nothing.tif -o to.tif
echo 'not a raster' >text.tif
refuses 1 'text.tif' text.tif -o to.tif
head -c 5000 dem.tif >cut.tif
refuses 1 'cut.tif' cut.tif -o to.tif
sed '7,$s/[0-9][0-9]*/9999/g;s/-*9999/-9999/g' grid.asc >void.asc
refuses 1 'void.asc' void.asc -o to.tif
printf 'ncols 1\nnrows 1\nxllcorner 10\nyllcorner 45\ncellsize 0.01\n7\n' >one.asc
refuses 1 '2 x 2 posts' one.asc -o to.tif
refuses 1 'outside of --te' grid.asc -o to.tif --te 50 5 51 6
refuses 1 'no band 9' grid.asc -o to.tif -b 9
refuses 1 'allow that with' dem.tif -o to.tif --filter-memory 4

# Places that cannot be written to.
refuses 1 'nowhere/to.tif' dem.tif -o nowhere/to.tif
mkdir folder.tif
refuses 1 'folder.tif' dem.tif -o folder.tif
exit $failed
