# Draws error_against_levels.spot_cone.svg and error_against_levels.spot_cone.png from error_against_levels.spot_cone.csv: run gnuplot on this file in its folder.
data = "error_against_levels.spot_cone.csv"
set datafile separator comma
set title 'p95 against setting: spot_cone' noenhanced
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
set yrange [0.00650625:1.27852]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_levels.spot_cone.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'vertices', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_levels.spot_cone.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'vertices', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
