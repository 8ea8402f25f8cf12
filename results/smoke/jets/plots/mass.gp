# Draws mass.svg and mass.png from mass.csv: run gnuplot on this file in its folder.
data = "mass.csv"
set datafile separator comma
set title 'Smoke in the box' noenhanced
set xlabel 'time [s]' noenhanced
set ylabel 'mass [m^3]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [-0.03:1.03]
set yrange [-0.00247657:0.0850287]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "mass.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'jets'
set terminal pngcairo size 1230,660 font "Sans,13"
set output "mass.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'jets'
