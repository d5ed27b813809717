"""What came of an import, in one line and in few: what came in, what was put right, what is left, what to
do about it. The window and the command line say the same.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from metagraph.common.wording import join_phrases, phrase, plural_phrase
from metagraph.formats.imports import Imported, Strangers
from metagraph.formats.takes import BIND_POSE, FRAME_TIME, FROM_OFFSET, LONE_FRAME, NAME, ONE_FRAME, UNIT, UP

_RIGHT = {
    BIND_POSE: phrase("bind poses on first frames"),
    UNIT: phrase("units of length"),
    UP: phrase("Z up"),
    ONE_FRAME: phrase("takes of one frame"),
    LONE_FRAME: phrase("single stray frames"),
    FROM_OFFSET: phrase("positions relative to OFFSET"),
    FRAME_TIME: phrase("frame times"),
    NAME: phrase("names"),
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


def list_remedies(result: Imported) -> tuple[Remedy, ...]:
    """Return what can be done about what an import left, the most useful first."""
    out: list[Remedy] = []
    sure = tuple(s for s in result.apart if not s.joint_map.missing)
    unsure = tuple(s for s in result.apart if s.joint_map.missing)
    if sure:
        count = _clips(_count(sure))
        label = phrase("Retarget {clips}", clips=count)
        out.append(Remedy("retarget", label, f"retarget {count} (--retarget)", sure))
    if unsure:
        count = _clips(_count(unsure))
        label = phrase("Map joints of {clips}…", clips=count)
        out.append(Remedy("map", label, f"map joints of {count} in the window", unsure))
    if result.stand_ins:
        out.append(Remedy("character", phrase("Choose character…"), "choose a character in the window"))
    return tuple(out)


def describe_imported(result: Imported) -> str:
    """Return what came in: "Imported 24 clips, 3 of them retargeted"."""
    count = len(result.loaded)
    if result.chosen and result.character is not None:
        return phrase("Drawn with {name} from now on", name=Path(result.character.path).name)
    if result.retargeted and count:
        again = result.retargeted
        return phrase("Imported {clips}, {again} of them retargeted", clips=_clips(count), again=again)
    return phrase("Imported {clips}", clips=_clips(count))


def describe_import(result: Imported, window: bool = True) -> str:
    """Return all of it in one line. window: what is to be done is done with buttons."""
    parts = [describe_imported(result)]
    right: dict[str, int] = {}
    for name, n in _repairs(result):
        right[name] = right.get(name, 0) + n
    if result.stand_ins:
        first = Path(result.stand_ins[0].path).name
        more, why = len(result.stand_ins) - 1, result.stand_ins[0].why_not
        parts.append(
            phrase("No character: the mesh of {first} and {more} more {why}", first=first, more=more, why=why)
            if more
            else phrase("No character: the mesh of {first} {why}", first=first, why=why)
        )
    if right:
        made = [phrase("{what} ({count})", what=_RIGHT.get(k, k), count=n) for k, n in right.items()]
        parts.append(phrase("Repaired: {made}", made=join_phrases(made, ", ")))
    if result.character is not None and result.character.hidden:
        count = len(result.character.hidden)
        parts.append(
            plural_phrase(
                "Hidden: {count:,} mesh held in the hands",
                "Hidden: {count:,} meshes held in the hands",
                count,
            )
        )
    known = {repair.words for _, _, _, clip in result.loaded for repair in clip.repairs}
    hidden = result.character.notes if result.character is not None else ()
    notes = [n for n in result.notes if n.partition(": ")[2] not in known and n not in hidden]
    if notes := count_alike(notes):
        parts.append(plural_phrase("{count:,} note", "{count:,} notes", len(notes)))
    left = []
    if apart := _count(result.apart):
        left.append(phrase("{clips} with another skeleton", clips=_clips(apart)))
    broken = len(result.failures) - sum(len(s.told) for s in result.apart)
    if broken > 0:
        left.append(plural_phrase("{count:,} unusable file", "{count:,} unusable files", broken))
    if left:
        parts.append(phrase("Skipped: {left}", left=join_phrases(left, ", ")))
    to_do = list_remedies(result)
    if to_do:
        steps = [_STEPS[r.do](r) if window else r.command for r in to_do]
        parts.append(phrase("To do: {steps}", steps=join_phrases(steps, ", ")))
    if result.cancelled:
        parts.append(phrase("The import was cancelled"))
    return join_phrases(parts, ". ")


_STEPS: dict[str, Callable[[Remedy], str]] = {
    "retarget": lambda r: phrase("retarget {clips}", clips=_clips(_count(r.strangers))),
    "map": lambda r: phrase("map joints of {clips}", clips=_clips(_count(r.strangers))),
    "character": lambda r: phrase("choose character"),
}


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


def count_alike(lines: Iterable[str]) -> list[str]:
    """Return lines on files, those that say the same of several as one with a count.

    They are the same where only numbers and what is in quotes differ; numbers are then told from the least to
    the most.
    """
    groups: dict[tuple[str, bool], list[tuple[str, str]]] = {}
    whole: dict[tuple[str, str], str] = {}  # lines as they came, with what they know of their making
    for line in lines:
        subject, colon, text = line.partition(": ")
        whole[subject, text] = line
        groups.setdefault((_VARIES.sub("#", text or subject), bool(colon)), []).append((subject, text))
    out = []
    for (_, about), found in groups.items():
        subject, text = found[0]
        if len(found) == 1 or not about:
            out += [whole.get((s, t), f"{s}: {t}" if about else s) for s, t in dict.fromkeys(found)]
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


def _clips(count: int) -> str:
    return plural_phrase("{count:,} clip", "{count:,} clips", count)
