# Draws stability_map.svg and stability_map.png from stability_map.csv: run gnuplot on this file in its folder.
data = "stability_map.csv"
set datafile separator comma
set encoding utf8
set xrange [-4.5000:1.5000]
set yrange [-6.5000:3.5000]
set cbrange [-16:2]
set xtics 2
set ytics 2
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725", 4.5 "#d55e00")
set cblabel 'log10 of the steps until the energy is tenfold' noenhanced
set object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "#bbbbbb" fillstyle solid noborder
set terminal svg dynamic size 1500,1775 font "sans-serif,11"
set output "stability_map.svg"
set multiplot layout 5,4
set title 'galerkin 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'galerkin 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'galerkin 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, Chebyshev 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, Chebyshev 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 4 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, Chebyshev 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 5 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, L2 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 6 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, L2 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 7 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, L2 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 8 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 4' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 9 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 10 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 11 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 12 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 4' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 13 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 14 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 15 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 16 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
unset multiplot
set terminal pngcairo size 1800,2150 font "Sans,11"
set output "stability_map.png"
set multiplot layout 5,4
set title 'galerkin 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'galerkin 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'galerkin 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, Chebyshev 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, Chebyshev 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 4 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, Chebyshev 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 5 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, L2 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 6 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, L2 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 7 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, repaired, L2 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 8 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 4' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 9 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 10 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 11 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, Chebyshev 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 12 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 4' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 13 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 6' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 14 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 8' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 15 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title 'paper, L2 12' noenhanced
set xlabel 'log10 step [s]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 16 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
unset multiplot
