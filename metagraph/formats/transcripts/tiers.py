"""Transcripts in tiers: TextGrid and ELAN, ours and others'."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.formats.elan import read_elan
from metagraph.formats.transcripts.json_values import (
    list_of,
    name_of,
    parse_json_seconds,
    parse_text,
    require_dict,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import LATEST, TO_ALL, Collected, Transcript, count, is_silent
from metagraph.graph.conversation.model import EVERYBODY, SHORTEST, SPOKEN, Segment, Spoken
from metagraph.playback.learning.annotation import IGNORE, guess_role
from metagraph.playback.learning.annotation import AnnotationTier as ElanTier
from metagraph.speech.textgrid import read_textgrid

_ROLES = {
    "word": "words",
    "words": "words",
    "ort": "words",
    "orthography": "words",
    "token": "words",
    "tokens": "words",
    "mots": "words",
    "wörter": "words",
    "palabras": "words",
    "transcript": "phrases",
    "transcription": "phrases",
    "text": "phrases",
    "speech": "phrases",
    "utterance": "phrases",
    "utterances": "phrases",
    "phrase": "phrases",
    "phrases": "phrases",
    "sentence": "phrases",
    "sentences": "phrases",
    "segments": "segments",
    "peaks": "peaks",
    "phone": "other",
    "phones": "other",
    "phonemes": "other",
    "phoneme": "other",
    "mau": "other",
    "kan": "other",
    "sampa": "other",
    "ipa": "other",
    "syllable": "other",
    "syllables": "other",
    "pos": "other",
    "notes": "other",
    "comments": "other",
    "silences": "other",
}
_PARTING = " -_@:/|.()[]\t"  # what stands between a name and what a tier holds
_ALIGNED = re.compile(r"(?i)(?<![a-z])(ort|kan|kas|trn)-mau(?![a-z])")
_PARTED = re.compile(r"\s*[-_@:/|.()\[\]\s]+\s*")


@dataclass(frozen=True)
class _Tier:
    """name: as it stands. whose: the speaker's name. role: what its labels are. rows: text, start, end."""

    name: str
    whose: str
    role: str
    rows: Sequence[tuple[str, float, float]]


def is_textgrid(source: TranscriptSource) -> bool:
    """Return whether a file is a TextGrid, or is called one."""
    begins = source.head.startswith(('File type = "ooTextFile', '"ooTextFile'))
    return begins or source.path.suffix.casefold() == ".textgrid"


def read_textgrid_tiers(source: TranscriptSource) -> Transcript:
    """Read the words of a TextGrid. Raises FileError."""
    grid = read_textgrid(source.path)
    tiers = [_tier(t.name, "", [(i.text, i.start, i.end) for i in t.intervals]) for t in grid.tiers]
    points = {t.name for t in grid.tiers if t.points}
    return _from_tiers(source.path, [t for t in tiers if t.name not in points or t.role == "peaks"], ())


def is_mfa_json(source: TranscriptSource) -> bool:
    """Return whether JSON is what the Montreal Forced Aligner writes, or praatio."""
    return isinstance(source.data, dict) and isinstance(source.data.get("tiers"), dict | list)


def read_mfa_json(source: TranscriptSource) -> Transcript:
    """Read `tiers`, by name or as a list, each with `entries` of start, end and label in seconds. Raises
    FileError.
    """
    out = Collected(source.path)
    given = source.data["tiers"]
    named = given.items() if isinstance(given, dict) else [("", one) for one in given]
    tiers = []
    for key, value in named:
        one = require_dict(out, value, f"tiers.{key}")
        name = name_of(one.get("name", "")) or key
        if name_of(one.get("type", one.get("class", ""))).casefold() in ("point", "texttier"):
            continue
        rows = []
        for n, entry in enumerate(list_of(out, one.get("entries") or [], f"tiers.{name}.entries")):
            where = f"tiers.{name}.entries[{n}]"
            cells = list_of(out, entry, where)
            start, end = (
                (parse_json_seconds(out, c, where) for c in cells[:2]) if len(cells) > 2 else (None, None)
            )
            if start is None or end is None:
                raise out.fail(phrase("has no start, end and label"), where)
            rows.append((parse_text(cells[2]), start, end))
        tiers.append(_tier(name, "", rows))
    return _from_tiers(source.path, tiers, ())


