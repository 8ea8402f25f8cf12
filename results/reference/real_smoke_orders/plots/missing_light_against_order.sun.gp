# Draws missing_light_against_order.sun.svg and missing_light_against_order.sun.png from missing_light_against_order.sun.csv: run gnuplot on this file in its folder.
data = "missing_light_against_order.sun.csv"
set datafile separator comma
set title 'missing light, share of the whole against highest order of scattering: sun' noenhanced
set xlabel 'highest order of scattering' noenhanced
set ylabel 'missing light, share of the whole' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set logscale x
set format x "%g"
set xrange [0.882703:9.06307]
set logscale y
set format y "%g"
set yrange [0.00127795:0.78392]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "missing_light_against_order.sun.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'path tracer, orders up to', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     0.00180242 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
set terminal pngcairo size 1230,660 font "Sans,13"
set output "missing_light_against_order.sun.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'path tracer, orders up to', \
     data index 0 using 2:5:3:4:6:7 with xyerrorbars lc rgb "#0072B2" pt 0 lw 0.8 notitle, \
     data index 1 using 2:5 with points lc rgb "#0072B2" pt 10 ps 0.9 notitle, \
     0.00180242 with lines dt 2 lw 1 lc rgb "#888888" title "noise floor"
