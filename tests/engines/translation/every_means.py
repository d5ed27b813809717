"""All that may be written in a translated module, each with what it gives as a text."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right, insort
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

STEP = 0.1  # a number
WORDS: tuple[str, ...] = ("b", "a", "c")


@dataclass(frozen=True)
class Mark:
    """A value with a default of each kind."""

    name: str
    start: float
    length: float | None = None
    tags: tuple[str, ...] = ()
    part: int = 0

    @property
    def end(self) -> float:
        """When it is over."""
        return self.start + (STEP if self.length is None else self.length)

    @property
    def key(self) -> str:
        """Its name with its part."""
        return self.name if self.part == 0 else f"{self.name}+{self.part}"

    def after(self, seconds: float) -> bool:
        """Whether it comes after a time."""
        return self.start > seconds


@dataclass
class Tally:
    """What changes."""

    count: int = 0
    seen: dict[str, int] = field(default_factory=dict)

    def whole(self) -> Tally:
        """Itself."""
        return self

    def add(self, word: str) -> None:
        """Count a word."""
        self.count += 1
        self.seen[word] = self.seen.get(word, 0) + 1


def _yes(holds: bool) -> str:
    return "yes" if holds else "no"


def sums() -> str:
    """Numbers with fractions are not to be taken together otherwise."""
    a, b, c = 0.1, 0.2, 0.3
    return (
        f"{(a + (b + c) - (a + b + c)) * 1e17:.2f} {(a - (b - c)) * 10.0:.2f} {1 / 4:.2f} {-7 // 2} {-7 % 3}"
    )


def texts() -> str:
    """Texts: order by code points, parts, whole words."""
    high, low = "\U0001f600", "\uffee"
    order = "low first" if low < high else "high first"
    joined = "-".join(sorted(WORDS, key=lambda w: w))
    words = ["two", "words"]
    begins = "yes" if joined.startswith("a-") else "no"
    return (
        f"{order} {joined} {len(words)} {words[-1].strip()} {begins} {_yes('b' in joined)} {12!s}{int('7')}"
    )


def lists() -> str:
    """Lists: parts, places, order."""
    numbers = [3, 1, 2]
    numbers.append(5)
    numbers += [4]
    some = numbers[1:3]
    last = numbers[-1]
    gone = numbers[:-1]
    numbers.pop()
    pairs = [Mark("x", 2.0), Mark("y", 1.0), Mark("w", 1.0)]
    names = [m.name for m in sorted(pairs, key=lambda m: (m.start, m.name))]
    place = bisect_right([1.0, 2.0, 2.0], 2.0) + bisect_left([1.0, 2.0, 2.0], 2.0)
    back = [n for n in reversed(some)]
    return f"{'-'.join(names)} {some[0]}{some[1]} {last} {len(gone)} {len(numbers)} {place} {back[0]} {sum(numbers)}"


def _by_start(mark: Mark) -> tuple[float, str]:
    return mark.start, mark.name


def queues() -> str:
    """Put where it belongs, behind those alike, and not before a place."""
    queue = sorted([Mark("b", 1.0), Mark("a", 3.0)], key=_by_start)
    insort(queue, Mark("c", 0.5), lo=1, key=_by_start)
    insort(queue, Mark("b", 1.0, part=1), lo=0, key=_by_start)
    return " ".join(m.key for m in queue)


def maps() -> str:
    """Maps keep the order in which they were filled."""
    seen = {"z": 1, "a": 2}
    seen["m"] = 3
    by_length = {f"{n}": len(w) for n, w in enumerate(["one", "three"])}
    inside = {w for w in ["q", "q", "r"]}
    other = seen.get("none")
    told = "none" if other is None else f"{other + 1}"
    every = [f"{k}{v}" for k, v in seen.items()]
    more = [k for k in seen]
    return f"{' '.join(every)} {len(by_length)} {by_length['1']} {len(inside)} {told} {seen.get('a', 9)} {more[0]} {_yes('m' in seen)}"


def nothing(found: Mark | None = None, length: float | None = None) -> str:
    """What may be missing."""
    if found is None:
        found = Mark("made", 0.0, length)
    if found.length is not None and found.length > 1.0:
        return f"{found.length:.1f}"
    known = 0.0 if length is None else length + 1.0
    return f"{found.name} {known:.1f}"


def missing() -> str:
    """With and without."""
    return f"{nothing()} {nothing(Mark('given', 1.0, 2.0))} {nothing(length=0.5)}"


def records() -> str:
    """Values and what changes."""
    mark = Mark("one", 1.0, tags=("t",), part=2)
    moved = replace(mark, start=2.0, length=3.0)
    tally = Tally()
    for word in ("x", "y", "x"):
        tally.add(word)
    again = Tally(5)
    return (
        f"{mark.key} {mark.end:.1f} {moved.end:.1f} {_yes(moved.after(1.5))} {tally.count} {tally.seen['x']} "
        f"{len(again.seen)} {again.count} {len(moved.tags)}"
    )


def _swapped(a: int, b: int) -> tuple[int, int]:
    a, b = b, a
    return a, b


def loops() -> str:
    """Loops, with what is set in them and read after."""
    total, out = 0, ""
    for n in range(2, 9):
        if n == 3:
            continue
        if n > 6:
            break
        last = n
        total += last
    for place, pair in enumerate([("a", 1), ("b", 2)]):
        name, value = pair
        out += f"{place}{name}{value}"
    for a, b in zip([1, 2], [10, 20], strict=True):
        total += a * b
    one, two = _swapped(1, 2)
    low, high = _swapped(3, 4)  # taken apart, and changed afterwards
    if low > high:
        low, high = high, low
    out += f"<{low}{high}>"
    before = 0
    for n in [1, 2, 3]:
        out += f"/{before}"
        before = n
    while any(n > total for n in [60, 70]):
        total += 5
    return f"{total} {out} {one}{two} {last}"


def searches(numbers: Sequence[float] = (0.5, 1.5, 2.5), empty: Sequence[float] = ()) -> str:
    """Searches end at the first, and are not begun where it does not matter."""
    first = next((n for n in numbers if n > 1.0), -1.0)
    none = next((n for n in numbers if n > 9.0), None)
    guarded = len(empty) > 0 and any(n > empty[0] for n in numbers)
    chosen = "many" if len(numbers) > 2 and all(n > 0 for n in numbers) else "few"
    either = max([n * 2.0 for n in numbers if n < 2.0]) if any(n < 2.0 for n in numbers) else 0.0
    flat = [a + b for a in numbers if a < 2.0 for b in (10.0, 20.0)]
    return f"{first:.1f} {_yes(none is None)} {_yes(guarded)} {chosen} {either:.1f} {len(flat)} {flat[-1]:.1f} {max(1.0, 3.0, 2.0):.1f}"


def chains(seen: Mapping[str, int] | None = None) -> str:
    """Comparisons in a row, and tests of several."""
    n = 3
    inside = 0 <= n < 5 and not n == 4
    words = "some" if WORDS else "none"
    limit = math.inf if n > 2 else 1.0
    root = math.sqrt(16.0) + math.floor(2.7) + abs(-1.5)
    return f"{_yes(inside)} {words} {_yes(limit > 1e9)} {root:.1f} {_yes(seen is None)} {n if inside else -n}"


def waves() -> str:
    """Sines, and a text's last part."""
    before, dot, number = "a.b.12".rpartition(".")
    none, nothing, all_of_it = "ab".rpartition(".")
    digits = f"{_yes(number.isdigit())}{_yes(before.isdigit())}{_yes(none.isdigit())}"
    return f"{math.sin(math.pi / 6.0):.3f} {before} {dot} {number} {none}{nothing}{all_of_it} {digits}"


def selves() -> str:
    """The same, or only alike; lists of one's own; places by a key."""
    one, alike, tally = Mark("a", 1.0), Mark("a", 1.0), Tally()
    marks = [one, Mark("b", 2.0), Mark("c", 3.0)]
    mine = list(marks)
    mine.append(alike)
    tally.whole().add("x")
    places = bisect_right(marks, 2.0, key=lambda m: m.start) * 10 + bisect_left(
        marks, 2.0, key=lambda m: m.start
    )
    return f"{_yes(marks[0] is one)}{_yes(one is alike)}{_yes(one is not alike)} {len(marks)} {tally.count} {places}"


def products(factors: Sequence[float] = (0.5, 1.5), neutral: bool = False) -> str:
    """Products that are longer than a line is in any language."""
    weights = {
        f"{n:.1f}": (n + 1.0)
        / max(abs(n - 2.0), 1.0)
        * (1.0 if neutral else max(min(n * 3.0, 10.0 - n), n / 7.0 + 1.5))
        for n in factors
    }
    return " ".join([f"{name} {weight:.3f}" for name, weight in weights.items()])


MEANS = (waves, products, selves, sums, texts, lists, queues, maps, missing, records, loops, searches, chains)
