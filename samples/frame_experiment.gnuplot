# The plot of samples/frame_experiment.sh, which sets folder.
set datafile separator ","
file = folder."/frames.csv"
set terminal pngcairo size 1100,800 font "sans,13"
set output folder."/frames.png"
set grid
set multiplot layout 3,1
set lmargin 12
set rmargin 12
set ylabel "frames a second"
set yrange [0:*]
plot file using "time_s":(1000 / column("frame_ms")) with lines notitle
set ylabel "triangles"
set y2label "SVO by hand, m"
set y2tics
set ytics nomirror
set logscale y2
plot file using "time_s":"triangles" with lines title "triangles", \
     "" using "time_s":"manual_svo_m" axes x1y2 with lines title "SVO by hand"
unset y2label
unset y2tics
set ylabel "CPU ms outside of drawing"
set xlabel "s"
plot file using "time_s":"outside_ms" with lines notitle
unset multiplot
