# Draws error_against_time.plume_in_the_sun.svg and error_against_time.plume_in_the_sun.png from error_against_time.plume_in_the_sun.csv: run gnuplot on this file in its folder.
data = "error_against_time.plume_in_the_sun.csv"
set datafile separator comma
set title "Ray marcher and path tracer, single scattering in real smoke: plume in the sun" noenhanced
set xlabel "time of one render [s]" noenhanced
set ylabel "rel_l2" noenhanced
set key outside right top noenhanced
set grid xtics ytics lc rgb "#dddddd"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale y
set format y "%g"
set logscale x
set format x "%g"
set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
set terminal svg size 720,440 dynamic font "sans-serif,13"
set output "error_against_time.plume_in_the_sun.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title "ray marcher", \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title "ray marcher, marched shadows", \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 3 using 2:5 with points lc rgb "#D55E00" pt 10 ps 0.9 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title "path tracer", \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 5 using 2:5 with points lc rgb "#009E73" pt 10 ps 0.9 notitle, \
     0.192802 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
set terminal pngcairo size 1080,660 font "Sans,13"
set output "error_against_time.plume_in_the_sun.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title "ray marcher", \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title "ray marcher, marched shadows", \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 3 using 2:5 with points lc rgb "#D55E00" pt 10 ps 0.9 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title "path tracer", \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 5 using 2:5 with points lc rgb "#009E73" pt 10 ps 0.9 notitle, \
     0.192802 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
