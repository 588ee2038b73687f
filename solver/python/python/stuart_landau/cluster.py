"""Sweeps on a HyperQueue cluster: each task computes one share, in a process of its own.

`python -m stuart_landau.cluster ASSIGNMENT I N OUT` is what a task runs.
"""

from __future__ import annotations

import csv
import pickle
import shutil
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._core import Core

if TYPE_CHECKING:
    from ._core import Assignment


def run(
    client: Any, model: Any, assignment: Assignment, out: Path, tasks: int, cpus: int, force: bool
) -> None:
    """Submits the shares of a sweep, waits for them, and puts them together.

    Beside `out` stand meanwhile the shares, and a folder with the assignment and what the tasks print; the folder is new,
    so that no file of another kind is replaced.
    """
    from hyperqueue import Job
    from hyperqueue.task.task import ResourceRequest

    model._core.check_table(assignment, str(out), force)
    folder = Path(tempfile.mkdtemp(prefix=f"{out.name}.cluster-", dir=out.parent))
    file = folder / "assignment"
    file.write_bytes(pickle.dumps((model, assignment)))
    shards = [out.with_name(f"{out.name}.shard-{index}") for index in range(1, tasks + 1)]
    job = Job()
    for index, shard in enumerate(shards, 1):
        job.program(
            [sys.executable, "-m", "stuart_landau.cluster", str(file), str(index), str(tasks), str(shard)],
            env={"RAYON_NUM_THREADS": str(cpus)},
            cwd=str(out.parent),
            stdout=None,
            stderr=str(folder / f"{index}.err"),
            resources=ResourceRequest(cpus=cpus),
        )
    client.wait_for_jobs([client.submit(job)])
    Core.merge([str(shard) for shard in shards], str(out), force)
    for shard in shards:
        shard.unlink(missing_ok=True)
    shutil.rmtree(folder, ignore_errors=True)


def rows(table: Path, axes: int, columns: list[str]) -> list[dict[str, Any]]:
    """The rows of a sweep's table."""

    def number(text: str) -> float | None:
        return float(text) if text else None

    def pair(row: dict[str, str], name: str) -> list[float] | None:
        return [float(row[f"{name}_re"]), float(row[f"{name}_im"])] if row[f"{name}_re"] else None

    def parsed(row: dict[str, str]) -> dict[str, Any]:
        plain = ("c0_error", "c2_error", "amplitude", "mean_flow", "second_harmonic", "leading_re")
        return {
            "place": [float(x) for x in list(row.values())[:axes]],
            "c0": pair(row, "c0"),
            "c2": pair(row, "c2"),
            **{name: number(row[name]) for name in plain},
            "bifurcation": row["bifurcation"],
            "status": row["status"],
            "derived": [number(row[name]) for name in columns],
        }

    with table.open(newline="") as file:
        return [parsed(row) for row in csv.DictReader(file)]


def main(arguments: list[str]) -> None:
    """Computes one share."""
    assignment, index, count, out = arguments
    # A pickle that `run` wrote.
    model, chosen = pickle.loads(Path(assignment).read_bytes())
    model._core.sweep_share(chosen, (int(index), int(count)), out)


if __name__ == "__main__":
    main(sys.argv[1:])
