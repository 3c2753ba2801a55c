# Errors over condition numbers: `conditions` is docs/paper/conditions.csv, `out` the SVG.
set datafile separator ','
set terminal svg size 900,560 font 'sans,13' background rgb 'white'
set output out
set grid
set key outside below noenhanced
set title 'error of u over its condition number'
set logscale xy
set format xy '10^{%L}'
set xlabel 'condition number'
set ylabel 'error of u'
set xrange [1e-1:1e12]
set yrange [1e-18:1]
plot conditions using 1:4 with points pt 7 ps 0.3 lc rgb '#b7791f' title 'root of r in powers, form paper', \
     conditions using 2:5 with points pt 7 ps 0.3 lc rgb '#2b6cb0' title 'root of r in Bernstein form, no polish', \
     conditions using 3:6 with points pt 7 ps 0.3 lc rgb '#c02020' title 'common root of a and b, polish', \
     2**-53 * x with lines lc 'black' title 'condition x 2^-53'
