# Draws share_against_size.svg and share_against_size.png from share_against_size.csv: run gnuplot on this file in its folder.
data = "share_against_size.csv"
set datafile separator comma
set title 'share of the memory'."'".'s bandwidth against cells a side' noenhanced
set xlabel 'cells a side' noenhanced
set ylabel 'share of the memory'."'".'s bandwidth' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [0:73.6]
set yrange [0:0.110438]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "share_against_size.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'semi-Lagrangian', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'MacCormack, clamped', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'BFECC, clamped', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'semi-Lagrangian, scalar', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'MacCormack, clamped, scalar', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "share_against_size.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'semi-Lagrangian', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'MacCormack, clamped', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'BFECC, clamped', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'semi-Lagrangian, scalar', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'MacCormack, clamped, scalar', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle
