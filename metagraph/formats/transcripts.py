"""Transcripts: who says which word when, from TextGrid, ELAN, WebVTT, SRT, CTM and the JSON of Whisper's kin
and of IBM.

What a file is, its content says. Our own exports are read back whole: words and segments, as corrected by
hand.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.elan import read_elan
from metagraph.graph.conversation import SHORTEST, SPOKEN, Segment, Spoken, Word
from metagraph.playback.annotation import IGNORE, guess_role
from metagraph.playback.annotation import Tier as ElanTier
from metagraph.speech.textgrid import read_textgrid

SUFFIXES = (".TextGrid", ".eaf", ".vtt", ".srt", ".json", ".ctm")
LARGEST = 256 << 20  # bytes
MOST = 1_000_000  # words
LATEST = 1e6  # seconds
_TEXT = 1000  # characters of a word
_REMEDY = f"Known are {', '.join(SUFFIXES)}: TextGrid, ELAN, WebVTT, SRT, Whisper's and IBM's JSON, CTM."
_SILENT = frozenset(
    (
        "",
        "sil",
        "sp",
        "spn",
        "pau",
        "#",
        "_",
        "-",
        "<p:>",
        "<p>",
        "<sil>",
        "<eps>",
        "<unk>",
        "xxx",
        "...",
        "…",
    )
)
_NOISE = re.compile(r"[\[(<{*♪#].*[\])>}*♪#]|[♪♫\W_]+")  # [laughter], (coughs), <noise>: no words
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
_PARTED = re.compile(r"\s*[-_@:/|.()\[\]\s]+\s*")


@dataclass(frozen=True)
class Transcript:
    """speakers: name -> words by start, in the file's order; "" where it names nobody. segments: name -> what
    the file says of clauses, responses and hesitations, for those it does. notes: what was left out or
    settled, in words.
    """

    speakers: Mapping[str, tuple[Word, ...]]
    segments: Mapping[str, tuple[Segment, ...]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


@dataclass
class Collected:
    """Words while a file is being read. spread: texts of several words whose times were shared out; wrong:
    those out of order.
    """

    path: Path
    speakers: dict[str, list[Word]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    spread: int = 0
    wrong: int = 0
    count: int = 0

    def fail(
        self, cause: str, where: str = "", remedy: str = "Correct it there, or save the transcript anew."
    ) -> FileError:
        return FileError(self.path, cause, where, remedy)

    def add(
        self, speaker: str, text: str, start: float, end: float, where: str = "", whole: bool = False
    ) -> None:
        """Add a text, of one word or of several, which share its time by their letters unless it is `whole`.
        start, end: seconds. Raises FileError.
        """
        if not (abs(start) <= LATEST and abs(end) <= LATEST):
            raise self.fail(f"a word's time is {start:g} to {end:g} s", where)
        words = self.speakers.setdefault(speaker[:200], [])
        texts = [" ".join(text.split())] if whole else text.split()
        texts = [t for t in texts if not is_silent(t)] if not is_silent(text) else []
        if not texts:
            return
        start = max(start, 0.0)
        if end < start:
            self.wrong += 1
            end = start + 0.06 * len(text)
        self.count += len(texts)
        if self.count > MOST:
            raise self.fail(f"has more than {MOST:,} words", where, "Cut the recording into pieces.")
        if len(texts) == 1:
            words.append(Word(text=texts[0][:_TEXT], start=round(start, 4), end=round(end, 4)))
            return
        self.spread += len(texts)
        sizes = [len(t) + 1 for t in texts]
        at, total = start, sum(sizes)
        for word, size in zip(texts, sizes, strict=True):
            words.append(
                Word(text=word[:_TEXT], start=round(at, 4), end=round(at + (end - start) * size / total, 4))
            )
            at += (end - start) * size / total

    def finished(self, segments: Mapping[str, tuple[Segment, ...]] | None = None) -> Transcript:
        notes = list(self.notes)
        out = {}
        for name, words in self.speakers.items():
            out[name], told = settled(words)
            whose = f"'{name}': " if name else ""
            notes += [whose + t for t in told]
        if self.wrong:
            notes.append(
                f"{count(self.wrong, 'word')} ended before beginning; so long as letters take is kept"
            )
        if self.spread:
            notes.append(
                f"{count(self.spread, 'word')} had no times of their own; they share those of their sentence "
                "by their letters"
            )
        if not any(out.values()):
            notes.append("it holds no words")
        return Transcript(out, dict(segments or {}), tuple(notes))


def count(number: int, what: str) -> str:
    return f"{number:,} {what}{'' if number == 1 else 's'}"


def is_silent(text: str) -> bool:
    """Whether a label stands for silence or noise, not for a word."""
    bare = text.strip().casefold()
    return bare in _SILENT or (bare != "%hesitation" and _NOISE.fullmatch(bare) is not None)


def settled(words: Iterable[Word]) -> tuple[tuple[Word, ...], list[str]]:
    """Return words by start, each ending where the next begins at the latest, and what had to be done for
    that, in words.
    """
    given = list(words)
    ordered = sorted(given, key=lambda w: (w.start, w.end))
    moved = sum(a.start > b.start for a, b in pairwise(given))
    out: list[Word] = []
    over = gone = 0
    for word in ordered:
        if out and word.start < out[-1].end - 1e-6:
            before = out[-1]
            over += 1
            if word.start - before.start >= SHORTEST / 2:
                out[-1] = Word(text=before.text, start=before.start, end=word.start)
            elif word.end - before.end >= SHORTEST / 2:
                word = Word(text=word.text, start=before.end, end=word.end)
            else:
                gone += 1
                continue
        if word.end - word.start < SHORTEST / 2:
            word = Word(
                text=word.text, start=word.start, end=word.start + SHORTEST / 2
            )  # a word takes time, whatever was written
        out.append(word)
    for n in range(len(out) - 1):  # what was made longer ends where the next begins
        if out[n].end > out[n + 1].start > out[n].start:
            out[n] = Word(text=out[n].text, start=out[n].start, end=out[n + 1].start)
    notes = []
    if moved:
        notes.append(f"{count(moved, 'word')} out of order, sorted by time")
    if over:
        notes.append(f"{count(over, 'word')} overlapped the one before, which ends there now")
    if gone:
        notes.append(f"{count(gone, 'word')} lay wholly within another and were left out")
    return tuple(out), notes


def text_of(path: Path) -> str:
    """Return a text file's content. Raises FileError."""
    try:
        if path.stat().st_size > LARGEST:
            raise FileError(path, f"is larger than {LARGEST >> 20} MiB, no transcript is", remedy=_REMEDY)
        data = path.read_bytes()
    except OSError as error:
        raise FileError(
            path, f"cannot be read ({error.strerror or error})", remedy="Check that it is there."
        ) from None
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace").replace("\r\n", "\n").replace("\r", "\n")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", "replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_transcript(path: str | Path) -> Transcript:
    """Read a transcript, whatever of `SUFFIXES` it is. Raises FileError."""
    path = Path(path)
    text = text_of(path)
    head = text.lstrip("\ufeff \t\n")[:4000]
    if not head:
        return Transcript({}, {}, ("it is empty",))
    if "\0" in head[:200]:
        raise FileError(path, "is no text", "its beginning", _REMEDY)
    if head.startswith(('File type = "ooTextFile', '"ooTextFile')) or path.suffix.casefold() == ".textgrid":
        return _from_textgrid(path)
    if head.startswith("<"):
        return _from_elan(path)
    if head.startswith(("{", "[")):
        from metagraph.formats.transcripts_json import read_json

        return read_json(path, text)
    from metagraph.formats import transcripts_text

    if head.startswith("WEBVTT") or "-->" in text:
        return transcripts_text.read_cues(path, text)
    if transcripts_text.is_ctm(text):
        return transcripts_text.read_ctm(path, text)
    raise FileError(path, "is none of the transcripts that can be read", "its beginning", _REMEDY)


