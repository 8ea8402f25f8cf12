# Draws error_against_total_time.tube.svg and error_against_total_time.tube.png from error_against_total_time.tube.csv: run gnuplot on this file in its folder.
data = "error_against_total_time.tube.csv"
set datafile separator comma
set title 'rel_l2 against time of preparation and one render [s]: tube' noenhanced
set xlabel 'time of preparation and one render [s]' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.00199904:3.37246]
set logscale y
set format y "%g"
set yrange [0.00225013:9.88888]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_total_time.tube.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'S3', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'S3x', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'ray marcher', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'paper, GPU', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'S3, GPU', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'S3x, GPU', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'ray marcher, GPU', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_total_time.tube.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'S3', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'S3x', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'ray marcher', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'paper, GPU', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'S3, GPU', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'S3x, GPU', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'ray marcher, GPU', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle
