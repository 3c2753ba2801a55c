# '-' is standard input for a scene and standard output for a picture.
small="--size 8x6 --quiet"
cp "$SCENES/flat.pscn" .
pscn render flat.pscn -o a.png $small
pscn render - $small <flat.pscn >b.png && pscn compare a.png b.png --quiet && echo same
pscn render - -o c.png $small <flat.pscn && pscn compare a.png c.png --quiet && echo same
pscn render flat.pscn -o - $small --channels rgb,depth | head -c 4 | od -A n -t x1
pscn dump - <flat.pscn | cmp - <(pscn dump flat.pscn) && echo same
echo 'camera { loaction 1 }' | try pscn dump -
echo '#include "flat.pscn"' | pscn dump - | cmp - <(pscn dump flat.pscn) && echo same
try pscn trace - </dev/null
try pscn dump - <.
try pscn dump - <&-
# A closed stream is an error when it is used, and no other file takes its place.
(pscn compare a.png a.png >&-; echo "exit $?" >&2)
pscn render "$SCENES/bent.pscn" -o f.png $small
(pscn compare a.png f.png >&-; echo "exit $?" >&2)
(pscn render flat.pscn -o - $small >&-; echo "exit $?" >&2)
(pscn render flat.pscn -o d.png $small --stats - >&-; echo "exit $?" >&2)
(pscn render flat.pscn -o e.png --size 8x6 2>&-; echo "exit $?")
pscn compare a.png e.png --quiet && echo same
LC_ALL=C ls -A
