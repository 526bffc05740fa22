"""Runs sweep-hq.sh as tasks of HyperQueue's own local cluster: tasks.py FOLDER SHARDS STOP_AFTER

Stops the cluster after STOP_AFTER seconds unless that is 0. Exit code 0 if all tasks succeeded, 3 if not.
"""

import os
import sys
import tempfile
import threading
import time
from pathlib import Path

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig

folder, shards, stop_after = Path(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])

with tempfile.TemporaryDirectory() as server:
    cluster = LocalCluster(server_dir=server, worker_config=WorkerConfig(cores=2))
    job = Job(default_workdir=folder, max_fails=None)
    for task in range(shards):
        # As `hq submit --array` does; the numbers of tasks count from 0 here too.
        job.program(["bash", "./sweep-hq.sh"], stdout=None, stderr=None)
    client = cluster.client()
    submitted = client.submit(job)
    if stop_after > 0:

        def stop():
            cluster.stop()
            # SIGINT goes out at once, SIGKILL one second later.
            time.sleep(2)
            print(f"cluster stopped after {stop_after} s", flush=True)
            os._exit(3)

        threading.Timer(stop_after, stop).start()
    done = client.wait_for_jobs([submitted], raise_on_error=False)
    print(f"job {submitted.id}: {'all tasks done' if done else 'tasks failed'}", flush=True)
    os._exit(0 if done else 3)
