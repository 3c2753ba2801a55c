# An ended rendering loses little work: --resume continues to the same bits, or says what has changed.
scene="$SCENES/bent.pscn --size 300x200 --samples 4"
pscn render $scene -o one.exr --quiet --checkpoint 0.02
all=$((300 * 200 * 4 * 4))
# end SIGNAL FILE OPTION...: ends a rendering by the signal when a part of it is done. On a busy machine it may finish
# before the signal comes; then it is started again.
end() {
  local signal=$1 file=$2 status
  shift 2
  for attempt in {1..20}; do
    rm -f $file
    pscn render $scene -o $file --threads 1 --checkpoint 0.1 "$@" 2>said &
    for wait in {1..200}; do [ -e $file.part.exr ] && break || sleep 0.05; done
    kill -$signal $! 2>/dev/null
    wait $! 2>/dev/null && status=0 || status=$?
    [ $status = 0 ] || break
  done
  echo "exit $status"
  [ $# -gt 0 ] || sed -n '/interrupted/s/[0-9]* % of/so many % of/p' said # else it may end before it begins
  rm -f said
  [ -e $file ] && echo "$file is there"
}
# The bits of one.exr, with fewer rays than all of it takes.
resumed() {
  pscn render $scene -o $1 --resume --quiet --stats stats.json
  primary=$(sed -n 's/.*"primary": \([0-9]*\).*/\1/p' stats.json)
  [ "$primary" -lt $all ] || echo "$primary rays of $all"
  pscn compare $1 one.exr --fail 0 --quiet && echo "$1 is one.exr"
}
for signal in INT TERM KILL; do
  end $signal $signal.exr
  resumed $signal.exr
done
end INT again.png
end TERM again.png --resume
pscn render $scene -o again.png --resume --quiet
pscn render $scene -o one.png --quiet
pscn compare again.png one.png --fail 0 --quiet && echo 'again.png is one.png'
# The kept file is a piece of the picture.
end INT half.exr
pscn merge half.exr.part.exr -o no.png; echo "exit $?"
cp half.exr.part.exr some.exr
# Nothing else is continued.
try pscn render $scene -o half.exr --resume --samples 3
try pscn render $scene -o half.exr --resume --size 30x20
try pscn render $scene -o half.exr --resume --tile 1/2
try pscn render $scene -o half.exr --resume --solver newton
try pscn render $scene -o half.exr --resume --tolerance 1e-3
# A file that claims to be of this picture, but has another size, is no part of it.
small="$SCENES/bent.pscn --size 30x20 --quiet"
pscn render $SCENES/bent.pscn --size 90x80 --tile 1/1 -o larger.exr --quiet
sed 's/90x80/30x20/g; s/0,0,90,80/0,0,30,20/g' larger.exr >small.exr.part.exr
try pscn render $small -o small.exr --resume
rm larger.exr small.exr.part.exr
pscn render $small --crop 5,0,20,20 --tile 1/1 -o beside.exr
sed 's/5,0,20,20/0,0,20,20/' beside.exr >small.exr.part.exr
try pscn render $small --crop 0,0,20,20 -o small.exr --resume
rm beside.exr small.exr.part.exr
pscn render $small --tile 1/2 -o small.exr.part.exr
try pscn render $small --tile 2/2 -o small.exr --resume
rm small.exr.part.exr
echo no picture >half.exr.part.exr
pscn render $scene -o half.exr --resume 2>&1; echo "exit $?"
# Nothing is continued unless asked for, but that is said. A complete picture removes the kept file, even a part of
# another picture of this scene. Any other file stays, and that is an error.
for options in "--quiet" ""; do
  cp some.exr half.exr.part.exr
  pscn render $SCENES/bent.pscn --size 20x10 -o half.exr $options 2>said
  head -n 1 said
  [ -e half.exr.part.exr ] && echo "some.exr is still there"
done
rm said half.exr
for part in one.exr some.exr one.png; do
  for options in "" --resume; do
    cp $part half.exr.part.exr
    try pscn render $SCENES/flat.pscn --size 20x10 -o half.exr $options
    cmp $part half.exr.part.exr
  done
done
rm half.exr.part.exr
# A file that has some tiles twice counts for none: the tiles missing without it are reported.
pscn render $scene --tile 1/1 -o all.exr --quiet
try pscn merge some.exr all.exr -o no.png
rm some.exr
# Whoever forgets --resume, and ends the rendering therefore, loses nothing. A complete picture removes what was kept of
# it.
for attempt in {1..20}; do
  cp all.exr left.exr.part.exr
  rm -f said
  pscn render $scene -o left.exr --threads 1 --checkpoint 0.01 2>said &
  for wait in {1..200}; do [ -s said ] && break || sleep 0.05; done # it tells what is left where it begins
  sleep 0.3
  kill -INT $! 2>/dev/null
  wait $! || break
done
grep interrupted said
rm said
cmp all.exr left.exr.part.exr && echo 'what was left is there'
pscn render $scene -o left.exr 2>&1 | grep earlier
# A damaged file does not prevent keeping the new tiles.
for attempt in {1..20}; do
  rm -f cut.exr
  head -c -1000 all.exr >cut.exr.part.exr
  pscn render $scene -o cut.exr --threads 1 --checkpoint 0.1 2>said &
  for wait in {1..200}; do head -c -1000 all.exr | cmp -s - cut.exr.part.exr || break; sleep 0.05; done
  kill -INT $! 2>/dev/null
  wait $! || break
done
sed -n 's/[0-9]* % of/so many % of/p; /earlier/p' said
resumed cut.exr
rm all.exr said
# --checkpoint 0: an existing file stays unchanged while the picture is rendered.
pscn render $SCENES/bent.pscn --size 20x10 --tile 1/1 -o other.exr --quiet
cp other.exr never.exr.part.exr
pscn render $scene -o never.exr --threads 1 --checkpoint 0 2>said &
for wait in {1..200}; do [ -s said ] && break || sleep 0.05; done
sleep 0.3
kill -KILL $! 2>/dev/null
wait $! 2>/dev/null
cmp other.exr never.exr.part.exr && echo 'nothing is kept'
rm -f other.exr never.exr* said
# All of this picture is one tile. The rows that are whole are kept, and gone on from; a tile whose rays start from those
# before them is begun anew. A row takes longer than a signal is waited for.
for case in '40 bernstein' '25 aberth { start previous }'; do
  samples=${case%% *} solver=${case#* }
  scene="$SCENES/bent.pscn --size 32x32 --samples $samples --threads 1 --quiet"
  pscn render $scene -o whole.exr --solver "$solver"
  for attempt in {1..20}; do
    rm -f rows.exr
    pscn render $scene -o rows.exr --solver "$solver" --checkpoint 0.05 &
    for wait in {1..400}; do [ -e rows.exr.part.exr ] && break || sleep 0.02; done
    kill -TERM $! 2>/dev/null
    wait $! 2>/dev/null || break
  done
  grep -ao 'pscn:done.string.....[1-7]' rows.exr.part.exr | tr -d '\0-\37' | sed 's|[1-7]$|some|'; echo
  pscn merge rows.exr.part.exr -o no.exr; echo "exit $?"
  pscn render $scene -o rows.exr --solver "$solver" --resume --stats stats.json
  primary=$(sed -n 's/.*"primary": \([0-9]*\).*/\1/p' stats.json)
  echo "$solver: $([ "$primary" -lt $((32 * 32 * samples * samples)) ] && echo less || echo all)"
  pscn compare rows.exr whole.exr --fail 0 --quiet && echo 'rows.exr is whole.exr'
done
rm rows.exr whole.exr
# Nothing to continue.
pscn render $SCENES/flat.pscn --size 20x10 -o new.png --resume --quiet
LC_ALL=C ls
