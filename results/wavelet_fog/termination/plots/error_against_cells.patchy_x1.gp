# Draws error_against_cells.patchy_x1.svg and error_against_cells.patchy_x1.png from error_against_cells.patchy_x1.csv: run gnuplot on this file in its folder.
data = "error_against_cells.patchy_x1.csv"
set datafile separator comma
set title 'rmse against cells: patchy x1' noenhanced
set xlabel 'cells' noenhanced
set ylabel 'rmse' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:299139]
set yrange [0:0.00695941]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_cells.patchy_x1.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'skip', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_cells.patchy_x1.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'skip', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
