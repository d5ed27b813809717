"""The times of a line's words and mouth shapes, as a synthesiser reports them: the mouth follows them and is
shut in between. Times are seconds from the line's start.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil

from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.graphemes import PACE, Spelled, measure_letter, sounds, split_words
from metagraph.playback.life.mouth import LATE, STEP, VOWELS, MouthPiece

WORD = 0.15  # seconds that a word takes if only its start is known and nothing comes sooner
LETTER = 0.07  # and seconds for each of its letters
SHAPE = 0.2  # seconds for which the last shape of a line stays
FARTHEST = 3600.0  # seconds of a line
AGAIN = 0.1  # a later piece belongs to a line from this many seconds before its last shape on
SLACK = 0.05  # seconds by which times may exceed the given end
MISSED = 0.1  # seconds by which a word may come late and only be cut short

# What each viseme of a set shows of the mouth shapes, and how fully.
OCULUS: dict[str, str] = {
    "sil": "sil", "PP": "PP", "FF": "FF", "TH": "TH", "DD": "DD", "kk": "kk", "CH": "CH", "SS": "SS",
    "nn": "nn", "RR": "RR", "aa": "aa", "E": "E", "ih": "I", "oh": "O", "ou": "U", "I": "I", "O": "O",
    "U": "U",
}  # fmt: skip
# SAPI's numbers, which Azure has, too.
AZURE: dict[str, str] = {
    "0": "sil", "1": "E", "2": "aa", "3": "O", "4": "E", "5": "RR", "6": "I", "7": "U", "8": "O", "9": "aa",
    "10": "O", "11": "aa", "12": "kk", "13": "RR", "14": "nn", "15": "SS", "16": "CH", "17": "TH",
    "18": "FF", "19": "DD", "20": "kk", "21": "PP",
}  # fmt: skip
# Amazon Polly's speech marks.
POLLY: dict[str, str] = {
    "sil": "sil", "p": "PP", "t": "DD", "S": "CH", "T": "TH", "f": "FF", "k": "kk", "i": "I", "r": "RR",
    "s": "SS", "u": "U", "@": "E", "a": "aa", "e": "E", "E": "E", "o": "O", "O": "O",
}  # fmt: skip
# Of ARKit's blend shapes those that make the mouth.
ARKIT: dict[str, str] = {
    "jawOpen": "aa", "mouthClose": "PP", "mouthPressLeft": "PP", "mouthPressRight": "PP",
    "mouthFunnel": "O", "mouthPucker": "U", "mouthRollLower": "FF", "mouthRollUpper": "PP",
    "mouthStretchLeft": "E", "mouthStretchRight": "E", "mouthSmileLeft": "I", "mouthSmileRight": "I",
    "mouthShrugUpper": "CH", "tongueOut": "TH",
}  # fmt: skip
SETS: tuple[str, ...] = ("oculus", "azure", "sapi", "polly", "arkit")
WEAK: dict[str, float] = {"@": 0.6, "12": 0.5, "1": 0.8, "mouthSmileLeft": 0.3, "mouthSmileRight": 0.3}


@dataclass(frozen=True, slots=True)
class SpokenWord:
    """A word from `start` to `end`; `end` is None if only its start is known."""

    text: str
    start: float
    end: float | None = None


@dataclass(frozen=True, slots=True)
class VisemeMark:
    """A mouth shape from `at` until the next mark of a later time. viseme: its name in its set; in a
    `LineTiming`, one of `VISEMES`. weight: how fully it is made, 0..1.
    """

    at: float
    viseme: str
    weight: float = 1.0


@dataclass(frozen=True, slots=True)
class LineTiming:
    """A line's words and mouth shapes, each by time. later: seconds by which later pieces are delayed,
    because one came after its time. paced: whether the times are estimated from the letters.
    """

    words: tuple[SpokenWord, ...] = ()
    marks: tuple[VisemeMark, ...] = ()
    later: float = 0.0
    paced: bool = False


def alike_timings(one: LineTiming | None, other: LineTiming | None) -> bool:
    """Return whether two lines have the same words and shapes at the same times."""
    if one is None or other is None:
        return one is None and other is None
    if len(one.words) != len(other.words) or len(one.marks) != len(other.marks):
        return False
    words = all(
        a.text == b.text and a.start == b.start and a.end == b.end
        for a, b in zip(one.words, other.words, strict=True)
    )
    return words and all(
        a.at == b.at and a.viseme == b.viseme and a.weight == b.weight
        for a, b in zip(one.marks, other.marks, strict=True)
    )


def _table(name: str) -> dict[str, str]:
    if name == "oculus":
        return OCULUS
    if name == "polly":
        return POLLY
    return ARKIT if name == "arkit" else AZURE


def set_of(marks: Sequence[VisemeMark]) -> str:
    """Return the first set that has all of the visemes, "" if none has."""
    for name in SETS:
        if all(mark.viseme in _table(name) for mark in marks):
            return name
    return ""


def wrong_in(
    words: Sequence[SpokenWord], marks: Sequence[VisemeMark], name: str, duration: float | None
) -> str:
    """Return what is wrong with a line's times, where, and what would be right; "" if nothing is wrong.

    name: of the visemes' set, "" to find it by their names. duration: seconds of its sound, None if unknown.
    """
    last = 0.0
    for n, word in enumerate(words):
        place = f"words[{n}] '{word.text}'"
        why = _out_of_range(word.start)
        if why == "" and word.start < last:
            why = f"begins at {word.start:.3f} s, before the one before it; put words in order"
        end = word.start if word.end is None else word.end
        if why == "" and not end >= word.start:
            why = f"ends at {end:.3f} s, before it begins; give [word, start, end] in seconds"
        if why == "" and duration is not None and end > duration + SLACK:
            why = f"ends at {end:.3f} s, past the end at {duration:.3f} s; give a longer duration"
        if why != "":
            return f"{place}: {why}"
        last = word.start
    if name != "" and name not in SETS:
        return f"set: '{name}' is no set of visemes; there are {', '.join(SETS)}"
    found = set_of(marks) if name == "" else name
    last = 0.0
    for n, mark in enumerate(marks):
        why = _out_of_range(mark.at)
        if why == "" and mark.at < last:
            why = f"comes at {mark.at:.3f} s, before the one before it; put visemes in order"
        if why == "" and duration is not None and mark.at > duration + SLACK:
            why = f"comes at {mark.at:.3f} s, past the end at {duration:.3f} s; give a longer duration"
        if why == "" and not 0 <= mark.weight <= 1:
            why = f"has the weight {mark.weight:.3f}; weights are from 0 to 1"
        if why == "" and found == "" and set_of([mark]) == "":
            why = f"is in no set of visemes; there are {', '.join(SETS)}"
        if why == "" and found != "" and mark.viseme not in _table(found):
            why = f"is not in the set '{found}', which has {', '.join(list(_table(found).keys()))}"
        if why != "":
            return f"visemes[{n}] '{mark.viseme}': {why}"
        last = mark.at
    if found == "":
        return f"visemes: no set has all of them; there are {', '.join(SETS)}"
    return ""


def _out_of_range(seconds: float) -> str:
    if 0 <= seconds <= FARTHEST:
        return ""
    return f"is at {seconds:.3f} s; times are from 0 to {FARTHEST:.1f} s from the line's start"


def timing_of(
    alphabet: Alphabet, words: Sequence[SpokenWord], marks: Sequence[VisemeMark], name: str
) -> LineTiming:
    """Return the timing of words and visemes that are valid. name: as for `wrong_in`."""
    table = _table(set_of(marks) if name == "" else name)
    shown = [VisemeMark(m.at, table[m.viseme], m.weight * WEAK.get(m.viseme, 1.0)) for m in marks]
    said: list[SpokenWord] = []
    for n, word in enumerate(words):
        end = word.start + WORD + LETTER * len(alphabet.letters(word.text)) if word.end is None else word.end
        if n + 1 < len(words):
            end = min(end, words[n + 1].start)
        if word.end is None:  # a pause ends it
            end = min(end, next((m.at for m in shown if m.viseme == "sil" and m.at > word.start), end))
        said.append(SpokenWord(word.text, word.start, max(end, word.start)))
    return LineTiming(tuple(said), tuple(shown))


def measure_text(alphabet: Alphabet, text: str) -> float:
    """Return how many seconds a text takes as a part of a longer text."""
    out = 0.0
    for word, pause in split_words(alphabet, text):
        out += _measure_word(alphabet, word) + pause / PACE
    return out


def pace_text(alphabet: Alphabet, text: str, seconds: float | None) -> LineTiming:
    """Return the words of a text, one after the other. seconds: how long all of it takes, None to estimate it
    from the letters.
    """
    scale = 1.0 if seconds is None else seconds / max(measure_text(alphabet, text), 1e-3)
    at = 0.0
    words: list[SpokenWord] = []
    for word, pause in split_words(alphabet, text):
        end = at + scale * _measure_word(alphabet, word)
        if word != "":
            words.append(SpokenWord(word, at, end))
        at = end + scale * pause / PACE
    return LineTiming(tuple(words), (), 0.0, True)


def _measure_word(alphabet: Alphabet, word: str) -> float:
    """Return how long a word takes, seconds."""
    return sum([measure_letter(alphabet.code(letter)) for letter in alphabet.letters(word)]) / PACE


def join_letters(alphabet: Alphabet, letters: Sequence[SpokenWord]) -> list[SpokenWord]:
    """Return the words of letters that have a time each. Blanks separate words, and so does each letter that
    is a syllable.
    """
    out: list[SpokenWord] = []
    parted = True
    for letter in letters:
        if alphabet.stripped(letter.text) == "":
            parted = True
            continue
        alone = measure_letter(alphabet.code(alphabet.letters(letter.text)[0])) > 1
        if parted or alone:
            out.append(letter)
        else:
            last = out[-1]
            out[len(out) - 1] = SpokenWord(last.text + letter.text, last.start, letter.end)
        parted = alone
    return out


def told_text(timing: LineTiming) -> str:
    """Return the words of a line as its text."""
    return " ".join([word.text for word in timing.words])


def timed_seconds(timing: LineTiming, duration: float | None) -> float:
    """Return how long a line lasts, rounded to whole rows of the mouth's track, so that later additions move
    nothing. duration: of its sound, None for as long as its words and shapes need.
    """
    last = _end_of(timing)
    return ceil((last + LATE if duration is None else max(duration, last)) / STEP - 1e-6) * STEP


def timed_sounds(alphabet: Alphabet, timing: LineTiming) -> Spelled:
    """Return the mouth's pieces and the syllables of a line's words and shapes: the mouth follows the shapes
    if there are any; gestures and blinks follow the words.
    """
    out = Spelled()
    for word in timing.words:
        plan = sounds(alphabet, word.text)
        over = word.start if word.end is None else word.end
        if len(plan) > 0 and over > word.start:
            out.add(plan, word.start, over)
    if len(timing.marks) == 0:
        return out
    shown = Spelled()
    before = "sil"
    for mark, end in zip(timing.marks, _ends(timing.marks), strict=True):
        if mark.viseme != "sil" and end > mark.at:
            shown.pieces.append(MouthPiece(mark.at, end, mark.viseme, mark.weight))
            if mark.viseme in VOWELS and before not in VOWELS and mark.weight > 0:
                shown.peaks.append(0.5 * (mark.at + end))
                shown.strengths.append(mark.weight * min(1.0, 0.3 + 4 * (end - mark.at)))
        before = mark.viseme
    if len(out.peaks) > 0:
        return Spelled(shown.pieces, out.peaks, out.strengths)
    return shown


def _ends(marks: Sequence[VisemeMark]) -> list[float]:
    """Return when each mark ends: marks at the same time show together."""
    out: list[float] = []
    end, at = 0.0, -1.0
    for mark in reversed(marks):
        if mark.at != at:
            end = mark.at + SHAPE if at < 0 else at
            at = mark.at
        out.append(end)
    return list(reversed(out))


def tells_on(old: LineTiming, new: LineTiming) -> bool:
    """Return whether a piece that comes after the end of a line belongs to the same line: it begins after the
    last known word or shape, or repeats all with more behind it. Otherwise it is something else under the
    same id.
    """
    if len(new.words) > 0 and len(old.words) > 0:
        first = new.words[0]
        if first.start > old.words[-1].start:
            return True
        same = first.text == old.words[0].text and first.start == old.words[0].start
        return same and len(new.words) > len(old.words)
    if len(new.marks) > 0 and len(old.marks) > 0:
        shape = new.marks[0]
        if shape.at >= old.marks[-1].at - AGAIN:
            return True
        return shape.at == old.marks[0].at and len(new.marks) > len(old.marks)
    return False


def shifted(timing: LineTiming, by: float) -> LineTiming:
    """Return a timing `by` seconds later."""
    if by == 0:
        return timing
    words = [
        SpokenWord(word.text, word.start + by, None if word.end is None else word.end + by)
        for word in timing.words
    ]
    return LineTiming(tuple(words), tuple([replace(mark, at=mark.at + by) for mark in timing.marks]))


def place_told(old: LineTiming, new: LineTiming, said: float) -> LineTiming:
    """Return a later piece of a line with the times at which it is said. A piece that counts from its own
    beginning follows the earlier pieces. A piece that comes too late, because the voice had stopped, is said
    at once, and everything after it is delayed. said: seconds of the line that are over.
    """
    end = _end_of(old)
    if restarts(old, new, said):
        return replace(shifted(new, max(said, end)), later=old.later)
    told = shifted(new, old.later)
    by = 0.0
    if len(old.words) > 0 and len(told.words) > 0:
        words = [word for word in told.words if word.start > old.words[-1].start]
        if len(words) > 0 and comes_late(words[0].start, max([_end(word) for word in words]), end, said):
            by = max(said, end) - words[0].start
    elif len(old.marks) > 0 and len(told.marks) > 0:
        marks = [mark for mark in told.marks if mark.at > old.marks[-1].at]
        if len(marks) > 0 and comes_late(marks[0].at, marks[-1].at + SHAPE, end, said):
            by = max(said, end) - marks[0].at
    return replace(shifted(told, by), later=old.later + by)


def comes_late(first: float, last: float, silent: float, said: float) -> bool:
    """Return whether what is new of a line comes too late: all of it, or its beginning after the voice had
    stopped. first, last: when it would begin and end; silent: when what was known before ends; said: as for
    `place_told`.
    """
    return last <= said or (first < said - MISSED and silent <= said)


def restarts(old: LineTiming, new: LineTiming, said: float) -> bool:
    """Return whether a piece of a line counts its times from 0 again: it lies at the beginning of the line,
    but does not repeat it.
    """
    if len(old.words) > 0 and len(new.words) > 0:
        same = 0
        while same < min(len(old.words), len(new.words)) and _alike(old.words[same], new.words[same]):
            same += 1
        again = same > 0 and len(new.words) >= len(old.words)
        return same < len(new.words) and not again and new.words[0].start < _end(old.words[0])
    if len(old.marks) > 0 and len(new.marks) > 0:
        again = all(
            a.viseme == b.viseme and abs(a.at - b.at) < SLACK
            for a, b in zip(old.marks, new.marks, strict=False)
        )
        first = new.marks[0].at
        return not again and first < old.marks[0].at + SLACK and first < said
    return False


def _alike(one: SpokenWord, other: SpokenWord) -> bool:
    return one.text == other.text and abs(one.start - other.start) < SLACK


def _end(word: SpokenWord) -> float:
    return word.start if word.end is None else word.end


def _end_of(timing: LineTiming) -> float:
    """Return when the last word or shape ends."""
    end = max([0.0, *[_end(word) for word in timing.words]])
    if len(timing.marks) > 0:
        mark = timing.marks[-1]
        end = max(end, mark.at + (0.0 if mark.viseme == "sil" else SHAPE))
    return end


def extended(old: LineTiming, new: LineTiming, said: float) -> LineTiming:
    """Return a line's timing with a later piece: the old timing stays up to `said` seconds, and up to the
    beginning of the new piece. Of a word or shape that has begun meanwhile, the rest is said.
    """
    words = list(old.words)
    begun = max([-1.0, *[word.start for word in old.words if word.start < said]])
    coming = [
        word
        for word in new.words
        if word.start >= said
        or (word.start > begun and (word.start if word.end is None else word.end) > said)
    ]
    if len(coming) > 0:
        until = max(said, new.words[0].start)
        first = max(coming[0].start, said)
        words = [
            replace(word, end=min(first if word.end is None else word.end, first))
            for word in old.words
            if word.start < until
        ]
        words.extend([replace(word, start=max(word.start, said)) for word in coming])
    marks = list(old.marks)
    now = max([-1.0, *[mark.at for mark in new.marks if mark.at < said]])
    over = max([-1.0, *[mark.at for mark in old.marks if mark.at < said]])
    shown = [
        replace(mark, at=max(mark.at, said))
        for mark in new.marks
        if mark.at >= said or (mark.at == now and now >= over and not _told(old.marks, mark))
    ]
    if len(shown) > 0:
        until = max(said, new.marks[0].at)
        marks = [mark for mark in old.marks if mark.at < until]
        marks.extend(shown)
    return LineTiming(tuple(words), tuple(marks), new.later)


def _told(marks: Sequence[VisemeMark], mark: VisemeMark) -> bool:
    return any(m.at == mark.at and m.viseme == mark.viseme for m in marks)
