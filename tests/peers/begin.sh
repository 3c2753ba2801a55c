# The beginning of the scripts here: . begin.sh PROGRAM...
# Skips the test if one of the PROGRAMs is not installed. Makes a folder for it, which is also POV-Ray's home.
set -euo pipefail
for program; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed" >&2; exit 77; }
done
folder=$(mktemp -d)
trap '[ $BASHPID != $$ ] || rm -rf "$folder"' EXIT # not in a child that is killed before it is a program
export LC_ALL=C HOME=$folder
cd "$folder"
