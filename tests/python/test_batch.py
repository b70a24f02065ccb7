"""Batches from Python: on this machine, and on a real Dask scheduler with worker processes of which one is killed."""

import os
import signal
import socket
import subprocess
import sys

import pytest

import catoptra

PLAN = """
[[prescriptions]]
sph = {{ from = -8, to = 6, step = {step} }}
cyl = [0, -2]
material = 1.5
"""


def export(database) -> bytes:
    """Every row of the database, as the program exports it."""
    program = os.environ["CATOPTRA_PROGRAM"]
    cases = subprocess.run([program, "batch", "export", "--db", database, "-o", "-"], check=True, capture_output=True).stdout
    points = subprocess.run([program, "batch", "export", "--db", database, "--points", "-o", "-"], check=True, capture_output=True).stdout
    return cases + points


@pytest.fixture
def plan(tmp_path):
    file = tmp_path / "plan.toml"
    file.write_text(PLAN.format(step=0.25))
    return file


def test_the_same_rows_as_the_program(plan, tmp_path):
    told = []
    outcome = catoptra.batch.run(plan, tmp_path / "python.sqlite", progress=lambda stored, wanted: told.append((stored, wanted)))
    assert told == [(stored, outcome.done) for stored in range(1, outcome.done + 1)]
    assert outcome.done == len(catoptra._core.read_batch_plan(plan)) and outcome.failed == 0
    subprocess.run([os.environ["CATOPTRA_PROGRAM"], "batch", "run", plan, "--db", tmp_path / "program.sqlite"], check=True)
    assert export(tmp_path / "python.sqlite") == export(tmp_path / "program.sqlite")
    again = catoptra.batch.run(plan, tmp_path / "python.sqlite")
    assert again == (0, 0)


INTERRUPTED = """
import os, signal, sys, catoptra

def interrupt(stored, wanted):
    if stored == 20:
        os.kill(os.getpid(), signal.SIGINT)

try:
    catoptra.batch.run(sys.argv[1], sys.argv[2], jobs=2, progress=interrupt)
    print("finished")
except KeyboardInterrupt:
    print("interrupted")
again = catoptra.batch.run(sys.argv[1], sys.argv[2])  # the same process can go on: nothing holds the database
print(again.done, again.failed)
"""


def test_ctrl_c_stops_a_run_and_loses_no_row(tmp_path):
    plan = tmp_path / "plan.toml"
    plan.write_text(PLAN.format(step=0.25) + '[[poses]]\nmode = "as-worn"\npanto_deg = { from = 0, to = 9, step = 1 }\n')
    database = tmp_path / "interrupted.sqlite"
    ran = subprocess.run([sys.executable, "-c", INTERRUPTED, plan, database], capture_output=True, text=True, timeout=600)
    assert ran.returncode == 0, ran.stderr
    told, rest = ran.stdout.splitlines()
    assert told == "interrupted"
    wanted = len(catoptra._core.read_batch_plan(plan))
    done, failed = map(int, rest.split())
    assert failed == 0 and 0 < done <= wanted - 20, "what was stored before Ctrl-C is not computed again"
    catoptra.batch.run(plan, tmp_path / "calm.sqlite")
    assert export(database) == export(tmp_path / "calm.sqlite")


class Cluster:
    """A scheduler and two workers as processes of their own, as on a cluster."""

    def __init__(self, folder):
        self.processes = []
        with socket.socket() as probe:  # a port that is free now
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{port}"
        self.start("scheduler", folder, "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")
        self.workers = [
            self.start("worker", folder, self.address, "--nthreads", "1", "--no-dashboard", "--no-nanny", "--local-directory",
                       str(folder / f"worker{i}"))
            for i in range(2)
        ]

    def start(self, what, folder, *arguments):
        log = open(folder / f"{what}{len(self.processes)}.log", "wb")
        # Without a nanny a killed worker stays dead, as a lost machine does.
        process = subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{what}", *arguments], stdout=log, stderr=log)
        self.processes.append(process)
        return process

    def close(self):
        for process in reversed(self.processes):
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path):
    started = Cluster(tmp_path)
    yield started
    started.close()


def test_a_killed_worker_costs_nothing_but_time(cluster, plan, tmp_path):
    from distributed import Client

    with Client(cluster.address, timeout=60) as client:
        client.wait_for_workers(2, timeout=60)
        killed = []

        def kill_one_half_way(stored, wanted):
            if not killed and stored >= wanted // 2:
                os.kill(cluster.workers[0].pid, signal.SIGKILL)
                killed.append(stored)

        # Shards of a single case, so that the half-way point comes while the worker still holds some.
        outcome = catoptra.batch.run(plan, tmp_path / "cluster.sqlite", client, shard_cases=1, progress=kill_one_half_way)
        assert killed, "the worker was never killed"
        assert cluster.workers[0].wait(timeout=30) == -signal.SIGKILL
        assert cluster.workers[1].poll() is None
    assert outcome.failed == 0
    catoptra.batch.run(plan, tmp_path / "here.sqlite")
    assert outcome.done == len(catoptra._core.read_batch_plan(plan))
    assert export(tmp_path / "cluster.sqlite") == export(tmp_path / "here.sqlite")
