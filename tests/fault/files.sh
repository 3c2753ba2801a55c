#!/bin/bash
# What happens to files if the disk is full or read-only, the name is strange, two programs write at once, memory is
# short, or the process is killed at any moment: the file is whole or unchanged, no other one is left, the exit code is
# right. PSCN_SEED=N chooses other moments; PSCN_EFFORT=full makes it six times as many.
set -uo pipefail
self=$(realpath "$0")
said=$(mktemp)
scene=$PSCN_SOURCE_DIR/scenes/dome.pscn
small="--size 40x30 --quiet"
chart="--size 1x1 --rays 1 --rounds 1 --quick --solver bernstein --no-peers --quiet"
check="--size 40x30 --steps 0 --grid 0 --failpercent 100 --failpsnr 0 --failmask 100 --quiet"
failed=0
RANDOM=${PSCN_SEED:-1}
moments=4
[ "${PSCN_EFFORT:-}" != full ] || moments=24

wrong() { echo "wrong: $*"; failed=1; }
# expect CODE COMMAND...: asserts the command's exit code; a failure prints why
expect() {
  local wanted=$1 code=0
  shift
  "$@" 2>"$said" || code=$?
  [ "$code" = "$wanted" ] || { wrong "exit $code instead of $wanted: $*"; cat "$said"; }
  [ "$code" = 0 ] || [ -s "$said" ] || wrong "exit $code and nothing said: $*"
}
# only NAME...: asserts that nothing else is in the folder
only() { [ "$(ls -A)" = "$(printf '%s\n' "$@" | LC_ALL=C sort)" ] || wrong "here are: $(ls -A | tr '\n' ' ')"; }
export LC_ALL=C

# pretend FOLDER: makes a program that answers check as POV-Ray does, with a picture of ours
pretend() {
  "$PSCN" render "$scene" $small -o "$1/answer.png"
  printf '#!/bin/sh\necho POV-Ray 3.7.0\ncat %s >picture.png\n>answers.txt\n' "$1/answer.png" >"$1/povray"
  chmod +x "$1/povray"
  check="$check --povray $1/povray"
}

# On a small file system of its own, first full, then read-only.
if [ "${1:-}" = inside ]; then
  cd "$2" && mount -t tmpfs -o size=200k pscn . && cd . && cd "$2" || exit 77
  check="$check --povray $3/povray"
  echo old >old.exr
  echo '1 0 -1' >polynomials
  expect 0 "$PSCN" render "$scene" $small -o a.png
  expect 4 "$PSCN" render "$scene" --size 300x300 --quiet --bits 32 --channels rgb,depth,normal,u,v -o old.exr
  expect 4 "$PSCN" render "$scene" --size 300x300 --quiet --bits 32 --channels rgb,depth,normal,u,v -o new.exr
  only a.png old.exr polynomials
  mkdir old && echo old | tee old/chart.html old/check.html >/dev/null
  # What cannot be replaced is reported before the scene is read: a mount point that is a file, another user's file in a
  # sticky folder.
  touch mounted.png other.png && mount --bind other.png mounted.png
  expect 4 "$PSCN" render missing.pscn -o mounted.png
  grep -q "cannot write 'mounted.png'" "$said" || wrong "told too late: $(cat "$said")"
  umount mounted.png && rm mounted.png other.png
  mkdir -m 1777 sticky && touch sticky/other.png && chmod 666 sticky/other.png
  if setpriv --reuid 65534 --clear-groups "$PSCN" dump "$scene" >/dev/null 2>&1; then
    expect 4 setpriv --reuid 65534 --clear-groups "$PSCN" render missing.pscn -o sticky/other.png
    grep -q "cannot write 'sticky/other.png'" "$said" || wrong "told too late: $(cat "$said")"
    setpriv --reuid 65534 --clear-groups touch sticky/own.png
    expect 4 setpriv --reuid 65534 --clear-groups "$PSCN" render missing.pscn -o sticky/own.png
    grep -q "missing.pscn: there is no such file" "$said" || wrong "an own file may be replaced: $(cat "$said")"
  fi
  rm -r sticky
  head -c 1M /dev/zero >full 2>/dev/null
  expect 4 "$PSCN" render "$scene" $small -o b.png
  expect 4 "$PSCN" compare a.png a.png --quiet -o b.png
  expect 4 "$PSCN" trace "$scene" --stats s.json </dev/null
  expect 4 "$PSCN" roots --stats s.json <polynomials >/dev/null
  expect 4 "$PSCN" roots --stats old.exr <polynomials >/dev/null
  for folder in new old; do
    expect 4 "$PSCN" chart "$scene" $chart -o $folder
    expect 4 "$PSCN" check "$scene" $check -o $folder
  done
  [ "$(cat old/*)" = "$(printf 'old\nold')" ] || wrong "old pages have changed: $(ls old)"
  [ "$(cat old.exr)" = old ] || wrong "the old file has changed"
  only a.png full old old.exr polynomials
  mount -o remount,ro "$2"
  for out in new.png old.exr a.png; do
    expect 4 "$PSCN" render "$scene" $small -o $out
  done
  rm -f "$said"
  exit "$failed"
