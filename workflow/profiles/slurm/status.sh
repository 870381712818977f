#!/usr/bin/env bash
# What Snakemake asks of a job: running, success or failed. Slurm forgets a job some minutes after its end (MinJobAge); by then
# Snakemake has asked. What it does not know has failed.
state=$(scontrol show job "$1" 2> /dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p' | head -1)
case $state in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED) echo running ;;
  *) echo failed ;;
esac
