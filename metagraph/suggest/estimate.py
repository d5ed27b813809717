"""A guess with how sure it is, and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Belief(Generic[T]):
    """value: what is believed. confidence: 0..1, how often such a guess is right. reason: in words, for
    people, without a full stop: 'ends 0.4 cm from "arms crossed"'.
    """

    value: T
    confidence: float
    reason: str
