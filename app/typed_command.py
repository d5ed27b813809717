"""Commands for the user to type, as this system's terminal reads them."""

from __future__ import annotations

import os
import shlex
import subprocess


def list_program_words() -> list[str]:
    """Return what to type to start Metagraph: `metagraph`, or what started this process, such as `run.py`."""
    return shlex.split(os.environ.get("METAGRAPH_COMMAND", "")) or ["metagraph"]


def quote_command(words: list[str]) -> str:
    """Return a command as this system's terminal reads it."""
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)
