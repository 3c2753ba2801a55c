# How POV-Ray's answer nears ours with u_steps, and what it takes it.
set terminal svg size 1180,400 enhanced font 'sans-serif,12' background '#ffffff'
set output 'figure.svg'
set datafile missing '?'
$rows << EOD
{{#rows}}{{#u_steps}}{{u_steps}}{{#percent}} {{value}}{{/percent}}{{#distances}} {{median}}{{^median}}?{{/median}} {{percent_99}}{{^percent_99}}?{{/percent_99}}{{/distances}}{{^distances}} ? ?{{/distances}}{{#time}} {{cpu}}{{/time}} "POV-Ray, {{&name}}"
{{/u_steps}}{{/rows}}EOD
set multiplot layout 1,3
set logscale y
set format y '10^{%T}'
set grid lc rgb '#dddddd'
set xtics 1
set offsets 0.3, 0.3, 0, 0
set xlabel 'u\_steps = v\_steps'
set key top right samplen 2
{{#pixels}}set title 'pixels beyond, in percent'
plot $rows using 1:2 with linespoints pt 7 ps 0.6 lw 2 lc rgb '#2b6cb0' title '1/255', \
  '' using 1:3 with linespoints pt 7 ps 0.6 lw 2 lc rgb '#c05621' title '4/255', \
  '' using 1:4 with linespoints pt 7 ps 0.6 lw 2 lc rgb '#9b2c2c' title '16/255'
{{/pixels}}{{#converging}}set title 'difference of distances, relative'
set key top right
plot $rows using 1:6 with linespoints pt 7 ps 0.6 lw 2 lc rgb '#c05621' title '99 %', \
  '' using 1:5 with linespoints pt 7 ps 0.6 lw 2 lc rgb '#2b6cb0' title 'median'
set title 'CPU seconds over the error of 99 % of the distances'
unset logscale
set logscale x
set format x '10^{%T}'
set format y '%g'
set xtics auto
set offsets 0, 0, graph 0.4, 0
set xlabel 'relative; too small to show for pscn'
set yrange [0:*]
set key top right
plot $rows using 6:7 with lines lw 1.5 lc rgb '#0891b2' title 'POV-Ray, u\_steps', \
  '' using 6:7:8 with labels hypertext point pt 7 ps 0.6 lc rgb '#0891b2' notitle, \
  '' using 6:7:1 with labels offset 0.8,0.6 tc rgb '#0891b2' notitle, \
  {{#time}}{{cpu}}{{/time}} lw 2 lc rgb '#c02020' title 'pscn, exact'
{{/converging}}
