# Draws evaluator_times.svg and .png from evaluator_times.csv: run gnuplot on this file in its folder.
data = "evaluator_times.csv"
set datafile separator comma
set title "Error against time of one evaluation; labels: degree or nodes" noenhanced
set xlabel "time, one thread or the whole device [ns]"
set ylabel "relative error, 99th percentile"
set logscale xy
set format y "%g"
set key outside right center vertical Left reverse
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "evaluator_times.svg"
plot data index 0 using 3:4 with linespoints lc rgb "#D55E00" pt 7 ps 0.7 lw 1.6 title "polynomial, single", \
     data index 0 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#D55E00" notitle, \
     data index 1 using 3:4 with linespoints lc rgb "#E69F00" pt 7 ps 0.7 lw 1.6 title "polynomial, double", \
     data index 1 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#E69F00" notitle, \
     data index 2 using 3:4 with linespoints lc rgb "#CC79A7" pt 7 ps 0.7 lw 1.6 title "polynomial, single, device", \
     data index 2 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#CC79A7" notitle, \
     data index 3 using 3:4 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title "rule, single", \
     data index 3 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#0072B2" notitle, \
     data index 4 using 3:4 with linespoints lc rgb "#56B4E9" pt 7 ps 0.7 lw 1.6 title "rule, double", \
     data index 4 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#56B4E9" notitle, \
     data index 5 using 3:4 with linespoints lc rgb "#009E73" pt 7 ps 0.7 lw 1.6 title "rule, single, device", \
     data index 5 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#009E73" notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "evaluator_times.png"
plot data index 0 using 3:4 with linespoints lc rgb "#D55E00" pt 7 ps 0.7 lw 1.6 title "polynomial, single", \
     data index 0 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#D55E00" notitle, \
     data index 1 using 3:4 with linespoints lc rgb "#E69F00" pt 7 ps 0.7 lw 1.6 title "polynomial, double", \
     data index 1 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#E69F00" notitle, \
     data index 2 using 3:4 with linespoints lc rgb "#CC79A7" pt 7 ps 0.7 lw 1.6 title "polynomial, single, device", \
     data index 2 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#CC79A7" notitle, \
     data index 3 using 3:4 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title "rule, single", \
     data index 3 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#0072B2" notitle, \
     data index 4 using 3:4 with linespoints lc rgb "#56B4E9" pt 7 ps 0.7 lw 1.6 title "rule, double", \
     data index 4 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#56B4E9" notitle, \
     data index 5 using 3:4 with linespoints lc rgb "#009E73" pt 7 ps 0.7 lw 1.6 title "rule, single, device", \
     data index 5 using 3:4:2 with labels offset 0.6,0.6 font ",9" tc rgb "#009E73" notitle
