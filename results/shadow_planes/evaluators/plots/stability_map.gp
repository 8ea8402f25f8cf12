# Draws stability_map.svg and .png from ../map.csv: run gnuplot on this file in its folder.
data = "../map.csv"
set datafile separator comma
set key autotitle columnhead
set encoding utf8
# White: a = extinction * h = 1; dashed: the light is 3 optical lengths away.
$far << EOD
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
set xrange [-6.12:4.12]
set yrange [-6.12:3.12]
set cbrange [-16:2]
set xtics 2
set ytics 2
set xlabel "log10 extinction [1/m]" offset 0,0.5
set ylabel "log10 h [m]" offset 1,0
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962", 4 "#fde725", 4.5 "#d55e00")
set cblabel "log10 of the relative error"
set object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "#bbbbbb" fillstyle solid noborder
set terminal svg size 1500,700 dynamic font "sans-serif,11"
set output "stability_map.svg"
set multiplot layout 2,4
set title "polynomial, differences, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "polynomial, part by part, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($4 < 1e-16 ? 1e-16 : $4)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 8 nodes, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($5 < 1e-16 ? 1e-16 : $5)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 16 nodes, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($6 < 1e-16 ? 1e-16 : $6)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "polynomial, differences, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($7 < 1e-16 ? 1e-16 : $7)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "polynomial, part by part, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($8 < 1e-16 ? 1e-16 : $8)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 32 nodes, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($9 < 1e-16 ? 1e-16 : $9)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 64 nodes, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($10 < 1e-16 ? 1e-16 : $10)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
unset multiplot
set terminal pngcairo size 1800,840 font "Sans,11"
set output "stability_map.png"
set multiplot layout 2,4
set title "polynomial, differences, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "polynomial, part by part, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($4 < 1e-16 ? 1e-16 : $4)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 8 nodes, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($5 < 1e-16 ? 1e-16 : $5)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 16 nodes, single" noenhanced
plot data using (log10($1)):(log10($2)):(log10($6 < 1e-16 ? 1e-16 : $6)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "polynomial, differences, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($7 < 1e-16 ? 1e-16 : $7)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "polynomial, part by part, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($8 < 1e-16 ? 1e-16 : $8)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 32 nodes, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($9 < 1e-16 ? 1e-16 : $9)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
set title "rule, 64 nodes, double" noenhanced
plot data using (log10($1)):(log10($2)):(log10($10 < 1e-16 ? 1e-16 : $10)) with image notitle, \
     -x with lines lw 1 lc rgb "white" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb "white" notitle
unset multiplot
