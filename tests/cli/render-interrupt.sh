# SIGINT gives 130, SIGTERM 143; neither leaves a file.
scene=$SCENES/bent.pscn
echo old >a.png
for signal in INT TERM; do
  pscn render "$scene" -o a.png --size 2000x2000 --samples 16 --quiet &
  sleep 1
  kill -$signal $!
  wait $!
  echo "exit $?"
done
cat a.png
ls -A
