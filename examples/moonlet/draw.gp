# Draws moonlet.png from disc_at_the_end.csv and paths.csv, which the program has written.
set terminal pngcairo size 1100,640 font "sans,11"
set output 'moonlet.png'
set datafile separator ','
set multiplot
set tics out nomirror scale 0.5
set size ratio -1
set xlabel 'y, along the motion (Hill radii)' offset 0,0.5
set ylabel 'x, outwards' offset 0.5,0
set ytics 4
set origin 0, 0.6
set size 1, 0.4
set title 'tracers of a disc after 13 orbits of the moonlet'
set object 1 circle at 0,0 size 0.5 fillcolor '#b2422f' fillstyle solid noborder front
plot [-60:60] [-8:8] 'disc_at_the_end.csv' using 2:1 with points pt 7 ps 0.25 lc rgb '#2f5d8a' notitle
set origin 0, 0
set size 0.66, 0.6
set ylabel 'x, outwards (Hill radii)'
set title 'paths of single tracers past a point'
set object 1 circle at 0,0 size 0.2
plot [-16:16] [-8:8] 'paths.csv' using 2:1 with lines lw 1 lc rgb '#2f5d8a' notitle, \
  '' using (-$2):(-$1) with lines lw 1 lc rgb '#d08a2e' notitle
unset object 1
set origin 0.66, 0
set size noratio
set size 0.34, 0.6
set logscale xy
set xlabel 'b, distance of the passage (Hill radii)' offset 0,0.5
set ylabel 'E, amplitude afterwards (Hill radii)' offset 0.5,0
set xtics (5, 10, 20, 40)
set ytics (0.003, 0.01, 0.03, 0.1, 0.3)
set format y '%g'
set title 'distant passages'
plot [4:50] [0.002:0.6] 2.2396 * 3 / x**2 with lines lw 1.5 lc rgb '#d08a2e' title '2.24 G m/b^2', \
  'passages.csv' using 1:2 with points pt 7 ps 1.2 lc rgb '#2f5d8a' title 'measured'
