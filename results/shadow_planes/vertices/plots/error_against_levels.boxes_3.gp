# Draws error_against_levels.boxes_3.svg and error_against_levels.boxes_3.png from error_against_levels.boxes_3.csv: run gnuplot on this file in its folder.
data = "error_against_levels.boxes_3.csv"
set datafile separator comma
set title 'p95 against setting: boxes_3' noenhanced
set xlabel 'setting' noenhanced
set ylabel 'p95' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [3.38698:75.5835]
set logscale y
set format y "%g"
set yrange [0.00103029:0.0405342]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_levels.boxes_3.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'vertices', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_levels.boxes_3.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'vertices', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
