# Draws error_by_coefficients.figure_8.svg and error_by_coefficients.figure_8.png from error_by_coefficients.figure_8.csv: run gnuplot on this file in its folder.
data = "error_by_coefficients.figure_8.csv"
set datafile separator comma
set title 'Difference to 36 coefficients an axis after two seconds: figure 8' noenhanced
set xlabel 'coefficients along an axis' noenhanced
set ylabel 'relative L2 difference of the density' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:27.6]
set logscale y
set format y "%g"
set yrange [0.0243936:0.553745]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_by_coefficients.figure_8.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'galerkin', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'galerkin, filtered', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_by_coefficients.figure_8.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'galerkin', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'galerkin, filtered', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
