# The chart of docs/accuracy.md: `chart` is a CSV of pscn chart, `out` the SVG, `name` the scene. And of conditions.csv.
set datafile separator ','
set grid
set key outside below noenhanced
set terminal svg size 1100,660 font 'sans,13' background rgb 'white'
if (exists('chart')) {
  # Colour for the solver, shape for the form. A point has the columns of the table made by accuracy.sh: solver, form,
  # error of right answers, share of wrong ones, nanoseconds, label.
  solvers = 'bernstein newton laguerre aberth rival Embree'
  colours = '#c02020 #2b6cb0 #2f855a #b7791f #000000 #6b46c1'
  forms = 'leaves whole power paper rival mesh'
  titles = '"leaves, polish" "whole patches, polish" "power basis, no polish" "form paper" "rivals" "Embree, 8 rays"'
  shapes = '7 5 9 12 13 6'
  set output out
  set multiplot layout 1,2 title name font ',14'
  set key maxrows 6
  set yrange [10:3e5]
  set logscale xy
  set format x '10^{%L}'
  set ylabel 'nanoseconds a ray'
  set xlabel 'error of T of right answers (99 %)'
  set xrange [1e-17:1]
  do for [panel = 3:4] {
    if (panel == 4) { set xlabel 'share of wrong answers (left: none)'; set xrange [1e-4:1]; set format x '%g' }
    plot for [s = 1:words(solvers)] for [f = 1:words(forms)] chart \
           using (strcol(1) eq word(solvers, s) && strcol(2) eq word(forms, f) ? column(panel) : NaN):5 \
           with points pt int(word(shapes, f)) ps 0.9 lc rgb word(colours, s) notitle, \
         chart using panel:5:6 with labels offset 0.6,0.4 left font ',9' notitle, \
         for [s = 1:words(solvers)] NaN with points pt 7 lc rgb word(colours, s) title word(solvers, s), \
         for [f = 1:words(forms)] NaN with points pt int(word(shapes, f)) lc 'gray30' title word(titles, f)
  }
  unset multiplot
} else {
  set output out
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
}
