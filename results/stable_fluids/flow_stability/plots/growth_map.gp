# Draws growth_map.svg and growth_map.png from growth_map.csv: run gnuplot on this file in its folder.
data = "growth_map.csv"
set datafile separator comma
set encoding utf8
set xrange [-1.2500:2.2500]
set yrange [-6.5000:6.5000]
set cbrange [-16:2]
set xtics 2
set ytics 2
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725", 4.5 "#d55e00")
set cblabel 'log10 of the growth of the energy' noenhanced
set object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "#bbbbbb" fillstyle solid noborder
$line0 << EOD
0.0000,-6.0000
0.0000,-5.0000
0.0000,-4.0000
0.0000,-3.0000
0.0000,-2.0000
0.0000,-1.0000
0.0000,0.0000
0.0000,1.0000
0.0000,2.0000
0.0000,3.0000
0.0000,4.0000
0.0000,5.0000
0.0000,6.0000
EOD
$line1 << EOD
-1.0000,-0.3677
-0.5000,-0.8677
0.0000,-1.3677
0.5000,-1.8677
1.0000,-2.3677
1.5000,-2.8677
2.0000,-3.3677
EOD
set terminal svg dynamic size 1500,710 font "sans-serif,11"
set output "growth_map.svg"
set multiplot layout 2,4
set title 'semi-Lagrangian' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, clamped' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, reverted' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, unlimited' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'BFECC, clamped' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 4 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'BFECC, unlimited' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 5 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, clamped, 3D' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 6 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, unlimited, 3D' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 7 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
unset multiplot
set terminal pngcairo size 1800,860 font "Sans,11"
set output "growth_map.png"
set multiplot layout 2,4
set title 'semi-Lagrangian' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, clamped' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, reverted' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, unlimited' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'BFECC, clamped' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 4 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'BFECC, unlimited' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 5 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, clamped, 3D' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 6 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'MacCormack, unlimited, 3D' noenhanced
set xlabel 'log10 CFL [cells a step]' offset 0,0.5 noenhanced
set ylabel 'log10 viscosity [m^2/s]' offset 1,0 noenhanced
plot data index 7 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
unset multiplot
