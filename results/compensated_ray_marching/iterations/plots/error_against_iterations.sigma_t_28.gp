# Draws error_against_iterations.sigma_t_28.svg and error_against_iterations.sigma_t_28.png from error_against_iterations.sigma_t_28.csv: run gnuplot on this file in its folder.
data = "error_against_iterations.sigma_t_28.csv"
set datafile separator comma
set title 'rel_l2 against setting: sigma_t 28' noenhanced
set xlabel 'setting' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.624461:4099.53]
set logscale y
set format y "%g"
set yrange [0.0202503:0.805669]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_iterations.sigma_t_28.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'as printed', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'corrected', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'as printed, lsqr', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'as printed, rows of length 1', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'corrected, rows of length 1', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     0.0246678 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_iterations.sigma_t_28.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'as printed', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'corrected', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'as printed, lsqr', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'as printed, rows of length 1', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'corrected, rows of length 1', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     0.0246678 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
