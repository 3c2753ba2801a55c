# The figures of docs/paper.md from the CSV files in the folder `data` (a variable set on the command line).
set datafile separator ','
set datafile missing NaN
set terminal svg size 640,420 font 'sans,13' background rgb 'white'
set grid
set key outside below
methods = 'newton laguerre aberth durand_kerner'

# Against the degree, eps = 1e-6.
set xlabel 'degree n'
set xrange [2:24]
degrees = data.'/degrees.csv'
set output data.'/fig02.svg'
set title 'Fig 2: time of one iteration of one root'
set ylabel 'microseconds'
plot for [method in methods] degrees using 1:(strcol(2) eq method ? $4 : NaN) with linespoints title method
set output data.'/fig03.svg'
set title 'Fig 3: iterations to find one root'
set ylabel 'iterations'
plot for [method in methods] degrees using 1:(strcol(2) eq method ? $3 : NaN) with linespoints title method
set output data.'/fig04.svg'
set title 'Fig 4: time to find one root'
set ylabel 'microseconds'
plot for [method in methods] degrees using 1:(strcol(2) eq method ? $5 : NaN) with linespoints title method
set output data.'/fig05.svg'
set title 'Fig 5: time to find all roots'
plot for [method in methods] degrees using 1:(strcol(2) eq method ? $6 : NaN) with linespoints title method

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
set output data.'/fig09.svg'
set title 'Fig 9: time to find all roots, degree 18'
set ylabel 'microseconds'
set yrange [0:40]
plot for [method in methods] tolerances using 1:(strcol(2) eq method ? $6 : NaN) with linespoints title method
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
set yrange [0:30]
plot for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'previous' && strcol(4) eq 'power' ? $5 : NaN) \
       with linespoints lt m lw 2 title word(methods, m), \
     for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'cold' && strcol(4) eq 'power' ? $5 : NaN) \
       with linespoints lt m dt 3 title word(methods, m).', cold'
set output data.'/fig14.svg'
set title 'Fig 14: time of a pixel (full: from the ray before)'
set ylabel 'microseconds'
set yrange [0:30]
plot for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'previous' && strcol(4) eq 'power' ? $6 : NaN) \
       with linespoints lt m lw 2 title word(methods, m), \
     for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'cold' && strcol(4) eq 'power' ? $6 : NaN) \
       with linespoints lt m dt 3 title word(methods, m).', cold'
set output data.'/fig15.svg'
set title 'Fig 15: share of pixels whose roots are all accurate (eq 11)'
set ylabel 'share'
set yrange [0:1.02]
plot for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'previous' && strcol(4) eq 'power' ? $7 : NaN) \
       with linespoints lt m lw 2 title word(methods, m), \
     for [m = 1:3] patch \
       using 1:(strcol(2) eq word(methods, m) && strcol(3) eq 'cold' && strcol(4) eq 'power' ? $7 : NaN) \
       with linespoints lt m dt 3 title word(methods, m).', cold'

# Against the order in which the roots were found.
unset logscale x
set xtics auto
set format x '%g'
set xlabel 'order in which the root was found'
set xrange [1:18] noreverse
set ylabel 'log10 of |P| / delta, mean'
set yrange [*:*]
order = data.'/order.csv'
tried = '0.01 0.0001 1e-06 1e-08 1e-10 1e-12'
do for [figure in 'fig11,newton fig12,laguerre fig12-aberth,aberth'] {
  comma = strstrt(figure, ',')
  name = figure[1:comma - 1]
  method = figure[comma + 1:*]
  set output data.'/'.name.'.svg'
  set title (name eq 'fig11' ? 'Fig 11: ' : name eq 'fig12' ? 'Fig 12: ' : 'For comparison: ') \
    .method.', accuracy against order (below 0 meets eq 11)'
  plot for [eps in tried] order using 3:(strcol(2) eq method && strcol(1) eq eps ? $5 : NaN) \
       with linespoints title 'eps '.eps
}
