"""What is shown of words that are longer than their room: cut in the middle, in whole words, or over lines;
what tells them apart from their neighbours is still seen.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache

from PySide6.QtGui import QFont, QFontMetricsF

from app.look.plural import split_name_at

GAP = "…"
LEAST = 3  # letters that still say something; 2 of scripts in which a letter says more


def shorten_middle(
    text: str, width: float, measure: Callable[[str], float], others: Iterable[str] = (), sure: bool = False
) -> str:
    """Return as much of a text as a width has room for, its middle left out, or both ends. others: what
    stands beside it; what is left is to be none of theirs, if that can be. sure: "" if it cannot.
    """
    if measure(text) <= width:
        return text
    if measure(GAP) > width:
        return ""
    rivals = [o for o in set(others) if o != text]
    whole = len(text)
    found: list[tuple[int, int, int, int]] = []  # collisions, letters lost, how uneven, letters in front
    tail = whole
    for head in range(whole):
        while tail and measure(text[:head].rstrip() + GAP + _end(text, tail)) > width:
            tail -= 1
        if measure(text[:head].rstrip() + GAP + _end(text, tail)) > width:
            break
        last = min(tail, whole - head - 1)
        begin, end = text[:head].rstrip(), _end(text, last)
        alike = sum(1 for o in rivals if o.startswith(begin) and o.endswith(end))
        found.append((alike, whole - head - last, abs(head - last), head))
    if not found:
        return "" if sure else GAP
    alike, lost, _, head = min(found, key=lambda f: (f[0], f[1] // 3, f[2]))
    best = text[:head].rstrip() + GAP + _end(text, whole - head - lost)
    if alike:
        same, inner = _inner(text, width, measure, rivals)
        if same < alike:
            alike, best = same, inner
    return "" if sure and alike else best


def _inner(
    text: str, width: float, measure: Callable[[str], float], rivals: Sequence[str]
) -> tuple[int, str]:
    """Return the part of a text that fewest rivals have, both ends left out, after how many have it."""
    starts = {_common(text, o) for o in rivals} | {
        text.rfind(" ", 0, _common(text, o) + 1) + 1 for o in rivals
    }
    best = len(rivals) + 1, 0, ""
    for start in sorted(starts):
        end = start
        while end < len(text) and measure(GAP + text[start : end + 1] + GAP) <= width:
            end += 1
        piece = text[start:end].strip()
        if len(piece) < 2:
            continue
        alike = sum(1 for o in rivals if piece in o)
        front, back = GAP if start else "", GAP if end < len(text) else ""
        best = min(best, (alike, -len(piece), front + piece + back))
    return best[0], best[2]


def _common(one: str, other: str) -> int:
    """Return how many letters two texts begin with alike."""
    return next(
        (n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other))
    )


def _end(text: str, letters: int) -> str:
    return text[len(text) - letters :].lstrip() if letters else ""


def break_at_words(
    text: str, width: float, lines: int, measure: Callable[[str], float], others: Iterable[str] = ()
) -> tuple[str, ...]:
    """Return the lines that stand in a space, at most so many of a width: all of a text, else the longest run
    of its words that none of the others has, a number even where no more has room; () where none has room.
    """
    if (whole := _broken(text, width, lines, measure)) is not None:
        return whole
    words, rivals = split_name_at(text), _rivals(text, others)
    best: tuple[int, int, tuple[str, ...]] = (0, 0, ())
    for first, (_, begin, _) in enumerate(words):
        for last, (_, _, end) in enumerate(words[first:], first):
            run, piece = [word for word, *_ in words[first : last + 1]], text[begin:end]
            number = all(word.isdecimal() for word in run)
            if any(_holds(r, run) for r in rivals) or not (number or _tells(piece)):
                continue
            shown = f"{GAP if begin else ''}{piece}{GAP if end < len(text) else ''}"
            made = _broken(shown, width, lines, measure)
            if made is None and number:
                made = _broken(piece, width, lines, measure)
            if made is not None:
                best = max(best, (end - begin, -first, made), key=lambda b: b[:2])
    return best[2]


def shorten_to_lines(
    text: str, width: float, lines: int, measure: Callable[[str], float], others: Iterable[str] = ()
) -> tuple[str, ...]:
    """Return `break_at_words`, else the beginning of a word that begins no word of the others; () if nothing
    of a text tells it apart.
    """
    return break_at_words(text, width, lines, measure, others) or _beginning(
        text, width, measure, _rivals(text, others)
    )


def _rivals(text: str, others: Iterable[str]) -> list[list[str]]:
    return [[word for word, *_ in split_name_at(o)] for o in {*others} - {text}]


def _beginning(
    text: str, width: float, measure: Callable[[str], float], rivals: Sequence[Sequence[str]]
) -> tuple[str, ...]:
    """Return as much of a word as there is room for, where that begins no other's."""
    theirs, best = {word for rival in rivals for word in rival}, ""
    for _, begin, end in split_name_at(text):
        last = end
        while last > begin and measure(f"{GAP if begin else ''}{text[begin:last]}{GAP}") > width:
            last -= 1
        piece = text[begin:last]
        if _tells(piece) and not any(w.startswith(piece.lower()) for w in theirs):
            best = max(best, f"{GAP if begin else ''}{piece}{GAP}", key=lambda b: len(b.strip(GAP)))
    return (best,) if best else ()


def _tells(piece: str) -> bool:
    letters = sum(c.isalpha() for c in piece)
    return letters >= (LEAST if piece.isascii() else LEAST - 1)


def _holds(words: Sequence[str], run: Sequence[str]) -> bool:
    """Return whether words stand among others, one after the other."""
    n = len(run)
    return any(words[i : i + n] == list(run) for i in range(len(words) - n + 1))


def _broken(text: str, width: float, lines: int, measure: Callable[[str], float]) -> tuple[str, ...] | None:
    """Return a text in as few lines as take it whole, broken between words; None if none do."""
    if measure(text) <= width:
        return (text,)
    if lines < 2:
        return None
    for _, begin, _ in reversed(split_name_at(text)):
        head = text[:begin].rstrip()
        if head.strip(GAP) and measure(head) <= width:
            rest = _broken(text[begin:], width, lines - 1, measure)
            return (head, *rest) if rest is not None else None
    return None


@lru_cache(maxsize=8192)
def shorten_to_font(
    text: str, width: int, font: str, others: tuple[str, ...] = (), sure: bool = False
) -> str:
    """Return as much of a text as there is room for in a font, given as `QFont.toString` does: whole words
    that none of the others has, where it has such, else `fitting`; made once.
    """
    measure = measure_font(font).horizontalAdvance
    whole = break_at_words(text, width, 1, measure, others) if others else ()
    return whole[0] if whole else shorten_middle(text, width, measure, others, sure)


@lru_cache(maxsize=8192)
def shorten_to_lines_in_font(
    text: str, width: int, lines: int, font: str, others: tuple[str, ...] = ()
) -> tuple[str, ...]:
    """Return `chip` in a font, given as `QFont.toString` does; made once."""
    return shorten_to_lines(text, width, lines, measure_font(font).horizontalAdvance, others)


@lru_cache(maxsize=8)
def measure_font(font: str) -> QFontMetricsF:
    """Return the measures of a font, given as `QFont.toString` does."""
    made = QFont()
    made.fromString(font)
    return QFontMetricsF(made)
