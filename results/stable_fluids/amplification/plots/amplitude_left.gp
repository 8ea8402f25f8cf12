# Draws amplitude_left.svg and amplitude_left.png from amplitude_left.csv: run gnuplot on this file in its folder.
data = "amplitude_left.csv"
set datafile separator comma
set title 'Amplitude left after one turn' noenhanced
set xlabel 'waves in 64 cells' noenhanced
set ylabel 'amplitude left' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [1.76541:18.1261]
set logscale y
set format y "%g"
set yrange [1.6765e-16:7.81318]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "amplitude_left.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'semi-Lagrangian 0.25', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'semi-Lagrangian 0.5', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'semi-Lagrangian 1.5', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'semi-Lagrangian 3.25', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 0.25', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 0.5', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 1.5', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 3.25', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'MacCormack 0.25', \
     data index 16 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'MacCormack 0.5', \
     data index 18 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle, \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'MacCormack 1.5', \
     data index 20 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 22 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'MacCormack 3.25', \
     data index 22 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 24 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'MacCormack, clamped 0.25', \
     data index 24 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 26 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'MacCormack, clamped 0.5', \
     data index 26 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 28 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'MacCormack, clamped 1.5', \
     data index 28 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 30 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'MacCormack, clamped 3.25', \
     data index 30 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 32 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'BFECC 0.25', \
     data index 32 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 34 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'BFECC 0.5', \
     data index 34 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 36 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'BFECC 1.5', \
     data index 36 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 38 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'BFECC 3.25', \
     data index 38 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "amplitude_left.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'semi-Lagrangian 0.25', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'semi-Lagrangian 0.5', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'semi-Lagrangian 1.5', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'semi-Lagrangian 3.25', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 0.25', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 0.5', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 1.5', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'semi-Lagrangian, cubic 3.25', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'MacCormack 0.25', \
     data index 16 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'MacCormack 0.5', \
     data index 18 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle, \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'MacCormack 1.5', \
     data index 20 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 22 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'MacCormack 3.25', \
     data index 22 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 24 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'MacCormack, clamped 0.25', \
     data index 24 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 26 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'MacCormack, clamped 0.5', \
     data index 26 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 28 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'MacCormack, clamped 1.5', \
     data index 28 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 30 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'MacCormack, clamped 3.25', \
     data index 30 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 32 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'BFECC 0.25', \
     data index 32 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 34 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'BFECC 0.5', \
     data index 34 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 36 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'BFECC 1.5', \
     data index 36 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 38 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'BFECC 3.25', \
     data index 38 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle
