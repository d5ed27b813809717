"""What single rules are asked in conformance: numbers and texts on both sides of each boundary, with the
answers. They are the same for every character.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise, product
from random import Random
from typing import Any

from metagraph.engines.single_rules import OPEN, answer_rule
from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.planning.hashing import Bits

SEED = 7
Numbers = list[float]
Row = tuple[str, Numbers, list[str]]

NONE = 9.0  # in the place of a part of a mood that is not told
STILL = [0.0, 0.0, 0.0, 1.0]
TEXTS = (
    "Hello, my friend - how are you?",
    "Accommodate a bee; see the tree. The apple: a queue! Nations, through, though…",
    "Eye key. Tax, judge, why, quick, ship, patch, night, sing, whale, book, cow, boy, day, they",
    "ΑΒΓΔ Ελληνικά; Юля щёлкает, объём. Ґанок її",
    "日本語です。はい！ 안녕하세요? ｶﾅ ー Ａ1 23",
    "Հայաստան և այլն. თბილისი ᲗᲑ ᾳ ŉ ǰ ﬁn ß Straße ŀ",
    "(a) “b” — c – d-e'f ’g. ...",
    "नमस्ते สวัสดี שלום مرحبا",
    "E. e ee me the Zoe, aa bb",
    "hmm",
    "?!",
    "",
    " a ",
)


def list_rule_rows() -> list[list[Any]]:
    """Return rows: a rule, the seed, numbers, texts, and its answer."""
    out = []
    chance = Random(50)
    for part in (_directions, _lines, _arms, _bodies, _steps, _spans, _mouths, _letters, _times_told):
        for rule, numbers, texts in part(chance):
            out.append(_row(rule, numbers, texts))
    for rule, numbers, texts in (*_pieces(chance), *_moods(chance), *_intervals()):
        out.append(_row(rule, numbers, texts))
    return out


def find_rule_answer(row: Sequence[Any]) -> list[float]:
    """Return the answer to a row."""
    rule, seed, numbers, texts = row[:4]
    found = answer_rule(ALPHABET, Bits(seed), rule, [float(x) for x in numbers], list(texts))
    return [round(float(x), 7) for x in found]


def _row(rule: str, numbers: Sequence[float], texts: Sequence[str]) -> list[Any]:
    short = [int(x) if float(x).is_integer() else x for x in numbers]
    row = [rule, SEED, short, list(texts)]
    return [*row, [int(x) if x.is_integer() else x for x in find_rule_answer(row)]]


def _some(chance: Random, size: float, count: int = 3) -> Numbers:
    """Return numbers with few binary digits, which all languages read alike."""
    return [round(chance.uniform(-size, size) * 256) / 256 for _ in range(count)]


def _turned(chance: Random, size: float) -> Numbers:
    return [*_some(chance, size), chance.choice((1.0, 1.0, -1.0))]


# --- directions, and lines of capsules


def _directions(chance: Random) -> Iterator[Row]:
    axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
    across = [
        [0.94, 0.3, 0.16],
        [-0.94, 0.2, -0.28],
        [0.87, -0.4, 0.29],
        [0.89, 0.456, 0.0],
        [0.3, -0.9, 0.3],
    ]
    for a in (*axes, *across):
        yield "between", [*a, *(-x for x in a)], []
        yield "between", [*a, *a], []
    for n in range(8):
        yield "between", [*_some(chance, 1.0), *_some(chance, 1.0)], []
        yield "unit", [*_some(chance, 4.0 / 4**n), *_some(chance, 4.0 / 4**n, 4)], []
    yield "unit", [0.0] * 7, []


def _lines(chance: Random) -> Iterator[Row]:
    points = [0.0, 0.0, 0.0]
    for _ in range(40):
        a, b, c, d = (_some(chance, 1.0) for _ in range(4))
        yield "apart", [*a, *b, *c, *d], []
    for n in range(12):  # without length, one or both, before, beside and behind the other
        a, b = _some(chance, 1.0), _some(chance, 1.0)
        beside = [x + (y - x) * (n - 3) / 4 + 0.25 for x, y in zip(a, b, strict=True)]
        yield "apart", [*a, *b, *beside, *beside], []
        yield "apart", [*beside, *beside, *a, *b], []
        along = [y - x for x, y in zip(a, b, strict=True)]
        far = [x + y for x, y in zip(beside, along, strict=True)]
        yield "apart", [*a, *b, *beside, *far], []
        yield "apart", [*a, *b, *far, *beside], []
    for n in range(8):  # short ones that are nearly parallel to others
        slant = [0.03125, 0.0078125 * 0.25**n, 0.0]
        ends = [0.0, 0.0625, 0.0, 0.25, 0.0625, 0.0, *points, *slant]
        yield "apart", ends, []
        yield "apart", [*ends[6:], *ends[:6]], []
    yield "apart", [*points, *points, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5], []
    yield "apart", [*points, *points, *points, *points], []


# --- arms

LIMBS = ((3, 4, 5, (3, 4, 5, 9)), (6, 7, 8, (6, 7, 8)))
PARENTS = (-1, 0, 1, 1, 3, 4, 1, 6, 7, 5)
BONES = (
    [0.0, 1.0, 0.0],
    [0.0, 0.25, 0.0],
    [0.0, 0.3125, 0.0],
    [0.1875, 0.1875, 0.0],
    [0.25, 0.0, 0.0],
    [0.25, 0.0, 0.0],
    [-0.1875, 0.1875, 0.0],
    [-0.25, 0.0, 0.0],
    [-0.25, 0.0, 0.0],
    [0.0625, 0.0, 0.0],
)


def _skeleton(
    turns: Sequence[Sequence[float]],
    bones: Sequence[Sequence[float]] = BONES,
    parents: Sequence[int] = PARENTS,
) -> Numbers:
    out: Numbers = [float(len(bones))]
    for up, bone, turn in zip(parents, bones, turns, strict=True):
        out += [float(up), *bone, *turn]
    for upper, lower, hand, below in LIMBS:
        out += [upper, lower, hand, len(below), *below]
    return out


def _capsules(chance: Random, thick: float) -> Numbers:
    """Return capsules: trunk, head, forearms and hands, some of them balls."""
    nothing = [0.0, 0.0, 0.0]
    rows: list[Numbers] = [
        [0, 0.0, -0.125, 0.0, 1, 0.0, 0.125, 0.0, thick, -1, 0],
        [2, 0.0, 0.0625, 0.0, 2, 0.0, 0.0625, 0.0, 0.75 * thick, -1, 0],
        [4, *nothing, 5, *nothing, 0.046875, 0, 1],
        [7, *nothing, 8, *nothing, 0.046875, 1, 1],
        [5, *nothing, 9, *nothing, 0.0390625, 0, 2],
        [8, *nothing, 8, -0.0625, 0.0, 0.0, 0.0390625, 1, 2],
        [3, *nothing, 4, *nothing, 0.0625, 0, 0],
        [6, *nothing, 7, *nothing, 0.0625, 1, 0],
    ]
    if chance.random() < 0.25:
        rows[5] = [8, *nothing, 8, *nothing, 0.0625, 1, 2]  # a ball
    if chance.random() < 0.2:
        rows[3] = [7, *nothing, 7, *nothing, 0.0625, 1, 1]
    if chance.random() < 0.4:  # a long bar, whose ball is far larger than a limb's
        rows.append([0, -1.5, 0.25, 0.125, 0, 1.5, 0.25, 0.125, 0.03125, -1, 0])
    return [float(len(rows)), *(x for row in rows for x in row)]


def _arms(chance: Random) -> Iterator[Row]:
    for n in range(56):
        bent = n % 4 != 3
        turns = [_turned(chance, 0.125) if k < 3 else _turned(chance, 0.75) for k in range(len(BONES))]
        if not bent:  # straight arms, whose side is given
            turns = [STILL if k in (4, 7) else turn for k, turn in enumerate(turns)]
        if n % 2:  # hands before the belly, where they meet
            turns[3], turns[6] = [0.25, -0.75, -0.375, 1.0], [0.25, 0.75, 0.375, 1.0]
            turns[4], turns[7] = (
                [0.0, -0.5 - n / 128, *_some(chance, 0.125, 1), 1.0],
                [0.0, 0.625, 0.0625, 1.0],
            )
        if n % 8 == 5:  # above the head
            turns[3], turns[6] = [0.125, -0.125, 0.75, 1.0], [0.0, 0.25, -0.625, 1.0]
        goals: list[Numbers] = []
        for k in range((0, 1, 2, 3)[n % 4]):
            arm = (n + k) % 2
            to = chance.choice((1, 2, 0, 7 if arm == 0 else 4, 8 if arm == 0 else 5))
            weight = chance.choice((0.0, 0.25, 0.5, 1.0, 1.0))
            goals.append([arm, to, *_some(chance, 0.1875), *_turned(chance, 1.0), weight])
        numbers = [*_skeleton(turns), *_capsules(chance, 0.125 + n / 512), float(n % 5 != 4)]
        yield "contacts", [*numbers, len(goals), *(x for goal in goals for x in goal)], []
    for n in range(40):
        turns = [_turned(chance, 0.25) for _ in BONES]
        bones = [list(bone) for bone in BONES]
        if n % 3 == 0:
            turns[4] = turns[7] = STILL
        if n in (5, 6, 7, 8):  # bones without length, and a hand on its shoulder
            bones[(4, 5, 7, 8)[n - 5]] = [0.0, 0.0, 0.0]
        if n == 9:
            turns[4] = [0.0, 1.0, 0.0, 0.0]
        size = (0.0625, 0.25, 0.5, 2.0)[n % 4]
        shoulder = [0.1875 if n % 2 == 0 else -0.1875, 1.4375, 0.0]
        goal = [x + y for x, y in zip(shoulder, _some(chance, size), strict=True)]
        side_of = [0.0, 0.0, 0.0] if n % 7 == 6 else _some(chance, 1.0)
        parents = list(PARENTS)
        if n % 5 == 4:  # arms without a body
            parents[3] = parents[6] = -1
        numbers = [
            *_skeleton(turns, bones, parents),
            0.0,
            0.0,
            float(n % 2),
            *goal,
            *_turned(chance, 1.0),
            *side_of,
        ]
        yield "bring", numbers, []


# --- a body on its legs

LEGS = (
    [0.0, 1.0, 0.0],
    [0.0, 0.25, 0.0],
    [0.0, 0.3125, 0.0],
    [0.125, -0.0625, 0.0],
    [0.0, -0.4375, 0.0],
    [0.0, -0.4375, 0.0],
    [-0.125, -0.0625, 0.0],
    [0.0, -0.4375, 0.0],
    [0.0, -0.4375, 0.0],
    [0.0, 0.0, 0.125],
)
UNDER = (-1, 0, 1, 0, 3, 4, 0, 6, 7, 5)


def _bodies(chance: Random) -> Iterator[Row]:
    for n in range(60):
        bend = (0.0, 0.0625, 0.25, 0.375, 0.5, 1.0)[n % 6]  # from straight legs to a squat
        turns: list[Sequence[float]] = [_turned(chance, 0.0625) for _ in LEGS]
        for knee, hip in ((4, 3), (7, 6)):
            turns[knee] = [bend, 0.0, 0.0, 1.0]
            turns[hip] = [-0.5 * bend, *_some(chance, 0.03125, 2), 1.0]
        if n % 10 == 9:
            turns[0] = [1.0, 0.0, 0.0, 1.0]  # it lies
        rooted = n % 4 == 3
        out: Numbers = [float(len(LEGS))]
        for k, (up, bone, turn) in enumerate(zip(UNDER, LEGS, turns, strict=True)):
            place = (1 if k == 0 else 0 if k == 1 else up) if rooted else up
            place = -1 if rooted and k == 0 else 0 if rooted and k == 1 else up
            out += [float(place), *bone, *turn]
        for upper, lower, hand, below in LIMBS:
            out += [upper, lower, hand, len(below), *below]
        out += [0.0, 0.0]
        hips = 1 if rooted else 0
        axes = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        out += [2.0, hips, *axes, 1.0, 2 - hips, *axes, -0.75]
        out += [2.0, 2, 9, 0.0, 0.0, 1.0, 0, 1, 2, 0.0, 0.0, float(n % 5 != 4), 1]
        out += [0.0, 0.0, 1.0, 0.25, 0.125, 0.125, 0.0, 1.0, -0.25, 0.0625]
        out += [1.75, (1.0, 0.75, 0.0)[0 if n % 3 else n % 9 // 3]]
        if n % 2 == 0:
            size = (0.0, 0.0078125, 0.03125, 0.25)[n // 2 % 4]
            drive = _some(chance, size, 16)
            yield "weight", [*out, *drive, chance.choice((0.0, 1.0, 1.5)), chance.choice((0.0, 1.0, 2.0))], []
            continue
        sinks = [*_some(chance, 0.125, 1), 0.0625, 0.0, (0.75, 0.875, 0.90625)[n % 3], 0.125]
        sinks += [0.0, 2.0 if n % 7 == 0 else 0.0, 0.5 if n % 5 == 0 else 0.0, 0.875, (0.0, 0.0625)[n % 2]]
        if n % 4 == 1:
            sinks[:5] = [0.9375 + n / 2048, 0.0625, 0.0, 0.875, 0.125]  # farther aside than a leg is long
        near = (0.0, 0.0078125, 0.0625, 0.25)[n // 2 % 4]
        feet: Numbers = []
        for side in (0.125, -0.125):
            at = [side, 0.0625, 0.0]
            feet += [x + y for x, y in zip(at, _some(chance, near), strict=True)]
            feet += [
                *_turned(chance, near),
                chance.choice((0.0, 0.5, 1.0, 1.0)),
                chance.choice((0.0, 0.03125)),
            ]
        count = 0.0 if n % 20 == 19 else 2.0
        yield "feet", [*out, *sinks, count, *(feet if count else ()), (1.0, 0.5, 0.0)[0 if n % 8 else 2]], []


def _foot(chance: Random, at: Sequence[float], size: float, planted: float = 1.0) -> Numbers:
    place = [x + y for x, y in zip(at, _some(chance, size), strict=True)]
    return [*place, *_turned(chance, size), planted, 0.0]


def _steps(chance: Random) -> Iterator[Row]:
    left, right = (0.125, 0.0625, 0.0), (-0.125, 0.0625, 0.0)
    for n in range(8):
        yield "way", [*_foot(chance, left, 0.03 * n), *_foot(chance, left, 0.06 * n)], []
    for n in range(72):
        size = (0.0, 0.001953125, 0.0078125, 0.03125, 0.125, 0.375)[n % 6]
        planted = chance.choice((1.0, 1.0, 1.0, 0.0, 0.5))
        first = [*_foot(chance, left, 0.0), *_foot(chance, right, 0.0)]
        last = [*_foot(chance, left, size, planted), *_foot(chance, right, size if n % 4 else 0.0)]
        numbers: Numbers = [1.75]
        for row in (first, last, first, last):
            numbers += [2.0, *row]
        if n == 70:
            numbers = [1.75, 0.0, *numbers[18:]]  # nothing known of earlier
        seconds = (0.0, 0.125, 0.5, 1.0)[n // 6 % 4]
        yield "steps", [*numbers, seconds * (n % 9) / 8, seconds], []
        yield "steps", [*numbers, seconds * ((5 * n) % 7) / 8, seconds], []
    for n in range(8):
        rows = [[round(100000 * x) for x in _some(chance, 1.0, 16)] for _ in range(1 + n % 4)]
        flat = [x for row in rows for x in row]
        yield "track", [len(rows), *flat, (-0.5, 0.0, 0.0625, 0.125, 0.1875, 0.25, 0.375, 5.0)[n]], []
        yield "driven", [*_some(chance, 1.0, 32), 0.0625 * n], []


def _spans(chance: Random) -> Iterator[Row]:
    seconds = [k / 16 for k in range(-1, 34)]
    for start, end, eases, plays in product(
        (0.0, 0.25),
        (0.5, 2.0),
        ((0.0, 0.0), (0.125, 0.375), (0.5, 0.0)),
        ((0.0, 2.0), (-1.0, 3.0), (0.25, 0.5)),
    ):
        numbers = [start, end, *eases, 0.0, *plays, len(seconds), *seconds]
        yield "span", numbers, []
    for count in (1, 2, 3):
        keys: Numbers = []
        for n in range(count):
            keys += [0.25 + 0.5 * n, *_some(chance, 1.0), *_turned(chance, 1.0)]
        for sign in (1.0, -1.0):
            keys[-1] *= sign
            asked = [0.0, 0.25, 0.375, 0.75, 1.0, 1.25, 2.0]
            yield "key", [0.0, 2.0, 0.0, 0.0, count, *keys, len(asked), *asked], []
    twice = [0.5, 0.0, 1.0, 0.0, *STILL, 0.5, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    yield "key", [0.0, 2.0, 0.0, 0.0, 2, *twice, 2, 0.5, 0.75], []


# --- the mouth


def _mouths(chance: Random) -> Iterator[Row]:
    runs = (
        ["SS", "DD", "U", "nn", "O", "PP", "aa"],
        ["PP", "FF", "aa", "FF", "PP"],
        ["kk", "RR", "SS", "DD", "CH", "O"],
        ["E", "U"],
        ["TH", "I", "CH", "E", "RR"],
        list(VISEMES),
    )
    for n, run in enumerate(runs):
        for part in range(2):
            at, numbers = (0.0, 0.125)[part], [float(len(run))]
            for k, _ in enumerate(run):
                size = chance.choice((0.03125, 0.0625, 0.09375, 0.125, 0.25))
                at += 0.03125 if k % 3 == 2 and part else 0.0
                at += 0.0234375 if k % 4 == 1 and part else 0.0
                numbers += [at, at + size, (1.0, 0.75)[(k + n) % 2]]
                at += size
            yield "mouth", [*numbers, at + (0.0, 0.125)[part]], run
    yield "mouth", [1, 0.0, 0.0009765625, 1.0, 0.0009765625], ["aa"]
    yield "mouth", [0, 0.0], []
    yield "mouth", [0, 0.0625], []
    yield "mouth", [2, 0.0, 0.5, 0.0, 0.25, 0.5, 0.0, 0.5], ["PP", "FF"]
    for _n in range(8):
        rows = []
        for _ in range(3):
            shown = [chance.choice((0.0, 0.0, 0.125, 0.5)) for _ in range(14)]
            whole = max(1.0, sum(shown))
            rows += [round(x / whole * 256) / 256 for x in shown]
        yield "soften", rows, []
    yield "soften", [*([0.0] * 14), *([1.0] + [0.0] * 13), *([0.0] * 14)], []
    yield "soften", [*([0.5, 0.5] + [0.0] * 12) * 3], []
    for n in range(10):
        count = n if n < 4 else 8
        peaks = sorted(round(chance.uniform(0.0, 8.0) * 4) / 4 for _ in range(count))
        yield "accents", [count, *peaks, *(round(chance.random() * 4) / 4 for _ in range(count))], []


def _letters(_chance: Random) -> Iterator[Row]:
    edges = (0x3041, 0x30FF, 0xFF66, 0xFF9D, 0x3400, 0x9FFF, 0xF900, 0xFAFF, 0x20000, 0x323AF, 0xAC00, 0xD7A3)
    codes = [code + more for code in edges for more in (-1, 0, 1)]
    yield "letters", [len(codes), *codes], []
    for n, text in enumerate(TEXTS):
        for seconds in (1.5, 0.25) if n % 3 == 0 else (2.0,):
            yield "spelled", [seconds], [text]
    for seconds in (0.0, 0.0009765625, 0.001953125, 0.5, 0.625):
        yield "spelled", [seconds], ["mama"]
    for text in ("a" * n for n in (4, 5, 6, 7, 8)):
        yield "spelled", [0.5], [text]


def _line(words: Sequence[tuple[str, float, float]], marks: Sequence[tuple[str, float, float]]) -> Row:
    numbers: Numbers = [float(len(words))]
    for _, start, end in words:
        numbers += [start, end]
    numbers.append(float(len(marks)))
    for _, at, weight in marks:
        numbers += [at, weight]
    return "", numbers, [*(one[0] for one in words), *(one[0] for one in marks)]


def _times_told(_chance: Random) -> Iterator[Row]:
    none = OPEN
    words = [("one", 0.25, none), ("twelve", 0.5, 0.75), ("three", 1.5, none), ("four", 3.0, 3.5)]
    wrong: list[tuple[list[tuple[str, float, float]], list[tuple[str, float, float]], str, float]] = [
        (words, [("PP", 0.25, 1.0), ("aa", 0.5, 0.5), ("sil", 1.75, 1.0), ("O", 3.0, 0.0)], "", none),
        (words, [("p", 0.25, 1.0), ("@", 0.5, 0.5), ("sil", 1.625, 1.0)], "polly", 4.0),
        (words, [("12", 0.25, 1.0), ("1", 0.5, 0.5), ("0", 1.75, 1.0)], "", 3.5),
        (words, [("mouthSmileLeft", 0.25, 1.0), ("jawOpen", 0.25, 0.5), ("tongueOut", 0.5, 1.0)], "", none),
        ([], [("sil", 0.5, 1.0), ("sil", 0.5, 1.0)], "azure", none),
        ([], [], "", 0.0),
        ([("alone", 0.0, none)], [], "", 0.25),
        ([("late", 1.0, 1.0625), ("early", 0.5, 0.75)], [], "", none),
        ([("back", 1.0, 0.5)], [], "", none),
        ([("at once", 1.0, 1.0), ("same", 1.0, 1.0)], [("E", 1.0, 1.0), ("E", 1.0, 1.0)], "", 1.0),
        ([("past", 1.0, 1.046875)], [], "", 1.0),
        ([("past", 1.0, 1.0625)], [], "", 1.0),
        ([("far", 3600.0, 3600.0)], [("E", 3600.0, 1.0)], "", none),
        ([("far", 3600.5, 3601.0)], [], "", none),
        ([("before", -0.5, 1.0)], [], "", none),
        ([], [("PP", 0.5, 1.0), ("aa", 0.25, 1.0)], "", none),
        ([], [("PP", 0.5, 1.0625)], "", none),
        ([], [("PP", 0.5, -0.0625)], "", none),
        ([], [("PP", 1.046875, 1.0)], "", 1.0),
        ([], [("PP", 1.0625, 1.0)], "", 1.0),
        ([], [("PP", -0.0625, 1.0), ("aa", 0.0, 1.0)], "", none),
        (
            [("한", 0.0, 0.25), ("국", 0.25, 0.5), (" ", 0.5, 0.5), ("a", 0.5, 0.625), ("b", 0.625, none)],
            [],
            "",
            none,
        ),
    ]
    for spoken, marks, name, duration in wrong:
        _, numbers, texts = _line(spoken, marks)
        spoken_text = " ".join(one[0] for one in spoken) or "so, it is."
        yield "timing", [duration, *numbers, 0.0], [name, *texts, spoken_text]


def _pieces(chance: Random) -> Iterator[Row]:
    shut = [0, 1, 0.0, 1.0, 0.0]
    for first, said in ((0.05, 0.5), (0.046875, 0.5), (0.0625, 0.5), (0.0, 0.0), (0.03125, 0.03125)):
        yield "piece", [*shut, 0, 1, first, 1.0, 0.0, said, 0.0, 0.0, 0.0], ["PP", "aa"]
    for n in range(150):
        numbers: Numbers = []
        texts: list[str] = []
        old: list[tuple[str, float, float]] = []
        for which in range(2):
            at = 0.0 if which == 0 or n % 3 == 0 else 0.25 * (n % 8)
            words: list[tuple[str, float, float]] = []
            for k in range((n + 2 * which) % 4):
                same = n % 5 == 0 and which == 1 and k < len(old)
                word = (
                    old[k] if same else ("abcd"[(k + n * which) % 4], at, chance.choice((OPEN, at + 0.125)))
                )
                words.append(word)
                at = max(at, word[1]) + chance.choice((0.0, 0.125, 0.25))
            marks = [("aa" if k % 2 else "PP", 0.125 * (k + n % 4 * which), 1.0) for k in range(n // 4 % 4)]
            if n % 6 == 1 and marks:
                marks[-1] = ("sil", marks[-1][1], 1.0)
            _, row, named = _line(words, marks)
            numbers += [*row, chance.choice((0.0, 0.0, 0.125))]
            texts += named
            old = words
        said = 0.125 * (n % 7)
        late = [said + 0.125 * (n % 3 - 1), said + 0.125 * (n % 4 - 1), said + 0.125 * (n % 5 - 2)]
        yield "piece", [*numbers, said, *late], texts


# --- moods and times


def _moods(chance: Random) -> Iterator[Row]:
    levels = (-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.625, 1.0)
    tags = (("happy", "positive"), ("angry", "negative"), ("sad", ""), ("calm", "afraid"), ("tired", "nod"))
    for n, (valence, arousal) in enumerate(product(levels, levels)):
        intensity = (1.0, 0.0, 1.25, 2.0, 0.625)[n % 5]
        changes = [chance.choice((-2.0, -1.0, 0.5, 1.5, 3.0, 0.0)) for _ in range(3)]
        yield "mood", [valence, arousal, intensity, (-1.0, 0.0, 0.5, 1.0)[n % 4], *changes], list(tags[n % 5])
    for n in range(16):
        told: Numbers = []
        for k in range(n % 6):
            start = 0.5 * (k + chance.randrange(3))
            some = [chance.choice((NONE, *levels)) for _ in range(3)]
            told += [start, *some, chance.choice((OPEN, start + 1.0, start + 2.5))]
        yield "moods", [0.25, -0.5, 1.0, n % 6, *told, 0.5 * (n % 3), 4.0 + n % 2], []
        yield "lasting", [n % 6, *told, 0.5 * n], []
        starts = [0.0, 0.5, 1.0, 4.0][: n % 5]
        values = _some(chance, 1.0, 3 * len(starts))
        yield "shown", [len(starts), *starts, *values, 0.25 * n], []
    open_ = [0.0, 0.5, NONE, NONE, OPEN, 1.0, NONE, 0.5, NONE, OPEN, 2.0, 0.25, 0.5, 1.0, OPEN]
    for seconds in (0.0, 1.0, 2.0, 2.5, 3.0, 3.5, 4.0, 8.0):
        yield "lasting", [3, *open_, seconds], []
        yield "lasting", [2, *open_[:10], seconds], []


def _intervals() -> Iterator[Row]:
    for n in range(40):
        yield "lull", [float(n % 2), (0.0, 0.5, 1.0, 2.0)[n // 2 % 4]], [f"auto/arms/{n}"]
    for n, count in enumerate((0, 1, 2, 3, 5, 25, 26, 40)):
        yield "intervals", [count, n / 8, (0.0, 1.0, 9.0, 21.0, 180.0)[n % 5]], []
    edges = (-1.25, -1.0, -0.5, -0.125, 0.0, 0.0625, 0.125, 0.25, 0.375, 0.5, 0.75, 1.0, 1.25)
    for x in sorted({*edges, *(0.5 * (a + b) for a, b in pairwise(edges))}):
        yield "curves", [x], []
