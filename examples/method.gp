# The figures of docs/method.md, in its folder method/: gnuplot examples/method.gp
set encoding utf8
set terminal svg size 900,420 font 'sans,13' background rgb 'white'
red = '#c02020'; blue = '#2b6cb0'; green = '#2f855a'; brown = '#b7791f'; violet = '#6b46c1'

# A function named like a net: its 16 coefficients in Bernstein form, of u^i v^j at 4 i + j.
w(k, t) = (k == 0 || k == 3 ? 1 : 3) * t**k * (1 - t)**(3 - k)
net(name, c) = name.'(u, v) = '.term(c, 0).term(c, 1).term(c, 2).term(c, 3).'0'
term(c, i) = sprintf('w(%d, u) * ((%s) * w(0, v) + (%s) * w(1, v) + (%s) * w(2, v) + (%s) * w(3, v)) + ', \
  i, word(c, 4 * i + 1), word(c, 4 * i + 2), word(c, 4 * i + 3), word(c, 4 * i + 4))
# Its bilinear part about the middle, by differences that are exact for cubics but for roundings.
flat(name) = sprintf('%s_flat(u, v) = %s(0.5, 0.5) + (u - 0.5) * (%s(0.501, 0.5) - %s(0.499, 0.5)) / 0.002 + (v - 0.5) * (%s(0.5, 0.501) \
  - %s(0.5, 0.499)) / 0.002 + (u - 0.5) * (v - 0.5) * (%s(0.501, 0.501) - %s(0.501, 0.499) - %s(0.499, 0.501) + %s(0.499, 0.499)) / 4e-6', \
  name, name, name, name, name, name, name, name, name, name)
# A step of Newton's method on the functions a and b, in u (0) or v.
e = 1e-5
step(a, b, a_u, a_v, b_u, b_v, k) = (k == 0 ? b * a_v - a * b_v : a * b_u - b * a_u) / (a_u * b_v - a_v * b_u)
newton(a, b) = sprintf('step(%s(u, v), %s(u, v), (%s(u + e, v) - %s(u - e, v)) / (2 * e), (%s(u, v + e) - %s(u, v - e)) / (2 * e), \
  (%s(u + e, v) - %s(u - e, v)) / (2 * e), (%s(u, v + e) - %s(u, v - e)) / (2 * e), k)', a, b, a, a, a, a, b, b, b, b)
# Where a function is zero on a square, as a table of that name.
zero(name, f, from, to) = sprintf('set table $%s; splot [u = %g:%g] [v = %g:%g] %s(u, v); unset table', name, from, to, from, to, f)
set cntrparam levels discrete 0

# ---- a leaf with its bilinear part ----

