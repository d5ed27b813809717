"""Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section 6.1).

Greedy, by start time and then priority. The running action is never touched. Where two overlap, the more important one
keeps its time; the other is delayed past it, or cut where it begins, and then goes on with its remainder if it asked to.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from dataclasses import replace

from metagraph.graph.model import Settings
from metagraph.playback.plan import MetaAction, Report


def replan(metas: Iterable[MetaAction], free: float, settings: Settings) -> tuple[list[MetaAction], list[Report]]:
    """Return the meta plan, ascending and without overlaps, and what became of the rest.

    free: seconds before which nothing may start (the end of the running action). A meta action asked for at or after
    `free - settings.wait` is delayed to it; an older one is reported as past.
    """
    queue: list[tuple[float, int, str, int, MetaAction]] = []
    reports: list[Report] = []

    def push(meta: MetaAction) -> None:
        heapq.heappush(queue, (meta.start, -meta.request.priority, meta.request.id, meta.part, meta))

    def tell(meta: MetaAction, outcome: str, message: str, played: bool = False) -> None:
        reports.append(
            Report(meta.request.id, outcome, message, meta.request.layer, meta.start, played, meta.written)  # type: ignore[arg-type]
        )

    for meta in metas:
        push(meta)
    placed: list[MetaAction] = []
    while queue:
        meta = heapq.heappop(queue)[-1]
        if meta.start < free:
            late = free - meta.request.start
            if late > settings.wait:
                tell(meta, "past", f"asked for at {meta.request.start:.2f} s, {late:.1f} s before anything could start")
                continue
            length = meta.end - meta.start
            push(replace(meta, start=free, end=free + length))
            if not meta.written:
                tell(meta, "late", f"waits {free - meta.start:.2f} s for the running action", True)
            continue
        last = placed[-1] if placed else None
        if last is None or last.end <= meta.start:
            placed.append(meta)
            continue
        if meta.request.priority > last.request.priority:
            placed.pop()
            rest = replace(last, start=meta.end, end=last.end, part=last.part + 1)
            resumes = last.request.resume and rest.end - rest.start >= settings.shortest
            kept = meta.start - last.start >= settings.shortest
            if kept:
                placed.append(replace(last, end=meta.start))
            if resumes:
                # What was never begun goes on as itself, so that its draws stay the same.
                push(rest if kept else replace(rest, part=last.part))
            word = "is cut" if kept else "gives way"
            after = f" and goes on at {meta.end:.2f} s" if resumes else ""
            outcome = "resumed" if resumes else "cut" if kept else "covered"
            tell(last, outcome, f"{word} at {meta.start:.2f} s for '{meta.request.id}', which is more important{after}", kept or resumes)
            push(meta)  # it may reach back over what was placed before, too
            continue
        late = last.end - meta.request.start
        if meta.written or late > settings.wait:
            # What nobody asked for is not worth shifting; neither is what would come much too late.
            if meta.end - last.end >= settings.shortest and meta.written:
                push(replace(meta, start=last.end))
            else:
                tell(meta, "covered", f"no time left beside '{last.request.id}' ({last.start:.2f}-{last.end:.2f} s)")
            continue
        push(replace(meta, start=last.end, end=last.end + (meta.end - meta.start)))
        tell(meta, "late", f"waits {last.end - meta.start:.2f} s for '{last.request.id}'", True)
    return placed, reports
