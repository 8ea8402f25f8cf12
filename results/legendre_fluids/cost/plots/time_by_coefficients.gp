# Draws time_by_coefficients.svg and time_by_coefficients.png from time_by_coefficients.csv: run gnuplot on this file in its folder.
data = "time_by_coefficients.csv"
set datafile separator comma
set title 'Time of one thread' noenhanced
set xlabel 'coefficients along an axis' noenhanced
set ylabel 'time [ms]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [3.16:32.84]
set logscale y
set format y "%g"
set yrange [0.000985298:4379.47]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "time_by_coefficients.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'step', \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'projection', \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'product', \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'product, triple products', \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'dense system', \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'eigen-decomposition', \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'step, more coefficients'
set terminal pngcairo size 1230,660 font "Sans,13"
set output "time_by_coefficients.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'step', \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'projection', \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'product', \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'product, triple products', \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'dense system', \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'eigen-decomposition', \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'step, more coefficients'
