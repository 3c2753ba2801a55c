#!/bin/bash
# A picture in pieces by Slurm: an array job with one task for each piece, and the merging once all are there.
#
#   examples/farm_slurm.sh PIECES FILE SCENE [OPTION...]      options of pscn render
#
# Waits for the picture. SBATCH_OPTIONS is passed to sbatch ("--time=1:00:00 --cpus-per-task=8"); PSCN is the program.
# The nodes must share the folder. A task that is requeued, or ended at its time limit, is continued: SIGTERM comes
# before SIGKILL, and finished tiles are saved every half minute. Pieces that failed are submitted again, at most twice.
set -euo pipefail
pieces=${1:?how many pieces?} file=${2:?which picture?}
shift 2
pscn=${PSCN:-pscn}
command -v sbatch >/dev/null || { echo "Slurm is not installed" >&2; exit 4; }

folder=$(realpath -m "$file").pieces
mkdir -p "$folder"
cat >"$folder/task.sh" <<END
#!/bin/bash
exec $(printf '%q ' "$pscn" render "$@") --tile "\$SLURM_ARRAY_TASK_ID/$pieces" -o $(printf %q "$folder")/"\$SLURM_ARRAY_TASK_ID.exr" \\
  --threads "\${SLURM_CPUS_PER_TASK:-1}" --quiet --resume
END

# Makes the picture, or prints the numbers of the pieces to render.
merged() {
  missing=1-$pieces
  compgen -G "$folder/*.exr" >/dev/null || return 1
  local told
  told=$("$pscn" merge "$folder"/*.exr -o "$file" 2>"$folder/merge.log") && return
  missing=${told:-$missing}
  return 1
}

for try in 1 2 3; do
  merged && break
  echo "to render: $missing" >&2
  # shellcheck disable=SC2086 # options are words
  sbatch --quiet --wait --requeue --array="$missing" --output="$folder/%a.log" ${SBATCH_OPTIONS:-} "$folder/task.sh" || true
done
if ! merged; then
  cat "$folder"/*.log >&2
  exit 1
fi
rm -r "$folder"
