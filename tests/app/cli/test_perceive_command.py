"""`metagraph study perceive`: from stimuli to a report, and everything that can be wrong in between."""

from __future__ import annotations

import http.client
import json
import signal
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.cli.parser import main
from metagraph.research.study.perceive.folder import read_folder
from preview.video import write_video
from preview.video_reading import measure_video_seconds, read_pictures, read_video_sound
from tests.processes import started
from tests.research.study.perceive.perceive_makers import sheet, study, text

pytestmark = pytest.mark.usefixtures("quick_codes")

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"


def told(capsys: pytest.CaptureFixture[str]) -> dict[str, object]:
    return json.loads(capsys.readouterr().out)  # type: ignore[no-any-return]


def drawn(folder: Path, shade: int, seconds: float = 1.2, sound: float = 0.0) -> None:
    frames = [np.full((48, 64, 3), shade, np.uint8)] * round(10 * seconds)
    tone = (sound * np.sin(np.arange(round(44100 * seconds)) * 0.1)).astype(np.float32)
    write_video(folder, frames, 10, sound=(tone, 44100) if sound else None)


@pytest.mark.nightly
def test_simulated_raters_are_reported_and_the_planted_preference_is_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "made-up"
    assert (
        main(["study", "perceive", "simulate", str(out), "--participants", "20", "--lapses", "0", "--json"])
        == 0
    )
    assert told(capsys)["raters"] == 20
    assert main(["study", "perceive", "report", str(out), "--json"]) == 0
    data = told(capsys)
    assert data["simulated"] and data["people"] == 20 and (out / "report" / "report.html").is_file()
    first = data["pairs"][0]  # type: ignore[index]
    assert first["model_low"] < 0.68 < first["model_high"]  # 0.8 log odds, among people and items that differ
    assert main(["study", "perceive", "withdraw", str(out), "P01"]) == 0
    assert main(["study", "perceive", "delete", str(out), "P02", "--yes"]) == 0
    assert "write the report again" in capsys.readouterr().out
    assert main(["study", "perceive", "report", str(out)]) == 0
    assert "Nobody took part" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["simulate", "OUT", "--liked", "deaf"], "CONDITION=LOGODDS"),
        (["simulate", "OUT", "--liked", "who=1"], "no condition 'who'"),
        (["simulate", "OUT", "--lapses", "2"], "share of 0 to 1"),
        (["simulate", "OUT", "--participants", "0"], "1 to 1000"),
        (["simulate", "TAKEN"], "has a study already"),
        (["make", "PLAN", "--into", "TAKEN"], "has a study already"),
        (["report", "OUT"], "cannot be read"),
        (["report", "."], "holds no perceptual study"),
        (["collect", "TAKEN", "nowhere.json"], None),
        (["withdraw", "TAKEN", "P77"], "does not take part"),
        (["delete", "TAKEN", "P01"], "confirm with --yes"),
        (["serve", "TAKEN"], "videos are not there"),
        (["plan", "--share", "0.4"], "more than 0.5"),
        (["plan", "--share", "0.6", "--smallest", "1"], "--smallest"),
        (["plan", "--share", "0.6", "--chance", "0"], "--chance"),
        (["plan", "--share", "0.6", "--participants", "1"], "2 to 400 people"),
    ],
)
def test_what_cannot_be_done_is_told(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    error: str | None,
) -> None:
    monkeypatch.chdir(tmp_path)
    study(tmp_path / "TAKEN", text())
    (tmp_path / "PLAN").write_text(text())
    code = main(["study", "perceive", *words])
    shown = capsys.readouterr().err
    assert code == (1 if error else 3) and (error or "cannot be read") in shown and "Traceback" not in shown


def test_answers_that_were_saved_are_collected_and_bad_files_spoil_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = study(tmp_path / "s", text())
    files = tmp_path / "files"
    files.mkdir()
    for who in ("P01", "P02"):
        (files / f"{who}.json").write_bytes(msgspec.json.encode(sheet(made, who)))
    (files / "broken.json").write_text("{")
    (files / "other.json").write_bytes(
        msgspec.json.encode(msgspec.structs.replace(sheet(made), design="0" * 64))
    )
    assert main(["study", "perceive", "collect", str(made.folder), str(files), "--json"]) == 3
    data = told(capsys)
    assert [d["code"] for d in data["collected"]] == ["P01", "P02"] and len(data["failed"]) == 2  # type: ignore[attr-defined, arg-type, index]
    assert main(["study", "perceive", "collect", str(made.folder), str(files / "P01.json")]) == 0
    assert "0 new events" in capsys.readouterr().out
    assert main(["study", "perceive", "report", str(made.folder)]) == 0


