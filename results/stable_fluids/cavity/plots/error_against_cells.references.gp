# Draws error_against_cells.references.svg and error_against_cells.references.png from error_against_cells.references.csv: run gnuplot on this file in its folder.
data = "error_against_cells.references.csv"
set datafile separator comma
set title 'greatest difference of u [m/s] against cells a side: references' noenhanced
set xlabel 'cells a side' noenhanced
set ylabel 'greatest difference of u [m/s]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:55.2]
set logscale y
set format y "%g"
set yrange [0.00472271:0.0385048]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_cells.references.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Re 100, regularized lid', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'Re 100, unit lid', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_cells.references.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Re 100, regularized lid', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'Re 100, unit lid', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
