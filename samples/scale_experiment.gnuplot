# Plots of samples/scale_experiment.sh, which sets folder.
set datafile separator ","

# A sub-block through its 21 states.
set terminal pngcairo size 1100,700 font "sans,13"
set output folder."/states.png"
set title "Sub-block I: visual range, triangles and simplifications against the SVO threshold"
set xlabel "SVO, m"
set ylabel "visual range, m"
set y2label "triangles, simplifications"
set ytics nomirror
set y2tics
set key top center
set grid
plot folder."/block_one.csv" using "svo_m":"visual_range_m" with linespoints pt 7 lw 2 title "visual range", \
     "" using "svo_m":"triangles" axes x1y2 with linespoints pt 5 lw 2 title "triangles", \
     "" using "svo_m":"simplifications" axes x1y2 with linespoints pt 9 lw 2 title "simplifications"

# Six pictures, two rows of three.
unset title
unset xlabel
unset ylabel
unset y2label
unset ytics
unset y2tics
unset xtics
unset key
unset grid
unset border
set lmargin 0
set rmargin 0
set bmargin 0
set tmargin 2
set autoscale xfix
set autoscale yfix
set size ratio -1
set terminal pngcairo size 1440,680 font "sans,13"

set output folder."/scales.png"
set multiplot layout 2,3
do for [i = 1:6] {
    said = system("awk -F, '$1 == \"T".i."\" { n += $6; s = $3 } END { printf \"T".i.": SVO %.3g m, %d triangles\", s, n }' ".folder."/table.csv")
    set title said
    plot folder."/scale".i.".png" binary filetype=png with rgbimage
}
unset multiplot

set output folder."/distances.png"
set multiplot layout 2,3
do for [i = 1:6] {
    said = system("awk -F, '$1 == ".i." { printf \"%.0f km away: SVO from %.3g m, %d triangles\", $2 / 1000, $3, $6 }' ".folder."/distances.csv")
    set title said
    plot folder."/distance".i.".png" binary filetype=png with rgbimage
}
unset multiplot