fi

# Everything else in a folder that is removed from outside: a child killed before it has become a program runs the traps
# of the shell that it was.
if [ "${1:-}" != within ]; then
  folder=$(mktemp -d)
  "$self" within "$folder"
  code=$?
  rm -rf "$folder" "$said"
  exit "$code"
fi
folder=$2
cd "$folder"
chmod 755 . # another user is to come through
mkdir disk
if unshare -m true 2>/dev/null; then
  mkdir tool && pretend "$folder/tool"
  unshare -m "$self" inside "$folder/disk" "$folder/tool" || { [ $? = 77 ] && echo "no file system can be mounted: a full disk is left out" || wrong "on a disk of its own"; }
else
  echo "no file system can be mounted: a full disk is left out"
fi

mkdir work && cd work
# A folder; a pipe; a symbolic link, followed and kept; permissions, of the old file and of the mask.
mkdir folder.png
expect 4 "$PSCN" render "$scene" $small -o folder.png
rmdir folder.png
mkfifo pipe.png
cat pipe.png >copy.png &
expect 0 "$PSCN" render "$scene" $small -o pipe.png
wait
[ -p pipe.png ] || wrong "the pipe is gone"
rm pipe.png
# A device that is always full: by its own name, and through another name.
expect 4 "$PSCN" roots --stats /dev/full <<<'1 0 -1' >/dev/null
ln -s /dev/full full.png
expect 4 "$PSCN" render "$scene" $small -o full.png
[ -L full.png ] && rm full.png full.png.part.exr || wrong "the link is gone, or what was rendered"
expect 4 "$PSCN" dump "$scene" >/dev/full
expect 4 "$PSCN" trace "$scene" <<<'0 0 -9 0 0 1' >/dev/full
(umask 027 && expect 0 "$PSCN" render "$scene" $small -o a.png && exit "$failed") || wrong "with a mask"
[ "$(stat -c %a a.png)" = 640 ] || wrong "the mask was not heeded"
expect 0 "$PSCN" compare a.png copy.png --quiet
chmod 604 a.png
ln -s a.png link.png
expect 0 "$PSCN" render "$scene" $small -o link.png
[ -L link.png ] || wrong "the link is gone"
[ "$(stat -c %a a.png)" = 604 ] || wrong "the permissions have changed"
only a.png copy.png link.png
rm link.png

# Many programs write to one name.
for k in 1 2 3 4; do "$PSCN" render "$scene" $small -o copy.png & done
wait
expect 0 "$PSCN" compare a.png copy.png --quiet
only a.png copy.png

# Without the module for EXR, which is loaded while rendering begins: reported, and the rendering ends. PNG needs none.
mkdir alone
cp "$PSCN" alone/pscn
expect 0 alone/pscn render "$scene" $small -o copy.png
expect 4 timeout 60 alone/pscn render "$scene" --samples 64 --quiet -o b.exr
grep -q "cannot write pictures" "$said" || wrong "the missing module was not told"
rm -r alone
only a.png copy.png

