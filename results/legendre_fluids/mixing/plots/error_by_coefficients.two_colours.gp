# Draws error_by_coefficients.two_colours.svg and error_by_coefficients.two_colours.png from error_by_coefficients.two_colours.csv: run gnuplot on this file in its folder.
data = "error_by_coefficients.two_colours.csv"
set datafile separator comma
set title 'Difference of the first density to 32 coefficients an axis, after two seconds: two colours' noenhanced
set xlabel 'coefficients along an axis' noenhanced
set ylabel 'relative L2 difference' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:27.6]
set logscale y
set format y "%g"
set yrange [0.0350541:0.583183]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_by_coefficients.two_colours.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'densities', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'albedo', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_by_coefficients.two_colours.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'densities', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'albedo', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
