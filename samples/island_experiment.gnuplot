# Plots of samples/island_experiment.sh, which sets folder.
set datafile separator ","
set datafile missing NaN # the rows of other sub-blocks
set grid

set terminal svg size 980,400 font "sans,12" background "white"
set output folder."/mmqe.svg"
set multiplot layout 1,2
set title "Error grows with simplification"
set xlabel "collapses"
set ylabel "MMQE, m²"
set key top left
plot for [block in "I II III IV"] folder."/rungs.csv" \
     using "collapses":(strcol("block") eq block ? column("mmqe_m2") : NaN) with linespoints pt 7 ps 0.4 lw 1.5 \
     title "sub-block ".block
set title "What is drawn from how far away"
set xlabel "visual range, m"
set ylabel "triangles"
set key top right
plot for [block in "I II III IV"] folder."/states.csv" \
     using "visual_range_m":(strcol("sub_block") eq block ? column("triangles") : NaN) with steps lw 1.5 \
     title "sub-block ".block
unset multiplot

# Three scales, and below them their triangles from nearby, pixel by pixel.
if (pictures ne "yes") exit
reset
unset xtics
unset ytics
unset key
unset border
set autoscale xfix
set autoscale yfix
set terminal pngcairo size 1020,712 font "sans,13"
set output folder."/scales.png"
set multiplot
do for [i = 1:3] {
    set lmargin at screen (i - 1) / 3.0
    set rmargin at screen i / 3.0
    said = system("awk -F, 'NR > 1 { n += $11; if ($8 > s) s = $8 } END { printf \"SVO %.2f m, %d triangles\", s, n }' ".folder."/scale".i.".tiles")
    set label 1 said at screen (i - 0.5) / 3, 0.977 center
    set bmargin at screen 340.0 / 712
    set tmargin at screen 680.0 / 712
    plot folder."/scale".i."-whole.png" binary filetype=png with rgbimage
    unset label 1
    set bmargin at screen 0
    set tmargin at screen 340.0 / 712
    plot folder."/scale".i."-near.png" binary filetype=png with rgbimage
}
unset multiplot