# Little address space, too little for OpenImageIO (a sanitizer needs more for itself).
if (ulimit -v 1000000 && "$PSCN" --version >"$said" 2>&1); then
  for kilobytes in 50000 200000 300000 395000 410000 425000 440000; do
    (ulimit -v $kilobytes && expect 5 "$PSCN" render "$scene" $small -o a.exr && exit "$failed") || wrong "in $kilobytes KB"
  done
  # The file of an earlier run stays whole if only the room for its pixels is missing.
  large="--size 6000x4000 --tile 1/23000"
  expect 0 "$PSCN" render "$scene" $large -o large.exr.part.exr
  kilobytes=440000
  until (ulimit -v $kilobytes && "$PSCN" render "$scene" $small -o b.exr) >"$said" 2>&1; do kilobytes=$((kilobytes + 20000)); done
  (ulimit -v $((kilobytes + 300000)) && "$PSCN" render "$scene" $large -o large.exr) >"$said" 2>&1
  grep -q -e '--resume continues' "$said" || wrong "a part that there is no room for is called useless"
  rm -f b.exr large.exr*
  # Little memory for data, few threads, little stack: too little for OpenImageIO, or for a hard ray (a sanitizer needs
  # more, as above).
  for kilobytes in 40000 70000 85000 100000; do
    (ulimit -d $kilobytes && expect 5 "$PSCN" render "$scene" $small -o a.exr && exit "$failed") || wrong "with $kilobytes KB of data"
  done
  chmod 644 copy.png
  user=$((10000 + $$ % 50000)) # one that runs nothing else: threads are counted by user
  if setpriv --reuid $user --clear-groups "$PSCN" compare copy.png copy.png --quiet >"$said" 2>&1; then
    for threads in 1 4; do
      (ulimit -u $threads && expect 5 setpriv --reuid $user --clear-groups "$PSCN" compare copy.png copy.png && exit "$failed") ||
        wrong "with $threads threads"
    done
  fi
  for kilobytes in 64 200 1000; do
    (ulimit -s $kilobytes && expect 0 "$PSCN" trace "$scene" <<<'0 0 -9 0 0 1' >/dev/null && exit "$failed") || wrong "with $kilobytes KB of stack"
  done
  # Little stack, and no room for a larger one.
  (ulimit -s 512 && ulimit -v 8000 && expect 5 "$PSCN" dump "$scene" && exit "$failed") || wrong "without room for a stack"
fi

# A file that calls itself regular, and whose data never come.
if [ -r /proc/kmsg ]; then
  expect 4 timeout 10 "$PSCN" dump /proc/kmsg
fi

# Ended by a signal at any moment.
"$PSCN" render "$scene" $small -o new.png
for signal in KILL INT TERM HUP; do
  for k in $(seq $moments); do
    [ $((k % 2)) = 0 ] && rm -f new.png
    "$PSCN" render "$scene" $small -o new.png --stats new.json &
    sleep "0.$(printf %03d $((RANDOM % 200)))"
    kill -$signal $! 2>/dev/null
    wait $! 2>/dev/null
    code=$?
    case $code in 0 | 137 | 130 | 143 | 129) ;; *) wrong "exit $code after SIG$signal" ;; esac
    [ $code != 0 ] || [ -e new.json ] || wrong "done without the statistics"
    if [ -e new.png ]; then expect 0 "$PSCN" compare a.png new.png --quiet; fi
    if [ -e new.json ]; then [ "$(tail -n 1 new.json)" = "}" ] || wrong "half a file of statistics"; fi
    rm -f new.json
    if [ -e new.png.part.exr ]; then # what is done is kept, and it goes on from there
      case $code in 130 | 143 | 129) ;; *) wrong "something is kept at exit $code" ;; esac
      expect 0 "$PSCN" render "$scene" $small -o new.png --resume
      expect 0 "$PSCN" compare a.png new.png --quiet
    fi
    only a.png copy.png $([ -e new.png ] && echo new.png)
  done
done

# Folders of results: the page is unchanged or whole, and the program that was started has ended, too.
export TMPDIR=$folder/tmp
mkdir "$TMPDIR"
for signal in KILL TERM; do
  for k in $(seq $((moments / 2))); do
    for command in chart check; do
      mkdir -p results && echo old >results/$command.html
      "$PSCN" $command "$scene" ${!command} -o results &
      if [ $((k % 2)) = 0 ]; then # when its scratch folder has just been made
        while [ -z "$(ls -A "$TMPDIR")" ] && kill -0 $! 2>/dev/null; do :; done
      else
        sleep "0.$(printf %03d $((RANDOM % 300)))"
      fi
      kill -$signal $! 2>/dev/null
      wait $! 2>/dev/null
      code=$?
      case $code in 0 | 137 | 143) ;; *) wrong "$command: exit $code after SIG$signal" ;; esac
      case $(tail -n 1 results/$command.html) in
        old) [ $code != 0 ] || wrong "$command: done without its page" ;;
        '</html>') ;;
        *) wrong "$command: half a page" ;;
      esac
      [ $signal = KILL ] || [ -z "$(ls -A "$TMPDIR")" ] || wrong "$command: left here: $(ls "$TMPDIR")"
      rm -rf results "$TMPDIR"/*
    done
  done
done
rm -f "$said"
exit "$failed"
