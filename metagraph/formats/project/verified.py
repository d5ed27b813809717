"""What verifying a project or an export has found, part by part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.errors import FileError


@dataclass(frozen=True)
class VerificationFault:
    """Something that is not whole. place: the file, or the place in it. remedy: what to do about it."""

    place: str
    words: str
    remedy: str


@dataclass(frozen=True)
class VerifiedPart:
    """A part that was looked at. words: what there is of it, and how it is."""

    name: str
    words: str
    faults: tuple[VerificationFault, ...] = ()


@dataclass(frozen=True)
class Verified:
    """A project or an export that was looked at. file: as it was named."""

    file: str
    kind: str
    parts: tuple[VerifiedPart, ...]

    @property
    def faults(self) -> tuple[VerificationFault, ...]:
        return tuple(fault for part in self.parts for fault in part.faults)


def make_fault(error: FileError, name: str | None = None, remedy: str | None = None) -> VerificationFault:
    """Return a file's error as a fault. name: what the file is called if that is more than its name; remedy:
    what to do if that is known better.
    """
    name = name or error.path.name
    place = f"{name}, {error.where}" if error.where else name
    return VerificationFault(place, f"{error.cause}.", str(error.remedy) if remedy is None else remedy)


def count_in_words(count: int, one: str, many: str | None = None) -> str:
    """Return a number of things in words."""
    return f"1 {one}" if count == 1 else f"{count:,} {many or f'{one}s'}"


def describe_whole(count: int, faults: Sequence[object], whole: str) -> str:
    """Return how many of the parts are whole, "none" if there are none."""
    return f"{count - len(faults):,} of {count:,} {whole}" if count else "none"
