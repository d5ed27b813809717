"""What stands of a name in a space that is smaller than it: all of it in two lines, else whole words that
none of its neighbours has.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache

from app.look.names import GAP, measured
from app.look.plural import parts

LEAST = 3  # letters that still say something; 2 of scripts in which a letter says more


def chip(
    text: str, width: float, lines: int, measure: Callable[[str], float], others: Iterable[str] = ()
) -> tuple[str, ...]:
    """Return the lines that stand in a space, at most so many of a width: all of a text, else the longest run
    of its words that none of the others has, a number even where no more has room, else the beginning of a
    word that begins no word of theirs; () where nothing of it tells it apart.
    """
    if (whole := _broken(text, width, lines, measure)) is not None:
        return whole
    words, rivals = parts(text), [[word for word, *_ in parts(o)] for o in {*others} - {text}]
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
    return best[2] or _beginning(text, width, measure, rivals)


def _beginning(
    text: str, width: float, measure: Callable[[str], float], rivals: Sequence[Sequence[str]]
) -> tuple[str, ...]:
    """Return as much of a word as there is room for, where that begins no other's."""
    theirs, best = {word for rival in rivals for word in rival}, ""
    for _, begin, end in parts(text):
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
    """Return a text in as few lines as take it whole, broken between words; None where none do."""
    if measure(text) <= width:
        return (text,)
    if lines < 2:
        return None
    for _, begin, _ in reversed(parts(text)):
        head = text[:begin].rstrip()
        if head.strip(GAP) and measure(head) <= width:
            rest = _broken(text[begin:], width, lines - 1, measure)
            return (head, *rest) if rest is not None else None
    return None


@lru_cache(maxsize=8192)
def chipped(text: str, width: int, lines: int, font: str, others: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Return `chip` in a font, given as `QFont.toString` does; made once."""
    return chip(text, width, lines, measured(font).horizontalAdvance, others)