X_net = '0 0.02 -0.02 0 0.35 0.34 0.33 0.33 0.66 0.66 0.68 0.67 1 1.02 0.98 1'
Y_net = '0 0.33 0.67 1 0.02 0.34 0.68 1.02 -0.02 0.33 0.66 0.98 0 0.34 0.66 1'
Z_net = '0 0.16 0.22 0.12 0.26 0.5 0.52 0.3 0.22 0.46 0.56 0.4 -0.06 0.2 0.3 0.26'
do for [name in 'X Y Z'] { eval net(name, value(name.'_net')) }
array O = [0.62, -0.22, 1.2]    # the ray's start
array D = [0.30, 0.62, -1.14]   # and direction, longest along z
do for [name in 'X Y Z'] { eval flat(name) }
a(u, v) = X(u, v) - O[1] - D[1] / D[3] * (Z(u, v) - O[3])
b(u, v) = Y(u, v) - O[2] - D[2] / D[3] * (Z(u, v) - O[3])
p(u, v) = X_flat(u, v) - O[1] - D[1] / D[3] * (Z_flat(u, v) - O[3])
q(u, v) = Y_flat(u, v) - O[2] - D[2] / D[3] * (Z_flat(u, v) - O[3])
eval 'next(u, v, k) = '.newton('a', 'b')
eval 'next_flat(u, v, k) = '.newton('p', 'q')
array U[5]; array V[5]
U[1] = 0.5; V[1] = 0.5
do for [n = 1:8] { s = next_flat(U[1], V[1], 0); t = next_flat(U[1], V[1], 1); U[1] = U[1] + s; V[1] = V[1] + t }
do for [n = 1:4] { U[n + 1] = U[n] + next(U[n], V[n], 0); V[n + 1] = V[n] + next(U[n], V[n], 1) }
set isosamples 100
set samples 100
set contour base
unset surface
do for [f in 'a b p q'] { eval zero(f, f, 0, 1) }
unset contour
set surface
set output 'docs/method/bilinear.svg'
set multiplot layout 1,2
unset border; unset tics
set view 66,24,1.35
set view equal xyz
set parametric
set isosamples 9
set samples 9
set key at screen 0.02,0.97 left top Left reverse samplen 2
set urange [0:1]; set vrange [0:1]
set xrange [-0.05:1.05]; set yrange [-0.05:1.05]; set zrange [-0.1:1]
splot X(u, v), Y(u, v), Z(u, v) with lines lc rgb blue title 'the leaf', \
  X_flat(u, v), Y_flat(u, v), Z_flat(u, v) with lines lc rgb brown dt 2 title 'its bilinear part', \
  O[1] + 0.9 * u * D[1], O[2] + 0.9 * u * D[2], O[3] + 0.9 * u * D[3] with lines lc rgb 'black' lw 2 title 'the ray', \
  X_flat(U[1], V[1]), Y_flat(U[1], V[1]), Z_flat(U[1], V[1]) with points pt 6 ps 1.1 lw 1.5 lc rgb brown notitle, \
  X(U[5], V[5]), Y(U[5], V[5]), Z(U[5], V[5]) with points pt 7 ps 0.8 lc rgb red notitle
unset parametric
set border; set tics; set grid
set key at graph 0.03,0.97 left top Left reverse samplen 2
set xlabel 'u'; set ylabel 'v'
set size square
set lmargin at screen 0.55; set rmargin at screen 0.98; set tmargin at screen 0.95; set bmargin at screen 0.13
set xrange [0:1]; set yrange [0:1]
plot $a using 1:2 with lines lw 2 lc rgb blue title 'a = 0', $b using 1:2 with lines lw 2 lc rgb violet title 'b = 0', \
  $p using 1:2 with lines dt 2 lc rgb blue title 'of the bilinear part', $q using 1:2 with lines dt 2 lc rgb violet notitle, \
  U using (U[$1]):(V[$1]) with linespoints pt 7 ps 0.5 lc rgb red title "Newton's method", \
  U every ::0::0 using (U[$1]):(V[$1]) with points pt 6 ps 1.2 lw 1.5 lc rgb brown title 'root of degree 2'
unset multiplot

# ---- two nets, and a combination that keeps its sign ----

set lmargin; set rmargin; set tmargin; set bmargin
A = '-0.35 -0.05 0.33 0.62 -0.45 -0.10 0.24 0.55 -0.52 -0.18 0.14 0.46 -0.62 -0.27 0.07 0.40'
B = '-0.54 -0.26 0.02 0.28 -0.61 -0.33 -0.06 0.20 -0.64 -0.40 -0.12 0.16 -0.72 -0.45 -0.18 0.11'
eval net('a', A)
eval net('b', B)
a_v = (a(0.5, 0.5 + e) - a(0.5, 0.5 - e)) / (2 * e)
b_v = (b(0.5, 0.5 + e) - b(0.5, 0.5 - e)) / (2 * e)
C = ''
do for [n = 1:16] { C = C.sprintf('%.3f ', b_v * word(A, n) - a_v * word(B, n)) }
set isosamples 100
set samples 100
set contour base
unset surface
do for [f in 'a b'] { eval zero(f, f, 0, 1) }
unset contour
set surface
set terminal svg size 900,270
set output 'docs/method/combination.svg'
set multiplot layout 1,4
set key above samplen 2
set xlabel 'u'; set ylabel 'v'
set xtics 0.5; set ytics 0.5
plot $a using 1:2 with lines lw 2 lc rgb blue title 'a = 0', $b using 1:2 with lines lw 2 lc rgb violet title 'b = 0'
set key off
unset grid
unset border
unset xtics; unset ytics
unset xlabel; unset ylabel
set xrange [-0.6:3.6]; set yrange [-0.6:3.6]
array N[16]
do for [panel = 1:3] {
  name = panel == 1 ? A : panel == 2 ? B : C
  set title (panel == 1 ? 'net of a' : panel == 2 ? 'net of b' : sprintf('net of %.2f a - %.2f b', b_v, a_v))
  plot N using (int($0) / 4):(int($0) % 4):(word(name, int($0) + 1) < 0 ? 0xc02020 : 0x2f855a) with points pt 7 ps 3.4 lc rgb variable, \
    N using (int($0) / 4):(int($0) % 4):(sprintf('%.2f', real(word(name, int($0) + 1)))) with labels font ',9' tc rgb 'white'
}
unset multiplot
unset title

