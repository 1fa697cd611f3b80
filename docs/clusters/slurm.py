"""Run a design on a SLURM cluster: python slurm.py mine.toml results/mine, on a login node."""

import sys

from dask_jobqueue import SLURMCluster

from reports.cli.main import main

if __name__ == "__main__":
    design, results = sys.argv[1:]
    cluster = SLURMCluster(
        cores=8,  # of a job, with so many processes of one thread each
        processes=8,
        memory="32GB",
        walltime="04:00:00",
        # Ends the workers a while before the job is: what they have in hand goes to others.
        worker_extra_args=["--lifetime", "3h50m", "--lifetime-stagger", "5m"],
        scheduler_options={"dashboard_address": "127.0.0.1:0"},
    )
    with cluster:
        cluster.adapt(minimum=0, maximum=200)  # workers; none before there is work
        main(["run", results, "--config", design, "--scheduler", cluster.scheduler_address])
