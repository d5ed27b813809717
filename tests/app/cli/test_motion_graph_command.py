"""`metagraph motion-graph` from the command line: takes and speech in, graphs, motion and figures out."""

from __future__ import annotations

import json
import re
import signal
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest
import soundfile

from app.cli.parser import main
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.clips import read_clips
from metagraph.formats.conversations.writers import write_elan, write_json, write_textgrid
from metagraph.graph.conversation.model import Conversation, Side
from tests.synthesis.talking import VOICE, aloud, speech, talking

SECONDS = 18


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("takes")
    (out / "takes").mkdir()
    for n, (write, ending) in enumerate(
        ((write_elan, ".eaf"), (write_textgrid, ".TextGrid"), (write_json, ".json"))
    ):
        said = speech(SECONDS, n)
        write_bvh(talking(f"take{n}", said, SECONDS, n), out / "takes" / f"take{n}.bvh")
        sides = [tuple(s for s in said if (s.kind == "hesitation") == partner) for partner in (False, True)]
        both = (Side(name="Ann", segments=sides[0]), Side(name="Ben", segments=sides[1]))
        write(Conversation(name=f"take {n}", length=float(SECONDS), sides=both), out / f"take{n}{ending}")
    return out


def said(folder: Path) -> list[str]:
    return ["--speech", *(str(folder / f"take{n}") for n in ("0.eaf", "1.TextGrid", "2.json"))]


def run(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> str:
    assert main(["motion-graph", *arguments]) == code
    told = capsys.readouterr()
    return told.out if code == 0 else told.err


@pytest.mark.nightly
def test_a_graph_is_built_and_told(folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    takes = str(folder / "takes")
    text = run(capsys, "build", takes)
    assert (
        "3 takes, 1,620 states" in text
        and "Johnson's S_B" in text
        and "observed" in text
        and "largest component" in text
    )
    data = json.loads(
        run(capsys, "build", takes, "--json", "--k", "4", "--most", "9", "--keep", str(tmp_path / "kept"))
    )
    assert (
        data["k"] == 4
        and 0 < data["kept"] <= data["states"] == 1620
        and data["transitions"] <= 9 * data["keys"]
    )
    again = json.loads(
        run(capsys, "build", takes, "--json", "--k", "4", "--most", "9", "--keep", str(tmp_path / "kept"))
    )
    assert {f["name"] for f in data["fits"]} == {"Johnson S_B", "log-normal", "Weibull", "gamma", "beta"}
    plain, heard = (json.loads(run(capsys, "build", takes, *x, "--json")) for x in ([], said(folder)))
    assert heard["keys"] == plain["keys"]  # as many, but others: also those where what is heard changes
    assert heard["transitions"] != plain["transitions"]
    assert {**again, "seconds": 0} == {**data, "seconds": 0} and len(list((tmp_path / "kept").iterdir())) == 1


def test_the_papers_table_of_k_grows(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = json.loads(run(capsys, "table", str(folder / "takes"), "--json"))
    assert [r["k"] for r in rows] == [2, 3, 4]
    assert rows[0]["edges"] < rows[1]["edges"] < rows[2]["edges"] and all(
        r["kept_edges"] <= r["edges"] for r in rows
    )
    assert run(capsys, "table", str(folder / "takes")).count("\n") == 4


@pytest.mark.nightly
def test_motion_is_made_for_a_takes_speech_and_for_new_speech(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    given = [str(folder / "takes"), *said(folder)]
    of_take = ["--take", "2", "--search", "greedy"]
    text = run(capsys, "synthesize", *given, *of_take, "-o", str(tmp_path / "out.bvh"))
    assert "15.0 s with" in text and "of 2 takes" in text
    assert read_clips(tmp_path / "out.bvh")[0].frames == 450
    new = [
        "--new",
        str(folder / "take0.eaf"),
        "--start",
        "2",
        "-s",
        "5",
        "--without",
        "hesitation",
    ]
    data = json.loads(run(capsys, "synthesize", *given, *new, "-o", str(tmp_path / "out.glb"), "--json"))
    assert data["frames"] == 150 and read_clips(tmp_path / "out.glb")[0].duration == pytest.approx(
        149 / 30, abs=1e-3
    )


@pytest.mark.nightly
def test_held_out_speech_is_counted(folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    given = [str(folder / "takes"), *said(folder), "--quick"]
    text = run(capsys, "evaluate", *given, "-o", str(tmp_path / "cases.csv"))
    assert re.search(r"[123]/3", text) and "greedy" in text and "exact" in text
    assert len((tmp_path / "cases.csv").read_text().splitlines()) == 1 + 3 * 2
    data = json.loads(run(capsys, "evaluate", *given, "--search", "greedy", "--json"))
    assert [r["search"] for r in data["rows"]] == ["greedy"] and data["cases"] == 3


def test_speech_is_found_in_a_folder(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    takes = str(folder / "takes")
    (folder / "notes.json").write_text("{}")  # no take has its name
    named = run(capsys, "co-occurrence", takes, *said(folder))
    assert run(capsys, "co-occurrence", takes, "--speech", str(folder)) == named
    assert "no speech for take0" in run(capsys, "co-occurrence", takes, "--speech", takes, code=1)


def test_an_evaluation_that_is_stopped_keeps_its_cases(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[int] = []

    def told(done: int, total: int) -> None:
        seen.append(done)
        if done == 2:
            signal.raise_signal(signal.SIGINT)  # as Ctrl+C does

    monkeypatch.setattr("app.cli.motion_graph_command.ProgressLine", lambda *_: Namespace(tell=told))
    before = signal.getsignal(signal.SIGINT)
    given = [str(folder / "takes"), *said(folder), "--search", "greedy"]
    assert main(["motion-graph", "evaluate", *given, "-o", str(tmp_path / "cases.csv")]) == 3
    assert "cancelled" in capsys.readouterr().out and seen == [1, 2]
    assert len((tmp_path / "cases.csv").read_text().splitlines()) == 3
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.nightly
def test_what_goes_with_what_is_counted(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = json.loads(run(capsys, "co-occurrence", str(folder / "takes"), *said(folder), "--json"))
    by = {r["hypothesis"]: r for r in rows}
    assert by["clause with the right hand"]["rate"] > 0.9 > 0.1 > by["clause with the left hand"]["rate"]
    assert by["partner's hesitation with a nod"]["matched"] > 0, "what the other hesitates about is heard"
    other = json.loads(
        run(capsys, "co-occurrence", str(folder / "takes"), *said(folder), "--json", "--side", "Ben")
    )
    assert all(r["total"] == 0 for r in other), "Ben says nothing but hesitates"
    assert "chance" in run(capsys, "co-occurrence", str(folder / "takes"), *said(folder))


@pytest.mark.nightly
def test_files_that_do_not_go_together_are_told(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    takes, out = str(folder / "takes"), ["-o", str(tmp_path / "out.bvh")]
    assert "take1, take2" in run(capsys, "evaluate", takes, "--speech", str(folder / "take0.eaf"), code=1)
    two = [str(folder / "takes" / f"take{n}.bvh") for n in (0, 1)]
    assert "take2.json" in run(capsys, "evaluate", *two, *said(folder), code=1)
    assert "has no speaker 'Eve'" in run(
        capsys, "co-occurrence", takes, *said(folder), "--side", "Eve", code=1
    )
    assert "there is no take '9'" in run(
        capsys, "synthesize", takes, *said(folder), "--take", "9", *out, code=1
    )
    assert "not as '.fbx'" in run(
        capsys, "synthesize", takes, *said(folder), "--take", "1", "-o", "x.fbx", code=1
    )
    late = ["--take", "1", "--start", "99"]
    assert "its speech lasts from 0 to" in run(
        capsys, "synthesize", takes, *said(folder), *late, *out, code=1
    )
    assert "gone" in run(capsys, "build", str(tmp_path / "gone"), code=1)
    (tmp_path / "empty").mkdir()
    assert "has no clips" in run(capsys, "build", str(tmp_path / "empty"), code=1)
    words = tmp_path / "take0.json"
    words.write_text(
        '{"segments": [{"start": 0, "end": 1, "text": "hello", "words": [{"word": "hello", "start": 0, '
        '"end": 1}]}]}'
    )
    assert "has no clauses" in run(capsys, "evaluate", two[0], "--speech", str(words), code=1)
    assert "--k must be at least 2" in run(capsys, "build", takes, "--k", "1", code=1)
    assert "--level must be between 0 and 1" in run(capsys, "build", takes, "--level", "95", code=1)


def test_takes_of_other_skeletons_and_of_one_frame_are_told(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    text = (folder / "takes" / "take0.bvh").read_text()
    (tmp_path / "odd.bvh").write_text(text.replace("Hips", "Pelvis"))
    assert "another skeleton" in run(
        capsys, "build", str(folder / "takes"), str(tmp_path / "odd.bvh"), code=1
    )
    head, _, motion = text.partition("MOTION\n")
    lines = motion.splitlines()
    (tmp_path / "one.bvh").write_text(f"{head}MOTION\nFrames: 1\n{lines[1]}\n{lines[2]}\n")
    assert "only one frame" in run(capsys, "build", str(tmp_path / "one.bvh"), code=1)


def test_takes_of_another_rate_are_resampled_and_it_says_so(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    write_bvh(talking("fast", speech(SECONDS, 5), SECONDS, 5, fps=60.0), tmp_path / "fast.bvh")
    assert main(["motion-graph", "build", str(folder / "takes"), str(tmp_path / "fast.bvh"), "--json"]) == 0
    told = capsys.readouterr()
    assert "1 of 4 takes" in told.err and json.loads(told.out)["states"] in (2160, 2161)


def test_a_graph_that_falls_apart_says_what_to_do(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    lines = (folder / "takes" / "take0.bvh").read_text().split("MOTION\n")
    rows = lines[1].splitlines()
    moved = []
    for n, row in enumerate(rows[2:62]):  # ever further bent, so that nothing comes back
        numbers = row.split()
        numbers[6:9] = ["0", "0", f"{2 * n}"]
        moved.append(" ".join(numbers))
    (tmp_path / "bend.bvh").write_text(f"{lines[0]}MOTION\nFrames: 60\n{rows[1]}\n" + "\n".join(moved) + "\n")
    assert "level" in run(capsys, "build", str(tmp_path / "bend.bvh"), "--k", "2", "--level", "0.01", code=1)


@pytest.mark.nightly
def test_live_motion_is_evaluated_for_speech_that_is_heard_and_announced(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = json.loads(run(capsys, "evaluate", str(folder / "takes"), *said(folder), "--live", "--json"))
    assert [r["how"] for r in rows][:2] == ["heard", "announced 0 s ahead"] and rows[-1]["how"] == "all known"
    assert rows[0]["met"] < rows[3]["met"] and all(r["seconds"] == pytest.approx(54, abs=2) for r in rows)


def test_a_file_that_is_no_live_motion_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "a.json").write_text("{}")
    words = (str(folder / "takes"), *said(folder), "--again", str(tmp_path / "a.json"), "-o")
    told = run(capsys, "synthesize", *words, str(tmp_path / "a.bvh"), code=1)
    assert "a.json" in told and "live --keep" in told


@pytest.fixture(scope="module")
def aloud_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Takes with transcripts and sounds; those of the second are quiet, and of both channels."""
    out = tmp_path_factory.mktemp("aloud")
    (out / "takes").mkdir()
    for n in range(3):
        segments = speech(SECONDS, n)
        steps, words, samples = aloud(segments, SECONDS, n, -12.0 * n)
        sizes = [1 + 0.5 * step for step in steps]
        write_bvh(talking(f"take{n}", segments, SECONDS, n, sizes=sizes), out / "takes" / f"take{n}.bvh")
        own = tuple(s for s in segments if s.kind != "hesitation")
        both = (Side(name="Ann", segments=own, words=words), Side(name="Ben"))
        write_json(Conversation(name=f"take {n}", length=float(SECONDS), sides=both), out / f"take{n}.json")
        sides = np.stack([samples, np.zeros_like(samples)], 1) if n == 1 else samples
        soundfile.write(out / f"take{n}.wav", sides, VOICE)
    return out


def asked(folder: Path) -> list[str]:
    takes = [str(folder / "takes"), "--speech", *(str(folder / f"take{n}.json") for n in range(3))]
    return [*takes, "--sounds", *(str(folder / f"take{n}.wav") for n in range(3))]


@pytest.mark.nightly
def test_loudness_rate_words_and_speed_are_asked_for_and_told(
    aloud_folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    words = tmp_path / "words.txt"
    words.write_text("# shapes\nround = river, along\nbig, nothing, there\n")
    beside = [
        "--loudness",
        "0.5",
        "--rate",
        "0.25",
        "--words",
        str(words),
        "--word",
        "went",
        "--retime",
        "15",
    ]
    out = str(tmp_path / "out.bvh")
    given = [*asked(aloud_folder), "--take", "3", "-s", "10", "-o", out]
    data = json.loads(run(capsys, "synthesize", *given, *beside, "--json"))["beside"]
    assert [m["measure"] for m in data["matches"]] == ["loudness", "rate"]
    assert data["words"] and data["paid"]["loudness"] > 0 and data["was"] >= data["off"] > 0
    plain = json.loads(run(capsys, "synthesize", *given, "--json"))
    assert "beside" not in plain and read_clips(tmp_path / "out.bvh")[0].frames == 300
    text = run(capsys, "synthesize", *given, "--loudness", "0.5", "--word", "went", "--words-must")
    assert re.search(
        r"loudness differs by 0\.\d\d standard deviations.*have the motion of a take that says them.*added cost",
        text,
    )
    new = ["--new", str(aloud_folder / "take1.json"), "-s", "5", "-o", out, "--rate", "0.5"]
    assert "rate" in run(capsys, "synthesize", *asked(aloud_folder), *new)
    cues = [f"{n}\n00:00:{n:02},000 --> 00:00:{n:02},900\nround" for n in range(1, 17)]
    for n in range(3):
        (tmp_path / f"take{n}.srt").write_text("\n\n".join(cues))
    transcripts = ["--transcripts", *(str(tmp_path / f"take{n}.srt") for n in range(3))]
    told = json.loads(run(capsys, "synthesize", *given, *transcripts, "--word", "round", "--json"))["beside"]
    assert [w["text"] for w in told["words"]] == ["round"] * 9 and all(w["known"] for w in told["words"])
    rows = json.loads(
        run(capsys, "evaluate", *asked(aloud_folder), *beside, "--quick", "--search", "exact", "--json")
    )["rows"]
    assert rows[0]["loudness"] < 1.5 and rows[0]["off"] <= rows[0]["was"]


def test_wishes_that_cannot_be_are_told(
    aloud_folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    given = [*asked(aloud_folder), "--take", "3", "-o", str(tmp_path / "out.bvh")]
    deaf = [x for x in given if not x.endswith(".wav") and x != "--sounds"]
    few = [x for x in given if not x.endswith("take1.wav")]
    other = str(tmp_path / "other.json")
    Path(other).write_bytes((aloud_folder / "take0.json").read_bytes())
    new = [*asked(aloud_folder), "--new", other, "-o", str(tmp_path / "out.bvh")]
    for arguments, words in (
        ([*deaf, "--loudness", "1"], "give them with --sounds"),
        ([*few, "--loudness", "1"], "no sound for take1"),
        ([*new, "--loudness", "1"], "no sound for other.json"),
        ([*given, "--transcripts", other], "no transcript for take0"),
        ([*given, "--words-must"], "give them with --word or --words"),
        ([*given, "--word", "= huge"], "names no word"),
        ([*given, "--retime", "90"], "speed may change by 0 to 50%"),
        ([*given, "--rate", "-1"], "the weight of rate is 0 to 1000"),
        ([*given, "--words", str(tmp_path / "none.txt")], "none.txt"),
    ):
        assert words in run(capsys, "synthesize", *arguments, code=1), words