# ---- the certificate ----

# M f near z = (0, 0), in units of the last step, with bend (step + size) = 1/8
F(u, v) = u - 1 + 0.03 * u**2 + 0.03 * u * v
G(u, v) = v - 0.6 - 0.03 * u**2 + 0.02 * v**2
eval 'next(u, v, k) = '.newton('F', 'G')
U[1] = 1; V[1] = 0.6
do for [n = 1:4] { U[n + 1] = U[n] + next(U[n], V[n], 0); V[n + 1] = V[n] + next(U[n], V[n], 1) }
set contour base
unset surface
do for [f in 'F G'] { eval zero(f, f, -2.4, 2.4) }
unset contour
set surface
set terminal svg size 900,420
set output 'docs/method/certificate.svg'
set multiplot layout 1,2
set border
set key above samplen 2
set size square
set samples 81
edge(t, k) = (x = t < 1 ? 4 * t - 2 : t < 2 ? 2 : t < 3 ? 10 - 4 * t : -2, y = t < 1 ? -2 : t < 2 ? 4 * t - 6 : t < 3 ? 2 : 14 - 4 * t, \
  k == 0 ? x - F(x, y) : k == 1 ? y - G(x, y) : k == 2 ? x : y)
do for [panel = 1:2] {
  set xtics (panel == 1 ? 1 : 0.2)
  set ytics (panel == 1 ? 1 : 0.2)
  set xrange [(panel == 1 ? -2.4 : 0.6):(panel == 1 ? 2.4 : 1.4)]
  set yrange [(panel == 1 ? -2.4 : 0.2):(panel == 1 ? 2.4 : 1)]
  set xlabel (panel == 1 ? 'u - z, in steps' : 'enlarged')
  set object 1 rectangle from 0.75,0.35 to 1.25,0.85 fc rgb '#fde8c8' fs solid border lc rgb brown behind
  set arrow 1 from (panel == 1 ? 0 : 0.6),(panel == 1 ? 0 : 0.36) to 1,0.6 lw 2 lc rgb red front
  set label 1 (panel == 1 ? 'z' : '') at -0.25,-0.15 front
  plot $F using 1:2 with lines lw 2 lc rgb blue title 'f_1 = 0', $G using 1:2 with lines lw 2 lc rgb violet title 'f_2 = 0', \
    [t = 0:4] '+' using (edge($1, 2)):(edge($1, 3)) with lines lc rgb green lw 2 title 'one root in here', \
    [t = 0:4] '+' using (edge($1, 0)):(edge($1, 1)) with filledcurves lc rgb '#9ad0ac' title 'its image', \
    '+' every ::0::0 using (U[5]):(V[5]) with points pt 7 ps 0.6 lc rgb 'black' title 'root', \
    NaN with lines lw 4 lc rgb brown title 'and in here'
}
unset multiplot
unset object 1
unset arrow 1
unset label 1

# ---- a pole divided out ----

