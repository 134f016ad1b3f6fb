#!/bin/sh
#SBATCH --job-name=rtc-merge
#SBATCH --array=@FIRST@-@LAST@
#SBATCH --mem=@MEMORY@G
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x-%a.log
# @TITLE@
frame=$(printf %04d "$SLURM_ARRAY_TASK_ID")
"${RTC:-rtc}" @MERGE@