# --- tiers
# --------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Tier:
    """name: as it stands. whose: the speaker's name. role: what its labels are. rows: text, start, end."""

    name: str
    whose: str
    role: str
    rows: Sequence[tuple[str, float, float]]


def _from_textgrid(path: Path) -> Transcript:
    grid = read_textgrid(path)
    tiers = [_tier(t.name, "", [(i.text, i.start, i.end) for i in t.intervals]) for t in grid.tiers]
    points = {t.name for t in grid.tiers if t.points}
    return _from_tiers(path, [t for t in tiers if t.name not in points or t.role == "peaks"], ())


def _from_elan(path: Path) -> Transcript:
    read = read_elan(path)
    tiers = [
        _tier(t.name, t.participant, [(i.text, round(i.start, 6), round(i.end, 6)) for i in t.intervals])
        for t in read.tiers
        if not _of_movement(t)
    ]
    return _from_tiers(path, tiers, read.notes)


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
    parts = _PARTED.split(name)
    for n in (-1, 0):
        role = _ROLES.get(parts[n].casefold()) if parts else None
        if role is None:
            continue
        size = len(parts[n])
        rest = (
            name[:-size]
            if n == -1 and name.casefold().endswith(parts[n].casefold())
            else name[size:]
            if n == 0
            else name.replace(parts[n], "")
        )
        return rest.strip(" -_@:/|.()[]\t"), role
    return name, ""


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
                "it has no tiers",
                "",
                "Save it anew with a tier of words for each speaker, or go on without words.",
            )
        names = ", ".join(f"'{t.name[:40]}'" for t in tiers[:8])
        raise out.fail(
            f"no tier holds words; its tiers are {names}",
            "",
            "Name the tier that does 'words', or 'Ann - words' of two speakers.",
        )
    worded = _one_each(out, worded)
    ours = {t.whose for t in tiers if t.role == "segments"}
    for tier in worded:
        out.speakers.setdefault(tier.whose, [])
        whole = tier.role == "words" and sum(len(x.split()) > 1 for x, *_ in tier.rows) <= 0.3 * sum(
            not is_silent(x) for x, *_ in tier.rows
        )
        for text, start, end in tier.rows:
            out.add(tier.whose, text, start, end, f"tier '{tier.name}'", whole)
    for name in ours:
        out.speakers.setdefault(name, [])
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
                f"tier '{tier.name}' left out, as '{best[tier.whose].name}' holds more words of the same "
                "speaker"
            )
    return list(best.values())