p0 = 0.02; q0 = 0.009                # the pole, as the ray (the origin) sees it
A = ''; B = ''
do for [n = 0:15] {
  r = (n / 4) / 3.0; angle = pi * (0.85 + 0.16 * (n % 4) + 0.05 * (n / 4))
  A = A.sprintf('%.12g ', p0 + r * cos(angle)); B = B.sprintf('%.12g ', q0 + r * sin(angle))
}
eval net('a', A)
eval net('b', B)
q(u, v) = (q0 / p0 * a(u, v) - b(u, v)) / u
set contour base
unset surface
set table $a; splot [u = 0:1] [v = 0:1] a(u, v); unset table
set table $b; splot [u = 0:1] [v = 0:1] b(u, v); unset table
set table $q; splot [u = 1e-6:1] [v = 0:1] q(u, v); unset table
unset contour
set surface
set terminal svg size 900,330
set grid
set output 'docs/method/pole.svg'
set multiplot layout 1,3
set title 'the patch, as the ray sees it'
set xlabel 'a'; set ylabel 'b'
set xtics 0.1; set ytics 0.1
set xrange [-0.3:0.05]; set yrange [-0.2:0.15]
set key off
set label 1 'pole' at p0 - 0.02,q0 + 0.03 front
plot for [k = 0:8] [t = 0:1] '+' using (a($1, k / 8.0)):(b($1, k / 8.0)) with lines lc rgb blue, \
  for [k = 1:8] [t = 0:1] '+' using (a(k / 16.0, $1)):(b(k / 16.0, $1)) with lines lc rgb blue, \
  '+' every ::0::0 using (0):(0) with points pt 7 ps 0.8 lc rgb red
unset label 1
set key above samplen 2
set xlabel 'u'; set ylabel 'v'
set xtics 0.5; set ytics 0.5
set xrange [0:1]; set yrange [0:1]
set title 'a and b'
plot $a using 1:2 with lines lw 2 lc rgb blue title 'a = 0', $b using 1:2 with lines lw 2 lc rgb violet title 'b = 0'
set title 'a and the quotient'
plot $a using 1:2 with lines lw 2 lc rgb blue title 'a = 0', \
  $q using 1:2 with lines lw 2 lc rgb green title '((b_0/a_0) a - b)/u = 0'
unset multiplot

# ---- a strip about the steeper curve, and the box that is left (src/intersect/exact/root.c, tangent_box) ----

