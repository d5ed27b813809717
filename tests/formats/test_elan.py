"""ELAN annotations: real files, every way a time can be missing, and files that are none."""

from __future__ import annotations

import random
import tracemalloc
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.elan import read_elan
from metagraph.playback.learning.annotation import Annotation, AnnotationInterval

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / "annotation" / "conversation.eaf"


def eaf(slots: str, tiers: str, header: str = '<HEADER TIME_UNITS="milliseconds"/>', rest: str = "") -> str:
    """An .eaf: slots as "a=0 b=500 c", tiers as XML."""
    rows = [s.partition("=") for s in slots.split()]
    times = "".join(
        f'<TIME_SLOT TIME_SLOT_ID="{i}"' + (f' TIME_VALUE="{t}"/>' if e else "/>") for i, e, t in rows
    )
    inside = f"{header}<TIME_ORDER>{times}</TIME_ORDER>{tiers}{rest}"
    return f"<?xml version='1.0'?><ANNOTATION_DOCUMENT>{inside}</ANNOTATION_DOCUMENT>"


def tier(name: str, *marks: str, at: str = "") -> str:
    """A tier; a mark is "id from-to text" or, for one that refers to another, "id of parent text" or "id of
    parent after text".
    """
    out = []
    for mark in marks:
        ident, first, *more = mark.split()
        if "-" in first:
            a, b = first.split("-")
            kind, refs, text = "ALIGNABLE", f'TIME_SLOT_REF1="{a}" TIME_SLOT_REF2="{b}"', " ".join(more)
        else:
            kind, refs, text = "REF", f'ANNOTATION_REF="{more[0]}"', more[-1]
            if len(more) > 2:
                refs += f' PREVIOUS_ANNOTATION="{more[1]}"'
        out.append(
            f'<ANNOTATION><{kind}_ANNOTATION ANNOTATION_ID="{ident}" {refs}>'
            f"<ANNOTATION_VALUE>{text}</ANNOTATION_VALUE></{kind}_ANNOTATION></ANNOTATION>"
        )
    return f'<TIER TIER_ID="{name}" {at}>{"".join(out)}</TIER>'


@pytest.fixture
def read(tmp_path: Path):
    def inner(text: str | bytes) -> Annotation:
        path = tmp_path / "talk.eaf"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_elan(path)

    return inner


def rows(annotation: Annotation, name: str) -> list[tuple[float, float, str]]:
    found = next(t for t in annotation.tiers if t.name == name)
    return [(round(i.start, 6), round(i.end, 6), i.text) for i in found.intervals]


# --- times


def test_an_annotation_with_nothing_in_it_is_read(read) -> None:
    assert read(eaf("", "")) == Annotation((), (), {}, ())
    empty = read(eaf("", tier("LH")))
    assert empty.tiers[0].intervals == ()
    assert empty.end == 0


def test_times_become_seconds_and_intervals_ascend(read) -> None:
    found = read(eaf("a=0 b=500 c=750 d=2000", tier("LH", "m2 c-d  second", "m1 a-b first")))
    assert rows(found, "LH") == [(0, 0.5, "first"), (0.75, 2, "second")]
    assert found.end == 2


@pytest.mark.parametrize(
    ("unit", "seconds"),
    [("milliseconds", 0.1), ("PAL-frames", 4.0), ("PAL-50-frames", 2.0), ("NTSC-frames", 100.1 / 30)],
)
def test_frames_are_understood(read, unit: str, seconds: float) -> None:
    found = read(eaf("a=0 b=100", tier("LH", "m a-b x"), f'<HEADER TIME_UNITS="{unit}"/>'))
    assert rows(found, "LH")[0][1] == pytest.approx(seconds, abs=1e-5)


def test_annotations_that_refer_have_their_parents_times_however_far_up(read) -> None:
    chain = (
        tier("a", "m1 t-u x")
        + tier("b", "m2 of m1 y", at='PARENT_REF="a"')
        + tier("c", "m3 of m2 z", at='PARENT_REF="b"')
    )
    found = read(eaf("t=100 u=400", chain))
    assert rows(found, "b") == [(0.1, 0.4, "y")]
    assert rows(found, "c") == [(0.1, 0.4, "z")]
    assert [t.parent for t in found.tiers] == ["", "a", "b"]


def test_a_tier_may_refer_to_one_further_down(read) -> None:
    found = read(eaf("t=100 u=400", tier("b", "m2 of m1 y") + tier("a", "m1 t-u x")))
    assert rows(found, "b") == [(0.1, 0.4, "y")]


