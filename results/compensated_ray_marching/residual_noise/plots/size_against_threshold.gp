# Draws size_against_threshold.svg and size_against_threshold.png from size_against_threshold.csv: run gnuplot on this file in its folder.
data = "size_against_threshold.csv"
set datafile separator comma
set title 'kB against setting' noenhanced
set xlabel 'setting' noenhanced
set ylabel 'kB' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.812252:39.3966]
set logscale y
set format y "%g"
set yrange [38.3273:921.001]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "size_against_threshold.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'hash, tags', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'hash, domain bits', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'small hash, tags', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'hash of 27 frames', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'hash of 27 frames that differ', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'bricks 8', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'bricks 4', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'bricks 8, apron', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'NanoVDB floats', \
     data index 16 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'NanoVDB 8 bits', \
     data index 18 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle, \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'raw', \
     data index 20 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 22 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'density bricks 8', \
     data index 22 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "size_against_threshold.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'hash, tags', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'hash, domain bits', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'small hash, tags', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'hash of 27 frames', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'hash of 27 frames that differ', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'bricks 8', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'bricks 4', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'bricks 8, apron', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'NanoVDB floats', \
     data index 16 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'NanoVDB 8 bits', \
     data index 18 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle, \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'raw', \
     data index 20 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 22 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'density bricks 8', \
     data index 22 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle
