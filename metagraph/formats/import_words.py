"""What came of an import, in one line and in few: what came in, what was put right, what is left, what to
do about it. The window and the command line say the same.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from metagraph.formats.imports import Imported, Strangers
from metagraph.formats.takes import BIND_POSE, NAME, ONE_FRAME, UNIT, UP

_RIGHT = {
    BIND_POSE: "bind poses on first frames",
    UNIT: "units of length",
    UP: "Z up",
    ONE_FRAME: "takes of one frame",
    NAME: "names",
}
_VARIES = re.compile(r"'[^']*'|\d+(?:\.\d+)?")


@dataclass(frozen=True)
class Remedy:
    """Something to do about what was left. do: what; label: on a button; command: for who has no window.

    strangers: whom it is about.
    """

    do: Literal["retarget", "map", "character"]
    label: str
    command: str
    strangers: tuple[Strangers, ...] = ()


def remedies(result: Imported) -> tuple[Remedy, ...]:
    """Return what can be done about what an import left, the most useful first."""
    out: list[Remedy] = []
    sure = tuple(s for s in result.apart if not s.joint_map.missing)
    unsure = tuple(s for s in result.apart if s.joint_map.missing)
    if sure:
        count = _clips(_count(sure))
        out.append(Remedy("retarget", f"Retarget {count}", f"retarget {count} (--retarget)", sure))
    if unsure:
        count = _clips(_count(unsure))
        out.append(Remedy("map", f"Map joints of {count}…", f"map joints of {count} in the window", unsure))
    if result.stand_ins:
        out.append(Remedy("character", "Choose character…", "choose a character in the window"))
    return tuple(out)


def head(result: Imported) -> str:
    """Return what came in: "Imported 24 clips, 3 of them retargeted"."""
    count = len(result.loaded)
    return f"Imported {_clips(count)}" + (
        f", {result.retargeted} of them retargeted" if result.retargeted and count else ""
    )


def said(result: Imported, window: bool = True) -> str:
    """Return all of it in one line. window: what is to be done is done with buttons."""
    parts = [head(result)]
    right: dict[str, int] = {}
    for name, n in _repairs(result):
        right[name] = right.get(name, 0) + n
    if result.stand_ins:
        first = Path(result.stand_ins[0].path).name
        more = f" and {len(result.stand_ins) - 1} more" if len(result.stand_ins) > 1 else ""
        parts.append(f"No character: the mesh of {first}{more} {result.stand_ins[0].why_not}")
    if right:
        parts.append("Put right: " + ", ".join(f"{_RIGHT.get(k, k)} ({n})" for k, n in right.items()))
    if result.character is not None and result.character.hidden:
        parts.append(f"Hidden: {_many(len(result.character.hidden), 'mesh', 'meshes')} in the hands")
    told = {repair.words for _, _, _, clip in result.loaded for repair in clip.repairs}
    hidden = result.character.notes if result.character is not None else ()
    notes = [n for n in result.notes if n.partition(": ")[2] not in told and n not in hidden]
    if notes := counted(notes):
        parts.append(f"{_many(len(notes), 'note', 'notes')}")
    left = []
    if apart := _count(result.apart):
        left.append(f"{_clips(apart)} of another skeleton")
    broken = len(result.failures) - sum(len(s.told) for s in result.apart)
    if broken > 0:
        left.append(f"{_many(broken, 'file', 'files')} that cannot be used")
    if left:
        parts.append(f"Left out: {', '.join(left)}")
    to_do = remedies(result)
    if to_do:
        steps = [r.label[0].lower() + r.label[1:].rstrip("…") if window else r.command for r in to_do]
        parts.append(f"To do: {', '.join(steps)}")
    if result.cancelled:
        parts.append("It was stopped before the end")
    return ". ".join(parts)


def _repairs(result: Imported) -> Iterable[tuple[str, int]]:
    skipped: set[tuple[str, int]] = set()  # takes of a file are on each of its clips
    for path, _, _, clip in result.loaded:
        for repair in clip.repairs:
            if not repair.made or repair.name == NAME:  # a name is plain to see
                continue
            if repair.take is not None:
                if (path, repair.take) in skipped:
                    continue
                skipped.add((path, repair.take))
            yield repair.name, 1


def counted(lines: Iterable[str]) -> list[str]:
    """Return lines on files, those that say the same of several as one with a count.

    They are the same where only numbers and what is in quotes differ; numbers are then told from the least to
    the most.
    """
    groups: dict[tuple[str, bool], list[tuple[str, str]]] = {}
    for line in lines:
        subject, colon, text = line.partition(": ")
        groups.setdefault((_VARIES.sub("#", text or subject), bool(colon)), []).append((subject, text))
    out = []
    for (_, about), found in groups.items():
        subject, text = found[0]
        if len(found) == 1 or not about:
            out += [f"{s}: {t}" if about else s for s, t in dict.fromkeys(found)]
            continue
        out.append(f"{subject} and {len(found) - 1} more: {_ranged([t for _, t in found])}")
    return out


def _ranged(texts: list[str]) -> str:
    """Return texts that differ in numbers as one, "1 to 12" where they do."""
    values = [_VARIES.findall(text) for text in texts]
    places = iter(zip(*values, strict=True))

    def one(match: re.Match[str]) -> str:
        mine = next(places)
        if match[0].startswith("'") or len(set(mine)) == 1:
            return match[0]
        return f"{min(mine, key=float)} to {max(mine, key=float)}"

    return _VARIES.sub(one, texts[0])


def _count(strangers: Iterable[Strangers]) -> int:
    return sum(len(s.clips) for s in strangers)


def _many(count: int, one: str, more: str) -> str:
    return f"{count:,} {one if count == 1 else more}"


def _clips(count: int) -> str:
    return _many(count, "clip", "clips")
