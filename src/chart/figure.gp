# Time over error, both logarithmic: the front, then each family's bars, symbols and labels.
set terminal svg size 900,700 enhanced font 'sans-serif,13' background '#ffffff'
set output 'figure.svg'
set logscale xy
set format xy '10^{%T}'
set xlabel 'relative error of the distance T: 99 % of the rays (a lost, invented or wrong hit counts as 1)'
set ylabel 'ns a camera ray, one thread'
set grid lc rgb '#dddddd'
set tics scale 0.7
set mxtics 2
set key outside top center horizontal Left reverse samplen 1.5 width 1
set xrange [5e-18:4]
{{#sets}}${{id}} << EOD
{{#points}}{{error:.6g}} {{#time}}{{median:.6g}} {{lower:.6g}} {{upper:.6g}}{{/time}} {{label_at:.6g}} "{{&label}}" "{{&name}}: {{#time}}{{median:.4g}}{{/time}} ns, error {{error:.2g}}"
{{/points}}EOD
{{/sets}}{{#steps}}set arrow from {{x1:.6g}},{{y1:.6g}} to {{x2:.6g}},{{y1:.6g}} nohead lw 2 lc rgb '#c02020' dt 2 back
set arrow from {{x2:.6g}},{{y1:.6g}} to {{x2:.6g}},{{y2:.6g}} nohead lw 2 lc rgb '#c02020' dt 2 back
{{/steps}}{{#pale_steps}}set arrow from {{x1:.6g}},{{y1:.6g}} to {{x2:.6g}},{{y1:.6g}} nohead lw 1.5 lc rgb '#eab0b0' dt 2 back
set arrow from {{x2:.6g}},{{y1:.6g}} to {{x2:.6g}},{{y2:.6g}} nohead lw 1.5 lc rgb '#eab0b0' dt 2 back
{{/pale_steps}}plot keyentry with lines lw 2 lc rgb '#c02020' dt 2 title 'Pareto front'{{#sets}}, \
  ${{id}} using 1:3:(0):($4-$3) with vectors nohead lc rgb '{{&color}}' notitle, \
  '' using 1:2:7 with labels hypertext point pt {{symbol}} ps 0.75 lw 1.3 lc rgb '{{&color}}' notitle, \
  keyentry with points pt {{symbol}} ps 0.75 lw 1.3 lc rgb '{{&color}}' {{#title}}title "{{&title}}"{{/title}}{{^title}}notitle{{/title}}, \
  ${{id}} using 5:2:6 with labels font ',10' tc rgb '{{&color}}' offset 0.3,-0.7 left notitle{{/sets}}, \
  keyentry with points pt 6 lc rgb '#444444' title 'hollow: some are wrong'
