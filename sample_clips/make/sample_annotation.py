"""`python -m sample_clips.make.sample_annotation`: make the sample annotation again, the same to the byte.

What ELAN would hold had somebody annotated three minutes of talk as Borer et al. did (section 7.2): a tier
for each arm, two for the head, one for the body, one for who speaks. Nobody was filmed: turns are laid out by
hand, what is done in them is drawn.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from metagraph.playback.planning.choice import pick, uniform

OUT = Path(__file__).resolve().parents[1] / "annotation" / "conversation.eaf"
WORDS = """ Made up: nobody was filmed and nobody annotated this. Written by sample_clips/make/sample_annotation.py as an example of
     what Metagraph reads, with the tiers of Borer et al., Animating an Autonomous 3D Talking Avatar, section 7.2. MIT licence. """
# When each turn begins, seconds, and what this person does in it.
TURNS = (
    (0.0, "listens"),
    (9.4, "speaks"),
    (31.2, "listens"),
    (43.8, "speaks"),
    (61.5, "listens"),
    (79.7, "speaks"),
    (104.3, "listens"),
    (113.9, "speaks"),
    (127.2, "listens"),
    (141.6, "speaks"),
    (167.8, "listens"),
    (182.0, ""),
)
SEED = 11
SCHEMA = "http://www.w3.org/2001/XMLSchema"
Mark = tuple[float, float, str]  # start, end, label
RELATIONS = {
    "Time_Subdivision": "Time subdivision of parent annotation's time interval, no time gaps allowed within "
    "this interval",
    "Symbolic_Subdivision": "Symbolic subdivision of a parent annotation. Annotations refering to the same "
    "parent are ordered",
    "Symbolic_Association": "1-1 association with a parent annotation",
    "Included_In": "Time alignable annotations within the parent annotation's time interval, gaps are "
    "allowed",
}


def _span(key: str, least: float, most: float) -> float:
    return least + (most - least) * uniform(SEED, key, "span")


def _turn(seconds: float) -> str:
    return next(what for start, what in reversed(TURNS) if start <= seconds)


# What follows what, in speaking and in listening; limb and label.
ARMS = {
    "speaks": {
        "both gesture": 5.0,
        "right gesture": 6.0,
        "left gesture": 2.0,
        "right fidget": 0.6,
        "both stance-transition": 0.9,
        "left fidget": 0.4,
    },
    "listens": {
        "left fidget": 3.0,
        "right fidget": 4.0,
        "both fidget": 1.2,
        "both stance-transition": 2.0,
        "right gesture": 0.6,
        "left stance-transition": 0.8,
    },
}


def arms() -> Iterator[tuple[str, Mark]]:
    """Yield (left or right, mark). Both hands seldom begin and end together."""
    time, n, before = 1.3, 0, ""
    while time < TURNS[-1][0] - 4.0:
        key, turn = f"arms{n}", _turn(time)
        weights = dict(ARMS[turn])
        if before in weights:
            weights[before] *= 1.8  # people go on with what they do
        before = pick(SEED, key, "act", weights)
        limb, label = before.split(" ")
        least, most = {"gesture": (0.7, 2.9), "fidget": (0.6, 4.2), "stance-transition": (0.8, 1.9)}[label]
        length = least + (most - least) * uniform(SEED, key, "length") ** 1.6
        if limb == "both":
            late, early = _span(key + "l", -0.25, 0.25), _span(key + "e", -0.2, 0.3)
            yield "left", (time + max(0.0, late), time + length - max(0.0, early), label)
            yield "right", (time + max(0.0, -late), time + length - max(0.0, -early), label)
        else:
            yield limb, (time, time + length, label)
        time += length + (_span(key + "r", 0.15, 1.7) if turn == "speaks" else _span(key + "r", 1.2, 5.5))
        n += 1


def head() -> Iterator[tuple[str, Mark]]:
    """Yield (action or stance, mark)."""
    time, n = 2.2, 0
    while time < TURNS[-1][0] - 3.0:
        key, turn = f"head{n}", _turn(time)
        listening = turn == "listens"
        label = pick(
            SEED,
            key,
            "act",
            {"nodding": 6.0 if listening else 2.5, "shaking": 1.0 if listening else 1.4, "turn": 2.0},
        )
        length = _span(key, 0.5, 1.9) if label != "turn" else _span(key, 0.4, 1.1)
        yield (
            ("stance", (time, time + length, "stance-transition"))
            if label == "turn"
            else ("action", (time, time + length, label))
        )
        time += length + _span(key + "r", 0.9, 3.6 if listening else 6.0)
        n += 1


def body() -> Iterator[Mark]:
    time, n = 5.1, 0
    while time < TURNS[-1][0] - 4.0:
        length = _span(f"body{n}", 1.0, 2.4)
        yield time, time + length, "stance-transition"
        time += length + _span(f"body{n}r", 6.0, 21.0)
        n += 1


def write(path: Path = OUT) -> None:
    hands = list(arms())
    heads = list(head())
    tiers = {
        "Speech": [(a, b, what) for (a, what), (b, _) in pairwise(TURNS)],
        "Left arm": [mark for side, mark in hands if side == "left"],
        "Right arm": [mark for side, mark in hands if side == "right"],
        "Head stance": [mark for which, mark in heads if which == "stance"],
        "Head action": [mark for which, mark in heads if which == "action"],
        "Body": list(body()),
    }
    at = {
        "AUTHOR": "made up",
        "DATE": "2020-01-01T00:00:00+00:00",
        "FORMAT": "3.0",
        "VERSION": "3.0",
        "xmlns:xsi": SCHEMA + "-instance",
        "xsi:noNamespaceSchemaLocation": "http://www.mpi.nl/tools/elan/EAFv3.0.xsd",
    }
    document = ET.Element("ANNOTATION_DOCUMENT", at)
    document.append(ET.Comment(WORDS))
    ET.SubElement(document, "HEADER", MEDIA_FILE="", TIME_UNITS="milliseconds")
    order = ET.SubElement(document, "TIME_ORDER")
    edges = [
        (edge, tier, n, which)
        for tier, marks in tiers.items()
        for n, mark in enumerate(marks)
        for which, edge in enumerate(mark[:2])
    ]
    slots = {}
    for n, (edge, tier, mark, which) in enumerate(sorted(edges, key=lambda e: e[0]), 1):
        slots[tier, mark, which] = f"ts{n}"
        ET.SubElement(order, "TIME_SLOT", TIME_SLOT_ID=f"ts{n}", TIME_VALUE=str(round(edge * 1000)))
    number = 0
    for name, marks in tiers.items():
        tier = ET.SubElement(
            document, "TIER", LINGUISTIC_TYPE_REF="default-lt", PARTICIPANT="A", TIER_ID=name
        )
        for n, (_, _, label) in enumerate(marks):
            number += 1
            at = {
                "ANNOTATION_ID": f"a{number}",
                "TIME_SLOT_REF1": slots[name, n, 0],
                "TIME_SLOT_REF2": slots[name, n, 1],
            }
            one = ET.SubElement(ET.SubElement(tier, "ANNOTATION"), "ALIGNABLE_ANNOTATION", at)
            ET.SubElement(one, "ANNOTATION_VALUE").text = label
    ET.SubElement(
        document,
        "LINGUISTIC_TYPE",
        GRAPHIC_REFERENCES="false",
        LINGUISTIC_TYPE_ID="default-lt",
        TIME_ALIGNABLE="true",
    )
    for stereotype, words in RELATIONS.items():
        ET.SubElement(document, "CONSTRAINT", DESCRIPTION=words, STEREOTYPE=stereotype)
    ET.indent(document)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(
        b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(document, encoding="utf-8") + b"\n"
    )
    print(f"{path.name}: {number} annotations on {len(tiers)} tiers, {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    write()
