"""Mouth shapes of every tool: open and shut at the same times, and what was inferred told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from metagraph.errors import FileError
from metagraph.graph.face.names import VISEMES
from metagraph.graph.model import Project
from metagraph.graph.requests import Line
from metagraph.speech.lines import load_voices, make_voice_from_phones
from metagraph.speech.mouth_files.model import MouthFile, MouthShapes
from metagraph.speech.mouth_files.registry import MOUTH_READERS, read_mouth_file
from tests.speech.mouth_files.made_mouths import MADE_MOUTHS


def read(
    folder: Path, kind: str, sound: float | None = 2.0, change: tuple[str, str] = ("", "")
) -> MouthShapes:
    name, text = MADE_MOUTHS[kind]
    assert change[0] in text
    path = folder / name
    path.write_text(text.replace(*change) if change[0] else text, encoding="utf-8")
    return read_mouth_file(path, sound)


def shown(found: MouthShapes, at: float) -> str:
    """What the mouth shows at a time."""
    if found.weights is not None and found.times is not None:
        return VISEMES[int(found.weights[np.searchsorted(found.times, at, "right") - 1].argmax())]
    return next((p.viseme for p in found.pieces if p.start <= at < p.end), "sil")


@pytest.mark.parametrize("kind", MADE_MOUTHS)
def test_every_kind_opens_and_shuts_the_mouth_at_the_same_times(tmp_path: Path, kind: str) -> None:
    found = read(tmp_path, kind)
    assert [shown(found, t) for t in (0.2, 0.55, 0.95, 1.05, 1.45, 1.7)] == [
        "sil",
        "aa",
        "aa",
        "PP",
        "PP",
        "sil",
    ]


def test_every_reader_is_tried_by_a_made_file() -> None:
    files = [MouthFile(Path(name), text) for name, text in MADE_MOUTHS.values()]
    assert {next(i for i, r in enumerate(MOUTH_READERS) if r.begins(f)) for f in files} == set(
        range(len(MOUTH_READERS))
    )


@pytest.mark.parametrize(
    ("kind", "told"),
    [
        ("moho, rhubarb", "24 frames a second were assumed"),
        ("papagayo", "2 voices; the first"),
        ("azure ticks", "ticks of 100 nanoseconds"),
        ("azure milliseconds", "read as milliseconds"),
        ("oculus milliseconds", "read as milliseconds"),
        ("rhubarb tsv", "those of Rhubarb"),
        ("moho, preston blair", "those of Preston Blair"),
        ("arpabet table", "phones (ARPAbet)"),
        ("ipa table", "phones (IPA or SAMPA)"),
        ("ovr csv without head", "evenly over 2.00 s"),
    ],
)
def test_what_was_inferred_is_told(tmp_path: Path, kind: str, told: str) -> None:
    assert any(told in note for note in read(tmp_path, kind).notes)


def test_a_first_column_that_counts_frames_is_no_time(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = [[n, *(float(k == (1 if n < 60 else 10)) for k in range(15))] for n in range(120)]
    path.write_text("\n".join(",".join(map(str, row)) for row in rows))
    found = read_mouth_file(path, 2.0)
    assert (shown(found, 0.5), shown(found, 1.5)) == ("PP", "aa") and found.end < 2.0
    assert found.notes == ("it has no times: its frames lie evenly over 2.00 s",)


def test_moho_frames_that_do_not_fit_the_sound_are_at_a_higher_rate(tmp_path: Path) -> None:
    found = read(tmp_path, "moho, rhubarb", 0.8)
    assert found.pieces[0].start == pytest.approx(0.25) and any(
        "48 frames a second were assumed" in n for n in found.notes
    )


@pytest.mark.parametrize(
    ("kind", "change", "cause"),
    [
        ("rhubarb json", ('"D"', '"nonsense-label"'), "nor a mouth shape of Rhubarb"),
        ("rhubarb json", ('"start": 0.5', '"start": "soon"'), "a time is 'soon'"),
        ("rhubarb xml", ("</rhubarbResult>", ""), "not well-formed XML"),
        ("rhubarb xml", ("<rhubarbResult>", '<!DOCTYPE r [<!ENTITY a "b">]><rhubarbResult>'), "entities"),
        ("papagayo", ("\n24\n", "\nx\n"), "its frame rate"),
        ("azure ticks", ('"visemeId": 2}', '"visemeId": 99}'), "nor a mouth shape"),
        ("ovr csv", ("0.5,0,", "0.5,x,"), "no number for 'sil'"),
        ("ovr json", ('"Visemes": [1.0, ', '"Visemes": ['), "no phones and no mouth shapes"),
        ("gentle", ('"duration": 0.5', '"duration": null'), "has no time"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, kind: str, change: tuple[str, str], cause: str) -> None:
    with pytest.raises(FileError) as caught:
        read(tmp_path, kind, change=change)
    assert cause in str(caught.value) and caught.value.remedy


@pytest.mark.parametrize("text", ["", "once upon a time", "{}", "[]", "[1, 2]", "<html/>", "MohoSwitch1\n"])
def test_other_files_are_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "a.txt"
    path.write_text(text)
    with pytest.raises(FileError):
        read_mouth_file(path)


@pytest.mark.parametrize("kind", ["rhubarb json", "azure ticks", "ovr csv", "ovr json", "textgrid"])
def test_a_line_moves_its_lips_by_such_a_file(tmp_path: Path, kind: str) -> None:
    name, text = MADE_MOUTHS[kind]
    (tmp_path / name).write_text(text, encoding="utf-8")
    seconds = np.arange(2 * 16000) / 16000
    soundfile.write(tmp_path / "a.wav", 0.3 * np.sin(900 * seconds) * (seconds > 0.5), 16000)
    project, notes = load_voices(Project(lines={"a": Line(audio="a.wav", phones=name)}), tmp_path)
    voice = project.voices["a"]
    at = [
        [float(np.interp(t, voice.times, voice.weights[:, VISEMES.index(v)])) for v in ("aa", "PP")]
        for t in (0.75, 1.25)
    ]
    assert at[0][0] > 0.8 > 0.2 > at[0][1] and at[1][1] > 0.8 > 0.2 > at[1][0]
    assert float(voice.weights[-1, 0]) == 1.0 and (np.diff(voice.times) >= 0).all()
    assert any("ticks" in note for note in notes) == (kind == "azure ticks")


def test_a_line_without_sound_lasts_as_long_as_its_shapes(tmp_path: Path) -> None:
    for kind in ("rhubarb json", "ovr csv"):
        name, text = MADE_MOUTHS[kind]
        (tmp_path / name).write_text(text, encoding="utf-8")
        assert make_voice_from_phones(tmp_path / name).duration == pytest.approx(2.0, abs=0.03)


def test_the_phones_of_other_speakers_are_told(tmp_path: Path) -> None:
    tiers = "".join(
        f'"IntervalTier"\n"{who} - phones"\n0\n1\n1\n0\n1\n"{phone}"\n'
        for who, phone in (("Ann", "AA1"), ("Bob", "IY1"))
    )
    path = tmp_path / "two.TextGrid"
    path.write_text(f'File type = "ooTextFile"\nObject class = "TextGrid"\n\n0\n1\n<exists>\n2\n{tiers}')
    found = read_mouth_file(path)
    assert [p.viseme for p in found.pieces] == ["aa"]
    assert found.notes == ("its phones are those of tier 'Ann - phones'; not read: 'Bob - phones'",)


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.tsv", "0,00\tX\n0,50\tD\n1,00\tA\n1,50\tX\n", "its decimal commas were read as points"),
        ("a.csv", "0,00;X\n0,50;D\n1,00;A\n1,50;X\n", "its decimal commas were read as points"),
        ("a.csv", "start,duration,phone\n0.0,0.5,sil\n0.5,0.5,AA1\n1.0,0.5,M\n", "ARPAbet"),
        ("a.lab", "separator ;\nnfields 1\n#\n0.5 121 pau\n1.0 121 aa\n1.5 121 m\n1.9 121 pau\n", "ARPAbet"),
        ("a.json", '[{"start": 0.5, "duration": 0.5, "value": "aa"}, '
         '{"start": 1, "duration": 0.5, "value": "PP"}]', "Oculus"),
    ],
    ids=["commas and tabs", "commas and semicolons", "durations", "xwaves labels", "durations in JSON"],
)  # fmt: skip
def test_tables_mean_what_their_programs_mean_by_them(
    tmp_path: Path, name: str, text: str, told: str
) -> None:
    path = tmp_path / name
    path.write_text(text)
    found = read_mouth_file(path, 2.0)
    assert [shown(found, t) for t in (0.2, 0.55, 0.95, 1.05, 1.45, 1.7)] == [
        "sil", "aa", "aa", "PP", "PP", "sil",
    ]  # fmt: skip
    assert any(told in note for note in found.notes)


def test_shapes_that_end_long_after_the_sound_are_told(tmp_path: Path) -> None:
    path = tmp_path / "frames.tsv"
    path.write_text("1\tX\n12\tD\n20\tB\n47\tX\n")
    assert any(
        "its shapes end at 47.2 s and the sound at 2.0 s" in x for x in read_mouth_file(path, 2.0).notes
    )
    assert not any("the sound at" in x for x in read_mouth_file(path).notes)