def test_those_that_share_a_parent_share_its_time_evenly_in_their_order(read) -> None:
    found = read(
        eaf(
            "t=0 u=900", tier("a", "p t-u x") + tier("b", "m1 of p one", "m3 of p m2 three", "m2 of p m1 two")
        )
    )
    assert rows(found, "b") == [(0, 0.3, "one"), (0.3, 0.6, "two"), (0.6, 0.9, "three")]


def test_an_order_that_goes_in_circles_loses_nobody(read) -> None:
    found = read(
        eaf(
            "t=0 u=900", tier("a", "p t-u x") + tier("b", "m1 of p m2 one", "m2 of p m1 two", "m3 of p three")
        )
    )
    assert sorted(text for *_, text in rows(found, "b")) == ["one", "three", "two"]


def test_slots_that_were_never_aligned_lie_evenly_along_their_annotations(read) -> None:
    # In the file's order they stand between two slots of the same time, so that order alone would leave
    # nothing of them.
    found = read(eaf("a=0 b=300 c d e=300 f=900", tier("w", "m1 b-c one", "m2 c-d two", "m3 d-f three")))
    assert rows(found, "w") == [(0.3, 0.5, "one"), (0.5, 0.7, "two"), (0.7, 0.9, "three")]


def test_stray_slots_lie_evenly_between_their_neighbours_in_the_file(read) -> None:
    found = read(
        eaf("s a=300 x y b=600 z", tier("w", "m1 s-a q", "m2 x-b one", "m3 a-y two", "m4 y-z three"))
    )
    assert rows(found, "w") == [(0.15, 0.3, "q"), (0.3, 0.5, "two"), (0.4, 0.6, "one"), (0.5, 0.6, "three")]


def test_what_lasts_no_time_is_left_out_and_noted(read) -> None:
    found = read(
        eaf("a=100 b=100 c=50", tier("LH", "m1 a-b x", "m2 a-c y", "m3 c-a z") + tier("RH", "m4 a-b x"))
    )
    assert rows(found, "LH") == [(0.05, 0.1, "z")]
    left, right = found.notes
    assert left.startswith("tier 'LH': 2 ") and right.startswith("tier 'RH': 1 ")


def test_empty_labels_and_odd_letters_are_kept(read) -> None:
    found = read(eaf("a=0 b=100", tier("Rück", "m a-b &lt;Ü&amp;&#x1F44B;&gt;") + tier("x", "n a-b")))
    assert found.tiers[0].name == "Rück"
    assert rows(found, "Rück")[0][2] == "<Ü&\N{WAVING HAND SIGN}>"
    assert rows(found, "x") == [(0, 0.1, "")]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_other_encodings_are_read(read, encoding: str) -> None:
    text = eaf("a=0 b=100", tier("Körper", "m a-b drüben"))
    name = "utf-8" if "8-sig" in encoding else encoding
    assert rows(
        read(text.replace("version='1.0'", f"version='1.0' encoding='{name}'").encode(encoding)), "Körper"
    ) == [(0, 0.1, "drüben")]


def test_media_people_and_vocabularies_are_told(read) -> None:
    header = '<HEADER MEDIA_FILE="old.mpg" TIME_UNITS="milliseconds">'
    header += '<MEDIA_DESCRIPTOR MEDIA_URL="file:///C:/a.mp4" RELATIVE_MEDIA_URL="./a.mp4"/>'
    header += '<MEDIA_DESCRIPTOR MEDIA_URL="file:///b.wav"/></HEADER>'
    vocabularies = (
        "<CONTROLLED_VOCABULARY "
        'CV_ID="old"><CV_ENTRY>nod</CV_ENTRY><CV_ENTRY>shake</CV_ENTRY></CONTROLLED_VOCABULARY>'
    )
    vocabularies += (
        '<CONTROLLED_VOCABULARY CV_ID="new"><CV_ENTRY_ML CVE_ID="c"><CVE_VALUE LANG_REF="e">prep</CVE_VALUE>'
    )
    vocabularies += '<CVE_VALUE LANG_REF="d">Vorb</CVE_VALUE></CV_ENTRY_ML></CONTROLLED_VOCABULARY>'
    found = read(eaf("", tier("LH", at='PARTICIPANT=" B "'), header, vocabularies))
    assert found.media == ("./a.mp4", "file:///b.wav")
    assert found.vocabularies == {"old": ("nod", "shake"), "new": ("prep", "Vorb")}
    assert found.tiers[0].whose == "B"
    assert read(eaf("", "", '<HEADER MEDIA_FILE="old.mpg" TIME_UNITS="milliseconds"/>')).media == ("old.mpg",)


