# Draws crossings_against_edges.svg and crossings_against_edges.png from crossings_against_edges.csv: run gnuplot on this file in its folder.
data = "crossings_against_edges.csv"
set datafile separator comma
set title 'crossings against silhouette edges' noenhanced
set xlabel 'silhouette edges' noenhanced
set ylabel 'crossings' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [61.8808:151668]
set logscale y
set format y "%g"
set yrange [10791:1.84751e+06]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "crossings_against_edges.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'rule', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "crossings_against_edges.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'rule', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
