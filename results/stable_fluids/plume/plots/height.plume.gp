# Draws height.plume.svg and height.plume.png from height.plume.csv: run gnuplot on this file in its folder.
data = "height.plume.csv"
set datafile separator comma
set title 'Height of the centre of mass: plume' noenhanced
set xlabel 'time [s]' noenhanced
set ylabel 'height [m]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [-0.03:1.03]
set yrange [0:0.575]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "height.plume.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'semi-Lagrangian, double', \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'MacCormack, double', \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'BFECC, double', \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'MacCormack, float'
set terminal pngcairo size 1230,660 font "Sans,13"
set output "height.plume.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'semi-Lagrangian, double', \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'MacCormack, double', \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'BFECC, double', \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'MacCormack, float'
