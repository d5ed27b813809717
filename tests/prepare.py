"""Makes once what each process that tests would make for itself: `python -m tests.prepare`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests import kernels

ROOT = Path(__file__).resolve().parents[1]


def collected() -> list[str]:
    """Return the command that collects all tests and runs none. It leaves their modules' bytecode behind: to
    rewrite all asserts takes twenty seconds, in each process that begins without it.
    """
    return [
        sys.executable,
        "-m",
        "pytest",
        "--collect-only",
        "-qq",
        "-p",
        "no:cacheprovider",
        "-p",
        "no:xvfb",
    ]


if __name__ == "__main__":
    # Beside each other: neither waits for the other, and what checks types is done before both are.
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    levels = [sys.executable, "-m", "tests.levels"]
    # What cannot be collected is given by the tests themselves.
    beside = [subprocess.Popen(command, cwd=ROOT, **quiet) for command in (collected(), levels)]
    try:
        kernels.make()
        for process in beside:
            process.wait(timeout=900)
    finally:
        for process in beside:
            process.kill()
            process.wait()
