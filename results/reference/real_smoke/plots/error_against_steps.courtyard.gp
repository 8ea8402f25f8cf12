# Draws error_against_steps.courtyard.svg and error_against_steps.courtyard.png from error_against_steps.courtyard.csv: run gnuplot on this file in its folder.
data = "error_against_steps.courtyard.csv"
set datafile separator comma
set title 'rel_l2 against steps per camera ray: courtyard' noenhanced
set xlabel 'steps per camera ray' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [6.77396:151.167]
set logscale y
set format y "%g"
set yrange [0.00213225:0.0318341]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_steps.courtyard.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'ray marcher', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'ray marcher, 32 directions', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     0.00565714 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_steps.courtyard.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'ray marcher', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'ray marcher, 32 directions', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     0.00565714 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