def _wordy(tier: _Tier) -> bool:
    sizes = sorted(len(x.strip()) for x, *_ in tier.rows if not is_silent(x))
    return bool(sizes) and (sizes[len(sizes) // 2] > 2.5 or any(" " in x.strip() for x, *_ in tier.rows))


def _segments(out: Collected, tier: _Tier, tiers: Sequence[_Tier]) -> tuple[Segment, ...] | None:
    """Return what a tier of segments holds, with peaks from the tier beside it; None where its labels are not
    of ours.
    """
    peaks = sorted(
        start for t in tiers if t.role == "peaks" and t.whose == tier.whose for _, start, _ in t.rows
    )
    found: list[Segment] = []
    unknown: list[str] = []
    over = 0
    for text, start, end in sorted(tier.rows, key=lambda r: r[1:]):
        label, _, words = text.strip().partition(":")
        kind = label.strip().casefold()
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
        spoken: Spoken = next(k for k in SPOKEN if k == kind)
        found.append(
            Segment(
                spoken,
                start,
                end,
                None if peak is None else min(max(peak, start), end),
                " ".join(words.split()),
            )
        )
    if unknown and not found:
        return None
    if unknown:
        kinds = ", ".join(SPOKEN)
        out.notes.append(
            f"tier '{tier.name}': {count(len(unknown), 'segment')} left out, as '{unknown[0]}' is none of "
            f"{kinds}"
        )
    if over:
        out.notes.append(
            f"tier '{tier.name}': {count(over, 'segment')} overlapped the one before and were cut or left out"
        )
    return tuple(found)
