# Time over the error of right answers, and over the share of wrong ones; all logarithmic. Colour tells the solver, shape
# the form.
set terminal svg size 1000,660 enhanced font 'sans-serif,13' background '#ffffff'
set output 'figure.svg'
set logscale xy
set format xy '10^{%T}'
set grid lc rgb '#dddddd'
set tics scale 0.7
set key at screen 0.07,0.02 bottom left vertical Left reverse samplen 1.5 width 2 maxrows 5 noenhanced
set bmargin at screen 0.3
set tmargin at screen 0.97
$points << EOD
{{#drawn}}{{error:.6g}}{{^error}}NaN{{/error}} {{share:.6g}} {{#time}}{{median:.6g}} {{lower:.6g}} {{upper:.6g}}{{/time}} {{color}} {{symbol}} "{{&label}}" "{{&name}}: {{#time}}{{median:.4g}}{{/time}} ns, error {{error:.2g}}"
{{/drawn}}EOD
set multiplot layout 1,2
set ylabel 'ns a camera ray, one thread'
set xlabel 'error of T of right answers (99 %)'
set xrange [5e-18:1]
plot $points using 1:4:(0):($5-$4):6 with vectors nohead lc rgb variable notitle, \
  '' using 1:3:7:6 with points pt variable lc rgb variable ps 0.75 lw 1.3 notitle, \
  '' using 1:3:9 with labels hypertext point pt 6 ps 0.75 lc rgb '#ff000000' notitle, \
  '' using 1:3:8:6 with labels font ',10' tc rgb variable noenhanced offset 0.6,-0.4 left notitle{{#colors}}, \
  keyentry with points pt 7 ps 0.75 lc rgb {{look}} title "{{&title}}"{{/colors}}{{#shapes}}, \
  keyentry with points pt {{look}} ps 0.75 lc rgb '#444444' title "{{&title}}"{{/shapes}}
unset ylabel
set key off
set xlabel 'share of wrong answers (left: none)'
set format x '%g'
set xrange [7e-5:1.5]
plot $points using 2:4:(0):($5-$4):6 with vectors nohead lc rgb variable notitle, \
  '' using 2:3:7:6 with points pt variable lc rgb variable ps 0.75 lw 1.3 notitle, \
  '' using 2:3:9 with labels hypertext point pt 6 ps 0.75 lc rgb '#ff000000' notitle, \
  '' using 2:3:8:6 with labels font ',10' tc rgb variable noenhanced offset 0.6,-0.4 left notitle
unset multiplot
