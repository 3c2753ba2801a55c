#!/bin/bash
# Where methods fail, measured: writes docs/stability.md and its pictures in docs/stability/.
#
# Builds with tests; compares with the reference in every class of tests/accuracy/situations.c, for every solver in our
# form and in the paper's; runs the accuracy tests; and renders scenes where holes show, with POV-Ray too if it is
# installed.
#
#   examples/stability.sh            everything
#   examples/stability.sh proofs     only the section on the exact judge; the rest of the page stays
#   examples/stability.sh closed     only the section on closed surfaces
#   examples/stability.sh proofs FILE...  the same from earlier output of accuracy-certificate, in portions with
#                                    different seeds; for `closed`, of accuracy-parity and accuracy-cycles
#   examples/stability.sh maps       only the section on maps
#
# PSCN_EFFORT (see tests/effort.h) sets the fraction of the rays for everything. Without it each part has the fraction
# given below, some ten minutes of one core in all; `full` takes an hour or two. PSCN_BUILD is the build folder.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/packages.sh
export LC_ALL=C

TABLE_EFFORT=${PSCN_EFFORT:-0.5}
FRAME_EFFORT=${PSCN_EFFORT:-full}
RANDOM_EFFORT=${PSCN_EFFORT:-full}
LEAK_EFFORT=${PSCN_EFFORT:-0.02}
PROOF_EFFORT=${PSCN_EFFORT:-0.01}
CLOSED_EFFORT=${PSCN_EFFORT:-0.02}

install_packages "${BUILD_PACKAGES[@]}" libcmocka-dev libflint-arb-dev
build=${PSCN_BUILD:-build-stability}
cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DPSCN_TESTS=ON >/dev/null
targets=(pscn channel_maps stability-table accuracy-camera accuracy-random-patches accuracy-leaks accuracy-certificate
  accuracy-parity accuracy-cycles)
[ "${1:-}" != maps ] || targets=(pscn channel_maps)
cmake --build "$build" -j2 --target "${targets[@]}" >/dev/null
pscn=$PWD/$build/src/command/pscn
tests=$PWD/$build/tests
programs=$PWD/$build/examples/paper
pictures=docs/stability
mkdir -p "$pictures"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

PAPER='form paper'
FRAME=320x240
INSIDE=401x401

# The number of pixels of two pictures that differ by more than $3 (1 is white).
pixels_over() {
  { "$pscn" compare "$1" "$2" --fail "$3" 2>/dev/null || true; } |
    awk -v over="$3" '$1 == "over" && $2 == over { print $3 }'
}

# Runs a program that counts: $1 the effort, $2 its description, the rest its command line. If it fails, the page says
# so.
measure() {
  local effort=$1 out=$2
  shift 2
  echo "$1, PSCN_EFFORT=$effort" >&2
  PSCN="$pscn" PSCN_EFFORT=$effort "$@" >"$out" 2>"$out.errors" || {
    echo "$1 FAILED"
    grep -h '^ERROR\|allowed' "$out" "$out.errors" | head -5 || true
  } >>"$folder/failures"
}

# The output of tests/accuracy/trial.c's tally_print, two lines each, as rows of a table.
tally_rows() {
  awk '/ undecided; lost / {
    name = $0; sub(/:.*/, "", name)
    counts = $0; sub(/^[^:]*: /, "", counts); split(counts, n, /[^0-9]+/)
    getline; split($0, e, /[ ,;]+/)
    certain = n[1] ? 100 * (n[1] - n[7]) / n[1] : 0
    printf "| %s | %d | %d | %d | %d | %d | %.4f %% | %s | %s | %s | %s, %s, %s |\n",
      name, n[1], n[2], n[4], n[5], n[6], certain, e[5], e[8], e[10], e[15], e[17], e[19]
  }' "$1"
}

