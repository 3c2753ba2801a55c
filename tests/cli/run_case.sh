#!/bin/bash
# run_case.sh CASE: runs CASE.sh of this folder in a new empty folder and compares what it says with CASE.out (stdout) and
# CASE.err (stderr); a missing file stands for nothing said. With PSCN_UPDATE=1 the files are written instead; look at the
# difference before committing it. Equal lines one after the other, from three on, stand there once, with their number;
# "Try 'pscn help COMMAND'." stands as " [help]" behind the error of that command.
#
# In a case `pscn` is the program under test, $SCENES the folder of its scenes, and
#   try COMMAND...   runs a command and says its exit code on stdout, as "exit N"
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case=$1
folder=$(mktemp -d)
trap '[ $BASHPID != $$ ] || rm -rf "$folder"' EXIT # not in a child that is killed before it is a program
mkdir "$folder/work"
cp -r "$here/scenes" "$folder/scenes"
ln -s "$PSCN" "$folder/pscn"

# shorten FILE: writes it to stdout, with such lines shorter.
shorten() {
  LC_ALL=C sed -zE "s/(^|\n)pscn(| [a-z]+): error: ([^\n]*)\nTry 'pscn help\2'\./\1pscn\2: error: \3 [help]/g" "$1" |
    awk 'function tell() { if (n > 2) print line "\n(" n " times)"; else while (n-- > 0) print line }
      NR > 1 && $0 == line { n++; next }
      { tell(); line = $0; n = 1 }
      END { tell() }'
}

cat >"$folder/prelude" <<'EOF'
try() { "$@"; echo "exit $?"; }
EOF

failed=0
(cd "$folder/work" && PATH=$folder:$PATH SCENES=../scenes BASH_ENV=$folder/prelude bash "$here/$case.sh" \
  >"$folder/out" 2>"$folder/err" </dev/null) || failed=$?
[ "$failed" = 0 ] || echo "exit code $failed"
for part in out err; do
  expected=$here/$case.$part
  if [ "${PSCN_UPDATE:-}" = 1 ]; then
    rm -f "$expected"
    [ ! -s "$folder/$part" ] || shorten "$folder/$part" >"$expected"
  else
    [ -e "$expected" ] || expected=/dev/null
    diff -u --label "$case.$part" --label "what pscn said" "$expected" <(shorten "$folder/$part") || failed=1
  fi
done
exit "$failed"
