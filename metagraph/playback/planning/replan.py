"""Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section
6.1).

Greedy, by start time and then priority. The running action is never touched. If two overlap, the more
important one keeps its time. The other is delayed past it, or cut where it begins; its remainder then plays
afterwards if the request says so.
"""

from __future__ import annotations

from bisect import bisect_right, insort
from collections.abc import Iterable, Sequence
from dataclasses import replace

from metagraph.graph.model import Settings
from metagraph.playback.plan import MetaAction, Outcome, Report


def delay(
    asked: Iterable[MetaAction], free: float, settings: Settings
) -> tuple[list[MetaAction], list[Report]]:
    """Let new requests wait until `free` seconds, the end of the running action, and drop those that would
    wait too long. Requests that say how late they may be are judged later, when their lateness is known.
    """
    metas: list[MetaAction] = []
    reports: list[Report] = []
    for meta in asked:
        late = free - meta.start
        if late <= 0:
            metas.append(meta)
        elif meta.request.late is not None:
            metas.append(_after(meta, free))
        elif late > settings.wait:
            reports.append(
                _told(
                    meta, "past", f"asked for at {meta.start:.2f} s, {late:.1f} s before anything could start"
                )
            )
        else:
            metas.append(_after(meta, free))
            reports.append(_told(meta, "late", f"waits {late:.2f} s for the running action", True))
    return metas, reports


def replan(
    metas: Iterable[MetaAction], settings: Settings, busy: float = float("-inf")
) -> tuple[list[MetaAction], list[Report]]:
    """Return the meta plan, ascending and without overlaps, and what became of the rest.

    Requests are placed first; what a model wrote fits into the gaps, from `busy` seconds on. Meta actions
    that do not overlap stay as they are, so a plan that is placed again does not change. If start and
    priority are equal, the id that sorts first goes first.
    """
    every = list(metas)
    placed, reports = _placed([m for m in every if not m.written], settings)
    written, told = _fitted([m for m in every if m.written], placed, settings.shortest, busy)
    return sorted([*placed, *written], key=lambda m: (m.start, m.end)), [*reports, *told]


def _fitted(
    written: Iterable[MetaAction], placed: Sequence[MetaAction], shortest: float, busy: float
) -> tuple[list[MetaAction], list[Report]]:
    """Return the parts of written meta actions that fit beside the placed ones: the first stretch of each
    that is long enough.
    """
    out: list[MetaAction] = []
    reports: list[Report] = []
    starts = [m.start for m in placed]
    for meta in sorted(written, key=lambda m: (m.start, m.request.id)):
        start, end, beside = max(meta.start, busy, out[-1].end if out else busy), meta.end, None
        for other in placed[max(0, bisect_right(starts, start) - 1) :]:
            if other.start >= end:
                break
            if other.end <= start:
                continue
            beside = other
            if other.start - start >= shortest:
                end = other.start
                break
            start = other.end
        if start == meta.start and end == meta.end:
            out.append(meta)
        elif end - start >= shortest:
            out.append(replace(meta, start=start, end=end))
            if end < meta.end and beside is not None:
                reports.append(
                    _told(
                        meta,
                        "cut",
                        f"is cut at {end:.2f} s for '{beside.request.id}', which is asked for",
                        True,
                    )
                )
        else:
            words = _no_time(beside) if beside is not None else "no time left beside what plays"
            reports.append(_told(meta, "covered", words))
    return out, reports


def _order(meta: MetaAction) -> tuple[float, int, str, int]:
    """Return the sort key that decides which is placed first."""
    return meta.start, -meta.request.priority, meta.request.id, meta.part


def _placed(metas: Sequence[MetaAction], settings: Settings) -> tuple[list[MetaAction], list[Report]]:
    queue = sorted(metas, key=_order)
    at = 0  # what is before it was looked at
    placed: list[MetaAction] = []
    reports: list[Report] = []
    while at < len(queue):
        meta = queue[at]
        at += 1
        last = placed[-1] if placed else None
        if last is None or last.end <= meta.start:
            placed.append(meta)
            continue
        if meta.request.priority > last.request.priority:
            placed.pop()
            kept = meta.start - last.start >= settings.shortest
            if kept:
                placed.append(replace(last, end=meta.start))
            # What was never begun goes on as itself, so that its draws stay the same.
            rest = replace(last, start=meta.end, part=last.part + 1 if kept else last.part)
            resumes = last.request.resume and rest.end - rest.start >= settings.shortest
            if resumes:
                insort(queue, rest, lo=at, key=_order)
            word = "is cut" if kept else "gives way"
            after = f" and goes on at {meta.end:.2f} s" if resumes else ""
            outcome: Outcome = "resumed" if resumes else "cut" if kept else "covered"
            message = f"{word} at {meta.start:.2f} s for '{meta.request.id}', which is more important{after}"
            reports.append(_told(last, outcome, message, kept or resumes))
            insort(queue, meta, lo=at, key=_order)  # it may reach back over what was placed before, too
        elif meta.request.late is not None:
            insort(queue, _after(meta, last.end), lo=at, key=_order)
        elif last.end - meta.request.start > settings.wait:
            reports.append(_told(meta, "covered", _no_time(last)))
        else:
            insort(queue, _after(meta, last.end), lo=at, key=_order)
            reports.append(
                _told(
                    meta, "late", f"waits {last.end - meta.request.start:.2f} s for '{last.request.id}'", True
                )
            )
    return placed, reports


def _after(meta: MetaAction, free: float) -> MetaAction:
    """Return a meta action that begins at `free` instead."""
    return replace(meta, start=free, end=free + (meta.end - meta.start))


def _no_time(other: MetaAction) -> str:
    return f"no time left beside '{other.request.id}' ({other.start:.2f}-{other.end:.2f} s)"


def _told(meta: MetaAction, outcome: Outcome, message: str, played: bool = False) -> Report:
    return Report(meta.request.id, outcome, message, meta.request.layer, meta.start, played, meta.written)
