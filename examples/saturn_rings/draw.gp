# Draws saturn_rings.png from places.csv and surroundings.csv, which the program has written.
set terminal pngcairo size 940,910 font "sans,10"
set output 'saturn_rings.png'
set datafile separator ','
set multiplot layout 2,2 margins 0.065,0.925,0.06,0.965 spacing 0.1,0.1
set size ratio -1
set tics out nomirror scale 0.5
set xlabel 'x, away from Saturn (m)' offset 0,0.5
set ylabel 'y, along the motion (m)' offset 1,0
set xtics 30
set ytics 30
set style fill solid noborder
do for [k in "0 1 5"] {
  set title sprintf('%s orbit%s', k, k eq "1" ? '' : 's')
  plot [0:180] [0:180] 'places.csv' index int(k) using 1:2:3 with circles lc rgb '#2f5d8a' notitle
}
set title 'spheres about a sphere, of a mean of 1'
set palette defined (0.4 '#2f5d8a', 1 '#f7f7f7', 1.6 '#b2422f')
set cbrange [0.4:1.6]
set cbtics 0.2
plot [-90:90] [-90:90] 'surroundings.csv' with image notitle
