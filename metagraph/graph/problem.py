"""A problem of a project: what is wrong, where, and what to do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from metagraph.graph.words import Layer

Severity = Literal["error", "warning", "hint"]


@dataclass(frozen=True)
class Problem:
    """code: stable word for programs. message: what is wrong; remedy: what to do. The ids say where to jump
    to. moment: when it is seen, seconds of the performance that plays by itself (see `playback.rehearsal`).
    """

    severity: Severity
    code: str
    message: str
    remedy: str
    layer: Layer | None = None
    stance: str | None = None
    action: str | None = None
    clip: str | None = None
    state: str | None = None
    link: str | None = None
    moment: float | None = None
