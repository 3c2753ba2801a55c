# The figures of docs/paper.md from the CSV files in the folder `data` (a variable set on the command line).
set datafile separator ','
set datafile missing NaN
set terminal svg size 640,420 font 'sans,13' background rgb 'white'
set grid
set key outside below noenhanced
methods = 'newton laguerre aberth durand_kerner'
colours = '#2b6cb0 #2f855a #b7791f #9d174d'    # as in docs/accuracy.md
do for [k = 1:4] { set linetype k lc rgb word(colours, k) lw 1.3 }

# Figures on an equal footing: three panels, scalar as printed, operations counted (full: by our Table 1, dotted: by the
# paper's), and on lanes. `rows` is the file, x its column, time and operations those of the panels.
paper_methods = 'newton laguerre aberth'
set macros
panels = "set multiplot layout 1,3 title figure font ',14'; set title 'scalar, as printed'; set ylabel 'microseconds'; \
  plot for [m = 1:3] rows using (column(across)):(@chosen && strcol('form') eq 'scalar' && strcol('method') eq word(paper_methods, m) \
    ? column(time) : NaN) with linespoints title word(paper_methods, m); \
  set title 'operations'; set ylabel 'operations'; \
  plot for [m = 1:3] rows using (column(across)):(@chosen && strcol('form') eq 'scalar' && strcol('method') eq word(paper_methods, m) \
    ? @ours : NaN) with linespoints lt m title word(paper_methods, m), \
    for [m = 1:3] rows using (column(across)):(@chosen && strcol('form') eq 'scalar' && strcol('method') eq word(paper_methods, m) \
    ? @theirs : NaN) with lines lt m dt 3 notitle; \
  set title 'on lanes, one polynomial a lane'; set ylabel 'microseconds'; \
  plot for [m = 1:3] rows using (column(across)):(@chosen && strcol('form') eq 'lanes' && strcol('method') eq word(paper_methods, m) \
    ? column(time) : NaN) with linespoints title word(paper_methods, m); unset multiplot"
wide = "set terminal svg size 1100,400 font 'sans,13' background rgb 'white'"
narrow = "set terminal svg size 640,420 font 'sans,13' background rgb 'white'"


# Against the degree, eps = 1e-6.
set xlabel 'degree n'
set xrange [2:24]
degrees = data.'/degrees.csv'
set output data.'/fig03.svg'
set title 'Fig 3: iterations to find one root'
set ylabel 'iterations'
plot for [m = 1:words(methods)] degrees using 1:(strcol(2) eq word(methods, m) ? $3 : NaN):7 with yerrorlines lt m title word(methods, m)
@wide
rows = data.'/footing_degrees.csv'; across = 'degree'; chosen = "1"
figure = 'Fig 2: one iteration of one root'; time = 'us_iteration'
ours = "(column('operations_one') / column('iterations_one'))"; theirs = "(column('paper_one') / column('iterations_one'))"
set output data.'/fig02.svg'
@panels
figure = 'Fig 4: one root'; time = 'us_one'; ours = "column('operations_one')"; theirs = "column('paper_one')"
set output data.'/fig04.svg'
@panels
figure = 'Fig 5: all roots'; time = 'us_all'; ours = "column('operations_all')"; theirs = "column('paper_all')"
set output data.'/fig05.svg'
@panels
@narrow

# Against eps, degree 18.
set xlabel 'eps'
set logscale x
set format x '10^{%L}'
set xtics 1e-15, 1e2
set xrange [1e-15:1e-1] reverse
tolerances = data.'/tolerances.csv'
set output data.'/fig06.svg'
set title 'Fig 6: iterations to find one root, degree 18'
set ylabel 'iterations'
set yrange [0:30]
plot for [method in methods] tolerances using 1:(strcol(2) eq method ? $3 : NaN) with linespoints title method
set output data.'/fig07.svg'
set title 'Fig 7: time to find one root, degree 18'
set ylabel 'microseconds'
set yrange [0:*]
plot for [method in methods] tolerances using 1:(strcol(2) eq method ? $4 : NaN) with linespoints title method
set output data.'/fig08.svg'
set title 'Fig 8: share of accurate roots (eq 11), one root each'
set ylabel 'share'
set yrange [0:1.02]
plot for [method in methods] tolerances using 1:(strcol(2) eq method ? $5 : NaN) with linespoints title method
@wide
set yrange [0:*]
rows = data.'/footing_tolerances.csv'; across = 'eps'; figure = 'Fig 9: all roots, degree 18'; time = 'us_all'
ours = "column('operations_all')"; theirs = "column('paper_all')"
set output data.'/fig09.svg'
@panels
@narrow
set output data.'/fig10.svg'
set title 'Fig 10: share of accurate roots (eq 11), all roots'
set ylabel 'share'
set yrange [0:1.02]
plot for [method in methods] tolerances using 1:(strcol(2) eq method ? $7 : NaN) with linespoints title method