# --- files that are broken, or none

GOOD = tier("LH", "m a-b x")
WRONG = {
    "nothing": ("", "it is empty", "line 1", "Choose a file"),
    "no XML": (
        "HIERARCHY\nROOT Hips",
        "not well-formed XML (syntax error)",
        "line 1, column 1",
        "Choose a file",
    ),
    "binary": ("\0\1\2glTF", "not well-formed XML", "line 1", "Choose a file"),
    "other XML": ("<svg><g/></svg>", "outermost element is 'svg'", "line 1", "Choose a file"),
    "torn": (eaf("a=0 b=1", GOOD)[:-30], "not well-formed XML", "line 1, column ", "Open it in ELAN"),
    "unknown encoding": ("<?xml version='1.0' encoding='nonsense'?><a/>", "", "line 1", ""),
    "a slot that is not there": (
        eaf("a=0", GOOD),
        "annotation 'm' starts or ends at time slot 'b'",
        "line 1",
        "Open it in ELAN",
    ),
    "a slot twice": (eaf("a=0 a=1", ""), "time slot 'a' occurs twice", "", ""),
    "a time that is none": (eaf("a=0.5", ""), "'0.5' is not a whole number of milliseconds", "", ""),
    "a time before the beginning": (eaf("a=-5", ""), "not between 0", "", ""),
    "a time without end": (eaf("a=" + "9" * 5000, ""), "not between 0", "", ""),
    "a slot without name": (
        "<ANNOTATION_DOCUMENT>\n<TIME_SLOT/></ANNOTATION_DOCUMENT>",
        "a TIME_SLOT has no TIME_SLOT_ID",
        "line 2",
        "",
    ),
    "a unit nobody knows": (
        eaf("", "", '<HEADER TIME_UNITS="fortnights"/>'),
        "times are in 'fortnights'",
        "",
        "",
    ),
    "a tier twice": (eaf("", tier("LH") + tier("LH")), "tier 'LH' occurs twice", "", "Rename"),
    "a tier without name": (eaf("", "<TIER/>"), "a TIER has no TIER_ID", "", ""),
    "a mark twice": (
        eaf("a=0 b=1", tier("LH", "m a-b x", "m a-b x")),
        "annotation 'm' occurs twice",
        "",
        "",
    ),
    "a mark outside": (
        eaf("", '<REF_ANNOTATION ANNOTATION_ID="m" ANNOTATION_REF="n"/>'),
        "outside any tier",
        "",
        "",
    ),
    "a parent that is not there": (
        eaf("", tier("LH", "m of n x")),
        "annotation 'm' refers to 'n', which does not exist",
        "line 1",
        "",
    ),
    "parents in circles": (
        eaf("", tier("LH", "m of n x", "n of m x")),
        "refers to itself through",
        "line 1",
        "",
    ),
    "too deep": ("<ANNOTATION_DOCUMENT>" + "<a>" * 100000, "nested more than 64 levels deep", "", ""),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_broken_file_is_told_with_place_cause_and_remedy(read, case: str) -> None:
    text, cause, where, remedy = WRONG[case]
    with pytest.raises(FileError) as error:
        read(text)
    assert error.value.path.name == "talk.eaf"
    assert cause in error.value.cause and error.value.cause
    assert error.value.where.startswith(where) and error.value.where
    assert remedy in error.value.remedy and error.value.remedy


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"none\.eaf"):
        read_elan(tmp_path / "none.eaf")
    with pytest.raises(FileError, match="cannot be read"):
        read_elan(tmp_path)


def test_entities_that_grow_without_end_are_refused_and_outer_files_are_not_fetched(
    read, tmp_path: Path
) -> None:
    bomb = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10 if n else "x" * 10}">' for n in range(12))
    tracemalloc.start()
    with pytest.raises(FileError):
        read(f"<!DOCTYPE d [{bomb}]>" + eaf("a=0 b=1", tier("LH", "m a-b &e11;")).split("?>")[1])
    assert tracemalloc.get_traced_memory()[1] < 64 << 20
    tracemalloc.stop()
    (tmp_path / "secret").write_text("secret")
    outer = f'<!DOCTYPE d [<!ENTITY x SYSTEM "{(tmp_path / "secret").as_uri()}">]>'
    with pytest.raises(FileError, match="its own XML entities"):
        read(outer + eaf("a=0 b=1", tier("LH", "m a-b &x;")).split("?>")[1])


