# How the scripts beside this begin, which are given the PROGRAMs that they need: . begin.sh PROGRAM...
# They are skipped where one is not installed, and work in a folder of their own, where POV-Ray finds its home.
set -euo pipefail
for program; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed" >&2; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export LC_ALL=C HOME=$folder
cd "$folder"
