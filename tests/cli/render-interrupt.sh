# SIGINT gives 130, SIGTERM 143, SIGXCPU 152. None touches the picture. The finished tiles are kept beside it, or not at
# all.
scene=$SCENES/bent.pscn
# Waits until the process $1 has loaded what writes the part.
loaded() {
  for wait in {1..400}; do grep -q pscn_openimageio "/proc/$1/maps" && break || sleep 0.05; done
  sleep 0.5
}
echo old >a.png
for signal in INT TERM XCPU; do
  pscn render "$scene" -o a.png --size 2000x2000 --samples 16 --threads 1 --quiet &
  loaded $!
  kill -$signal $!
  wait $!
  echo "exit $?"
done
cat a.png
ls -A
rm a.png.part.exr
# However long a tile or a ray may take, the first signal is obeyed: these would take minutes.
ended() { # SCENE: TERM after a second, and KILL after another minute
  timeout -k 60 1 pscn render "$1" --size 32x32 --samples 256 -o slow.png --threads 1 --quiet
  echo "exit $?"
}
ended "$scene"
rm -f slow.png.part.exr # if a row was done by then
{
  sed -n '/^camera/p;/^light/p;/^bicubic/,/^}/p' "$scene" | sed '/^}/q' | sed 's/^bicubic/#declare A0 = bicubic/'
  for n in 1 2 3 4; do echo "#declare A$n = union { $(for k in {1..10}; do echo "object { A$((n - 1)) }"; done) }"; done
  echo 'object { A4 } global_settings { solver aberth { form paper } }'
} >copies.pscn
ended copies.pscn
rm -f copies.pscn slow.png.part.exr
(ulimit -St 1; pscn render "$scene" --size 32x32 --samples 256 -o slow.png --threads 1 --quiet; echo "exit $?")
rm -f slow.png.part.exr
pscn render "$scene" -o - --size 2000x2000 --samples 16 --threads 1 --quiet >/dev/null &
sleep 1
kill -INT $!
wait $!
echo "exit $?"
ls -A
# The same while the file is written, here into a pipe that nobody reads. With a small stack another thread waits there.
mkfifo p.png
(ulimit -s 2048 && exec pscn render "$scene" -o p.png --size 90x60) &
sleep 1
kill -TERM $!
wait $!
echo "exit $?"
pscn render "$scene" -o p.png --size 90x60 --resume --quiet --stats stats.json &
cat p.png >resumed.png
wait $!
echo "exit $?"
grep '"primary"' stats.json
pscn render "$scene" -o whole.png --size 90x60 --quiet
pscn compare resumed.png whole.png --fail 0 --quiet; echo "exit $?"
ls -A
rm resumed.png stats.json
# The same for the statistics, which are written before the picture: into a full pipe, and one without a reader.
mkfifo full
for way in full left; do
  exec 3<>full
  [ $way = left ] || dd if=/dev/zero of=full bs=4096 count=16 oflag=nonblock status=none
  exec 4>full
  [ $way = full ] || exec 3>&-
  pscn render "$scene" -o $way.png --size 90x60 --stats - 3>&- >&4 &
  sleep 1
  [ $way = left ] || kill -TERM $!
  wait $!
  echo "exit $?"
  exec 3>&- 4>&-
  pscn render "$scene" -o $way.png --size 90x60 --resume --quiet --stats stats.json
  grep '"primary"' stats.json
  pscn compare $way.png whole.png --fail 0 --quiet; echo "exit $?"
done
ls -A
rm full* left* stats.json
# Nothing is kept where the program would wait, or where it would be lost.
mkfifo a.png.part.exr
pscn render "$scene" -o a.png --size 2000x2000 --samples 16 --threads 1 --checkpoint 0.1 &
sleep 1
kill -INT $!
wait $!
echo "exit $?"
rm p.png a.png.part.exr whole.png
# Signals ignored at the start stay ignored: SIGHUP under nohup, SIGPIPE under programs that check write instead.
(trap '' HUP PIPE
pscn render "$scene" -o kept.png --size 60x40 --samples 24 --quiet &
sleep 0.2
kill -HUP $! 2>/dev/null
wait $!
echo "exit $?"
(sleep 0.2; pscn dump "$scene" 2>err; echo "exit $?" >code) | true
cat code err)
rm -f kept.png code err
# A program that waits for input ends at once.
mkfifo pipe
for command in "trace $scene" roots; do
  pscn $command --stats stats.json <pipe &
  exec 3>pipe
  sleep 0.2
  kill -INT $!
  wait $!
  echo "exit $?"
  exec 3>&-
done
rm pipe
ls -A
