"""Batches on this machine, or on a Dask cluster.

    catoptra.batch.run("plan.toml", "results.sqlite")                       # this machine's cores
    catoptra.batch.run("plan.toml", "results.sqlite", client=Client(...))   # the workers of a dask.distributed cluster

Both give the same rows, bit for bit: a case is a pure function of its inputs. The process that calls run() owns the database; workers only
compute, in shards of cases, and a shard whose worker dies is computed again elsewhere. A run that is killed is resumed by calling it again.
Lens files that a plan names must be found under the same paths on every worker (a shared file system).
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Sequence

from . import _core

if TYPE_CHECKING:
    from distributed import Client

#: Cases that a worker computes at a time: long enough to hide the network, short enough to lose little with a worker.
SHARD_CASES = 32

#: A shard that has taken so many workers down with it is not tried again.
RETRIES = 4


class Outcome(NamedTuple):
    """What a run has done: cases computed, and those of them that failed (their errors are rows)."""

    done: int
    failed: int


def evaluate_shard(lines: Sequence[str]) -> list[str]:
    """Computes cases given as lines of JSON; what a worker runs."""
    return [_core.evaluate_batch_case(line) for line in lines]


def _failed(line: str) -> bool:
    import json

    return json.loads(line)["error"] is not None


def run(
    plan: str | os.PathLike[str],
    database: str | os.PathLike[str],
    client: Client | None = None,
    *,
    jobs: int = 0,
    shard_cases: int = SHARD_CASES,
    progress: Callable[[int, int], None] | None = None,
) -> Outcome:
    """Computes what is pending of a plan and stores it.

    client: a dask.distributed client; None: this machine's cores, `jobs` of them (0: all).
    progress: called with the cases stored so far in this run, and those wanted.

    Ctrl-C raises KeyboardInterrupt once the cases in hand are stored; the same call goes on from there.
    """
    read = _core.read_batch_plan(plan)
    store = _core.BatchStore(database)
    store.add(read)
    if client is None:
        return Outcome(*_core.run_batch_here(read, store, jobs, progress))
    return _run_on(client, store, store.pending(read), shard_cases, progress)


def _run_on(
    client: Client,
    store: _core.BatchStore,
    lines: list[str],
    shard_cases: int,
    progress: Callable[[int, int], None] | None,
) -> Outcome:
    import distributed

    # Debian's distributed has no complete types.
    untyped: Any = client
    as_completed: Any = distributed.as_completed

    if shard_cases < 1:
        raise ValueError("shard_cases must be at least 1")
    shards = [lines[i : i + shard_cases] for i in range(0, len(lines), shard_cases)]
    # pure=False: the scheduler must not take two shards for one; a shard that is computed twice is stored once all the same.
    futures = untyped.map(evaluate_shard, shards, pure=False, retries=RETRIES)
    stored = failed = 0
    try:
        for future in as_completed(futures):
            for line in future.result():
                store.put(line)
                stored += 1
                failed += _failed(line)
            if progress is not None:
                progress(stored, len(lines))
    finally:
        untyped.cancel(futures)
    return Outcome(stored - failed, failed)