def is_elan(source: TranscriptSource) -> bool:
    """Return whether XML is an annotation of ELAN's, or nothing that is known."""
    return source.root == "ANNOTATION_DOCUMENT" or (
        source.head.startswith("<") and source.path.suffix.casefold() == ".eaf"
    )


def read_elan_tiers(source: TranscriptSource) -> Transcript:
    """Read the words of an annotation, at their times in the sound: an annotation's 0 is the medium's time
    origin. Raises FileError.
    """
    read = read_elan(source.path)
    late, told = read.offset_of(source.sound.names)
    rows = {
        t.name: [(i.text, round(i.start + late, 6), round(i.end + late, 6)) for i in t.intervals]
        for t in read.tiers
        if not _of_movement(t)
    }
    tiers = [_tier(t.name, t.participant, rows[t.name]) for t in read.tiers if t.name in rows]
    return _from_tiers(source.path, tiers, [*read.notes, *told])


def _of_movement(tier: ElanTier) -> bool:
    return _role(tier.name)[1] == "" and guess_role(tier) != IGNORE


def _tier(name: str, participant: str, rows: Sequence[tuple[str, float, float]]) -> _Tier:
    whose, role = _role(name)
    return _Tier(name, participant or whose, role, rows)


def _role(name: str) -> tuple[str, str]:
    """Return whose a tier is and what it holds, by its name: "Ann - words", "words@Ann", "Ann" -> "Ann",
    "words" (or "", not said).
    """
    name = name.strip().strip('"').strip()
    if (aligned := _ALIGNED.search(name)) is not None:  # WebMAUS: words, their sounds
        role = "words" if aligned[1].casefold() == "ort" else "other"
        return f"{name[: aligned.start()]}{name[aligned.end() :]}".strip(_PARTING), role
    parts = _PARTED.split(name)
    for n in (-1, 0):
        known = _ROLES.get(parts[n].casefold()) if parts else None
        if known is None:
            continue
        size = len(parts[n])
        rest = (
            name[:-size]
            if n == -1 and name.casefold().endswith(parts[n].casefold())
            else name[size:]
            if n == 0
            else name.replace(parts[n], "")
        )
        return rest.strip(_PARTING), known
    return name, ""


def _bare(name: str) -> str:
    """Return what speakers' names are compared by."""
    return " ".join(name.casefold().split()).strip(_PARTING)


def _from_tiers(path: Path, tiers: Sequence[_Tier], notes: Iterable[str]) -> Transcript:
    """Return words of the tiers that hold some: those named so; without any, those whose labels are not as
    short as phones.
    """
    out = Collected(path, notes=list(notes))
    worded = [t for t in tiers if t.role == "words" and any(not is_silent(x) for x, *_ in t.rows)]
    have = {t.whose for t in worded}
    worded += [t for t in tiers if t.role == "phrases" and t.whose not in have]
    if not worded:
        worded = [t for t in tiers if t.role == "" and _wordy(t)]
    if not worded:  # empty ones count where there is nothing else
        worded = [t for t in tiers if t.role in ("words", "phrases", "")]
    if not worded and not any(t.role == "segments" for t in tiers):
        if not tiers:
            raise out.fail(
                phrase("it has no tiers"),
                "",
                phrase("Save it again with a tier of words for each speaker, or continue without words."),
            )
        names = ", ".join(f"'{t.name[:40]}'" for t in tiers[:8])
        raise out.fail(
            phrase("no tier contains words; its tiers are {names}", names=names),
            "",
            phrase("Name the tier with the words 'words', or 'Ann - words' if there are two speakers."),
        )
    worded = _one_each(out, worded)
    ours = {t.whose for t in tiers if t.role == "segments"}
    talking = ours.union(t.whose for t in worded)
    out.speakers |= {t.whose: [] for t in tiers if t.whose in talking}  # in the file's order
    for tier in worded:
        whole = tier.role == "words" and sum(len(x.split()) > 1 for x, *_ in tier.rows) <= 0.3 * sum(
            not is_silent(x) for x, *_ in tier.rows
        )
        for text, start, end in tier.rows:
            out.add(tier.whose, text, start, end, f"tier '{tier.name}'", whole)
    segments = {t.whose: _segments(out, t, tiers) for t in tiers if t.role == "segments"}
    return out.finished({name: s for name, s in segments.items() if s is not None})


