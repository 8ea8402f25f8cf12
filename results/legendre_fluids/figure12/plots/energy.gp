# Draws energy.svg and energy.png from energy.csv: run gnuplot on this file in its folder.
data = "energy.csv"
set datafile separator comma
set title 'Kinetic energy of the wind' noenhanced
set xlabel 'time [s]' noenhanced
set ylabel 'energy [m^5/s^2]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [-0.06:2.06]
set yrange [-2.74311:94.1801]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "energy.svg"
plot data index 0 using 2:5 with lines lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'confetti'
set terminal pngcairo size 1230,660 font "Sans,13"
set output "energy.png"
plot data index 0 using 2:5 with lines lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'confetti'
