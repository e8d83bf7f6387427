#!/bin/sh
# The experiment of Ai et al. 2019 with a cloud like theirs: 21,134 points of a coral island and its reef, made by
# tests/island_cloud, as four sub-blocks that go down to a fifth of their triangles.
#   rungs.csv   each sub-block at each scale: MMQE, SVO, triangles, collapses (of edges, from the finest mesh on), bytes
#               to read; in mmqe.svg, as their Figure 3
#   table.csv   six states T1 .. T6 of a viewpoint that goes away: SVO, visual range, triangles and simplifications of
#               each sub-block, as their Table 2; states.csv: 21 states, in mmqe.svg
#   sizes.csv   bytes of the streams, and of the same scales as models of their own
#   scales.png  the island at three scales, as their Figure 12 (where scree-view can draw)
# A sub-block's visual range is the distance at which its smallest visible object is two pixels long, in a window 1080
# pixels high that spans 30 degrees. What the paper claims is checked at the end; exit code 1: something does not hold.
# Usage: samples/island_experiment.sh [FOLDER]   (build/experiments/island); environment: SCREE_BUILD (build);
# ISLAND_LEVELS ("1 4 8 all"): how many scales a program with separate models has, 1 being the finest;
# ISLAND_PICTURES: no leaves them out.
set -eu
cd "$(dirname "$0")/.."
build=${SCREE_BUILD:-build}
folder=${1:-build/experiments/island}
levels_list=${ISLAND_LEVELS:-1 4 8 all}
# Separate models take at least so many times the bytes of the streams, though they are but four: what
# docs/island.md says.
plain_factor=10
gzipped_factor=6
[ -x "$build/scree" ] || { echo "there is no $build/scree: run ./bootstrap first"; exit 1; }
[ -x "$build/tests/island_cloud" ] || make -s -C "$build" tests/island_cloud
# shellcheck source=samples/display.sh
. samples/display.sh
trap display_end EXIT
mkdir -p "$folder"
scree=$build/scree
terrain=$folder/terrain
models=$folder/models
rm -rf "$models"
mkdir "$models"

"$build/tests/island_cloud" -o "$folder/island.xyz"
"$scree" build "$folder/island.xyz" --s_srs EPSG:32649 --profile local --products stream -q -o "$terrain"
"$scree" verify "$terrain" --against "$folder/island.xyz" --s_srs EPSG:32649

# ---- the sub-blocks and their scales ----

# I to IV from the south-west to the north-east: I is nearest to the viewpoint.
zoom=$(find "$terrain/stream" -name '*.scree' | sed 's|/[0-9]*/[0-9]*\.scree$||; s|.*/||' | sort -n | tail -n 1)
: >"$folder/blocks"
for tile in 0/0 1/0 0/1 1/1; do
    echo "$zoom/$tile" >>"$folder/blocks"
done
name_of() { # TILE
    case $1 in */0/0) echo I ;; */1/0) echo II ;; */0/1) echo III ;; *) echo IV ;; esac
}
echo 'block,rung,svo_m,mmqe_m2,max_error_m,vertices,triangles,collapses,bytes,x_m,y_m' >"$folder/rungs.csv"
while read -r tile; do
    block=$(name_of "$tile")
    "$scree" info "$terrain/stream/$tile.scree" --format json | tr -d '",:{}' | awk -v OFS=, -v OFMT=%.12g -v block="$block" '
        NF == 2 { header[$1] = $2 }
        BEGIN { rungs = 0 }
        $1 == "rung" { for (i = 1; i < NF; i += 2) told[rungs, $i] = $(i + 1); rungs++ }
        END {
            for (i = 0; i < rungs; i++)
                print block, told[i, "rung"], told[i, "svo_m"], told[i, "mmqe_m2"], told[i, "max_error_m"],
                    told[i, "vertices"], told[i, "triangles"], told[rungs - 1, "vertices"] - told[i, "vertices"],
                    told[i, "bytes_so_far"], header["west"] + header["columns"] * header["spacing_x"] / 2,
                    header["south"] + header["rows"] * header["spacing_y"] / 2
        }' >>"$folder/rungs.csv"
done <"$folder/blocks"

# ---- states of a viewpoint that goes away, to the south-west and up ----