def _one_each(out: Collected, tiers: Sequence[_Tier]) -> list[_Tier]:
    """Return one tier a speaker: of several, as of words and their translation, the one with most words, or
    else most intervals.
    """
    best: dict[str, _Tier] = {}

    def much(tier: _Tier) -> tuple[int, int]:
        return sum(len(x.split()) for x, *_ in tier.rows if not is_silent(x)), len(tier.rows)

    for tier in tiers:
        if tier.whose not in best or much(tier) > much(best[tier.whose]):
            best[tier.whose] = tier
    for tier in tiers:
        if tier is not best[tier.whose] and any(not is_silent(x) for x, *_ in tier.rows):
            out.notes.append(
                phrase(
                    "tier '{name}' skipped, because '{name2}' has more words of the same speaker",
                    name=tier.name,
                    name2=best[tier.whose].name,
                )
            )
    return list(best.values())


def _wordy(tier: _Tier) -> bool:
    sizes = sorted(len(x.strip()) for x, *_ in tier.rows if not is_silent(x))
    return bool(sizes) and (sizes[len(sizes) // 2] > 2.5 or any(" " in x.strip() for x, *_ in tier.rows))


def _segments(out: Collected, tier: _Tier, tiers: Sequence[_Tier]) -> tuple[Segment, ...] | None:
    """Return what a tier of segments holds, with peaks from the tier beside it; None if its labels are not of
    ours.
    """
    peaks = sorted(
        start for t in tiers if t.role == "peaks" and t.whose == tier.whose for _, start, _ in t.rows
    )
    found: list[Segment] = []
    names = {_bare(name): n for n, name in enumerate(out.speakers)}
    unknown: list[str] = []
    over = 0
    for text, start, end in sorted(tier.rows, key=lambda r: r[1:]):
        label, _, words = text.strip().partition(":")
        kind, _, whom = label.strip().casefold().partition(" to ")
        if kind in ("", "idle"):
            continue
        if kind not in SPOKEN:
            unknown.append(label.strip()[:40])
            continue
        if found and start < found[-1].end:
            over += 1
            start = found[-1].end
        if not (0 <= start < LATEST and start + SHORTEST / 2 <= end <= LATEST):
            over += 1
            continue
        peak = next((p for p in peaks if start - 1e-3 <= p <= end + 1e-3), None) if kind == "clause" else None
        if peak is not None:
            peaks.remove(peak)  # where one clause ends and the next begins it is of one of them
        spoken: Spoken = next(k for k in SPOKEN if k == kind)
        found.append(
            Segment(
                spoken,
                start,
                end,
                None if peak is None else min(max(peak, start), end),
                " ".join(words.split()),
                EVERYBODY if whom == TO_ALL else names.get(_bare(whom)),
            )
        )
    if unknown and not found:
        return None
    if unknown:
        kinds = ", ".join(SPOKEN)
        out.notes.append(
            phrase(
                "tier '{name}': {count} skipped, because '{unknown}' is none of {kinds}",
                name=tier.name,
                count=count(len(unknown), "segment"),
                unknown=unknown[0],
                kinds=kinds,
            )
        )
    if over:
        out.notes.append(
            phrase(
                "tier '{name}': {count} overlapped the one before and were cut or skipped",
                name=tier.name,
                count=count(over, "segment"),
            )
        )
    return tuple(found)
