# Draws error_against_order.thick.svg and error_against_order.thick.png from error_against_order.thick.csv: run gnuplot on this file in its folder.
data = "error_against_order.thick.csv"
set datafile separator comma
set title 'rel_l2 against setting: thick' noenhanced
set xlabel 'setting' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.861488:13.9294]
set logscale y
set format y "%g"
set yrange [0.0181044:1.02132]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_order.thick.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper, HYB', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'paper, OL', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'paper, series', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'paper, directional', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'grid', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 9 using 2:5 with points lc rgb "#E69F00" pt 10 ps 0.9 notitle, \
     0.039822 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_order.thick.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper, HYB', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'paper, OL', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'paper, series', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'paper, directional', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'grid', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 9 using 2:5 with points lc rgb "#E69F00" pt 10 ps 0.9 notitle, \
     0.039822 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
