# Draws energy.swirl.svg and energy.swirl.png from energy.swirl.csv: run gnuplot on this file in its folder.
data = "energy.swirl.csv"
set datafile separator comma
set title 'Energy left of a swirl: swirl' noenhanced
set xlabel 'time [s], 100 steps each' noenhanced
set ylabel 'kinetic energy' noenhanced
set key outside right center vertical Left reverse noenhanced
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3 lc rgb "#444444"
set tics nomirror
set xrange [-3:103]
set logscale y
set format y "%g"
set yrange [0.00416401:0.236457]
set terminal svg size 820,440 dynamic font "sans-serif,13"
set output "energy.swirl.svg"
plot data index 0 using 2:5 with lines lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'galerkin 6', \
     data index 2 using 2:5 with lines lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'galerkin 8', \
     data index 4 using 2:5 with lines lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'galerkin 12', \
     data index 6 using 2:5 with lines lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'galerkin 16', \
     data index 8 using 2:5 with lines lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'galerkin, filtered', \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'paper, Chebyshev 6', \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'paper, Chebyshev 8', \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'paper, Chebyshev 12', \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'paper, L2 6', \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'paper, L2 8', \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper, L2 12', \
     data index 22 using 2:5 with lines lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'paper, repaired, Chebyshev 6', \
     data index 24 using 2:5 with lines lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'paper, repaired, Chebyshev 8', \
     data index 26 using 2:5 with lines lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'paper, repaired, Chebyshev 12', \
     data index 28 using 2:5 with lines lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'paper, repaired, L2 6', \
     data index 30 using 2:5 with lines lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'paper, repaired, L2 8', \
     data index 32 using 2:5 with lines lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'paper, repaired, L2 12', \
     data index 34 using 2:5 with lines lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'Stable Fluids, MacCormack'
set terminal pngcairo size 1230,660 font "Sans,13"
set output "energy.swirl.png"
plot data index 0 using 2:5 with lines lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'galerkin 6', \
     data index 2 using 2:5 with lines lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'galerkin 8', \
     data index 4 using 2:5 with lines lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'galerkin 12', \
     data index 6 using 2:5 with lines lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'galerkin 16', \
     data index 8 using 2:5 with lines lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'galerkin, filtered', \
     data index 10 using 2:5 with linespoints lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'paper, Chebyshev 6', \
     data index 12 using 2:5 with linespoints lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'paper, Chebyshev 8', \
     data index 14 using 2:5 with linespoints lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'paper, Chebyshev 12', \
     data index 16 using 2:5 with linespoints lc rgb "#80BA5A" pt 12 ps 0.7 lw 1.6 title 'paper, L2 6', \
     data index 18 using 2:5 with linespoints lc rgb "#A5AA99" pt 15 ps 0.7 lw 1.6 title 'paper, L2 8', \
     data index 20 using 2:5 with linespoints lc rgb "#0072B2" pt 7 ps 0.7 lw 1.6 title 'paper, L2 12', \
     data index 22 using 2:5 with lines lc rgb "#D55E00" pt 5 ps 0.7 lw 1.6 title 'paper, repaired, Chebyshev 6', \
     data index 24 using 2:5 with lines lc rgb "#009E73" pt 9 ps 0.7 lw 1.6 title 'paper, repaired, Chebyshev 8', \
     data index 26 using 2:5 with lines lc rgb "#CC79A7" pt 13 ps 0.7 lw 1.6 title 'paper, repaired, Chebyshev 12', \
     data index 28 using 2:5 with lines lc rgb "#E69F00" pt 11 ps 0.7 lw 1.6 title 'paper, repaired, L2 6', \
     data index 30 using 2:5 with lines lc rgb "#56B4E9" pt 6 ps 0.7 lw 1.6 title 'paper, repaired, L2 8', \
     data index 32 using 2:5 with lines lc rgb "#000000" pt 4 ps 0.7 lw 1.6 title 'paper, repaired, L2 12', \
     data index 34 using 2:5 with lines lc rgb "#7F3C8D" pt 8 ps 0.7 lw 1.6 title 'Stable Fluids, MacCormack'
