#!/bin/bash
# Control flow, macros, functions and arrays mean what they mean to POV-Ray: meaning.pov prints the same in both.
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh" povray
scene=$PSCN_SOURCE_DIR/tests/peers/meaning.pov
"$PSCN" dump "$scene" 2>ours >dumped
povray +I"$scene" +W800 +H600 +ER2 +EC2 -D +Fn +Opicture.png -GA +GDtheirs </dev/null >said 2>&1 || { cat said; exit 1; }
diff theirs ours
[ "$(wc -l <ours)" -ge 195 ]
