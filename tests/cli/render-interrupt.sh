# SIGINT gives 130, SIGTERM 143, SIGXCPU 152; none touches the picture, and what is done is kept beside it, or nowhere.
scene=$SCENES/bent.pscn
echo old >a.png
for signal in INT TERM XCPU; do
  pscn render "$scene" -o a.png --size 2000x2000 --samples 16 --quiet &
  sleep 1
  kill -$signal $!
  wait $!
  echo "exit $?"
done
cat a.png
ls -A
rm a.png.part.exr
pscn render "$scene" -o - --size 2000x2000 --samples 16 --quiet >/dev/null &
sleep 1
kill -INT $!
wait $!
echo "exit $?"
ls -A
# While the file is written, too: here into a pipe that nobody reads. With a small stack it is another thread that waits
# there.
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
# Likewise the statistics, which come before the picture: into a pipe that is full, and where no one reads any more.
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
# What is done is not kept where it would be waited for, or be gone.
mkfifo a.png.part.exr
pscn render "$scene" -o a.png --size 2000x2000 --samples 16 --checkpoint 0.1 &
sleep 1
kill -INT $!
wait $!
echo "exit $?"
rm p.png a.png.part.exr whole.png
# What was ignored when it was started stays so: SIGHUP under nohup, SIGPIPE under programs that ask write instead.
(trap '' HUP PIPE
pscn render "$scene" -o kept.png --size 60x40 --samples 24 --quiet &
sleep 0.2
kill -HUP $! 2>/dev/null
wait $!
echo "exit $?"
(sleep 0.2; pscn dump "$scene" 2>err; echo "exit $?" >code) | true
cat code err)
rm -f kept.png code err
# Whoever waits for input ends at once.
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