# The output of tests/accuracy/certificate_test.c, summed: a row for each class, or if $2 is `solver`, for each solver
# and split.
proof_rows() {
  awk -v by="${2:-class}" '/ answers: proven / {
    name = substr($0, 1, 36); sub(/ +$/, "", name)
    split(substr($0, 38), word, / +/)
    if (by == "solver") name = word[2] ? word[1] ", split " word[2] : word[1]
    counts = $0; sub(/.*answers: proven/, "", counts); split(counts, n, /[^0-9]+/)
    if (!(name in seen)) { seen[name] = 1; order[++rows] = name }
    all[name] += word[3]
    for (k = 2; k <= 9; k++) count[name, k] += n[k]
    slow[name] += n[14]
    match($0, /slowest [0-9.]+/); time = substr($0, RSTART + 8, RLENGTH - 8) + 0
    if (time > slowest[name]) slowest[name] = time
  }
  function share(part, all) { return all ? sprintf("%.2f %%", 100 * part / all) : "-" }
  function row(c) {
    printf "| %s | %d | %d | %d | %d | %d | %s | %s | %d | %d | %d | %.2f |\n", c, all[c], count[c, 2], count[c, 3],
      count[c, 4], count[c, 5], share(count[c, 4] + count[c, 5], all[c]), share(count[c, 6], all[c]), count[c, 7],
      count[c, 8] + count[c, 9], slow[c], slowest[c]
  }
  END {
    for (k = 1; k <= rows; k++) {
      c = order[k]
      row(c)
      all["all"] += all[c]; slow["all"] += slow[c]
      for (m = 2; m <= 9; m++) count["all", m] += count[c, m]
      if (slowest[c] > slowest["all"]) slowest["all"] = slowest[c]
    }
    row("all")
  }' "$1"
}

# The values of PSCN_SEED with which the output in $1 was made: `seed N` is a test's own number plus a million times
# that.
seeds_of() {
  grep -oE 'seed [0-9]+' "$1" | awk '{ n = int($2 / 1000000); if (!(n in seen)) { seen[n] = 1; print n } }' | sort -n |
    awk 'function told() { list = list (list ? ", " : "") (first == last ? first : first " to " last) }
      NR > 1 && $1 > last + 100 { told(); first = $1 } # portions are numbered as they come, of all classes
      NR == 1 { first = $1 }
      { last = $1 }
      END { told(); print list == "0" ? "none" : list }'
}

# The output of accuracy-parity and accuracy-cycles, summed by what the rays are aimed at and how they are asked.
closed_rows() {
  awk '/ rays, .* of wrong parity/ {
    name = $0; sub(/^seed [0-9]+, /, "", name); sub(/: .*/, "", name)
    if (name ~ /^solver/) { sub(/split 0/, "split auto", name); name = "dome, ball, torus; " name }
    counts = $0; sub(/^[^:]*: /, "", counts); split(counts, n, /[^0-9]+/)
    if (!(name in rays)) order[++rows] = name
    rays[name] += n[1]; hits[name] += n[2]; wrong[name] += n[3]
    if ($0 ~ /another nearest/) differing[name] += n[4]; else differing[name] = "-"
    all += n[1]; all_hits += n[2]; all_wrong += n[3]
  }
  END {
    for (k = 1; k <= rows; k++)
      printf "| %s | %d | %d | %d | %s |\n", order[k], rays[order[k]], hits[order[k]], wrong[order[k]], differing[order[k]]
    printf "| all | %d | %d | %d | |\n", all, all_hits, all_wrong
  }' "$1"
}

