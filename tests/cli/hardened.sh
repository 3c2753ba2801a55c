#!/bin/bash
# hardened.sh BUILD: what the linker says of every program and module of the build tree, and of what is installed from
# it: a run path has no part that is empty or relative, for those mean the folder one happens to stand in; programs are
# position-independent, their tables of addresses are bound and read-only before main, stack frames are guarded.
set -uo pipefail
build=$1
command -v readelf >/dev/null || { echo "skipped: readelf is not installed" >&2; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder" >/dev/null || exit 1

failed=0
say() { echo "$1: $2"; failed=1; }

look_at() {
  local file=$1 dynamic part
  dynamic=$(readelf -dW "$file")
  while IFS= read -r -d: part; do
    case $part in
      /* | '$ORIGIN'/*) ;;
      *) say "$file" "'$part' is a part of its run path" ;;
    esac
  done < <(sed -n 's/.*(R\(UN\)\?PATH).*\[\(.*\)\]$/\2:/p' <<<"$dynamic")
  grep -q 'BIND_NOW\|FLAGS_1.*NOW' <<<"$dynamic" || say "$file" "symbols are bound late"
  grep -q GNU_RELRO < <(readelf -lW "$file") || say "$file" "its tables stay writable"
  grep -q "Type: *DYN" < <(readelf -hW "$file") || say "$file" "it is not position-independent"
}

looked=0
while IFS= read -r -d '' file; do
  if [ "$(head -c 4 "$file" | tail -c 3)" = ELF ]; then
    look_at "$file"
    looked=$((looked + 1))
  fi
done < <(find "$folder" "$build/src" "$build/tests" "$build/examples" \
  \( -name CMakeFiles -prune \) -o -type f \( -perm -u+x -o -name '*.so*' \) -print0 2>/dev/null)
[ "$looked" -ge 4 ] || say "$build" "only $looked programs and modules were found"
for file in "$folder"/bin/pscn $(find "$folder" -name pscn_openimageio.so -o -name "libpscn.so.*.*.*"); do
  grep -q __stack_chk_fail < <(readelf -sW --dyn-syms "$file") || say "$file" "its stack frames are not guarded"
done
exit "$failed"