# Each sub-block is shown at its coarsest scale whose smallest visible object is within two pixels. The viewpoint begins
# where sub-block I is at its finest and ends where it is at its base.
awk -F, -v OFS=, -v height_px=1080 -v pixels=2 -v states=21 '
    NR == 1 { next }
    !($1 in count) { name[blocks++] = $1; x[$1] = $10; y[$1] = $11 }
    { n = count[$1]++; svo[$1, n] = $3; triangles[$1, n] = $7; collapses[$1, n] = $8 }
    END {
        range_per_m = height_px / 2 / 0.26794919 / pixels # the tangent of half of 30 degrees
        first = range_per_m * svo["I", count["I"] - 1]
        last = range_per_m * svo["I", 0] * 1.01
        print "state,sub_block,visual_range_m,threshold_m,svo_m,triangles,simplifications"
        for (state = 0; state < states; state++) {
            away = first + (last - first) * state / (states - 1)
            for (b = 0; b < blocks; b++) {
                block = name[b]
                east = x[block] - x["I"] + 0.45 * away
                north = y[block] - y["I"] + 0.75 * away
                range = sqrt(east * east + north * north + (1 - 0.45 ^ 2 - 0.75 ^ 2) * away * away)
                threshold = range / range_per_m
                for (n = 0; n < count[block] - 1 && svo[block, n] > threshold; n++);
                printf "%d,%s,%.2f,%.3f,%.3f,%d,%d\n", state, block, range, threshold, svo[block, n],
                    triangles[block, n], collapses[block, n]
            }
        }
    }' "$folder/rungs.csv" >"$folder/states.csv"
awk -F, -v OFS=, 'NR == 1 || $1 % 4 == 0 { if (NR > 1) $1 = "T" ($1 / 4 + 1); print }' "$folder/states.csv" \
    >"$folder/table.csv"

# ---- the same scales as models of their own ----

