# Draws error_against_time.boxes_3.svg and error_against_time.boxes_3.png from error_against_time.boxes_3.csv: run gnuplot on this file in its folder.
data = "error_against_time.boxes_3.csv"
set datafile separator comma
set title 'rel_l2 against time of one render [s]: boxes_3' noenhanced
set xlabel 'time of one render [s]' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:0.0147329]
set logscale y
set format y "%g"
set yrange [6.57976e-08:0.118358]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_time.boxes_3.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'by pixel', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'stencil', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'stencil, polynomial', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'vertices', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'vertices, GPU', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'vertices, polynomial', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_time.boxes_3.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'by pixel', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'stencil', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'stencil, polynomial', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'vertices', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'vertices, GPU', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'vertices, polynomial', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle
