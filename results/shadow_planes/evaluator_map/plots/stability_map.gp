# Draws stability_map.svg and stability_map.png from stability_map.csv: run gnuplot on this file in its folder.
data = "stability_map.csv"
set datafile separator comma
set encoding utf8
set xrange [-6.1250:4.1250]
set yrange [-6.1250:3.1250]
set cbrange [-16:2]
set xtics 2
set ytics 2
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725", 4.5 "#d55e00")
set cblabel 'log10 of the relative error' noenhanced
set object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "#bbbbbb" fillstyle solid noborder
$line0 << EOD
6.0000,-6.0000
5.7500,-5.7500
5.5000,-5.5000
5.2500,-5.2500
5.0000,-5.0000
4.7500,-4.7500
4.5000,-4.5000
4.2500,-4.2500
4.0000,-4.0000
3.7500,-3.7500
3.5000,-3.5000
3.2500,-3.2500
3.0000,-3.0000
2.7500,-2.7500
2.5000,-2.5000
2.2500,-2.2500
2.0000,-2.0000
1.7500,-1.7500
1.5000,-1.5000
1.2500,-1.2500
1.0000,-1.0000
0.7500,-0.7500
0.5000,-0.5000
0.2500,-0.2500
0.0000,0.0000
-0.2500,0.2500
-0.5000,0.5000
-0.7500,0.7500
-1.0000,1.0000
-1.2500,1.2500
-1.5000,1.5000
-1.7500,1.7500
-2.0000,2.0000
-2.2500,2.2500
-2.5000,2.5000
-2.7500,2.7500
-3.0000,3.0000
EOD
$line1 << EOD
-0.2218,-6.0000
-0.2218,-5.7500
-0.2218,-5.5000
-0.2218,-5.2500
-0.2218,-5.0000
-0.2218,-4.7500
-0.2218,-4.5000
-0.2218,-4.2500
-0.2218,-4.0000
-0.2218,-3.7500
-0.2218,-3.5000
-0.2218,-3.2500
-0.2218,-3.0000
-0.2218,-2.7500
-0.2218,-2.5000
-0.2218,-2.2500
-0.2218,-2.0000
-0.2219,-1.7500
-0.2219,-1.5000
-0.2219,-1.2500
-0.2219,-1.0000
-0.2221,-0.7500
-0.2227,-0.5000
-0.2246,-0.2500
-0.2304,0.0000
-0.2477,0.2500
-0.2949,0.5000
-0.3994,0.7500
-0.5713,1.0000
-0.7894,1.2500
-1.0282,1.5000
-1.2746,1.7500
-1.5234,2.0000
-1.7731,2.2500
-2.0229,2.5000
-2.2729,2.7500
-2.5229,3.0000
EOD
set terminal svg dynamic size 1500,710 font "sans-serif,11"
set output "stability_map.svg"
set multiplot layout 2,4
set title 'polynomial, differences, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'polynomial, part by part, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 8 nodes, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 16 nodes, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'polynomial, differences, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 4 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'polynomial, part by part, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 5 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 32 nodes, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 6 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 64 nodes, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 7 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
unset multiplot
set terminal pngcairo size 1800,860 font "Sans,11"
set output "stability_map.png"
set multiplot layout 2,4
set title 'polynomial, differences, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 0 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'polynomial, part by part, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 1 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 8 nodes, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 2 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 16 nodes, single' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 3 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'polynomial, differences, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 4 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'polynomial, part by part, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 5 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 32 nodes, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 6 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title 'rule, 64 nodes, double' noenhanced
set xlabel 'log10 extinction [1/m]' offset 0,0.5 noenhanced
set ylabel 'log10 h [m]' offset 1,0 noenhanced
plot data index 7 using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, $line0 using 1:2 with lines lw 1 dt 1 lc rgb "white" notitle, $line1 using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
unset multiplot
