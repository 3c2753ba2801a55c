#!/bin/bash
# POV-Ray's own include files, if installed, each in a scene of one patch. They are read and change nothing, or put
# things into the scene and are refused, as docs/povray.md lists them. What pscn lacks is reported where it is used.
include=/usr/share/povray-3.7/include
[ -d $include ] || { echo "skipped: $include is not there" >&2; exit 77; }
. "$PSCN_SOURCE_DIR/tests/peers/begin.sh"
failed=0
fail() { echo "$*"; failed=1; }

scene() { # LINES...
  printf '%s\n' '#version 3.7; global_settings { assumed_gamma 1 }' '#include "colors.inc"' "$@" \
    'camera { location <0.5, 0.5, -4> look_at 0 }' 'light_source { <2, 5, -5>, rgb 1 }' \
    'bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3' \
    ' <-1,-1,0> <-.3,-1,1> <.3,-1,1> <1,-1,0>  <-1,-.3,1> <-.3,-.3,1> <.3,-.3,1> <1,-.3,1>' \
    ' <-1,.3,1> <-.3,.3,1> <.3,.3,1> <1,.3,1>  <-1,1,0> <-.3,1,1> <.3,1,1> <1,1,0> texture { pigment { Red } } }'
}
scene '' >plain.pscn
"$PSCN" dump plain.pscn >plain

declare -a read=() refused=()
for file in $include/*.inc; do
  name=$(basename "$file" .inc)
  scene "#include \"$name.inc\"" >"$name.pscn"
  if "$PSCN" dump "$name.pscn" >out 2>said; then
    read+=("$name")
    cmp -s out plain || fail "$name.inc changes the scene"
  else
    refused+=("$name")
  fi
  grep -v 'warning: this is read as version\|^ \|^included' said | grep 'warning' && fail "$name.inc: a warning"
done
documented() { # BEGINNING NAMES...
  local beginning=$1
  shift
  tr '\n' ' ' <"$PSCN_SOURCE_DIR/docs/povray.md" | tr -s ' ' | grep -Fq -- "- are $beginning: $(printf '%s, ' "$@" | sed 's/, $//')" ||
    fail "docs/povray.md does not say $beginning: $*"
}
documented read "${read[@]}"
documented 'refused, because they put things into the scene' "${refused[@]}"

# If used, each says what it is made of, and where that is.
used() { # FILE LINE NAME LIBRARY WORD
  scene "#include \"$1.inc\"" "$2" >used.pscn
  "$PSCN" dump used.pscn >out 2>said && fail "$2: exit 0"
  grep -Eq "^used.pscn:4:[0-9]+: error: POV-Ray's $5 \([^ ]*/$4.inc:[0-9]+\) is not supported" said ||
    { fail "$2: not told"; cat said; }
}
used stones '#default { texture { T_Stone10 } }' T_Stone10 stones1 granite
used shapes 'object { Disk_X scale 2 }' Disk_X shapes_old cylinder
used woods '#declare Mine = texture { T_Wood1 } #default { texture { Mine } }' Mine woods wood
used math 'camera { angle sind(30) }' sind math function
exit $failed
