#!/bin/bash
# Regenerates docs/corpus.md: what every solver does on the hard polynomials of tests/corpus/polynomials.txt.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

install_packages "${BUILD_PACKAGES[@]}" libcmocka-dev libflint-arb-dev mpsolve
build=${1:-build-corpus} # a build folder
cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DPSCN_TESTS=ON
cmake --build "$build" --target corpus_table
table=$(mktemp)
trap 'rm -f "$table"' EXIT
"$build/tests/corpus/corpus_table" >"$table"

# A row for each column of the table: median time, correct digits (at most 16, since answers are doubles), what is
# missing.
summary() {
  awk -F' *[|] *' '
    NR == 1 { for (k = 4; k < NF; k++) name[k] = $k; last = NF - 1 }
    NR > 2 {
      for (k = 4; k <= last; k++) {
        if ($k !~ /^[0-9]/) { none[k]++; continue }
        error = $k + 0
        digits = error > 1e-16 ? -log(error) / log(10) : 16
        digit[k, ++n[k]] = digits < 0 ? 0 : digits
        time = $k; sub(/.*[(;] */, "", time)
        took[k, n[k]] = time * (time ~ /ms/ ? 1000 : 1)
        lost[k] += $k ~ /without/; limit[k] += $k ~ /at the limit/
      }
    }
    function median(x, k,   i, j, swap, y) {
      for (i = 1; i <= n[k]; i++) y[i] = x[k, i]
      for (i = 2; i <= n[k]; i++) for (j = i; j > 1 && y[j] < y[j - 1]; j--) { swap = y[j]; y[j] = y[j - 1]; y[j - 1] = swap }
      return y[int((n[k] + 1) / 2)]
    }
    function least(x, k,   i, y) {
      for (i = 1; i <= n[k]; i++) y = i == 1 || x[k, i] < y ? x[k, i] : y
      return y
    }
    END {
      for (k = 4; k <= last; k++)
        printf "| %s | %.0f us | %.1f | %.1f | %d | %d |\n", name[k], median(took, k), median(digit, k), least(digit, k), limit[k], lost[k]
    }' "$table"
}

{
  cat <<'TEXT'
# Hard polynomials

What every solver does on the named polynomials of [tests/corpus/polynomials.txt](../tests/corpus/polynomials.txt),
against roots guaranteed by arb (FLINT). Made by

    examples/corpus.sh

Each cell is the largest error of a root, relative to 1 or to the root's modulus where that is larger, and in brackets
the iterations of all roots together and the time (CPU, the median of nine turns, on a busy machine). Coefficients in the power basis as they stand, each solver with its defaults
(tolerance 1e-12), `form paper` with the paper's plain iteration. "at the limit": roots that met neither their stopping
rule before the iteration limit nor a finite error bound; "without value": true roots for which there was none left.
`bernstein` is judged by the distinct real roots in [0,1] alone, and answers a cluster by one or two candidates.

Errors of multiple and clustered roots are what double precision allows: a root of multiplicity m moves by the m-th root
of a rounding. What the table cannot show is tested (tests/corpus/corpus_test.c): in both bases, at every tolerance, no
value is farther from a true root than its own error radius says, and no real root in [0,1] is outside all discs of
`bernstein`. And on ten families of 1,000 polynomials (tests/corpus/families_test.c: random coefficients over 0 to 60 decades, clusters,
multiple roots, Chebyshev, Mignotte, Wilkinson, sparse) every solver in both forms and both bases leaves no root out in silence: true roots and
values can be paired, each root within its value's radius, or what is not known is said. Of 100 of each
family in the power basis, where the coefficients are exact, the improved forms of the four solvers of all roots leave none unknown. Run in full (PSCN_EFFORT=full): 0 of 10,000 polynomials with anything lost in silence or false.

TEXT
  cat <<'TEXT'
The last column is a peer, mpsolve (Debian's package; `mpsolve -as -Ga -o20`), asked for 20 digits of
the same coefficients as exact fractions: iterations of Aberth's kind in the precision that it takes, so its answers are right to the last place of a
double, whatever the polynomial. Its time is that of the whole process, most of it its start (see `linear`). That is the price of digits: what is
clustered or multiple is known to few digits in double, by any solver, and a renderer that needs more goes back to the patch (`polish`), not to r.

| solver | median time | median of the correct digits | least | with roots at the limit | with roots without a value |
|---|---|---|---|---|---|
TEXT
  summary
  echo
  cat "$table"
  cat <<'TEXT'

The polynomials:

TEXT
  sed -n 's/^# \([a-z0-9-]*\): \(.*\)/- **\1**: \2/p' tests/corpus/polynomials.txt
} >docs/corpus.md
