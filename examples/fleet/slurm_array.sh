#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
# One line of jobs.txt for each task: sbatch --array=1-$(wc -l < jobs.txt) slurm_array.sh jobs.txt
#SBATCH --job-name=dermis
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --output=%A_%a.txt
set -euo pipefail
sed -n "${SLURM_ARRAY_TASK_ID}p" "$1" | xargs dermis