# Control values of x = u - 1/2 and y = v - 1/2, their squares and cubes: coefficient n = 4 i + j.
x1(n) = (n / 4) / 3.0 - 0.5; x2(n) = (n / 4) * (n / 4 - 1) / 6.0 - x1(n) - 0.25
x3(n) = (n / 4 == 0 || n / 4 == 2 ? -1 : 1) / 8.0
y1(n) = x1(4 * (n % 4)); y2(n) = x2(4 * (n % 4))
A = ''; B = ''
do for [n = 0:15] {
  A = A.sprintf('%.12g ', y1(n) + 0.03 + 0.1 * x1(n) + 0.2 * x2(n) + 0.05 * x1(n) * y1(n))
  B = B.sprintf('%.12g ', 0.9 * (y1(n) + 0.03 + 0.1 * x1(n)) - 0.16 * x2(n) + 0.004 + 0.04 * x3(n))
}
eval net('a', A)
eval net('b', B)
a_u = (a(0.5 + e, 0.5) - a(0.5 - e, 0.5)) / (2 * e)
a_v = (a(0.5, 0.5 + e) - a(0.5, 0.5 - e)) / (2 * e)
b_v = (b(0.5, 0.5 + e) - b(0.5, 0.5 - e)) / (2 * e)
F = ''
do for [n = 1:16] { F = F.sprintf('%.12g ', b_v * word(A, n) - a_v * word(B, n)) }
eval net('f', F)
h = 1e-3
f_u = (f(0.5 + h, 0.5) - f(0.5 - h, 0.5)) / (2 * h); f_v = (f(0.5, 0.5 + h) - f(0.5, 0.5 - h)) / (2 * h)
f_uu = (f(0.5 + h, 0.5) - 2 * f(0.5, 0.5) + f(0.5 - h, 0.5)) / h**2
f_vv = (f(0.5, 0.5 + h) - 2 * f(0.5, 0.5) + f(0.5, 0.5 - h)) / h**2
f_uv = (f(0.5 + h, 0.5 + h) - f(0.5 + h, 0.5 - h) - f(0.5 - h, 0.5 + h) + f(0.5 - h, 0.5 - h)) / (4 * h**2)
off_s = 0; off_f = 0
do for [n = 0:15] {
  d = abs(word(A, n + 1) - (a(0.5, 0.5) + a_u * x1(n) + a_v * y1(n))); off_s = d > off_s ? d : off_s
  d = abs(word(F, n + 1) - (f(0.5, 0.5) + f_u * x1(n) + f_v * y1(n) + f_uu / 2 * x2(n) + f_uv * x1(n) * y1(n) + f_vv / 2 * y2(n)))
  off_f = d > off_f ? d : off_f
}
steep = sqrt(a_u**2 + a_v**2); e0 = a_u / steep; e1 = a_v / steep
middle = -a(0.5, 0.5) / steep; half = off_s / steep
along = f_u * e0 + f_v * e1; across = f_v * e0 - f_u * e1
along2 = f_uu * e0**2 + 2 * f_uv * e0 * e1 + f_vv * e1**2
across2 = f_uu * e1**2 - 2 * f_uv * e0 * e1 + f_vv * e0**2
mixed = (f_vv - f_uu) * e0 * e1 + f_uv * (e0**2 - e1**2)
off_f = off_f + half * (abs(along + along2 * middle) + abs(mixed) + abs(along2) / 2 * half)
c0 = f(0.5, 0.5) + (along + along2 / 2 * middle) * middle; c1 = across + mixed * middle; c2 = across2 / 2
root = sqrt(c1**2 - 4 * c2 * (c0 - off_f))
array X[2] = [(-c1 - root) / (2 * c2), (-c1 + root) / (2 * c2)]
px(k, x) = 0.5 + (middle + k * half) * e0 - x * e1     # side k of the strip
py(k, x) = 0.5 + (middle + k * half) * e1 + x * e0
g0(x) = c0 + c1 * x + c2 * x**2
set contour base
unset surface
do for [f in 'a b'] { eval zero(f, f, 0, 1) }
unset contour
set surface
set terminal svg size 900,380
set output 'docs/method/tangency.svg'
set multiplot layout 1,2
unset title
set grid
set key above samplen 2
set samples 101
set xlabel 'u'; set ylabel 'v'
set xtics 0.5; set ytics 0.5
set xrange [0:1]; set yrange [0:1]
set object 1 polygon from px(-1, -1),py(-1, -1) to px(-1, 1),py(-1, 1) \
  to px(1, 1),py(1, 1) to px(1, -1),py(1, -1) to px(-1, -1),py(-1, -1) fc rgb '#dbe7f5' fs solid noborder behind
array L[2] = [1, 1]; array H[2] = [0, 0]
do for [k = -1:1:2] { do for [n = 1:2] {
  x = px(k, X[n]); y = py(k, X[n])
  L[1] = x < L[1] ? x : L[1]; H[1] = x > H[1] ? x : H[1]; L[2] = y < L[2] ? y : L[2]; H[2] = y > H[2] ? y : H[2]
} }
set object 2 rectangle from L[1],L[2] to H[1],H[2] fs empty border lc rgb red lw 2 front
plot $a using 1:2 with lines lw 2 lc rgb blue title 'a = 0', $b using 1:2 with lines lw 2 lc rgb violet title 'b = 0', \
  NaN with lines lw 6 lc rgb '#dbe7f5' title 'the strip', NaN with lines lw 2 lc rgb red title 'the box'
unset object 1
unset object 2
set xlabel 'place along the strip'; set ylabel 'the row'
set xrange [-0.5:0.5]; set yrange [-0.02:0.1]
set ytics 0.05
plot [x = -0.5:0.5] '+' using 1:(g0($1) - off_f):(g0($1) + off_f) with filledcurves lc rgb '#f3d9d9' title 'bounds', \
  f(px(-1, x), py(-1, x)) lw 2 lc rgb green title 'on the sides of the strip', f(px(1, x), py(1, x)) lw 2 lc rgb green notitle, \
  0 lc rgb 'gray50' notitle, '+' every ::0::0 using (X[1]):(0) with points pt 7 ps 0.7 lc rgb red notitle, \
  '+' every ::0::0 using (X[2]):(0) with points pt 7 ps 0.7 lc rgb red notitle
