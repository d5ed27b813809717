"""Starting a training: takes that were read, written for a process of its own."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from app.features.generation.generation_jobs import Listing
from app.features.generation.training_run import Process


def begin(listing: Listing, wish: Mapping[str, Any], out: Path) -> Process:
    """Begin to train; on a job's thread. wish: kind, size and minutes. Raises SplitError, FileError."""
    raise NotImplementedError
