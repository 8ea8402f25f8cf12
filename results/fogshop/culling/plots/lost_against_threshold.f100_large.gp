# Draws lost_against_threshold.f100_large.svg and lost_against_threshold.f100_large.png from lost_against_threshold.f100_large.csv: run gnuplot on this file in its folder.
data = "lost_against_threshold.f100_large.csv"
set datafile separator comma
set title 'p999 against eps_T: f100_large' noenhanced
set xlabel 'eps_T' noenhanced
set ylabel 'p999' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [5.7544e-07:0.017378]
set logscale y
set format y "%g"
set yrange [3.03304e-06:0.165686]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "lost_against_threshold.f100_large.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'by depth', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "lost_against_threshold.f100_large.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'by depth', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
