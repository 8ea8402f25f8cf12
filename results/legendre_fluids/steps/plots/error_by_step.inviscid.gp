# Draws error_by_step.inviscid.svg and error_by_step.inviscid.png from error_by_step.inviscid.csv: run gnuplot on this file in its folder.
data = "error_by_step.inviscid.csv"
set datafile separator comma
set title 'Error of the velocity after two seconds: inviscid' noenhanced
set xlabel 'step [s]' noenhanced
set ylabel 'relative L2 error' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.0110338:0.113288]
set logscale y
set format y "%g"
set yrange [1.56357e-08:0.000171653]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_by_step.inviscid.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Runge-Kutta', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_by_step.inviscid.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Runge-Kutta', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
