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
    kernels.make()
    # What cannot be collected is told by the tests themselves.
    subprocess.run(collected(), cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