# Against eps, on the patch: from the roots of the ray before, and cold.
patch = data.'/patch.csv'
set xrange [1e-14:1e-1] reverse
set output data.'/fig13.svg'
set title 'Fig 13: iterations a root (full: from the ray before)'
set ylabel 'iterations'
set logscale y
set yrange [1:600]
plot for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'previous' ? $4 : NaN) \
       with linespoints lt m lw 2 title word(methods, m), \
     for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'cold' ? $4 : NaN) \
       with linespoints lt m dt 3 title word(methods, m).', cold'
@wide
set yrange [*:*]
set logscale y
rows = data.'/footing_patch.csv'; figure = 'Fig 14: a pixel, from the roots of the ray before'; time = 'us_pixel'
chosen = "strcol('start') eq 'previous'"; ours = "column('operations_pixel')"; theirs = "column('paper_pixel')"
set output data.'/fig14.svg'
@panels
unset logscale y
set terminal svg size 960,420 font 'sans,13' background rgb 'white'
set output data.'/fig15.svg'
set multiplot layout 1,2 title 'Fig 15: share that meets eq 11 (full: from the ray before)' font ',14'
set ylabel 'share'
set yrange [0:1.02]
do for [count in 'roots pixels'] {
  set title (count eq 'roots' ? 'solutions' : 'pixels, all of whose solutions do')
  plot for [m = 1:3] patch \
         using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'previous' ? column('accurate_'.count) : NaN) \
         with linespoints lt m lw 2 title word(methods, m), \
       for [m = 1:3] patch \
         using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'cold' ? column('accurate_'.count) : NaN) \
         with linespoints lt m dt 3 title word(methods, m).', cold'
}
unset multiplot
@narrow
unset title

# Against the order in which the roots were found.
unset logscale x
set xtics auto
set format x '%g'
set xlabel 'order in which the root was found'
set xrange [1:18] noreverse
set ylabel 'log10 of |P| / delta, mean'
set yrange [*:*]
order = data.'/order.csv'
tried = '0.01 0.0001 1e-06 1e-12'    # those between coincide with the last
do for [figure in 'fig11,newton fig12,laguerre fig12-aberth,aberth'] {
  comma = strstrt(figure, ',')
  name = figure[1:comma - 1]
  method = figure[comma + 1:*]
  set output data.'/'.name.'.svg'
  set title (name eq 'fig11' ? 'Fig 11: ' : name eq 'fig12' ? 'Fig 12: ' : 'For comparison: ') \
    .method.', accuracy against order (below 0 meets eq 11)'
  plot for [e = 1:words(tried)] order using 3:(strcol(2) eq method && strcol(1) eq word(tried, e) ? $5 : NaN) \
       with linespoints title 'eps '.word(tried, e)
}

# Fig 1: the two curves of a ray, and where they meet.
set output data.'/fig01.svg'
set title 'Fig 1: a(u,v) = 0 and b(u,v) = 0 of one ray, and their common roots'
set xlabel 'u'
set ylabel 'v'
set xrange [0:1]
set yrange [0:1]
set key outside below noenhanced
bernstein(k, t) = (k == 0 || k == 3 ? 1 : 3) * t**k * (1 - t)**(3 - k)
curve(name) = sprintf('%s(u, v) = ', name).system("awk -F, '$1 == \"".name."\" { printf \"%s%s * bernstein(%d, u) * bernstein(%d, v)\", \
  n++ ? \" + \" : \"\", $4, $2, $3 }' ".data.'/fig01.csv')
eval curve('a')
eval curve('b')
set isosamples 200
set samples 200
set contour base
set cntrparam levels discrete 0
unset surface
set view map
set table $a
splot [u = 0:1] [v = 0:1] a(u, v) notitle
unset table
set table $b
splot [u = 0:1] [v = 0:1] b(u, v) notitle
unset table
unset contour
set surface
set datafile separator whitespace
plot $a using 1:2 with lines lw 2 title 'a = 0', $b using 1:2 with lines lw 2 title 'b = 0', \
  sprintf("< awk -F, '$1 == \"root\" { print $2, $3 }' %s/fig01.csv", data) using 1:2 with points pt 7 lc 'black' title 'roots'
set datafile separator ','
