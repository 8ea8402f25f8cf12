# Draws v_at_reynolds_100.references.svg and v_at_reynolds_100.references.png from v_at_reynolds_100.references.csv: run gnuplot on this file in its folder.
data = "v_at_reynolds_100.references.csv"
set datafile separator comma
set title 'Reynolds number 100: v along y = 0.5: references' noenhanced
set xlabel 'x [m]' noenhanced
set ylabel 'v [m/s]' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [-0.03:1.03]
set yrange [-0.266534:0.192551]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "v_at_reynolds_100.references.svg"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Re 100, unit lid 16', \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'Re 100, unit lid 32', \
     data index 4 using 2:5 with lines lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'Re 100, unit lid 48', \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'spectral, Re 100'
set terminal pngcairo size 1230,660 font "Sans,13"
set output "v_at_reynolds_100.references.png"
plot data index 0 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'Re 100, unit lid 16', \
     data index 2 using 2:5 with linespoints lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'Re 100, unit lid 32', \
     data index 4 using 2:5 with lines lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'Re 100, unit lid 48', \
     data index 6 using 2:5 with linespoints lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'spectral, Re 100'