closed_section() {
  cat <<END
## Closed surfaces

A ray that starts outside of a closed surface meets it an even number of times, and one that starts inside an odd number,
whatever else is true of either. So the parity of a certain list of all hits tells whether one was lost or invented, without
any judge.

- [tests/accuracy/parity.c](../tests/accuracy/parity.c) aims at a dome, a ball and a torus (turned, scaled by 1e6 and 1e-6,
  shifted by 1000), exactly at edges, corners, poles and iso-lines and next to them by every power of two, and along
  tangents; and exactly at edges and corners of a cube and of two pyramids.
- [tests/accuracy/cycles.c](../tests/accuracy/cycles.c) takes surfaces that nobody would draw: two random sheets with common
  borders, boxes, gores between two poles, a patch that closes upon itself, sheets halved on one side (T-junctions), four
  patches at one border, a sheet twice, specks within; folded, of whole numbers, graded, thin to 1e-15, skew to 1e6; each
  patch with a solver and a split of its own; crowds of them as copies, and 66,000 patches of them. There the nearest hit,
  and whether there is one, have to be what the list of all hits says, of the whole ray and of parts of it.

Nothing certain was wrong in the runs below, all of one revision
(PSCN_SEED $(seeds_of "$folder/closed")), nor in the longest run of
\`accuracy-parity\`, 107 million rays, of an earlier one (PSCN_EFFORT=0.1, PSCN_SEED 110001 to 110012, 130001 to 130027,
140001 to 140011):

| surface | rays | hits | of wrong parity | another nearest hit |
|---|---|---|---|---|
END
  closed_rows "$folder/closed"
  echo
}

proofs_section() {
  cat <<END
## Every answer put to the proof

Another judge, [tests/accuracy/exact.h](../tests/accuracy/exact.h), finds all points where a ray meets a patch by halving
nets of exact integers and proves them in ball arithmetic; it shares nothing with the renderer nor with the reference. It
takes every answer, hit or miss, certain or grazing, of the classes above and of those that an adversary would aim
([tests/accuracy/hostile.c](../tests/accuracy/hostile.c)): rings of every radius from 1e-18 to 1 round poles, edges, corners,
borders of leaves, cusps, rulings and tangencies; starts next to surfaces; nets degenerate but for some roundings;
coordinates of every size.

Each ray is asked as it is, from beyond what it hits back, ending there and starting there (but for 2^-20 to 2^-53, or to the
last bit); with every solver, and with whole patches (split 1) and 8 x 8 leaves (split 8). All answers to it are held to one
proof. Alone it has to be answered as in a packet, and asked for any hit as for the nearest.

The runs (PSCN_SEED $(seeds_of "$folder/proofs"); PSCN_CLASS takes one class):
those from 70001 on are of the present intersector, but for T, U and V in last places. They are a million answers each of the
sixteen classes that are slowest to judge, or had something refuted before, and a hundred thousand each of the others, whose
first million is of an earlier revision.

- **proven**: certain hits of which T is a root's, within 4 times what one rounding of each input moves it, and none before
  it; certain misses without a root on the ray.
- **grazing**: hits and misses that say so, and stand: no proven root is lost or passed by.
- **provable**: the share of all answers that say grazing though the judge proves them, so that they could be certain. What is
  left was met where no proof can be had: the exact tangency, the common curve, the border of an open surface or the pole to
  the last bit, the start on the surface.
- **undecided**: certain answers that the exact judge itself could not decide.
- **refuted**: a proven root is lost or passed by, or there is none at T; U, V, the point or the normal are wrong. What was
  met is a scene of [tests/accuracy/cases](../tests/accuracy/cases) and mended. What the table has is all of it grazing:
  - *tangent where nothing bends*: rays along a direction in which the surface does not bend, next to it from 1e-18 of its
    size on, half of them where that is the only one, so that they meet it as a cubic does 0, or a quartic. There a ray's
    share of work ended before a root that lies beyond. Of the present intersector nothing is refuted there: of 241,920 answers (seeds
    90101 and 90102) it calls 1.4 % grazing, and the judge, with 60,000 boxes in place of 2,000, for its own share ends there
    too, proves all certain ones but 7, which it leaves undecided.
  - *sizes beyond all digits*: needles 1e-160 thick and 1 long, met 1e-13 behind the ray's start: two rays of 143,000. The
    present intersector answers both (seeds 70080 and 70083), and calls 4.5 % of that class grazing.
- **slow**: answers that took more than 2 ms; **slowest**: the slowest one, in ms, the machine being busy.

| class | answers | hits proven | misses proven | grazing hits | grazing misses | grazing | provable | undecided | refuted | slow | slowest |
|---|---|---|---|---|---|---|---|---|---|---|---|
END
  proof_rows "$folder/proofs"
  cat <<END

| solver | answers | hits proven | misses proven | grazing hits | grazing misses | grazing | provable | undecided | refuted | slow | slowest |
|---|---|---|---|---|---|---|---|---|---|---|---|
END
  proof_rows "$folder/proofs" solver
  echo
}

# Maps of every solver's work on the teapot, in the default form and the paper's.
maps_section() {
  local methods=(bernstein newton laguerre aberth durand_kerner) method form map cell
  cat <<END
## Maps

The teapot, $FRAME, what \`pscn render --channels iterations,roots,residual,deviation\` tells, line by line: iterations a root (dark 1, yellow 64) and
the distance from the certified answer, relative (dark 1e-16, yellow 1, red: a hole or a phantom).

- The default form of every solver is certified; what differs is how long it looks, \`bernstein\` longest where a ray passes
  between two leaves.
- In the paper's form, eps 1e-12, \`aberth\` is right nearly everywhere but runs to its cap of steps all over the body and the
  lid; what it does not find to 1e-12 lies on the knob and the spout.
- Deflation leaves errors all over the body, and its holes lie in the floor, which is flat.
- \`bernstein\` is not in the paper and stands there with \`polish off\`.

The patch of the paper's figures is drawn so in [paper.md](paper.md).

| | ${methods[0]} | ${methods[1]} | ${methods[2]} | ${methods[3]} | ${methods[4]} |
|---|---|---|---|---|---|
END
  for form in default paper; do
    for method in "${methods[@]}"; do
      local solver=$method
      [ $form = default ] || solver="$method { $PAPER }"
      [ "$form $method" != 'paper bernstein' ] || solver='bernstein { polish off }'
      echo "map of $solver" >&2
      "$programs/channel_maps" scenes/teapot.pscn ${FRAME/x/ } "$solver" "$pictures/map-$form-$method" \
        >"$folder/map-$form-$method"
    done
    for map in iterations deviation; do
      [ "$form $map" != 'default deviation' ] || continue
      printf '| %s form, %s |' "$form" "$map"
      for method in "${methods[@]}"; do printf ' ![](stability/map-%s-%s-%s.png) |' "$form" "$method" "$map"; done
      echo
    done
    printf '| pixels off by more than 1e-12, holes and phantoms |'
    for method in "${methods[@]}"; do
      cell=$(awk -F, '{ printf "%.2f %%, %.2f %%", 100 * $4, 100 * $5 }' "$folder/map-$form-$method")
      printf ' %s |' "$cell"
    done
    echo
  done
  echo
  rm -f "$pictures"/map-*-residual.png "$pictures"/map-default-*-deviation.png
}

# Replaces the section with this heading by the output of $2, or inserts it before "## Holes".
replace_section() {
  "$2" >"$folder/section"
  awk -v section="$folder/section" -v heading="## $1" '
    /^## / { inside = $0 == heading }
    (/^## Holes/ || inside) && !done { while ((getline line < section) > 0) print line; done = 1 }
    !inside' docs/stability.md >"$folder/page"
  cp "$folder/page" docs/stability.md
}

# ---- measuring ----

if [ "${1:-}" = maps ]; then
  replace_section Maps maps_section
  exit
fi
measure_closed() {
  measure "$CLOSED_EFFORT" "$folder/parity" "$tests/accuracy/accuracy-parity"
  measure "$CLOSED_EFFORT" "$folder/cycles" "$tests/accuracy/accuracy-cycles"
  cat "$folder/parity" "$folder/cycles" >"$folder/closed"
}

if [ $# -gt 1 ]; then
  cat "${@:2}" >"$folder/$1"
elif [ "${1:-}" != closed ]; then
  measure "$PROOF_EFFORT" "$folder/proofs" "$tests/accuracy/accuracy-certificate"
fi
if [ "${1:-}" = proofs ]; then
  replace_section 'Every answer put to the proof' proofs_section
  exit
fi
[ $# -gt 1 ] || measure_closed
if [ "${1:-}" = closed ]; then
  replace_section 'Closed surfaces' closed_section
  exit
fi

measure "$TABLE_EFFORT" "$folder/table" "$tests/stability/stability-table"
measure "$FRAME_EFFORT" "$folder/camera" "$tests/accuracy/accuracy-camera"
measure "$RANDOM_EFFORT" "$folder/random" "$tests/accuracy/accuracy-random-patches"
measure "$LEAK_EFFORT" "$folder/leaks" "$tests/accuracy/accuracy-leaks"

"$pscn" render scenes/teapot.pscn --size "$FRAME" --quiet -o "$pictures/teapot-default.png"
for solver in aberth laguerre newton; do
  picture=$pictures/teapot-$solver.png
  "$pscn" render scenes/teapot.pscn --size "$FRAME" --quiet --solver "$solver { $PAPER }" -o "$picture"
  echo "| \`--solver '$solver { $PAPER }'\` | $(pixels_over "$pictures/teapot-default.png" "$picture" 0.02) |"
done >"$folder/holes"

"$pscn" render scenes/inside.pscn --size "$INSIDE" --quiet --stats "$folder/inside.json" -o "$pictures/inside-pscn.png"
certain=$(awk -F'[:,]' '/"certain"/ { print $2 + 0 }' "$folder/inside.json")
if command -v povray >/dev/null; then
  mkdir "$folder/home"
  (cd scenes && HOME=$folder/home povray +Iinside.pscn "+O$folder/inside.png" \
    "+W${INSIDE%x*}" "+H${INSIDE#*x}" +WT1 -D -A) >"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
  cp "$folder/inside.png" "$pictures/inside-povray.png"
  pinholes=$(pixels_over "$pictures/inside-povray.png" "$pictures/inside-pscn.png" 0.5)
  povray_version=$(povray --version 2>&1 | awk '/^POV-Ray/ { print $2; exit }')
else
  echo "povray is not installed: its picture is left out" >&2
fi

# ---- writing ----

page=$folder/page
{
  cat <<END
# Where methods fail

Written by \`examples/stability.sh\`; the numbers are those of its last run. Every answer is judged by the reference
([src/reference/reference.h](../src/reference/reference.h)): subdivision and Krawczyk's test in quadruple precision,
which shares nothing with the renderer.

- **lost**: the reference proves a hit, and the answer is a miss (a hole) or a later hit.
- **invented**: an answer where the reference proves that nothing is hit, or nearer than its first hit.
- Two distances are the same hit within 64 times what rounding the input can do (how near they really are is in the last
  columns of the first table), and 2^-40 of the largest coordinate where the answer says \`grazing\`. Without polish
  nothing is proven, every answer says \`grazing\`, and what is counted is whether the hit is found, within 1e-6
  relative.
- Errors of T are relative, of the answers that are the same hit.

The paper's form of a solver is \`NAME { $PAPER }\`, at that solver's default tolerance, 1e-12. With polish it has the
paper's plain iteration, basis, determinant and back-substitution too.

END
  if [ -s "$folder/failures" ]; then
    printf '**Bounds that this run found broken:**\n\n```\n'
    cat "$folder/failures"
    printf '```\n\n'
  fi
  cat <<END
## The frame, random patches, leaks

All pixels or a seeded choice of them (PSCN_EFFORT=$FRAME_EFFORT; teapot 800x600, the others 320x240), and random rays
over random patches (PSCN_EFFORT=$RANDOM_EFFORT of 1,000,000). The last column is in units of the data floor: how far
one rounding of each input can move the hit.

| rays of | rays | hits | undecided by the reference | lost | invented | certain | median error of T | 99 % | largest | T, U, V in floors, largest |
|---|---|---|---|---|---|---|---|---|---|---|
END
  tally_rows "$folder/camera"
  tally_rows "$folder/random"
  cat <<END

Rays from inside closed bodies (dome, ball, torus, the teapot's body; turned, scaled by 1e6 and 1e-6, shifted by 1e6) at
shared edges, corners, poles and iso-lines, PSCN_EFFORT=$LEAK_EFFORT of 10,000,000. The longest run, PSCN_SEED=1
PSCN_EFFORT=0.5, had 5,000,044 rays with the default and 100,072 with each other solver and split, and no leak.

| run | rays | leaks |
|---|---|---|
END
  awk '/^seed .* leaks$/ {
    gsub(/[,:]/, ""); print "| seed " $2 ", " $4 ", split " ($6 ? $6 : "auto") " | " $7 " | " $9 " |" }' "$folder/leaks"
  echo
  grep -h '^seed 403: ' "$folder/leaks" | sed 's/^/Rays that leave a hit, /; s/$/./' || true
  cat <<END

## Classes

PSCN_EFFORT=$TABLE_EFFORT of 10,000 rays a class (fewer where the reference is slow), the same rays for every column.
What each class is stands in [tests/accuracy/situations.c](../tests/accuracy/situations.c).

END
  cat "$folder/table"
  closed_section
  proofs_section
  maps_section
  cat <<END
## Holes

The teapot, \`pscn render scenes/teapot.pscn --size $FRAME\`: the default, and the paper's form of three solvers, at eps
1e-12. Aberth's roots are nearly all there; those of deflation have holes all over the floor, which is flat,
and on the body dark specks, shadow rays that hit what is not there.

| default | aberth | laguerre | newton |
|---|---|---|---|
| ![default](stability/teapot-default.png) | ![aberth](stability/teapot-aberth.png) | ![laguerre](stability/teapot-laguerre.png) | ![newton](stability/teapot-newton.png) |

| | pixels that differ from the default's by more than 0.02 |
|---|---|
$(cat "$folder/holes")

## Pinholes

[scenes/inside.pscn](../scenes/inside.pscn) is a half ball of four patches, seen from a point of its axis, $INSIDE
pixels: the rays of the middle row and column lie exactly in the planes where the patches join. Surface dark, background
bright yellow.

END
  if [ -n "${pinholes:-}" ]; then
    cat <<END
| POV-Ray $povray_version, \`u_steps 5 v_steps 5 flatness 0\` | pscn |
|---|---|
| ![POV-Ray](stability/inside-povray.png) | ![pscn](stability/inside-pscn.png) |
| **$pinholes** pixels of background (more than 0.5 off pscn's) | $certain of $((${INSIDE%x*} * ${INSIDE#*x})) answers certain |

    povray +Iinside.pscn +Opovray.png +W${INSIDE%x*} +H${INSIDE#*x} +WT1 -D -A       # in scenes/
    pscn render scenes/inside.pscn --size $INSIDE -o pscn.png
    pscn compare povray.png pscn.png --fail 0.5
END
  else
    echo "![pscn](stability/inside-pscn.png)"
    echo
    echo "POV-Ray was not at hand in this run."
  fi
} >"$page"
cp "$page" docs/stability.md
echo "docs/stability.md is written" >&2
if [ -s "$folder/failures" ]; then
  cat "$folder/failures" >&2
  exit 1
fi
