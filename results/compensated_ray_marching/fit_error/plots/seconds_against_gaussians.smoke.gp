# Draws seconds_against_gaussians.smoke.svg and seconds_against_gaussians.smoke.png from seconds_against_gaussians.smoke.csv: run gnuplot on this file in its folder.
data = "seconds_against_gaussians.smoke.csv"
set datafile separator comma
set title 'time of the fit [s] against Gaussians: smoke' noenhanced
set xlabel 'Gaussians' noenhanced
set ylabel 'time of the fit [s]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [38.9582:4106.96]
set logscale y
set format y "%g"
set yrange [0.0216641:5.70579]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "seconds_against_gaussians.smoke.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title '48^3', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title '48^3, two octaves', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title '48^3, one octave', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title '48^3, puff', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title '64^3', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title '128^3', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'plume', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title '48^3, none teleported', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title '48^3, to the end', \
     data index 16 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title '48^3, from 0.5 voxels', \
     data index 18 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle, \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title '48^3, from 0.35 voxels', \
     data index 20 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
set terminal pngcairo size 1230,660 font "Sans,13"
set output "seconds_against_gaussians.smoke.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title '48^3', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title '48^3, two octaves', \
     data index 2 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#D55E00" pt 0 lw 0.8 notitle, \
     data index 4 using 2:5 with linespoints lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title '48^3, one octave', \
     data index 4 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#009E73" pt 0 lw 0.8 notitle, \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title '48^3, puff', \
     data index 6 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#CC79A7" pt 0 lw 0.8 notitle, \
     data index 8 using 2:5 with linespoints lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title '64^3', \
     data index 8 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#E69F00" pt 0 lw 0.8 notitle, \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title '128^3', \
     data index 10 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#56B4E9" pt 0 lw 0.8 notitle, \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'plume', \
     data index 12 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#000000" pt 0 lw 0.8 notitle, \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title '48^3, none teleported', \
     data index 14 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#7F3C8D" pt 0 lw 0.8 notitle, \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title '48^3, to the end', \
     data index 16 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#80BA5A" pt 0 lw 0.8 notitle, \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title '48^3, from 0.5 voxels', \
     data index 18 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#A5AA99" pt 0 lw 0.8 notitle, \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title '48^3, from 0.35 voxels', \
     data index 20 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle
