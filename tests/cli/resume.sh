# An ended rendering loses little work: --resume continues to the same bits, or says what has changed.
# ended SIGNAL WHEN FILE OPTION...: renders $scene into FILE and sends the signal once the command WHEN succeeds. Fails if
# the picture was finished before.
ended() {
  local signal=$1 when=$2 file=$3
  shift 3
  rm -f $file
  pscn render $scene -o $file --threads 1 "$@" 2>said &
  until eval "$when" || ! kill -0 $! 2>/dev/null; do sleep 0.02; done
  kill -$signal $! 2>/dev/null
  wait $! 2>/dev/null
  status=$?
  [ $status != 0 ]
}
# end SIGNAL FILE OPTION...: ends a rendering by the signal when a part of it is kept.
end() {
  local signal=$1 file=$2
  shift 2
  for attempt in {1..9}; do ended $signal "[ -e $file.part.exr ]" $file --checkpoint 0.1 "$@" && break; done
  echo "exit $status"
  [ $# -gt 0 ] || sed -n '/interrupted/s/[0-9]* % of/so many % of/p' said # else it may end before it begins
  rm -f said
  [ -e $file ] && echo "$file is there"
}
# So many samples that this machine has done less than a third when a part is first kept. Where other programs are busy
# a picture may all the same be finished before the signal comes; then it is begun again.
for samples in 4 6 9 13 20 30; do
  scene="$SCENES/bent.pscn --size 300x200 --samples $samples"
  rm -f first.exr.part.exr
  ended INT '[ -e first.exr.part.exr ]' first.exr --checkpoint 0.1 && grep -q 'interrupted; [12]\?[0-9] %' said && break
done
[ -e first.exr ] && echo 'nothing is kept before the picture is finished' && exit 1
rm first.exr.part.exr said
pscn render $scene --tile 1/1 -o all.exr --quiet --checkpoint 0.02
for picture in one.exr one.png; do pscn merge all.exr -o $picture --quiet; done
all=$((300 * 200 * samples * samples))
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
pscn compare again.png one.png --fail 0 --quiet && echo 'again.png is one.png'
# The kept file is a piece of the picture.
end INT half.exr
pscn merge half.exr.part.exr -o no.png; echo "exit $?"
cp half.exr.part.exr some.exr
# Nothing else is continued.
try pscn render $scene -o half.exr --resume --samples 3 2>said
sed "s/'$samples'/'4'/" said >&2
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
try pscn merge some.exr all.exr -o no.png
rm some.exr
# Whoever forgets --resume, and ends the rendering therefore, loses nothing.
for attempt in {1..9}; do
  cp all.exr left.exr.part.exr
  # It warns of what is left where it begins.
  ended INT '[ -s said ] && sleep 0.2' left.exr --checkpoint 0.01 && grep interrupted said && break
done
rm said
cmp all.exr left.exr.part.exr && echo 'what was left is there'
# A complete picture removes what was kept of it.
pscn render $small --tile 1/1 -o left.exr.part.exr
pscn render ${small% --quiet} -o left.exr 2>&1 | grep earlier
# A damaged file does not prevent keeping the new tiles.
for attempt in {1..9}; do
  head -c -1000 all.exr >cut.exr.part.exr
  ended INT '! head -c -1000 all.exr | cmp -s - cut.exr.part.exr' cut.exr --checkpoint 0.1 && break
done
sed -n 's/[0-9]* % of/so many % of/p; /earlier/p' said
resumed cut.exr
rm all.exr said
# --checkpoint 0: an existing file stays unchanged while the picture is rendered.
pscn render $SCENES/bent.pscn --size 20x10 --tile 1/1 -o other.exr --quiet
cp other.exr never.exr.part.exr
scene="$SCENES/bent.pscn --size 2000x2000 --samples 16" # takes longer than the signal
ended KILL '[ -s said ] && sleep 0.3' never.exr --checkpoint 0
cmp other.exr never.exr.part.exr && echo 'nothing is kept'
rm -f other.exr never.exr* said
# All of this picture is one tile. The rows that are whole are kept, and gone on from; a tile whose rays start from those
# before them is begun anew. If the tile is finished before the signal comes, it gets more samples.
for case in '40 bernstein' '25 aberth { start previous }'; do
  samples=${case%% *} solver=${case#* }
  for attempt in {1..5}; do
    scene="$SCENES/bent.pscn --size 32x32 --samples $samples --threads 1 --quiet"
    rm -f rows.exr.part.exr
    ended TERM '[ -e rows.exr.part.exr ]' rows.exr --solver "$solver" --checkpoint 0.05 && break
    samples=$((samples * 3 / 2))
  done
  grep -ao 'pscn:done.string.....[1-7]' rows.exr.part.exr | tr -d '\0-\37' | sed 's|[1-7]$|some|'; echo
  pscn merge rows.exr.part.exr -o no.exr; echo "exit $?"
  pscn render $scene -o rows.exr --solver "$solver" --resume --stats stats.json
  primary=$(sed -n 's/.*"primary": \([0-9]*\).*/\1/p' stats.json)
  echo "$solver: $([ "$primary" -lt $((32 * 32 * samples * samples)) ] && echo less || echo all)"
  pscn render $scene -o whole.exr --solver "$solver"
  pscn compare rows.exr whole.exr --fail 0 --quiet && echo 'rows.exr is whole.exr'
done
rm rows.exr whole.exr said
# Nothing to continue.
pscn render $SCENES/flat.pscn --size 20x10 -o new.png --resume --quiet
LC_ALL=C ls