def survives(path: Path) -> Annotation | None:
    """Read a file; it may only succeed, every time in it sound, or raise a FileError with all its parts."""
    try:
        found = read_elan(path)
    except FileError as error:
        assert error.path == path
        assert error.cause and error.where and error.remedy
        return None
    for one in found.tiers:
        assert all(0 <= i.start < i.end <= 1e7 for i in one.intervals)
        assert list(one.intervals) == sorted(one.intervals, key=lambda i: (i.start, i.end))
    return found


@pytest.mark.parametrize("seed", range(60))
def test_changed_bytes_never_crash(seed: int, tmp_path: Path) -> None:
    rng, data = (
        random.Random(seed),
        bytearray(SAMPLE.read_bytes()[:12000] if seed % 2 else SAMPLE.read_bytes()),
    )
    for _ in range(rng.choice((1, 1, 3, 40))):
        at, how = rng.randrange(len(data)), rng.randrange(4)
        if how == 0:
            data[at] = rng.randrange(256)
        elif how == 1:
            del data[at : at + rng.randrange(1, 60)]
        elif how == 2:
            data[at:at] = rng.choice(
                (b"<", b">", b'"', b"&", b"\0", b"<TIER TIER_ID='x'>", b"\xff\xfe", b"ts3", b"-", b"<!--")
            )
        else:
            other = rng.randrange(len(data))
            data[at : at + 20], data[other : other + 20] = data[other : other + 20], data[at : at + 20]
    path = tmp_path / "changed.eaf"
    path.write_bytes(data)
    survives(path)


refs = st.sampled_from("abcdef")


@given(
    st.lists(st.tuples(refs, st.none() | st.integers(-5, 4000)), unique_by=lambda s: s[0]),
    st.lists(st.lists(st.tuples(refs, refs, st.booleans(), refs), max_size=5), max_size=4),
)
def test_whatever_refers_to_whatever_is_read_or_told(tmp_path_factory, slots, tiers) -> None:
    marks, number = [], 0
    for n, some in enumerate(tiers):
        row = []
        for first, second, refer, after in some:
            number += 1
            there = ["m" + str("abcdef".index(x) + 1) for x in (first, second, after)]
            row.append(f"m{number} of {there[0]} {there[2]} x" if refer else f"m{number} {first}-{second} x")
        marks.append(tier(f"t{n}", *row))
    path = tmp_path_factory.mktemp("any") / "any.eaf"
    path.write_text(eaf(" ".join(i if t is None else f"{i}={t}" for i, t in slots), "".join(marks)))
    found = survives(path)
    if found is not None:
        assert (
            sum(len(t.intervals) for t in found.tiers) + sum("left out" in n for n in found.notes) <= number
        )
        assert sum(len(t.intervals) for t in found.tiers) or number == 0 or found.notes


# --- real files


def test_the_sample_annotation_says_that_it_is_made_up_and_is_what_its_maker_writes(tmp_path: Path) -> None:
    from sample_clips.make.sample_annotation import write

    write(tmp_path / "again.eaf")
    assert (tmp_path / "again.eaf").read_bytes() == SAMPLE.read_bytes()
    assert b"Made up: nobody was filmed" in SAMPLE.read_bytes()[:600]
    found = read_elan(SAMPLE)
    assert [t.name for t in found.tiers] == [
        "Speech",
        "Left arm",
        "Right arm",
        "Head stance",
        "Head action",
        "Body",
    ]
    assert 150 < found.end < 200


def test_five_files_of_others_are_read(shared_data: Path) -> None:
    found = {path.stem: read_elan(path) for path in sorted((shared_data / "elan").glob("*.eaf"))}
    counts = {name: [len(t.intervals) for t in a.tiers] for name, a in found.items()}
    assert counts == {
        "blank": [0],
        "fables_01_03_aesop_64kb": [16, 3, 28, 28, 22],
        "sample_3.0": [399, 1995, 1995, 1197, 1197, 1995],
        "test": [8, 3, 12, 12, 8],
        "test2": [8, 3, 12, 12, 8, 0],
    }
    gestures = next(t for t in found["sample_3.0"].tiers if t.name == "gestures")
    assert gestures.intervals[:2] == (
        AnnotationInterval(1.8, 2.4, "prep"),
        AnnotationInterval(3.0, 3.6, "hold"),
    )
    words = next(t for t in found["sample_3.0"].tiers if t.name == "words-timesub").intervals
    assert all(i.end - i.start > 0.05 for i in words), "five words a sentence, some of them never aligned"
    language = next(
        t for t in found["test"].tiers if t.name == "Person1 (ChunkLanguage)"
    )  # refers to a tier that refers to another
    assert language.intervals[0].text == "en" and language.intervals[0].start == 1.04
    assert all(not a.notes for a in found.values())
