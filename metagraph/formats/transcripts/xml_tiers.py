"""Transcriber (.trs) and EXMARaLDA's basic transcriptions (.exb), from their published document types."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from xml.etree.ElementTree import Element

from metagraph.common.wording import phrase, plural_phrase
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def _seconds(out: Collected, text: str | None, where: str) -> float:
    try:
        value = float(text or "")
    except ValueError:
        raise out.fail(phrase("a time is '{value}'", value=(text or "")[:30]), where) from None
    if not abs(value) < 1e7:
        raise out.fail(phrase("a time is '{value}'", value=(text or "")[:30]), where)
    return value


# --- Transcriber


def is_transcriber(source: TranscriptSource) -> bool:
    return source.root == "Trans"


def read_transcriber(source: TranscriptSource) -> Transcript:
    """Read turns: what stands between two Sync marks shares the time between them. Where several speak at
    once, Who marks tell whose text it is. Raises FileError.
    """
    out, root = Collected(source.path), source.xml()
    names = {s.get("id", ""): s.get("name", "") or s.get("id", "") for s in root.iter("Speaker")}
    for n, turn in enumerate(root.iter("Turn"), 1):
        where = f"Turn {n}"
        start, end = (_seconds(out, turn.get(k), where) for k in ("startTime", "endTime"))
        people = [names.get(one, one) for one in (turn.get("speaker") or "").split()] or [""]
        parts: list[tuple[float, str, list[str]]] = [(start, people[0], [turn.text or ""])]
        at, who = start, people[0]
        for mark in turn:
            if mark.tag == "Sync":
                at, who = _seconds(out, mark.get("time"), where), people[0]
                parts.append((at, who, []))
            elif mark.tag == "Who":
                number = mark.get("nb", "1")
                who = people[int(number) - 1] if number.isdigit() and 0 < int(number) <= len(people) else who
                parts.append((at, who, []))
            parts[-1][2].append(mark.tail or "")
        times = sorted({p[0] for p in parts} | {end})
        until = dict(pairwise(times))
        for at, who, texts in parts:
            out.add(who, " ".join(texts), at, until.get(at, end), where)
    return out.finished()


# --- EXMARaLDA


def is_exmaralda(source: TranscriptSource) -> bool:
    return source.root == "basic-transcription"


def read_exmaralda(source: TranscriptSource) -> Transcript:
    """Read the tiers of type "t", which hold what is said, each with its speaker; points of the timeline
    without a time lie evenly between those with one. Raises FileError.
    """
    out, root = Collected(source.path), source.xml()
    names = {
        s.get("id", ""): (s.findtext("abbreviation") or "").strip() or s.get("id", "")
        for s in root.iter("speaker")
    }
    points = _timeline(out, list(root.iter("tli")))
    tiers = [t for t in root.iter("tier") if t.get("type") == "t"]
    if not tiers:
        raise out.fail(
            phrase("no tier is a transcription (type 't')"),
            "",
            phrase("In EXMARaLDA, make the tier with the words one of type T(ranscription)."),
        )
    for tier in tiers:
        where = f"tier '{tier.get('id', '')[:40]}'"
        who = names.get(tier.get("speaker", ""), tier.get("speaker", ""))
        for event in tier.iter("event"):
            ends = [event.get(k, "") for k in ("start", "end")]
            unknown = next((e for e in ends if e not in points), None)
            if unknown is not None:
                raise out.fail(
                    phrase("refers to '{unknown}', which is not in the timeline", unknown=unknown[:40]), where
                )
            out.add(who, "".join(event.itertext()), points[ends[0]], points[ends[1]], where)
    return out.finished()


def _timeline(out: Collected, points: Sequence[Element]) -> dict[str, float]:
    """Return the seconds of each point of the timeline."""
    known = [
        None if p.get("time") is None else _seconds(out, p.get("time"), f"'{p.get('id', '')[:40]}'")
        for p in points
    ]
    places = [n for n, t in enumerate(known) if t is not None]
    if points and not places:
        raise out.fail(
            phrase("its timeline has no times"), "", phrase("In EXMARaLDA, align it with its recording.")
        )
    times = [0.0 if t is None else t for t in known]
    for first, last in pairwise([-1, *places, len(known)]):
        low = times[first] if first >= 0 else 0.0
        high = times[last] if last < len(known) else low
        for n in range(first + 1, last):
            times[n] = low + (high - low) * (n - first) / (last - first)
    missing = sum(t is None for t in known)
    if missing:
        out.notes.append(
            plural_phrase(
                "{count:,} point of its timeline has no time; it lies evenly between the others",
                "{count:,} points of its timeline have no time; they lie evenly between the others",
                missing,
            )
        )
    return {p.get("id", ""): t for p, t in zip(points, times, strict=True)}
