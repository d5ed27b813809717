"""What a transcript is made of, and its words as they are collected, whatever file they come from."""

from __future__ import annotations

import codecs
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from metagraph.common.budgets import MARKS, TEXT_FILE
from metagraph.common.files import read_file
from metagraph.common.wording import Phrase, join_phrases, phrase, plural_phrase
from metagraph.errors import FileError
from metagraph.graph.conversation.model import SHORTEST, Segment, Word

LATEST = 1e6  # seconds
TO_ALL = "all"  # in "clause to all: ...", as our exports write whom a segment is said to
_TEXT = 1000  # characters of a word
_CORRECT = phrase("Correct it there, or save the transcript again.")
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


# Where writing has no blanks, its stops part what is said: えーと、それは -> えーと、 それは
_STOPPED = re.compile(r"(?<=[、。，！？；：])(?=[^\s、。，！？；：」』）’”])")


@dataclass(frozen=True)
class Transcript:
    """speakers: name -> words by start, in the file's order; "" if it names nobody. segments: name -> what
    the file says of clauses, responses and hesitations, for those it does. notes: what was left out or
    settled, in words.
    """

    speakers: Mapping[str, tuple[Word, ...]]
    segments: Mapping[str, tuple[Segment, ...]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


@dataclass
class Collected:
    """Words while a file is being read. spread: texts of several words whose times were shared out; wrong:
    those out of order. unit: seconds that one of the file's units of time is.
    """

    path: Path
    speakers: dict[str, list[Word]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    spread: int = 0
    wrong: int = 0
    count: int = 0
    unit: float = 1.0

    def fail(self, cause: str, where: str = "", remedy: str = _CORRECT) -> FileError:
        return FileError(self.path, cause, where, remedy)

    def add(
        self, speaker: str, text: str, start: float, end: float, where: str = "", whole: bool = False
    ) -> None:
        """Add a text, of one word or of several, which share its time by their letters unless it is `whole`.
        start, end: seconds. Raises FileError.
        """
        if not (abs(start) <= LATEST and abs(end) <= LATEST):
            raise self.fail(phrase("a word's time is {start:g} to {end:g} s", start=start, end=end), where)
        words = self.speakers.setdefault(speaker[:200], [])
        texts = [" ".join(text.split())] if whole else _STOPPED.sub(" ", text).split()
        texts = [t for t in texts if not is_silent(t)] if not is_silent(text) else []
        if not texts:
            return
        start = max(start, 0.0)
        if end < start:
            self.wrong += 1
            end = start + 0.06 * len(text)
        self.count += len(texts)
        if self.count > MARKS:
            raise self.fail(
                phrase("has more than {most:,} words", most=MARKS),
                where,
                phrase("Cut the recording into pieces."),
            )
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
            out[name], done = settle_words(words)
            notes += [phrase("'{name}': {note}", name=name, note=note) if name else note for note in done]
        if self.wrong:
            notes.append(
                phrase(
                    "{count} ended before they began; their length now comes from their letters",
                    count=count(self.wrong, "word"),
                )
            )
        if self.spread:
            notes.append(
                phrase(
                    "{count} had no times of their own; they share those of their sentence in "
                    "proportion to their letters",
                    count=count(self.spread, "word"),
                )
            )
        if not any(out.values()):
            notes.append(phrase("it contains no words"))
        return Transcript(out, dict(segments or {}), tuple(notes))


def join_as_list(words: Sequence[str]) -> str:
    """Return several words as a list in a sentence: commas, and "and" before the last."""
    some = join_phrases(words[:-1], ", ")
    return phrase("{some} and {last}", some=some, last=words[-1]) if len(words) > 1 else words[0]


def count(number: int, what: str) -> Phrase:
    """Return how many words or segments, in words."""
    if what == "word":
        return plural_phrase("{count:,} word", "{count:,} words", number)
    return plural_phrase("{count:,} segment", "{count:,} segments", number)


def is_silent(text: str) -> bool:
    """Whether a label stands for silence or noise, not for a word."""
    bare = unicodedata.normalize("NFKC", text).strip().casefold()  # （笑）is (笑)
    return bare in _SILENT or (bare != "%hesitation" and _NOISE.fullmatch(bare) is not None)


def settle_words(words: Iterable[Word]) -> tuple[tuple[Word, ...], list[str]]:
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
    notes: list[str] = []
    if moved:
        notes.append(phrase("{count} were out of order and were sorted by time", count=count(moved, "word")))
    if over:
        notes.append(
            phrase(
                "{count} overlapped the previous one, which now ends where they begin",
                count=count(over, "word"),
            )
        )
    if gone:
        notes.append(
            phrase("{count} were entirely inside another and were skipped", count=count(gone, "word"))
        )
    return tuple(out), notes


def decode_text(data: bytes) -> str:
    """Return a text file's content, whose lines end in a line feed."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace").replace("\r\n", "\n").replace("\r", "\n")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", "replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_text_file(path: Path) -> str:
    """Return a text file's content. Raises FileError."""
    return decode_text(read_file(path, TEXT_FILE))
