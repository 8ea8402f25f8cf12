# Draws error_against_time.spot__larger.svg and error_against_time.spot__larger.png from error_against_time.spot__larger.csv: run gnuplot on this file in its folder.
data = "error_against_time.spot__larger.csv"
set datafile separator comma
set title 'rel_l2 against time of one render [s]: spot, larger' noenhanced
set xlabel 'time of one render [s]' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.00352356:0.282524]
set logscale y
set format y "%g"
set yrange [1.13108e-07:0.381163]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_time.spot__larger.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'rule', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'rule, GPU', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'ray marcher', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_time.spot__larger.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'rule', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'rule, GPU', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'ray marcher', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle
