"""Broken transcripts: a reader returns words in order or raises a FileError that helps; nothing else."""

from __future__ import annotations

import json
import random
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.conversations.writers import write_elan, write_json, write_textgrid
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.graph.conversation.model import Conversation, Segment, Side, Word

TALK = Conversation(
    name="t",
    length=9,
    sides=(
        Side(
            name="Ann",
            audio="a.wav",
            words=(Word(text="so", start=1, end=1.2), Word(text="we", start=1.2, end=1.4)),
            segments=(Segment("clause", 1, 1.4, 1.1, "so we"),),
        ),
        Side(name="Ben", segments=(Segment("response", 2, 3),)),
    ),
)
SEEDS = {
    ".vtt": "WEBVTT\n\n00:01.000 --> 00:02.000\n<v Ann>so<00:00:01.500> we\n\n00:03.000 --> 00:04.000\nBen: "
    "yes\n\n"
    "00:05.000 --> 00:06.000\nAnn: no\n",
    ".srt": "1\n00:00:01,000 --> 00:00:02,000\nANN: so we\n\n2\n00:00:03,000 --> 00:00:04,000\n- BEN: yes\n",
    ".ctm": "a 1 0.5 0.2 so 0.9\na 2 0.7 0.2 we\n",
    ".tsv": "0.5\t0.7\tso\n0.7\t0.9\twe\n",
    ".whisper": json.dumps(
        {
            "segments": [
                {
                    "start": 0,
                    "end": 1,
                    "text": "a b",
                    "speaker": "x",
                    "words": [{"word": "a", "start": 0.1, "end": 0.3}, {"word": "b"}],
                }
            ]
        }
    ),
    ".ibm": json.dumps(
        {
            "results": [{"final": True, "alternatives": [{"timestamps": [["so", 0.1, 0.3]]}]}],
            "speaker_labels": [{"from": 0.1, "speaker": 1}],
        }
    ),
}

HEADS = (
    "WEBVTT\n\n",
    "1\n00:00:01,000 --> 00:00:02,000\n",
    'File type = "ooTextFile"\n',
    "<",
    "a 1 0.5 0.2 ",
    "",
)


def survives(path: Path) -> None:
    try:
        found = read_transcript(path)
    except FileError as error:
        assert error.cause and error.remedy and str(error).startswith(path.name)
        return
    for words in found.speakers.values():
        assert all(a.end <= b.start + 1e-9 for a, b in pairwise(words))
        assert all(0 <= w.start < w.end for w in words)
    for segments in found.segments.values():
        Side(segments=segments)


@pytest.fixture(scope="module")
def seeds(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("seeds")
    write_elan(TALK, folder / "a.eaf")
    write_textgrid(TALK, folder / "a.TextGrid")
    write_json(TALK, folder / "a.json")
    return {
        **{k: v.encode() for k, v in SEEDS.items()},
        **{p.suffix: p.read_bytes() for p in folder.iterdir()},
    }


@pytest.mark.parametrize("kind", [*SEEDS, ".eaf", ".TextGrid", ".json"])
def test_mutated_files_are_read_or_refused(seeds: dict[str, bytes], kind: str, tmp_path: Path) -> None:
    chance = random.Random(kind)
    path = tmp_path / f"a{kind}"
    for _ in range(150):
        data = bytearray(seeds[kind])
        for _ in range(chance.randint(1, 6)):
            at = chance.randrange(len(data) + 1)
            change = chance.randrange(5)
            if change == 0:
                data[at : at + 1] = bytes([chance.randrange(256)])
            elif change == 1:
                del data[at : at + chance.randint(1, 30)]
            elif change == 2:
                data[at:at] = chance.choice(
                    [
                        b'"',
                        b"-",
                        b"9" * 30,
                        b"nan",
                        b"1e309",
                        b"null",
                        b"{}",
                        b"[]",
                        b"\n",
                        b" --> ",
                        b"<",
                        b"\xff\xfe",
                        b"-1",
                    ]
                )
            elif change == 3:
                data[at:at] = data[chance.randrange(len(data) + 1) :][:60]
            else:
                data = data[: max(1, at)]
        path.write_bytes(data)
        survives(path)


KEYS = (
    "segments",
    "words",
    "word",
    "text",
    "start",
    "end",
    "results",
    "alternatives",
    "timestamps",
    "speaker_labels",
    "from",
    "speaker",
    "word_segments",
    "sides",
    "final",
)
values = st.recursive(
    st.one_of(st.none(), st.booleans(), st.floats(), st.integers(-5, 10**400), st.text(max_size=6)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.sampled_from(KEYS), inner, max_size=4)
    ),
    max_leaves=12,
)


@pytest.mark.nightly
@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(values)
def test_any_json_is_read_or_refused(tmp_path: Path, value: object) -> None:
    path = tmp_path / "a.json"
    try:
        path.write_text(json.dumps(value))
    except ValueError:  # a number longer than Python writes
        return
    survives(path)


@settings(max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.text(max_size=80), st.sampled_from(HEADS))
def test_any_text_is_read_or_refused(tmp_path: Path, text: str, head: str) -> None:
    path = tmp_path / "a.txt"
    path.write_text(head + text, encoding="utf-8", errors="replace")
    survives(path)
