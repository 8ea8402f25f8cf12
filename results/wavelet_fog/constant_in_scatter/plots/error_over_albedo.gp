# Draws error_over_albedo.svg and error_over_albedo.png from error_over_albedo.csv: run gnuplot on this file in its folder.
data = "error_over_albedo.csv"
set datafile separator comma
set title 'rel_l2 against parameter' noenhanced
set xlabel 'parameter' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:1.15]
set logscale y
set format y "%g"
set yrange [0.00234821:0.430702]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_over_albedo.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'constant, sky', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     0.003696 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_over_albedo.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'constant, sky', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     0.003696 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
