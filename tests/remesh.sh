#!/bin/sh
# scree remesh: meshes in every format, fine where the observer is, the same every time; what cannot be done is one line
# on standard error, exit code 1 or 2, and no mesh.
set -u
verb=remesh made=to.ply
. "$TOP_SRCDIR/tests/refuse.sh"
# triangles FILE.ply
triangles() { sed -n '/^element face/{s/^element face \([0-9]*\).*/\1/p;q;}' "$1"; }

"$TOP_BUILDDIR/tests/fractal_dem" -o dem.tif --size 300 --rows 201 --type Float32 --epsg 32611 --spacing-m 30 >out 2>err ||
    fail 'no DEM to work on'
cat >grid.asc <<EOG
ncols 5
nrows 4
xllcorner 10
yllcorner 45
cellsize 0.01
NODATA_value -9999
1 2 3 4 5
2 3 4 9 6
3 4 5 6 7
4 5 6 7 8
EOG
cat >grid.prj <<EOG
GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]
EOG

# Every format; all posts, where nothing may be merged; fewer, the more may be.
does dem.tif -o all.ply --threshold 0
says "60300 vertices, 119600 triangles, 100 % of the full grid's; max error 0 m"
says "over x and y of the raster's CRS"
[ "$(triangles all.ply)" = 119600 ] || fail 'all.ply: not the full grid'
before=119600
for threshold in 1 4 16; do
    does dem.tif -o some.ply --threshold $threshold
    some=$(triangles some.ply)
    [ "$some" -lt "$before" ] || fail "threshold $threshold: $some triangles are not fewer than $before"
    before=$some
done
for ending in ply obj stl off; do
    does dem.tif -o "mesh.$ending" --threshold 20
    [ -s "mesh.$ending" ] || fail "mesh.$ending: empty"
done
faces=$(grep -c '^f ' mesh.obj)
[ "$faces" = "$(triangles mesh.ply)" ] || fail "mesh.obj: $faces faces"

# The observer: the same place gives the same bytes, another place other ones; from far away next to nothing is needed.
corner=$("$scree" remesh grid.asc -o mesh.ply --observer 10.02,45.02,30 | sed -n 's/^as the observer sees it: //p')
[ -n "$corner" ] || fail 'an observer was to be told what they see'
does dem.tif -o near.ply --threshold 2 --reach 3000 --observer 0,0,1e7
[ "$(triangles near.ply)" -lt 20 ] || fail 'from far away a few triangles will do'
x=$(sed -n 's/^add \([-0-9]*\), \([-0-9]*\), .*/\1/p' out)
y=$(sed -n 's/^add \([-0-9]*\), \([-0-9]*\), .*/\2/p' out)
does dem.tif -o near.ply --threshold 2 --observer "$x,$y,1000"
says 'as the observer sees it: max error'
does dem.tif -o again.ply --threshold 2 --observer "$x,$y,1000"
cmp near.ply again.ply || failed=1
does dem.tif -o nearer.ply --threshold 2 --observer "$x,$y,1000" --reach 8000
[ "$(triangles near.ply)" -lt "$(triangles nearer.ply)" ] || fail 'with a farther reach it is finer'
does -q dem.tif -o quiet.ply
[ ! -s out ] || fail '-q: nothing was expected on stdout'

# Longitude and latitude, and what the rasters' options do.
does grid.asc -o mesh.ply --threshold 0
says '^in metres east, north and up of 10.025, 45.02$'
says '20 vertices, 24 triangles'
does grid.asc -o mesh.ply --te 10.005 45.005 10.03 45.03
says 'max error'

# Bad command lines.
refuses 2 'which DEM' -o to.ply
refuses 2 '-o names' dem.tif
refuses 2 'not to.dxf' dem.tif -o to.dxf
refuses 2 'not to' dem.tif -o to
refuses 2 'no option --frob' dem.tif -o to.ply --frob
for place in 1 1,2 1,2, 1,2,3,4 1,2,x nan,1,2 1,inf,2 '' '1, ,2'; do
    refuses 2 'x,y,z' dem.tif -o to.ply --observer "$place"
done
refuses 2 'missing behind --observer' dem.tif -o to.ply --observer
for threshold in -1 nan inf x ''; do
    refuses 2 'from 0' dem.tif -o to.ply --threshold "$threshold"
done
refuses 2 'above 0' dem.tif -o to.ply --observer 1,2,3 --reach 0
refuses 2 'above 0' dem.tif -o to.ply --observer 1,2,3 --reach -5
refuses 2 'goes with an --observer' dem.tif -o to.ply --reach 100
refuses 2 '--config' dem.tif -o to.ply --config KEY
refuses 2 'extent' dem.tif -o to.ply --te 1 1 1 1
refuses 1 'threshold' dem.tif -o to.ply --threshold 1e300

# What is no raster, or none that can be taken as it is.
refuses 1 'nothing.tif' nothing.tif -o to.ply
echo 'not a raster' >text.tif
refuses 1 'text.tif' text.tif -o to.ply
head -c 5000 dem.tif >cut.tif
refuses 1 'cut.tif' cut.tif -o to.ply
sed '7,$s/[0-9]/-9999/g' grid.asc >void.asc
refuses 1 'void.asc' void.asc -o to.ply
printf 'ncols 1\nnrows 1\nxllcorner 10\nyllcorner 45\ncellsize 0.01\n7\n' >one.asc
refuses 1 '2 x 2 posts' one.asc -o to.ply
refuses 1 'outside of --te' grid.asc -o to.ply --te 50 5 51 6
refuses 1 'no band 9' grid.asc -o to.ply -b 9
refuses 1 'not on Earth' dem.tif -o to.ply --s_srs EPSG:4326
# vrt NAME COLUMNS ROWS GEOTRANSFORM: the grid, stretched
vrt() {
    cat >"$1" <<EOG
<VRTDataset rasterXSize="$2" rasterYSize="$3">
  <SRS dataAxisToSRSAxisMapping="2,1">EPSG:4326</SRS>
  <GeoTransform>$4</GeoTransform>
  <VRTRasterBand dataType="Float32" band="1">
    <SimpleSource><SourceFilename relativeToVRT="1">grid.asc</SourceFilename><SourceBand>1</SourceBand>
      <SrcRect xOff="0" yOff="0" xSize="5" ySize="4"/><DstRect xOff="0" yOff="0" xSize="$2" ySize="$3"/></SimpleSource>
  </VRTRasterBand>
</VRTDataset>
EOG
}
vrt turned.vrt 40 30 '10, 0.05, 0.02, 45, 0.02, -0.05'
refuses 1 'gdalwarp' turned.vrt -o to.ply
vrt wide.vrt 40000 3 '10, 0.001, 0, 45, 0, -0.001'
refuses 1 'crop with --te' wide.vrt -o to.ply
does wide.vrt -o mesh.ply --te 10 44 20 46

# Places that cannot be written to.
refuses 1 'nowhere/to.ply' dem.tif -o nowhere/to.ply
mkdir folder.ply
refuses 1 'folder.ply' dem.tif -o folder.ply
exit $failed
