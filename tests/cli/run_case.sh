#!/bin/bash
# run_case.sh CASE: runs CASE.sh of this folder in a new empty folder and compares what it says with CASE.out (stdout),
# CASE.err (stderr) and CASE.exit (exit code); a missing file stands for nothing said, or exit code 0. With
# PSCN_UPDATE=1 the files are written instead; look at the difference before committing it. Equal lines one after the
# other, from three on, stand there once, with their number.
#
# In a case `pscn` is the program under test, $SCENES the folder of its scenes, and
#   try COMMAND...   runs a command and says its exit code on stdout, as "exit N"
# A case that the machine cannot run calls `skip WORD...`.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
case=$1
folder=$(mktemp -d)
trap '[ $BASHPID != $$ ] || rm -rf "$folder"' EXIT # not in a child that is killed before it is a program
mkdir "$folder/work"
cp -r "$here/scenes" "$folder/scenes"
ln -s "$PSCN" "$folder/pscn"

# shorten FILE: writes it to stdout, with such lines once.
shorten() {
  awk 'function tell() { if (n > 2) print line "\n(" n " times)"; else while (n-- > 0) print line }
    NR > 1 && $0 == line { n++; next }
    { tell(); line = $0; n = 1 }
    END { tell() }' "$1"
}

cat >"$folder/prelude" <<'EOF'
try() { "$@"; echo "exit $?"; }
skip() { echo "skipped: $*" >&2; exit 77; }
EOF

status=0
(cd "$folder/work" && PATH=$folder:$PATH SCENES=../scenes BASH_ENV=$folder/prelude bash "$here/$case.sh" \
  >"$folder/out" 2>"$folder/err" </dev/null) || status=$?
if [ "$status" -eq 77 ]; then
  cat "$folder/err" >&2
  exit 77
fi
echo "$status" >"$folder/exit"

failed=0
for part in out err exit; do
  expected=$here/$case.$part
  if [ "${PSCN_UPDATE:-}" = 1 ]; then
    rm -f "$expected"
    if [ "$part" = exit ] && [ "$status" -eq 0 ] || [ ! -s "$folder/$part" ]; then
      continue
    fi
    shorten "$folder/$part" >"$expected"
  elif [ -e "$expected" ]; then
    diff -u --label "$case.$part" --label "what pscn said" <(shorten "$expected") <(shorten "$folder/$part") || failed=1
  elif [ "$part" = exit ]; then
    [ "$status" -eq 0 ] || { echo "exit code $status instead of 0"; failed=1; }
  elif [ -s "$folder/$part" ]; then
    echo "unexpected text on std$part:"
    cat "$folder/$part"
    failed=1
  fi
done
exit "$failed"