@pytest.mark.nightly
def test_a_plan_says_how_many_answers_and_people_are_needed(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["plan", "--share", "0.75", "--smallest", "0.65", "--items", "6", "--studies", "30", "--json"]
    assert main(["study", "perceive", *words]) == 0
    data = told(capsys)
    assert (data["answers"], data["smallest"]) == (35, 97) and 4 <= data["people"] <= 30  # type: ignore[operator]
    assert main(["study", "perceive", *words[:-1], "--participants", "12", "--tests", "3"]) == 0
    assert "12 people: shown in" in capsys.readouterr().out


@pytest.mark.nightly
def test_videos_of_others_are_shown_with_one_size_length_and_loudness(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for n, shade in (("one", 40), ("two", 200)):
        for c, level in (("a", 0.1), ("b", 0.5)):
            drawn(tmp_path / f"{c}-{n}.mp4", shade + (10 if c == "b" and n == "one" else 0), sound=level)
    words = (
        "perceive: 1\ntitle: Of others\nparticipants: 2\n"
        "conditions: {a: {video: 'a-{item}.mp4'}, b: {video: 'b-{item}.mp4'}, quiet: {video: 'a-{item}.mp4', sound: none}}\n"
        "compare: [[a, b]]\nitems: [{id: one, seconds: 1}, {id: two, seconds: 1}]\nchoice: {question: Which?}\n"
        "rating: {questions: [{id: q, text: Q, scale: {from: 1, to: 5}}]}\nvideo: {width: 96, height: 64, fps: 10}\n"
    )
    (tmp_path / "perceive.yaml").write_text(words)
    out = tmp_path / "out"
    assert main(["study", "perceive", "make", str(tmp_path), "--into", str(out), "--json"]) == 0
    data = told(capsys)
    assert data["videos"] == 6 and data["alike"] == [["a", "b", "two"]]
    made = read_folder(out)
    assert not made.differences()
    loud = []
    for name, (condition, _) in made.key.stimuli.items():
        assert measure_video_seconds(made.video(name)) == pytest.approx(1.0, abs=0.08)
        sound = read_video_sound(made.video(name), 44100)
        assert (sound is None) == (condition == "quiet")
        loud += [] if sound is None else [float(np.abs(sound[4000:40000]).max())]
    assert max(loud) < 1.1 * min(loud)
    assert main(["study", "perceive", "make", str(tmp_path), "--into", str(out)]) == 1
    assert "has a study already" in capsys.readouterr().err


def test_a_video_that_is_too_short_is_told_before_anything_is_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawn(tmp_path / "a.mp4", 40)
    drawn(tmp_path / "b.mp4", 90, 0.6)
    (tmp_path / "perceive.yaml").write_text(
        "perceive: 1\ntitle: T\nparticipants: 1\nconditions: {a: {video: a.mp4}, b: {video: b.mp4}}\n"
        "items: [{id: one, seconds: 1}]\nchoice: {question: Which?}\n"
    )
    out = tmp_path / "out"
    assert main(["study", "perceive", "make", str(tmp_path / "perceive.yaml"), "--into", str(out)]) == 1
    shown = capsys.readouterr().err
    assert "conditions.b" in shown and "lasts 0.60 s" in shown and not out.exists()


@pytest.mark.nightly
@pytest.mark.gl
def test_a_conversation_is_drawn_in_every_condition(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "perceive.yaml").write_text(
        f"perceive: 1\ntitle: T\nparticipants: 2\nproject: {SAMPLE}\n"
        "conditions:\n  all: {conversation: Office}\n  none: {conversation: Office, without: [clause, response, hesitation]}\n"
        "  wrong: {conversation: Office, sound: mismatched}\n  improvised: {clip: hands_at_sides__wave_hello_rt_01, sound: none}\n"
        "compare: [[all, none]]\nitems: [{id: one, start: 1, seconds: 0.7}, {id: two, start: 0.5, seconds: 0.7}]\n"
        "choice: {question: Which?}\nrating: {questions: [{id: q, text: Q, scale: {from: 1, to: 5}}]}\n"
        "video: {width: 96, height: 96, fps: 6}\n"
    )
    assert main(["study", "perceive", "make", str(tmp_path), "--into", str(tmp_path / "out"), "--json"]) == 0
    assert told(capsys)["videos"] == 8
    made = read_folder(tmp_path / "out")
    assert all(
        (read_video_sound(made.video(n), 44100) is None) == (c == "improvised")
        for n, (c, _) in made.key.stimuli.items()
    )
    assert (
        main(["study", "perceive", "make", str(tmp_path), "--into", str(tmp_path / "again"), "--json"]) == 0
    )
    again = read_folder(tmp_path / "again")
    assert not set(again.key.stimuli) & set(made.key.stimuli)  # another secret, other names
    first, second = ({what: one.video(k) for k, what in one.key.stimuli.items()} for one in (made, again))
    assert first.keys() == second.keys()
    for what, path in first.items():
        one, other = (read_video_sound(p, 44100) for p in (path, second[what]))
        assert (one is None) == (other is None) and (one is None or np.array_equal(one, other))
    # x264 does not give the same bytes for the same pictures each time: they are compared as decoded.
    shown, afresh = ({what: pictures(p) for what, p in some.items()} for some in (first, second))
    assert max(float(np.abs(shown[w] - afresh[w]).mean()) for w in shown) < 1
    assert float(np.abs(shown["all", "one"] - shown["improvised", "one"]).mean()) > 5


def pictures(path: Path) -> np.ndarray:
    """Return the first four pictures of a video, 6 a second."""
    return np.stack(list(read_pictures(path, np.arange(4) / 6, (96, 96)))).astype(float)


@pytest.mark.parametrize(
    ("condition", "error"),
    [
        ("{conversation: Nowhere}", "there is no conversation 'Nowhere'"),
        ("{conversation: Office, taken: true}", "no take recorded with it"),
        ("{performance: Nowhere}", "no performance 'Nowhere'"),
        ("{clip: nowhere}", "there is no clip 'nowhere'"),
        ("{motion: nowhere.bvh}", "nowhere.bvh"),
        ("{video: nowhere.mp4}", "nowhere.mp4"),
        ("{clip: hands_at_sides__wave_hello_rt_01, audio: nowhere.wav}", "nowhere.wav"),
    ],
)
def test_what_is_not_there_to_be_shown_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], condition: str, error: str
) -> None:
    (tmp_path / "perceive.yaml").write_text(
        f"perceive: 1\ntitle: T\nparticipants: 2\nproject: {SAMPLE}\nconditions: {{a: {condition}, b: {{clip: hands_at_sides__wave_hello_rt_01}}}}\n"
        "items: [{id: one, seconds: 0.5}]\nchoice: {question: Which?, present: after}\n"
    )
    assert main(["study", "perceive", "make", str(tmp_path), "--into", str(tmp_path / "out")]) == 1
    assert error in capsys.readouterr().err and not (tmp_path / "out" / "key.json").exists()


