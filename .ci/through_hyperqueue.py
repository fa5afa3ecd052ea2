"""Runs a sweep through HyperQueue's own engine, as `phase submit --to hyperqueue` describes it.

Usage: through_hyperqueue.py PHASE SWEEP.toml FOLDER [--kill]

PyPI's wheel of HyperQueue holds server, worker and client without the program `hq`. So the tasks of
the job file are submitted one by one through Python, and what `next.sh` does is done here. With
--kill the processes of the first round are killed while they run: HyperQueue starts them again.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
import tomllib
from pathlib import Path

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest


def submit(client, file):
    description = tomllib.loads(file.read_text())
    # Its last task submits what is missing then.
    *tasks, last = description["task"]
    assert last["deps"] == list(range(len(tasks))), last
    assert last["command"] == ["bash", str(file.with_name("next.sh"))], last
    job = Job(max_fails=None, name=description["name"])
    for task in tasks:
        (request,) = task["request"]
        job.program(
            task["command"],
            resources=ResourceRequest(cpus=request["resources"]["cpus"]),
            crash_limit=task["crash_limit"],
            stdout=None,
            stderr=None,
        )
    return client.submit(job)


def kill_some(folder, number):
    """Kills processes at work in the folder, which their leases name."""
    killed = set()
    while len(killed) < number:
        for lease in folder.glob("records/*.lease"):
            try:
                process = json.loads(lease.read_text())["process"]
            except (OSError, ValueError):
                continue
            if process not in killed and len(killed) < number:
                time.sleep(0.3)
                try:
                    os.kill(process, signal.SIGKILL)
                    killed.add(process)
                except ProcessLookupError:
                    pass
        time.sleep(0.02)
    print(f"killed {len(killed)} processes", flush=True)


def main():
    phase, sweep, folder = sys.argv[1:4]
    killer = threading.Thread(target=kill_some, args=(Path(folder), 3), daemon=True)
    with LocalCluster() as cluster:
        cluster.start_worker(WorkerConfig(cores=2))
        client = cluster.client()
        for round in range(50):
            command = [phase, "submit", sweep, "--out", folder, "--to", "hyperqueue"]
            options = ["--time", "20s", "--tasks", "6", "--dry-run"]
            answer = subprocess.run(command + options, check=True, capture_output=True, text=True)
            print(answer.stdout, end="", flush=True)
            if "no run is missing" in answer.stdout:
                break
            if round == 0 and "--kill" in sys.argv:
                killer.start()
            job = submit(client, Path(folder).resolve() / "cluster" / "job.toml")
            client.wait_for_jobs([job], raise_on_error=False)
    subprocess.run([phase, "sweep", sweep, "--out", folder, "--quiet"], check=True)


main()
