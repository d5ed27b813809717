"""Define a guess with its confidence and reason."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Belief(Generic[T]):
    """A guess.

    `confidence` is how often such a guess is right, 0..1. `reason` is for people, without a full stop: 'ends
    0.4 cm from "arms crossed"'.
    """

    value: T
    confidence: float
    reason: str
