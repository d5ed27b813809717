"""Functions are as complex, long and full of arguments as `pyproject.toml` allows; those that were when the
limits came are listed there, and the list only gets shorter.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIMITS = {"C901", "PLR0913", "PLR0915"}  # branches, arguments, statements


def listed() -> set[tuple[str, str]]:
    """Return which file is excused from which limit; folders are excused for good."""
    ruff = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["ruff"]
    return {
        (path, code)
        for path, codes in ruff["lint"]["per-file-ignores"].items()
        for code in LIMITS.intersection(codes)
        if "*" not in path
    }


def over_limits(*paths: str) -> set[tuple[str, str]]:
    """Return which files go over which limit, whoever is excused."""
    done = subprocess.run(
        [sys.executable, "-m", "ruff", "check", *paths, "--select", ",".join(sorted(LIMITS))]
        + ["--config", "lint.per-file-ignores = {}", "--output-format", "json", "--no-cache"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr
    return {(Path(f["filename"]).relative_to(ROOT).as_posix(), f["code"]) for f in json.loads(done.stdout)}


def test_a_file_is_excused_from_a_limit_only_while_it_goes_over_it() -> None:
    excused = listed()
    assert excused, "the list is read"
    idle = excused - over_limits("app", "metagraph", "preview")
    assert not idle, f"take out of per-file-ignores in pyproject.toml: {sorted(idle)}"
