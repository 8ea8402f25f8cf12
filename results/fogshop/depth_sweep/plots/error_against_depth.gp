# Draws error_against_depth.svg and error_against_depth.png from error_against_depth.csv: run gnuplot on this file in its folder.
data = "error_against_depth.csv"
set datafile separator comma
set title 'rel_l2 against sigma_t (median depth: 9.6 times that)' noenhanced
set xlabel 'sigma_t (median depth: 9.6 times that)' noenhanced
set ylabel 'rel_l2' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.00158445:7.88918]
set logscale y
set format y "%g"
set yrange [4.62814e-05:1.7512]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "error_against_depth.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'S 12', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'S 26', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'S 64', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'S3 extrapolated 16', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'S3 extrapolated 24', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'S3 extrapolated 32', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'S3 extrapolated 64', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "error_against_depth.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'S 12', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'S 26', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'S 64', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'S3 extrapolated 16', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'S3 extrapolated 24', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'S3 extrapolated 32', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'S3 extrapolated 64', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle
