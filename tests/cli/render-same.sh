# Neither threads nor crop nor format change a pixel.
scene=$SCENES/bent.pscn
size="--size 150x100 --quiet --bits 32"
pscn render "$scene" $size -o whole.exr --threads 1
for threads in 2 3 8; do
  pscn render "$scene" $size -o threads.exr --threads $threads
  try pscn compare whole.exr threads.exr --fail 0 --quiet
done
for crop in 0,0,1,1 149,99,1,1 17,31,90,40; do
  pscn render "$scene" $size -o first.exr --crop $crop --threads 1
  pscn render "$scene" $size -o second.exr --crop $crop --threads 2
  try pscn compare first.exr second.exr --fail 0 --quiet
done
try pscn compare whole.exr first.exr
# The same with the paper's own method, which remembers the previous ray.
warm='aberth { basis power resultant sylvester back_substitution euclid polish off split 1 start previous }'
pscn render "$scene" $size -o one.exr --threads 1 --solver "$warm"
pscn render "$scene" $size -o four.exr --threads 4 --solver "$warm"
try pscn compare one.exr four.exr --fail 0 --quiet
