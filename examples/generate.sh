#!/bin/bash
# Writes a scene of many distinct patches to standard output.
#
#   examples/generate.sh hair N        N hairs on a ball, each one patch, 1 : 200
#   examples/generate.sh ribbons N     N loose ribbons, each one patch, 1 : 1000
#   examples/generate.sh creature N    about N patches of one smooth closed skin, a knotted body with bumps on it, no two
#                                      alike
#   examples/generate.sh knots N       N patches through one another, of sixteen random points each
#   examples/generate.sh confetti N    N small patches, each bent another way
#   examples/generate.sh shells N      N / 8 balls of eight patches through one another
#   examples/generate.sh pearls N      N / 8 small balls apart from one another
#   examples/generate.sh floor N       N / 8 balls of very different sizes on a floor 2,000 wide
#   examples/generate.sh book N        N curved pages from one spine
#   examples/generate.sh roll N        a carpet roll of N patches, eight a turn
#   examples/generate.sh marks N       N squares on a floor, in its plane
#   examples/generate.sh pipes N       N / 4 pipes every way, 1 : 80
#   examples/generate.sh crown N       a twig of 100 leaves, N / 100 times, turned about its end
#   examples/generate.sh hills N       N patches, a square number, of one smooth landscape, seen along it, the sun as low
#
# In the first three the light is at the camera: every hit of a camera ray sends one shadow ray, so counting these
# counts hits.
set -euo pipefail
export LC_ALL=C

KINDS='hair ribbons creature knots confetti shells pearls floor book roll marks pipes crown hills'