has_osg=no
! command -v osgconv >/dev/null || has_osg=yes
line_of() { # FORM LEVELS FILE...: bytes, and bytes with each file gzipped
    form=$1 levels=$2
    shift 2
    bytes=$(cat "$@" | wc -c)
    gzipped=$(for file in "$@"; do gzip -9 -c "$file"; done | wc -c)
    echo "$form,$levels,$((bytes)),$((gzipped))" >>"$folder/sizes.csv"
}
# The rungs of a block which LEVELS models show: the finest, the base, and between them those nearest to equal ratios of
# triangles.
chosen() { # BLOCK LEVELS
    awk -F, -v block="$1" -v levels="$2" '
        BEGIN { n = 0 }
        $1 == block { rung[n] = $2; size[n++] = log($7) }
        END {
            if (levels == "all") levels = n
            for (i = 0; i < levels; i++) {
                wanted = levels == 1 ? size[n - 1] : size[0] + (size[n - 1] - size[0]) * i / (levels - 1)
                best = 0
                for (j = 0; j < n; j++)
                    if ((size[j] - wanted) ^ 2 < (size[best] - wanted) ^ 2) best = j
                print levels == n ? rung[i] : rung[best]
            }
        }' "$folder/rungs.csv"
}
# Increments as the paper has them (Table 1), between each two scales as its section 2.2.2 merges them, in numbers of 4
# bytes: the scale and its MMQE; of a triangle that goes, its index and corners; of a replaced one also its new corners.
# Before them the points and the triangles of the base.
increments_of() { # OBJ... from coarse to fine: bytes
    awk '
        FNR == 1 { files++; points = 0; fine = 0; common = 0 }
        $1 == "v" {
            place = $2 " " $3 " " $4
            if (!(place in number)) number[place] = ++numbers
            vertex[++points] = number[place]
        }
        $1 == "f" {
            a = vertex[$2 + 0]; b = vertex[$3 + 0]; c = vertex[$4 + 0]
            if (b < a && b < c) { t = a; a = b; b = c; c = t } else if (c < a && c < b) { t = c; c = b; b = a; a = t }
            triangle = a " " b " " c
            if (last[triangle] == files - 1 && files > 1) common++
            last[triangle] = files
            count[files]++
            same[files] = common
        }
        END {
            bytes = 12 * numbers + 12 * count[1]
            for (i = 2; i <= files; i++)
                bytes += 8 + 16 * (count[i] - count[i - 1]) + 28 * (count[i - 1] - same[i])
            print bytes
        }' "$@"
}
echo 'form,levels,bytes,gzipped_bytes' >"$folder/sizes.csv"
# shellcheck disable=SC2046 # several files
line_of streams all $(sed "s|.*|$terrain/stream/&.scree|" "$folder/blocks")
increments=0
for levels in $levels_list; do
    mkdir "$models/$levels"
    while read -r tile; do
        block=$(name_of "$tile")
        files=
        for rung in $(chosen "$block" "$levels"); do
            name=$models/$levels/$block$rung
            "$scree" extract "$terrain/stream/$tile.scree" --rung "$rung" -q -o "$name.ply"
            files="$files $name.ply"
            [ "$levels" != all ] || "$scree" extract "$terrain/stream/$tile.scree" --rung "$rung" -q -o "$name.obj"
        done
        # shellcheck disable=SC2046,SC2086 # several files
        [ "$levels" != all ] || increments=$((increments + $(increments_of $(echo $files | sed 's/\.ply/.obj/g'))))
        [ $has_osg = no ] || for ending in osgb ive; do # all levels in one file, as the paper has them
            # shellcheck disable=SC2086 # several files
            osgconv $files "$models/$levels/$block.$ending" >/dev/null 2>&1
        done
    done <"$folder/blocks"
    line_of ply "$levels" "$models/$levels"/*.ply
    [ $has_osg = no ] || for ending in osgb ive; do
        line_of $ending "$levels" "$models/$levels"/*.$ending
    done
done
[ $increments = 0 ] || echo "increments,all,$increments," >>"$folder/sizes.csv"
rm -r "$models"

# ---- pictures and plots ----

pictures=no
if [ "${ISLAND_PICTURES:-yes}" = yes ] && [ -x "$build/scree-view" ] && display_begin; then
    scale=0
    shot() { # NAME OPTION...
        shot=$1
        shift
        "$build/scree-view" "$terrain" --svo "$svo" --no-morph --size 340x340 \
            --screenshot "$folder/scale$scale-$shot.png" --trace-tiles "$folder/scale$scale.tiles" "$@"
    }
    for svo in $(awk -F, 'NR > 1 { if ($3 > most) most = $3; if (!least || $3 < least) least = $3 }
            END { print 1.5 * least, sqrt(1.5 * least * most), most * 1.001 }' "$folder/rungs.csv"); do
        scale=$((scale + 1))
        # The triangles from nearby, at the shore of the lagoon, where the sub-blocks meet.
        shot near --camera=112.00859,16.89740,250,0,-90 --wireframe --background 101820
        shot whole --camera=112.00841,16.89669,1060,0,-90 --contours=5
    done
    pictures=yes
fi
if command -v gnuplot >/dev/null; then
    gnuplot -e "folder = '$folder'; pictures = '$pictures'" samples/island_experiment.gnuplot
else
    echo "the plots are skipped: gnuplot is not installed"
fi
rm -f "$folder"/scale?.tiles "$folder/blocks"

# ---- what the paper claims ----

column -s, -t "$folder/table.csv" 2>/dev/null || cat "$folder/table.csv"
column -s, -t "$folder/sizes.csv" 2>/dev/null || cat "$folder/sizes.csv"
awk -F, -v plain="$plain_factor" -v gzipped="$gzipped_factor" '
    function verdict(holds, text, figure) {
        printf "  %-6s  %-64s  %s\n", holds ? "ok" : "BROKEN", text, figure
        broken += !holds
    }
    FNR == 1 { file++; next }
    file == 1 { # each sub-block from the base to the finest
        if ($1 in mmqe) { steps++; grown += $4 < mmqe[$1]; scale++ } else { blocks++; scale = 0 }
        mmqe[$1] = $4
        triangles[scale] += $7
    }
    file == 2 && $2 == "I" {
        n++; x += $5; y += $3; xx += $5 * $5; yy += $3 * $3; xy += $5 * $3
    }
    file == 3 {
        if ($1 == "streams") streams = $3
        else if ($1 != "increments" && $2 != 1) {
            if (!least || $3 < least) least = $3
            if (!least_gzipped || $4 < least_gzipped) least_gzipped = $4
        }
    }
    END {
        base = triangles[0] / triangles[scale]
        before = triangles[1] / triangles[scale]
        r = (n * xy - x * y) / sqrt((n * xx - x * x) * (n * yy - y * y))
        print ""
        verdict(blocks == 4, "the points become four sub-blocks", blocks)
        verdict(base <= 0.2 && before > 0.2, "the base is the first scale with a fifth of the triangles",
                sprintf("%.3f", base))
        verdict(steps > 0 && grown == steps, "the MMQE grows with every simplification", grown " of " steps)
        verdict(r > 0.98, "the visual range is about linear in the SVO", sprintf("r = %.4f", r))
        verdict(least > plain * streams, "separate models take " plain " times the bytes, and more",
                sprintf("%.1f", least / streams))
        verdict(least_gzipped > gzipped * streams, "even gzipped they take " gzipped " times the bytes, and more",
                sprintf("%.1f", least_gzipped / streams))
        exit broken > 0
    }' "$folder/rungs.csv" "$folder/states.csv" "$folder/sizes.csv"
