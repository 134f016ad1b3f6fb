#!/bin/sh
#SBATCH --job-name=rtc-parts
#SBATCH --array=1-@TASKS@
#SBATCH --cpus-per-task=@THREADS@
#SBATCH --mem=@MEMORY@G
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x-%a.log
# @TITLE@
task=$((SLURM_ARRAY_TASK_ID - 1))
part=$((task % @PARTS@ + 1))
frame=$(printf %04d $((task / @PARTS@ + @FIRST@)))
"${RTC:-rtc}" @PART@
status=$?
# What failed is queued again; a node that died queues its tasks again by itself.
if [ $status != 0 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt @RETRIES@ ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
exit $status