kind=${1:?one of: $KINDS}
count=${2:?how many patches?}
case $count in *[!0-9]*) echo "$0: '$count' is no number of patches" >&2 && exit 2 ;; esac
case " $KINDS " in *" $kind "*) ;; *) echo "$0: there is no '$kind'" >&2 && exit 2 ;; esac
awk -v kind="$kind" -v n="$count" '
  # A generator of our own: the same scene whatever awk runs it.
  function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
  function between(a, b) { return a + (b - a) * random() }
  function head(x, y, z) { begin(x, y, z, x, y, z) }
  function begin(x, y, z, light_x, light_y, light_z) {
    printf "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
    printf "camera { location <%g, %g, %g> look_at 0 angle 40 }\n", x, y, z
    printf "light_source { <%g, %g, %g>, rgb 1 }\nbackground { rgb <0.74, 0.80, 0.88> }\n", light_x, light_y, light_z
    printf "#default { pigment { color rgb <0.8, 0.6, 0.5> } finish { ambient 0.1 diffuse 0.9 } }\n"
  }
  # P[k, c], k = 4 i + j, as a patch.
  function patch(k) {
    printf "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3"
    for (k = 0; k < 16; k++) printf ", <%.8g, %.8g, %.8g>", P[k, 0], P[k, 1], P[k, 2]
    printf " }\n"
  }
  # The cubic with the points A[i, c], widened to `width` along the direction W[c], which turns by `twist` turns.
  function strip(width, twist, i, j, c, s, t, a) {
    for (i = 0; i < 4; i++) {
      a = 6.28318 * twist * i / 3
      for (j = 0; j < 4; j++)
        for (c = 0; c < 3; c++) {
          s = W[c] * cos(a) + V[c] * sin(a)
          P[4 * i + j, c] = A[i, c] + (j / 3 - 0.5) * width * s
        }
    }
    patch()
  }
  function unit(x, l) { l = sqrt(x[0] ^ 2 + x[1] ^ 2 + x[2] ^ 2); x[0] /= l; x[1] /= l; x[2] /= l }
  # Two directions across D.
  function across(c) {
    W[0] = D[1] + 0.1; W[1] = D[2] - 0.2; W[2] = D[0] + 0.3
    V[0] = D[1] * W[2] - D[2] * W[1]; V[1] = D[2] * W[0] - D[0] * W[2]; V[2] = D[0] * W[1] - D[1] * W[0]; unit(V)
    W[0] = V[1] * D[2] - V[2] * D[1]; W[1] = V[2] * D[0] - V[0] * D[2]; W[2] = V[0] * D[1] - V[1] * D[0]; unit(W)
  }
  function direction() {
    do { for (c = 0; c < 3; c++) D[c] = between(-1, 1); l = D[0] ^ 2 + D[1] ^ 2 + D[2] ^ 2 } while (l > 1 || l < 0.01)
    unit(D)
  }
  function hair(k, i, c) {
    head(0, 1.5, -8)
    for (k = 0; k < n; k++) {
      direction(); across()
      for (i = 0; i < 4; i++)
        for (c = 0; c < 3; c++) A[i, c] = D[c] * (1 + i / 3) + (i > 1 ? between(-0.15, 0.15) * i : 0) - (c == 1) * i * i / 18
      strip(0.005, between(0, 0.5))
    }
  }
  function ribbons(k, i, c) {
    head(0, 1.5, -8)
    for (k = 0; k < n; k++) {
      direction(); across()
      for (c = 0; c < 3; c++) at[c] = between(-1.5, 1.5)
      for (i = 0; i < 4; i++)
        for (c = 0; c < 3; c++) A[i, c] = at[c] + D[c] * (i - 1.5) * 1.2 + between(-0.6, 0.6)
      strip(0.004, between(0, 1))
    }
  }
  # A point of the body: a tube about a knot, with bumps; s and t in turns.
  function body(s, t, c, a, b, r, q) {
    a = 6.28318530718 * s; b = 6.28318530718 * t
    for (c = 0; c < 2; c++) {
      q = a + c * 1e-4; r = 2 + cos(3 * q)
      K[c, 0] = r * cos(2 * q); K[c, 1] = 1.2 * sin(3 * q); K[c, 2] = r * sin(2 * q)
    }
    for (c = 0; c < 3; c++) D[c] = K[1, c] - K[0, c]
    unit(D)
    V[0] = -D[2]; V[1] = 0; V[2] = D[0]; unit(V) # the knot is nowhere upright
    W[0] = V[1] * D[2] - V[2] * D[1]; W[1] = V[2] * D[0] - V[0] * D[2]; W[2] = V[0] * D[1] - V[1] * D[0]
    r = 0.55 + 0.12 * sin(7 * a + 2 * b) + 0.05 * sin(31 * a) * cos(5 * b) + 0.02 * sin(97 * a + 13 * b)
    for (c = 0; c < 3; c++) B[c] = K[0, c] + r * (cos(b) * V[c] + sin(b) * W[c])
  }
  # The piece of a uniform cubic B-spline with the control points Q[x, y, c] as a patch. M: weights of the points -1 ...
  # 2.
  function spline(x, y, c, r, w) {
    split("1 4 1 0 0 4 2 0 0 2 4 0 0 1 4 1", M, " ")
    for (x = 0; x < 4; x++)
      for (y = 0; y < 4; y++)
        for (c = 0; c < 3; c++) {
          w = 0
          for (r = 0; r < 4; r++) if (M[4 * y + r + 1]) w += M[4 * y + r + 1] * Q[x, r, c]
          R[x, y, c] = w / 6
        }
    for (x = 0; x < 4; x++)
      for (y = 0; y < 4; y++)
        for (c = 0; c < 3; c++) {
          w = 0
          for (r = 0; r < 4; r++) if (M[4 * x + r + 1]) w += M[4 * x + r + 1] * R[r, y, c]
          P[4 * x + y, c] = w / 6
        }
    patch()
  }
  function creature(rows, columns, i, j, c, x, y) {
    columns = int(sqrt(n / 8)); if (columns < 3) columns = 3
    rows = int(n / columns + 0.5); if (rows < 3) rows = 3
    head(0, 7, -7)
    for (i = -1; i < rows + 2; i++) {
      for (j = 0; j < columns; j++) {
        body(((i + rows) % rows) / rows, j / columns)
        for (c = 0; c < 3; c++) G[i % 4 + (i < 0) * 4, j, c] = B[c]
      }
      if (i < 2) continue
      for (j = 0; j < columns; j++) {
        for (x = 0; x < 4; x++)
          for (y = 0; y < 4; y++)
            for (c = 0; c < 3; c++) Q[x, y, c] = G[(i - 3 + x + 4) % 4, (j - 1 + y + columns) % columns, c]
        spline()
      }
    }
  }
  function knots(k, i, c) {
    begin(0, 0, -4, 2, 3, -4)
    for (k = 0; k < n; k++) {
      for (i = 0; i < 16; i++) for (c = 0; c < 3; c++) P[i, c] = between(-1.5, 1.5)
      patch()
    }
  }
  function confetti(k, i, c) {
    begin(0, 1, -6, 4, 6, -5)
    for (k = 0; k < n; k++) {
      for (c = 0; c < 3; c++) { at[c] = between(-2, 2); V[c] = between(-1, 1); W[c] = between(-1, 1) }
      for (i = 0; i < 16; i++)
        for (c = 0; c < 3; c++)
          P[i, c] = at[c] + 0.08 * ((int(i / 4) / 3 - 0.5) * V[c] + (i % 4 / 3 - 0.5) * W[c] + between(-0.2, 0.2))
      patch()
    }
  }
  # A ball about `at` with the half axes R, of eight patches. Each is (ring, height) of two quarters of a circle,
  # rotated; u goes up to the pole.
  function ball(i, s) {
    split("1 1 0.5522847498 0", along, " "); split("0 0.5522847498 1 1", up, " ")
    for (s = 0; s < 8; s++) {
      for (i = 0; i < 16; i++) {
        P[i, 0] = at[0] + (s % 2 ? -1 : 1) * R[0] * along[int(i / 4) + 1] * along[i % 4 + 1]
        P[i, 1] = at[1] + (s % 4 > 1 ? -1 : 1) * R[1] * up[int(i / 4) + 1]
        P[i, 2] = at[2] + (s > 3 ? -1 : 1) * R[2] * along[int(i / 4) + 1] * up[i % 4 + 1]
      }
      patch()
    }
  }
  function shells(k, c) {
    begin(0, 0, -4, 2, 3, -4)
    for (k = 0; k < int(n / 8); k++) {
      for (c = 0; c < 3; c++) { at[c] = between(-0.3, 0.3); R[c] = between(0.9, 1.1) }
      ball()
    }
  }
  function pearls(k, c) {
    begin(0, 0, -9, 6, 9, -8)
    R[0] = R[1] = R[2] = 0.12
    for (k = 0; k < int(n / 8); k++) {
      for (c = 0; c < 3; c++) at[c] = between(-2.5, 2.5)
      ball()
    }
  }
  function floor(k, i) {
    begin(0, 2, -7, 6, 9, -8)
    for (i = 0; i < 16; i++) { P[i, 0] = 2000 * (int(i / 4) / 3 - 0.5); P[i, 1] = -1; P[i, 2] = 2000 * (i % 4 / 3 - 0.5) }
    patch()
    for (k = 0; k < int(n / 8); k++) {
      R[0] = R[1] = R[2] = 10 ^ between(-2.5, -0.4)
      at[0] = between(-3, 3); at[1] = R[0] - 1; at[2] = between(-3, 3)
      ball()
    }
  }
  # The cubic with the points A[i, 0], A[i, 1], with the depth 2 `half`.
  function ruled(half, i, j) {
    for (i = 0; i < 4; i++)
      for (j = 0; j < 4; j++) { P[4 * i + j, 0] = A[i, 0]; P[4 * i + j, 1] = A[i, 1]; P[4 * i + j, 2] = (2 * j / 3 - 1) * half }
    patch()
  }
  function book(k, i, a) {
    begin(2, 3, -6, 4, 6, -5)
    for (k = 0; k < n; k++) {
      a = 3.1415926536 * (k + 0.5) / n
      for (i = 0; i < 4; i++) { A[i, 0] = 0.6 * i * cos(a); A[i, 1] = 0.6 * i * sin(a) + (i == 1 || i == 2 ? 0.3 : 0) }
      ruled(1)
    }
  }
  # The point of the roll at the angle a, and a third of the way to the next patch: x, y; dx, dy.
  function wound(a, step, r) {
    r = 0.2 + 1.8 * a / (step * n)
    x = r * cos(a); y = r * sin(a)
    dx = (1.8 / (step * n) * cos(a) - y) * step / 3; dy = (1.8 / (step * n) * sin(a) + x) * step / 3
  }
  function roll(k, step) {
    begin(0, 3, -6, 4, 6, -5)
    step = 6.2831853072 / 8
    for (k = 0; k < n; k++) {
      wound(k * step, step); A[0, 0] = x; A[0, 1] = y; A[1, 0] = x + dx; A[1, 1] = y + dy
      wound((k + 1) * step, step); A[3, 0] = x; A[3, 1] = y; A[2, 0] = x - dx; A[2, 1] = y - dy
      ruled(0.5)
    }
  }
  # A square in the plane y = 0, of this half diagonal, turned by a.
  function square(half, a, i, u, v) {
    for (i = 0; i < 16; i++) {
      u = (2 * int(i / 4) / 3 - 1) / 2; v = (2 * (i % 4) / 3 - 1) / 2
      P[i, 0] = at[0] + half * ((u + v) * cos(a) + (u - v) * sin(a)); P[i, 1] = 0
      P[i, 2] = at[2] + half * ((u + v) * sin(a) - (u - v) * cos(a))
    }
    patch()
  }
  function marks(k) {
    begin(0, 3, -6, 4, 6, -5)
    at[0] = at[2] = 0
    square(14, 0.7853981634)
    for (k = 0; k < n; k++) { at[0] = between(-3, 3); at[2] = between(-3, 3); square(0.6, between(0, 6.28)) }
  }
  function pipes(k, q, i, j, c, x, y) {
    begin(0, 1, -9, 6, 9, -8)
    split("1 1 0.5522847498 0", along, " ")
    for (k = 0; k < int(n / 4); k++) {
      direction(); across()
      for (c = 0; c < 3; c++) at[c] = between(-2, 2)
      for (q = 0; q < 4; q++) {
        for (i = 0; i < 4; i++)
          for (j = 0; j < 4; j++) {
            x = along[q % 2 ? 4 - j : j + 1] * (q % 3 ? -1 : 1); y = along[q % 2 ? j + 1 : 4 - j] * (q > 1 ? -1 : 1)
            for (c = 0; c < 3; c++) P[4 * i + j, c] = at[c] + 8 * (i / 3 - 0.5) * D[c] + 0.05 * (x * V[c] + y * W[c])
          }
        patch()
      }
    }
  }
  function crown(k, i, c, x, y) {
    begin(0, 1, -7, 6, 9, -8)
    printf "#declare Twig = union {\n"
    for (k = 0; k < 100; k++) {
      direction(); across()
      for (i = 0; i < 16; i++) {
        x = int(i / 4) / 3; y = (i % 4 / 3 - 0.5) * 4 * x * (1 - x) # pointed
        for (c = 0; c < 3; c++)
          P[i, c] = (c == 0) * (0.2 + 0.018 * k) + 0.2 * x * D[c] + 0.1 * y * V[c] + (0.04 * x * x + 0.03 * y * y) * W[c]
      }
      patch()
    }
    printf "}\n"
    for (k = 0; k < int(n / 100); k++)
      printf "object { Twig rotate <%g, %g, %g> }\n", between(0, 360), between(0, 360), between(0, 360)
  }
  function hills(side, i, j, x, y) {
    side = int(sqrt(n))
    begin(0, side / 16, -0.7 * side, 7 * side, side / 6, 2.5 * side)
    for (i = 0; i < side + 3; i++)
      for (j = 0; j < side + 3; j++) G[i, j] = between(-0.8, 0.8)
    for (i = 0; i < side; i++)
      for (j = 0; j < side; j++) {
        for (x = 0; x < 4; x++)
          for (y = 0; y < 4; y++) {
            Q[x, y, 0] = i + x - side / 2 - 1; Q[x, y, 1] = G[i + x, j + y]; Q[x, y, 2] = j + y - side / 2 - 1
          }
        spline()
      }
  }
  BEGIN {
    seed = 20240511
    if (kind == "hair") hair(); else if (kind == "ribbons") ribbons(); else if (kind == "creature") creature()
    else if (kind == "knots") knots(); else if (kind == "confetti") confetti(); else if (kind == "shells") shells()
    else if (kind == "pearls") pearls(); else if (kind == "floor") floor()
    else if (kind == "book") book(); else if (kind == "roll") roll(); else if (kind == "marks") marks(); else if (kind == "pipes") pipes()
    else if (kind == "crown") crown(); else hills()
  }'
