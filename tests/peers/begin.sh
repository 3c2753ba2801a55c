# The beginning of the scripts here: . begin.sh PROGRAM...
# Skips the test if one of the PROGRAMs is not installed. Makes a folder for it, which is also POV-Ray's home.
set -euo pipefail
for program; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed" >&2; exit 77; }
done
: "${PSCN:=$PSCN_SOURCE_DIR/build/src/command/pscn}" # of a release, unless ctest says which
folder=$(mktemp -d)
trap '[ $BASHPID != $$ ] || rm -rf "$folder"' EXIT # not in a child that is killed before it is a program
export LC_ALL=C HOME=$folder
cd "$folder"

# beside COMMAND...: runs a function in a folder and home of its own, $folder/0 ..., at the same time as others: POV-Ray
# sleeps half a second in each run.
children=()
beside() {
  local own=$folder/${#children[@]}
  mkdir "$own"
  (cd "$own"; HOME=$own "$@") >"$own/said" 2>&1 &
  children+=($!)
}
# Waits for all of them and prints what they say, in order. Fails if one has failed.
all_right() {
  local k right=0
  for k in "${!children[@]}"; do
    wait "${children[k]}" || right=1
    cat "$folder/$k/said"
  done
  return $right
}