unset multiplot

# ---- the resultants of three rays with the first figure's leaf ----

# Polynomials are texts of coefficients in scaled Bernstein form, whose products are convolutions.
at(c, k) = real(word(c, k + 1))
choose(n, k) = gamma(n + 1) / gamma(k + 1) / gamma(n - k + 1)
conv(x, y, n) = sum [i = 0:n] (i < words(x) && n - i < words(y) ? at(x, i) * at(y, n - i) : 0)
array P[4]; array Q[4]; array M[12]; array E[3]; array R[3]; array last[3]
o_x = '-0.6 1.2 1'; o_y = '0.8 0.2 -0.4' # where they start, z = 1.2
do for [ray = 1:3] {
  x0 = at(o_x, ray - 1); y0 = at(o_y, ray - 1)
  do for [j = 0:3] {
    P[j + 1] = ''; Q[j + 1] = ''
    do for [i = 0:3] {
      z = at(Z_net, 4 * i + j) - O[3]; c = choose(3, i) * choose(3, j)
      P[j + 1] = P[j + 1].sprintf('%.15g ', c * (at(X_net, 4 * i + j) - x0 - D[1] / D[3] * z))
      Q[j + 1] = Q[j + 1].sprintf('%.15g ', c * (at(Y_net, 4 * i + j) - y0 - D[2] / D[3] * z))
    }
  }
  do for [k = 0:2] { do for [l = k + 1:3] {      # minor kl at 4 k + l
    s = ''
    do for [n = 0:6] { s = s.sprintf('%.15g ', conv(P[k + 1], Q[l + 1], n) - conv(P[l + 1], Q[k + 1], n)) }
    M[4 * k + l] = s
  } }
  both = ''
  do for [n = 0:6] { both = both.sprintf('%.15g ', at(M[3], n) + at(M[6], n)) }
  E[1] = ''; E[2] = ''; E[3] = ''
  do for [n = 0:12] {
    E[1] = E[1].sprintf('%.15g ', conv(both, M[11], n) - conv(M[7], M[7], n))
    E[2] = E[2].sprintf('%.15g ', conv(M[2], M[11], n) - conv(M[7], M[3], n))
    E[3] = E[3].sprintf('%.15g ', conv(M[2], M[7], n) - conv(both, M[3], n))
  }
  R[ray] = ''; most = 0
  do for [n = 0:18] {
    r = (conv(M[1], E[1], n) - conv(M[2], E[2], n) + conv(M[3], E[3], n)) / choose(18, n)
    R[ray] = R[ray].sprintf('%.15g ', r); most = abs(r) > most ? abs(r) : most
  }
  # coefficients of 1 at most; where the polygon crosses zero last
  c = ''; last[ray] = NaN
  do for [n = 0:18] { c = c.sprintf('%.6g ', at(R[ray], n) / most) }
  do for [n = 1:18] {
    if (at(c, n - 1) * at(c, n) < 0) { last[ray] = (n - 1 + at(c, n - 1) / (at(c, n - 1) - at(c, n))) / 18 }
  }
  R[ray] = c
}
r(c, u) = sum [n = 0:18] at(c, n) * choose(18, n) * u**n * (1 - u)**(18 - n)
set terminal svg size 900,300
set output 'docs/method/resultant.svg'
set multiplot layout 1,3
set key off
set grid
set samples 201
set xtics 0.5; set ytics 1
set xrange [0:1]; set yrange [-1.1:1.1]
set xlabel 'u'; set ylabel 'r(u)'
array N[19]
do for [ray = 1:3] {
  set title ray == 1 ? 'no variation: a miss' : ray == 2 ? 'one variation: one root' : 'two variations: no root or two'
  plot 0 lc rgb 'gray50', \
    N using (($1 - 1) / 18.0):(at(R[ray], int($1) - 1)) with linespoints pt 7 ps 0.5 lc rgb brown, \
    [u = 1e-9:1 - 1e-9] '+' using 1:(r(R[ray], $1)) with lines lw 2 lc rgb blue, \
    '+' every ::0::0 using (last[ray]):(0) with points pt 7 ps 0.9 lc rgb red
}
unset multiplot
