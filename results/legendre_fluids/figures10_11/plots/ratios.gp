# Draws ratios.svg and ratios.png from ratios.csv: run gnuplot on this file in its folder.
data = "ratios.csv"
set datafile separator comma
set encoding utf8
set xrange [1.0837:2.5287]
set yrange [1.6557:2.8598]
set cbrange [-16:2]
set xtics 2
set ytics 2
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725", 4.5 "#d55e00")
set cblabel 'log10 of the times faster' noenhanced
set object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "#bbbbbb" fillstyle solid noborder
set terminal svg dynamic size 1500,355 font "sans-serif,11"
set output "ratios.svg"
set multiplot layout 1,4
set title '2D' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title '2D, repaired paper' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title '3D' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title '3D, repaired paper' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
unset multiplot
set terminal pngcairo size 1800,430 font "Sans,11"
set output "ratios.png"
set multiplot layout 1,4
set title '2D' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title '2D, repaired paper' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title '3D' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
set title '3D, repaired paper' noenhanced
set xlabel 'log10 coefficients' offset 0,0.5 noenhanced
set ylabel 'log10 cells along an axis' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle
unset multiplot