@pytest.mark.nightly
@pytest.mark.gl
def test_plain_motion_is_drawn_on_the_default_body_or_on_its_character(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sample = SAMPLE.parent / "clips" / "hands_at_sides__wave_hello_rt_01.glb"
    (tmp_path / "one.glb").write_bytes(sample.read_bytes())
    plan = (
        "perceive: 1\ntitle: T\nparticipants: 2\nconditions: {{a: {{motion: '{{item}}.glb'}}, b: {{motion: '{{item}}.glb'{more}}}}}\n"
        "items: [{{id: one, start: 9, seconds: 0.4}}]\nchoice: {{question: Which?}}\nvideo: {{width: 64, height: 64, fps: 5}}\n"
    )
    (tmp_path / "perceive.yaml").write_text(plan.format(more=f", project: {SAMPLE}"))
    assert main(["study", "perceive", "make", str(tmp_path), "--into", str(tmp_path / "out"), "--json"]) == 0
    assert told(capsys)["alike"] == []


@pytest.mark.nightly
def test_serving_ends_when_it_is_told_to(tmp_path: Path) -> None:
    drawn(tmp_path / "a.mp4", 40)
    (tmp_path / "perceive.yaml").write_text(
        "perceive: 1\ntitle: T\nparticipants: 1\nconditions: {a: {video: a.mp4}, b: {video: a.mp4, sound: none}}\n"
        "items: [{id: one, seconds: 1}]\nchoice: {question: Which?, present: after}\n"
    )
    out = tmp_path / "out"
    assert main(["study", "perceive", "make", str(tmp_path), "--into", str(out)]) == 0
    command = (sys.executable, "-m", "app.cli", "study", "perceive", "serve", out)
    with started(*command, stderr=-1, longest=60) as process:
        assert process.stderr is not None
        line = process.stderr.readline()
        place = line.split("http://")[1].split("/")[0]
        asked = http.client.HTTPConnection(place, timeout=10)
        asked.request(
            "POST",
            "/answers",
            msgspec.json.encode(sheet(read_folder(out))),
            {"Content-Type": "application/json"},
        )
        assert asked.getresponse().status == 200
        asked.close()
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == 0
    assert main(["study", "perceive", "report", str(out)]) == 0
