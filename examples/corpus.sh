#!/bin/bash
# Regenerates docs/corpus.md: what every solver does on the hard polynomials of tests/corpus/polynomials.txt.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

install_packages "${BUILD_PACKAGES[@]}" libcmocka-dev libflint-arb-dev
cmake -S . -B build-corpus -G Ninja -DCMAKE_BUILD_TYPE=Release -DPSCN_TESTS=ON
cmake --build build-corpus --target corpus_table
{
  cat <<'TEXT'
# Hard polynomials

What every solver does on the named polynomials of [tests/corpus/polynomials.txt](../tests/corpus/polynomials.txt),
against roots guaranteed by arb (FLINT). Made by

    examples/corpus.sh

Each cell is the largest error of a root, relative to 1 or to the root's modulus where that is larger, and in brackets
the iterations of all roots together. Coefficients in the power basis as they stand, each solver with its defaults
(tolerance 1e-12), `form paper` with the paper's plain iteration. "at the limit": roots that met neither their stopping
rule before the iteration limit nor a finite error bound; "without value": true roots for which there was none left.
`bernstein` is judged by the distinct real roots in [0,1] alone, and answers a cluster by one or two candidates.

Errors of multiple and clustered roots are what double precision allows: a root of multiplicity m moves by the m-th root
of a rounding. What the table cannot show is tested (tests/corpus/corpus_test.c): in both bases, at every tolerance, no
value is farther from a true root than its own error radius says, and no real root in [0,1] is outside all discs of
`bernstein`. And on ten families of 1,000 polynomials (tests/corpus/families_test.c: random coefficients over 0 to 60 decades, clusters,
multiple roots, Chebyshev, Mignotte, Wilkinson, sparse) every solver in both forms and both bases leaves no root out in silence: true roots and
values can be paired, each root within its value's radius, or what is not known is said. Of 100 of each
family in the power basis, where the coefficients are exact, the improved forms of the four solvers of all roots leave none unknown.

TEXT
  build-corpus/tests/corpus/corpus_table
  cat <<'TEXT'

The polynomials:

TEXT
  sed -n 's/^# \([a-z0-9-]*\): \(.*\)/- **\1**: \2/p' tests/corpus/polynomials.txt
} >docs/corpus.md
