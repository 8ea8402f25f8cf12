# Draws error_against_cfl.references.svg and error_against_cfl.references.png from error_against_cfl.references.csv: run gnuplot on this file in its folder.
data = "error_against_cfl.references.csv"
set datafile separator comma
set title 'rms difference of u [m/s] against the lid'."'".'s way a step [cells]: references' noenhanced
set xlabel 'the lid'."'".'s way a step [cells]' noenhanced
set ylabel 'rms difference of u [m/s]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.211686:4.72397]
set yrange [0:0.0157789]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_cfl.references.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Re 100, regularized lid, by CFL', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_cfl.references.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Re 100, regularized lid, by CFL', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
