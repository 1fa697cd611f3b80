"""Run a design on Kubernetes: python kubernetes.py mine.toml results/mine, beside its operator."""

import sys

from dask_kubernetes.operator import KubeCluster

from reports.cli.main import main

if __name__ == "__main__":
    design, results = sys.argv[1:]
    cluster = KubeCluster(
        name="lepp-study",
        image="registry.example.org/lepp-study:latest",  # of the Dockerfile beside this file
        n_workers=0,
        resources={"limits": {"cpu": "1", "memory": "4Gi"}},
        worker_command=["dask", "worker", "--nthreads", "1", "--memory-limit", "4GiB"],
    )
    with cluster:
        cluster.adapt(minimum=0, maximum=100)  # pods; none before there is work
        main(["run", results, "--config", design, "--scheduler", cluster.scheduler_address])
