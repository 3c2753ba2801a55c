#!/bin/bash
# farms.sh parallel|slurm: the farms of examples/ make the picture of a single run, to the bit. Slurm is a cluster of
# one node, started in a folder and with a key of its own, and ended afterwards.
set -euo pipefail
farm=$1
folder=$(mktemp -d)
daemons=()
finish() {
  for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
  for daemon in "${daemons[@]}"; do wait "$daemon" 2>/dev/null || true; done
  rm -rf "$folder"
}
trap finish EXIT
export LC_ALL=C PATH=$PATH:/usr/sbin
skip() { echo "skipped: $*" >&2; exit 77; }

start_slurm() {
  local program host port=$((20000 + RANDOM % 20000))
  for program in munged munge slurmctld slurmd sbatch sinfo; do
    command -v $program >/dev/null || skip "$program is not installed"
  done
  [ "$(id -u)" -eq 0 ] || skip "Slurm's daemons want to be root"
  host=$(hostname -s)
  chmod 755 "$folder"
  mkdir "$folder/munge" "$folder/state" "$folder/spool"
  dd if=/dev/urandom of="$folder/munge/key" bs=128 count=1 status=none
  chmod 600 "$folder/munge/key"
  munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" --num-threads=2 \
    --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" --log-file="$folder/munge/log" >/dev/null 2>&1 &
  daemons+=($!)
  cat >"$folder/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
SlurmctldPidFile=$folder/ctld.pid
SlurmdPidFile=$folder/d.pid
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldLogFile=$folder/ctld.log
SlurmdLogFile=$folder/d.log
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$folder/slurm.conf
  slurmctld -D >/dev/null 2>&1 &
  daemons+=($!)
  slurmd -D >/dev/null 2>&1 &
  daemons+=($!)
  for _ in {1..100}; do
    sinfo --noheader --format=%t 2>/dev/null | grep -q idle && return
    sleep 0.3
  done
  tail -5 "$folder"/*.log >&2 || true
  skip "no cluster starts here"
}

cd "$folder"
scene=$PSCN_SOURCE_DIR/scenes/teapot.pscn
export PSCN
case $farm in
parallel) command -v parallel >/dev/null || skip "GNU parallel is not installed" ;;
slurm) start_slurm ;;
esac
mkdir 'a folder'
"$PSCN" render "$scene" --size 160x120 --quiet --bits 32 -o one.exr
"$PSCN" render "$scene" --size 160x120 --quiet -o one.png
"$PSCN_SOURCE_DIR/examples/farm_$farm.sh" 5 'a folder/farm.png' "$scene" --size 160x120
"$PSCN" compare one.png 'a folder/farm.png' --fail 0 --quiet
# A second run only does the missing pieces.
mkdir 'a folder/again.exr.pieces'
for k in 1 3; do
  "$PSCN" render "$scene" --size 160x120 --tile $k/3 -o "a folder/again.exr.pieces/$k.exr" --quiet
done
"$PSCN_SOURCE_DIR/examples/farm_$farm.sh" 3 'a folder/again.exr' "$scene" --size 160x120 2>said
[ "$farm" = parallel ] || grep -qx 'to render: 2' said
"$PSCN" render "$scene" --size 160x120 --quiet -o half.exr
"$PSCN" compare half.exr 'a folder/again.exr' --fail 0 --quiet
[ "$(ls 'a folder')" = "$(printf 'again.exr\nfarm.png')" ] || { ls -R 'a folder'; exit 1; }
# A scene that cannot be rendered gives no picture.
if "$PSCN_SOURCE_DIR/examples/farm_$farm.sh" 2 no.png "$folder/none.pscn" >/dev/null 2>&1; then exit 1; fi
[ ! -e no.png ]
echo "$farm: the picture of a single run"
