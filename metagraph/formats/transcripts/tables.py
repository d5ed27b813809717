"""Tables of words, a line each: NIST's CTM, which Kaldi writes, tables of start, end and word, as GENEA's and
Whisper's .tsv, and the Montreal Forced Aligner's CSV.
"""

from __future__ import annotations

import csv

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.speaker_names import find_speaker_names
from metagraph.formats.transcripts.units import infer_time_unit
from metagraph.formats.transcripts.words import Collected, Transcript

_RTTM = ("SPEAKER ", "SPKR-INFO ", "NOSCORE ", "LEXEME ")


def is_ctm(source: TranscriptSource) -> bool:
    """Return whether the first line that is no comment is one of CTM: recording, channel, start, duration,
    word.
    """
    for line in source.text.split("\n")[:1000]:
        if line.strip() and not line.lstrip().startswith((";;", "#")):
            return _ctm(line) is not None
    return False


def _ctm(line: str) -> tuple[str, str, float, float, str] | None:
    cells = line.split()
    if len(cells) < 5:
        return None
    try:
        start, length = float(cells[2]), float(cells[3])
    except ValueError:
        return None
    return cells[0], cells[1], start, length, cells[4]


def read_ctm(source: TranscriptSource) -> Transcript:
    """Read NIST's time-marked words. A channel, or else a recording, is a speaker. Raises FileError."""
    out = Collected(source.path)
    if source.head.startswith(_RTTM):
        raise out.fail(
            phrase("it says who speaks when (RTTM), but no words"),
            "",
            phrase("Choose a transcript with words. Many diarizers write one with their speakers."),
        )
    rows = []
    for n, line in enumerate(source.text.split("\n")):
        if not line.strip() or line.lstrip().startswith((";;", "#")):
            continue
        row = _ctm(line)
        if row is None:
            raise out.fail(
                phrase("has no recording, channel, start, duration and word"), phrase("line {n}", n=n + 1)
            )
        if not row[3] >= 0:
            raise out.fail(phrase("a word lasts {row:g} s", row=row[3]), phrase("line {n}", n=n + 1))
        rows.append((n, row))
    _infer(out, source, [(start, start + length, word) for _, (_, _, start, length, word) in rows])
    recordings, channels = len({r[0] for _, r in rows}), len({r[1] for _, r in rows})
    for n, (recording, channel, start, length, word) in rows:
        who = channel if recordings < 2 else recording if channels < 2 else f"{recording} {channel}"
        first, last = start * out.unit, (start + length) * out.unit
        out.add(who if recordings * channels > 1 else "", word, first, last, f"line {n + 1}")
    return out.finished()


def _infer(out: Collected, source: TranscriptSource, spans: list[tuple[float, float, str]]) -> None:
    out.unit, told = infer_time_unit(spans, source.sound.seconds)
    if told is not None:
        out.notes.append(told)


# --- a table of words

_HEAD = ("start", "end", "text")


def is_word_table(source: TranscriptSource) -> bool:
    """Return whether the first line that is not empty is one of a table: start, end, words, parted by
    tabs.
    """
    line = next((x for x in source.text.split("\n")[:1000] if x.strip()), "")
    return _table_row(line) is not None or _is_head(line)


def _is_head(line: str) -> bool:
    return tuple(c.strip().casefold() for c in line.split("\t")) == _HEAD


def _table_row(line: str) -> tuple[float, float, str] | None:
    cells = line.split("\t")
    if len(cells) != 3:
        return None
    try:
        return float(cells[0].replace(",", ".")), float(cells[1].replace(",", ".")), cells[2]
    except ValueError:
        return None


def read_word_table(source: TranscriptSource) -> Transcript:
    """Read a line a word or text: start, end and what is said. GENEA's and Audacity's are seconds, Whisper's
    below a head are milliseconds. Raises FileError.
    """
    out = Collected(source.path)
    rows: list[tuple[int, tuple[float, float, str]]] = []
    for n, line in enumerate(source.text.split("\n")):
        if not line.strip() or (not rows and _is_head(line)):
            continue
        row = _table_row(line)
        if row is None:
            raise out.fail(
                phrase("has no start, end and word, separated by tabs"), phrase("line {n}", n=n + 1)
            )
        rows.append((n, row))
    _infer(out, source, [row for _, row in rows])
    names = find_speaker_names([[text] for _, (_, _, text) in rows])
    names.tell(out)
    speaker = ""
    for n, (start, end, text) in rows:
        speaker, said = names.part(text) or (speaker, text)
        out.add(speaker, said, start * out.unit, end * out.unit, f"line {n + 1}")
    return out.finished()


# --- the Montreal Forced Aligner's CSV

_MFA = ["begin", "end", "label", "type", "speaker"]


def is_mfa_table(source: TranscriptSource) -> bool:
    line = source.head.split("\n", 1)[0]
    return [c.strip().casefold() for c in line.split(",")] == _MFA


def read_mfa_table(source: TranscriptSource) -> Transcript:
    """Read Begin, End, Label, Type, Speaker, of the rows that are words; seconds. Raises FileError."""
    out = Collected(source.path)
    try:
        rows = list(csv.reader(source.text.lstrip("\ufeff \t\n").replace("\0", "").split("\n")))[1:]
    except csv.Error as error:
        raise out.fail(phrase("is not a table with commas: {error}", error=error)) from None
    for n, cells in enumerate(rows):
        if not cells or (len(cells) == 5 and cells[3] != "words"):
            continue
        where = phrase("line {n}", n=n + 2)
        try:
            start, end, text, _, speaker = cells
            out.add(speaker, text, float(start), float(end), where, whole=True)
        except ValueError:
            raise out.fail(
                phrase("has no Begin, End, Label, Type and Speaker, separated by commas"), where
            ) from None
    return out.finished()
