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
    collecting = subprocess.Popen(collected(), cwd=ROOT, **quiet)
    try:
        kernels.make()
        collecting.wait(timeout=900)  # what cannot be collected is given by the tests themselves
    finally:
        collecting.kill()
        collecting.wait()
