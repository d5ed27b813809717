"""The command line: what an animator types, what a program reads, and what both get when something is
wrong.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from argparse import Namespace
from pathlib import Path

import pytest

from app.cli import demo_command, window_command
from app.cli.command_output import choose_plan
from app.cli.parser import COMMANDS, main
from metagraph.engines.reading import read_export
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.store import SUFFIX, open_project, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.conftest import Toy
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")

ROOT = Path(__file__).resolve().parents[3]
SAMPLE = str(ROOT / "sample_clips" / f"sample{SUFFIX}")


def run(*arguments: str | Path, **environ: str) -> subprocess.CompletedProcess[str]:
    """The command as a process of its own, without a screen."""
    clean = {
        k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    }
    words = [sys.executable, "-m", "app.cli", *map(str, arguments)]
    return subprocess.run(
        words, cwd=ROOT, env={**clean, **environ}, capture_output=True, text=True, timeout=300
    )


@pytest.fixture
def clips(tmp_path: Path) -> Path:
    folder = tmp_path / "clips"
    folder.mkdir()
    for name in ("idle", "wave", "nod"):
        write_glb(folder / f"{name}.glb", [clip(name)])
    return folder


@pytest.fixture
def small(clips: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """A project of three clips in which something plays."""
    path = clips.parent / f"small{SUFFIX}"
    assert main(["import", str(path), str(clips)]) == 0
    project = edits.add_stance(open_project(path).project, "arms", "rest", ["c1"])
    project = edits.place_clips(project, ["c2", "c3"], "arms", "gesture", "s4")
    save_project(project, path)
    capsys.readouterr()
    return path


# --- help and wrong usage


@pytest.mark.parametrize("command", [[], *([c] for c in COMMANDS)], ids=str)
def test_help_says_what_a_command_does(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main([*command, "--help"])
    assert caught.value.code == 0
    out = capsys.readouterr().out
    assert out.startswith("usage: metagraph")
    assert max(map(len, out.splitlines())) <= 110
    if not command:
        assert all(re.search(rf"^    {c}\s", out, re.MULTILINE) for c in COMMANDS)
        assert "exit codes" in out


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out.startswith("metagraph 0.")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["chekc"], "did you mean 'check'?"),
        (["frobnicate"], "the commands are window, import"),
        (["check"], "project"),
        (["render", SAMPLE], "-o/--out"),
        (["plan", SAMPLE, "-s", "long"], "invalid float value"),
        (["render", SAMPLE, "-o", "x.png", "--theme", "pink"], "invalid choice"),
        (["--frobnicate"], "unrecognized arguments"),
    ],
)
def test_wrong_usage_is_exit_code_2_with_a_hint(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check", "none.metagraph.yaml"], "none.metagraph.yaml, on opening it: cannot be read"),
        (["none.metagraph.yaml"], "there is no such file. Give a project"),
        (["info", "none.glb"], "none.glb"),
        (["plan", SAMPLE, "-s", "0"], "more than 0"),
        (["plan", SAMPLE, "-s", "nan"], "more than 0"),
        (["plan", SAMPLE, "-s", "inf"], "at most"),
        (["render", SAMPLE, "-o", "x.gif"], "pictures can be written as .png"),
        (["render", SAMPLE, "-o", "x"], "pictures can be written as .png"),
        (["render", SAMPLE, "-o", "x.png", "--size", "big"], "give --size as 960x540"),
        (["render", SAMPLE, "-o", "x.png", "--size", "1x1"], "--size must be between"),
        (["render", SAMPLE, "-o", "x.mp4", "--fps", "0"], "--fps must be 1 to 240"),
        (["render", SAMPLE, "-o", "x.png", "--frames", "0"], "--frames must be 1 to 1000"),
        (["render", SAMPLE, "-o", "x.png", "--clip", "nobody"], "there is no clip 'nobody'"),
        (["export", SAMPLE, "-o", str(ROOT / "pyproject.toml")], "cannot be created"),
    ],
)
def test_an_error_is_exit_code_1_in_words_that_help(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("metagraph: ")
    assert words in err
    assert "Traceback" not in err


def test_an_error_is_json_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "none.metagraph.yaml", "--json"]) == 1
    assert "cannot be read" in json.loads(capsys.readouterr().out)["error"]


def test_a_folder_nobody_may_write_to_is_an_error_in_words(
    small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    blocked = small.parent / "file"
    blocked.write_text("")
    for arguments in (
        ["export", str(small), "-o", str(blocked / "x")],
        ["render", str(small), "-o", str(blocked / "x" / "a.png")],
    ):
        assert main(arguments) == 1
        assert "Traceback" not in capsys.readouterr().err


# --- import


def test_import_makes_a_project_and_adds_to_it(
    clips: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["import", str(tmp_path / "new"), str(clips / "idle.glb")]) == 0
    path = tmp_path / f"new{SUFFIX}"
    assert read_project(path).name == "new"
    assert main(["import", str(path), str(clips), "--json"]) == 0
    assert json.loads(capsys.readouterr().out.splitlines()[-1])["imported"] == 3
    assert [e.path for e in read_project(path).clips.values()] == [
        "clips/idle.glb",
        "clips/nod.glb",
        "clips/wave.glb",
    ]


def test_import_with_a_bad_file_is_exit_code_3_and_the_rest_comes_in(
    clips: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (clips / "bad.bvh").write_text("HIERARCHY\nnonsense")
    path = clips.parent / f"p{SUFFIX}"
    assert main(["import", str(path), str(clips)]) == 3
    out, err = capsys.readouterr()
    assert "3 clips" in out and "1 unusable file" in out
    assert "left out: bad.bvh, " in err
    assert len(read_project(path).clips) == 3


def test_import_retargets_clips_of_another_skeleton_when_told_to(
    tmp_path: Path, toy: Toy, sample: Project, capsys: pytest.CaptureFixture[str]
) -> None:
    path, clips = tmp_path / f"p{SUFFIX}", tmp_path
    write_glb(clips / "own.glb", [toy.clip("own", 0.5)])
    motion = next(iter(sample.clips.values())).motion
    assert motion is not None
    write_glb(clips / "other.glb", [motion.trimmed(0, 20).renamed("other")])
    assert main(["import", str(path), str(clips / "own.glb")]) == 0
    assert main(["import", str(path), str(clips / "other.glb")]) == 1
    assert "import it with --retarget" in capsys.readouterr().err
    assert main(["import", str(path), str(clips / "other.glb"), "--retarget"]) == 0
    out, err = capsys.readouterr()
    assert "1 clip" in out and "retargeted" in out
    assert "note: other.glb" in err and "61 joints" in err
    assert len(read_project(path).joint_maps) == 1


def test_import_of_nothing_good_makes_no_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.bvh").write_text("no")
    assert main(["import", str(tmp_path / "p"), str(tmp_path)]) == 1
    assert not list(tmp_path.glob("*.yaml"))


def test_import_into_a_broken_project_leaves_it_as_it_is(
    clips: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = clips.parent / f"p{SUFFIX}"
    path.write_text("metagraph: 1\nclips: 7\n")
    assert main(["import", str(path), str(clips)]) == 1
    assert f"{path.name}, line 2: clips" in capsys.readouterr().err
    assert path.read_text() == "metagraph: 1\nclips: 7\n"


# --- check, plan, info


def test_check_lists_problems_with_what_to_do(small: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(small)]) == 0
    save_project(edits.update_actions(read_project(small), ["a6"], likelihood=0.0), small)
    assert main(["check", str(small)]) == 3
    out = capsys.readouterr().out
    assert "never plays" in out
    assert "Set it to more than 0." in out
    assert main(["check", str(small), "--json"]) == 3
    problems = json.loads(capsys.readouterr().out)["problems"]
    assert problems[0]["code"] == "likelihood"
    assert problems[0]["action"] == "a6"


def test_warnings_count_when_asked_to_be_strict(small: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_project(edits.update_actions(read_project(small), ["a6"], timing={"blend_in": 9.0}), small)
    assert main(["check", str(small)]) == 0
    assert main(["check", str(small), "--strict"]) == 3


def test_a_missing_clip_is_noted_and_checked(small: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (small.parent / "clips" / "wave.glb").unlink()
    assert main(["check", str(small)]) == 3
    out, err = capsys.readouterr()
    assert "note: 'clips/wave.glb'" in err
    assert "clip 'wave'" in out


@pytest.mark.nightly
def test_plan_lists_actions_in_time_and_the_seed_changes_them(
    small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", SAMPLE, "-s", "30"]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    starts = [float(row[0]) for row in rows]
    assert len(rows) > 10 and starts == sorted(starts)
    plans = []
    for seed in ("1", "1", "2"):
        assert main(["plan", SAMPLE, "-s", "30", "--seed", seed, "--json"]) == 0
        plans.append(json.loads(capsys.readouterr().out))
    assert plans[0] == plans[1] != plans[2]
    assert {"layer", "start", "end", "kind", "action", "name", "stance", "then"} == set(plans[0]["cues"][0])


def test_plan_of_a_project_where_nothing_plays_says_why(
    clips: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = clips.parent / f"p{SUFFIX}"
    assert main(["import", str(path), str(clips)]) == 0
    assert main(["plan", str(path)]) == 0
    assert "Nothing plays" in capsys.readouterr().err


def test_info_tells_of_a_clip_a_project_and_an_export(
    small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", str(small.parent / "clips" / "wave.glb")]) == 0
    assert "1 clip on 4 joints" in capsys.readouterr().out
    assert main(["info", str(small.parent / "clips" / "wave.glb"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["clips"][0]["frames"] == 31
    assert main(["info", str(small)]) == 0
    assert "small: 3 clips, 3 placed, 4 joints" in capsys.readouterr().out
    assert main(["export", str(small), "-o", str(small.parent / "game"), "--json"]) == 0
    made = json.loads(capsys.readouterr().out)
    told = []
    for path in (str(small), made["json"]):
        assert main(["info", path, "--json"]) == 0
        told.append(json.loads(capsys.readouterr().out))
    assert told[0] == told[1]
    assert told[0]["layers"]["arms"]["gesture"] == 2


def test_export_of_a_project_with_errors_says_what_to_mend(
    small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save_project(edits.update_actions(read_project(small), ["a6"], likelihood=0.0), small)
    assert main(["export", str(small), "-o", str(small.parent / "game")]) == 1
    assert "more than 0" in capsys.readouterr().err


# --- as a process


@pytest.mark.nightly
def test_a_whole_day_from_the_command_line_on_real_clips(
    shared_data: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"bandai{SUFFIX}"
    made = run("import", path, shared_data / "bandai-namco-1")
    assert (made.returncode, made.stdout) == (0, f"{path}: Imported 63 clips. 1 note\n")
    project = open_project(path).project
    by_name = {e.name.removeprefix("dataset-1_"): e.id for e in project.clips.values()}
    project = edits.add_stance(project, "body", "ready", [by_name["call_normal_001"]])
    gestures = [by_name[f"{n}_normal_001"] for n in ("bow", "bye", "guide", "respond")]
    project = edits.place_clips(
        project, gestures, "body", "gesture", next(iter(project.graphs["body"].stances))
    )
    save_project(project, path)
    assert main(["check", str(path)]) == 0
    capsys.readouterr()
    assert main(["plan", str(path), "-s", "40", "--json"]) == 0
    cues = json.loads(capsys.readouterr().out)["cues"]
    assert {c["name"].split("_")[1] for c in cues} <= {"bow", "bye", "guide", "respond"}
    exported = run("export", path, "-o", tmp_path / "game")
    assert exported.returncode == 0, exported.stderr
    json_path = Path(exported.stdout.splitlines()[0])
    assert read_export(json_path).graphs == project.graphs
    assert main(["info", str(json_path)]) == 0
    assert "5 placed" in capsys.readouterr().out


@pytest.mark.nightly
@pytest.mark.gl
def test_pictures_a_video_and_motion_are_rendered(small: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, first in (("a.png", b"\x89PNG"), ("a.mp4", b""), ("a.glb", b"glTF"), ("a.bvh", b"HIERARCHY")):
        out = small.parent / "new" / name
        assert (
            main(
                [
                    "render",
                    str(small),
                    "-o",
                    str(out),
                    "-s",
                    "0.4",
                    "--size",
                    "96x64",
                    "--frames",
                    "3",
                    "--json",
                ]
            )
            == 0
        )
        assert json.loads(capsys.readouterr().out) == {"written": str(out)}
        assert out.read_bytes().startswith(first)
        assert out.stat().st_size > 300
    assert (
        main(
            [
                "render",
                str(small),
                "--clip",
                "wave",
                "-o",
                str(small.parent / "wave.png"),
                "--size",
                "96x64",
                "--frames",
                "2",
            ]
        )
        == 0
    )


@pytest.mark.gl
def test_without_a_screen_the_same_job_runs_headless(tmp_path: Path, small: Path) -> None:
    made = run("demo", "-o", tmp_path / "out", "-s", "0.3", "--json")
    assert made.returncode == 0, made.stderr
    results = json.loads(made.stdout)
    assert set(results) == {"sheet", "video", "json", "glb"}
    assert all(Path(p).stat().st_size > 1000 for p in results.values())


def test_a_window_without_a_screen_is_the_demo_with_its_usual_options(
    small: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Namespace] = []

    def run_demo(options: Namespace) -> int:
        choose_plan(open_project(options.project).project, options)  # it has all that this needs
        asked.append(options)
        return 0

    monkeypatch.setattr(demo_command, "run", run_demo)
    monkeypatch.setattr(window_command, "has_screen", lambda: False)
    monkeypatch.delenv("QT_QPA_PLATFORM", raising=False)
    assert window_command.run(Namespace(paths=[small], json=True, sample=False, clip=None)) == 0
    assert asked[0].seconds == 60.0 and asked[0].out == Path("out")


@pytest.mark.nightly
def test_errors_come_without_a_traceback(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bad = tmp_path / f"bad{SUFFIX}"
    bad.write_bytes(b"\x00\xff")
    for words in (
        ["plan", tmp_path],
        ["info", bad],
        ["export", bad, "-o", tmp_path],
        ["import", bad, tmp_path / "none.glb"],
    ):
        assert main(list(map(str, words))) == 1
        told = capsys.readouterr().err
        assert told.startswith(("metagraph: ", "left out: "))
        assert "Traceback" not in told
    made = run("check", bad)  # and so does the process
    assert made.returncode == 1 and made.stderr.startswith("metagraph: ")
    assert "Traceback" not in made.stderr


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="pipes break otherwise on Windows")
def test_a_reader_that_has_read_enough_is_no_error(few: Path) -> None:
    made = subprocess.run(
        f"{sys.executable} -m app.cli plan '{few}' -s 6000 | head -1",
        shell=True,
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert made.stderr == ""
    assert len(made.stdout.splitlines()) == 1


def test_importing_a_folder_without_clips_is_an_error_that_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "empty").mkdir()
    assert main(["import", str(tmp_path / "p"), str(tmp_path / "empty")]) == 1
    assert "empty, " in capsys.readouterr().err
    assert not list(tmp_path.glob("*.yaml"))


HEAVY = ("numba", "scipy", "trimesh", "torch", "pyqtgraph", "PIL", "av", "jsonschema")


def loaded(code: str) -> set[str]:
    """The packages that are imported after some code ran in a process of its own."""
    words = f"{code}\nimport sys, json; print(json.dumps(sorted({{m.split('.')[0] for m in sys.modules}})))"
    made = subprocess.run(
        [sys.executable, "-c", words], cwd=ROOT, capture_output=True, text=True, check=True, timeout=300
    )
    return set(json.loads(made.stdout.splitlines()[-1]))


@pytest.mark.parametrize(
    "code",
    ["import app.cli.parser", "from app.cli.parser import main; main(['plan', {!r}, '-s', '2'])"],
    ids=["start", "plan"],
)
def test_commands_without_a_window_import_neither_qt_nor_anything_heavy(code: str, few: Path) -> None:
    assert not loaded(code.format(str(few))) & {"PySide6", "moderngl", *HEAVY}


@pytest.mark.nightly
def test_the_window_starts_without_anything_heavy() -> None:
    found = loaded("import app.shell.window")
    assert "PySide6" in found
    assert not found & set(HEAVY)


@pytest.mark.nightly
def test_sums_are_not_shared_among_threads_since_numpy_is_loaded_after_that_is_said():
    words = "import sys; from app.cli.parser import main; assert 'numpy' not in sys.modules; main(['check', '-h'])"
    code = (
        f"import atexit, os; atexit.register(lambda: print(os.environ.get('OPENBLAS_NUM_THREADS')))\n{words}"
    )
    clean = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"}
    told = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=clean, capture_output=True, text=True, timeout=300
    )
    assert told.stdout.split()[-1] == "1", told.stderr
    kept = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        env={**clean, "OPENBLAS_NUM_THREADS": "3"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert kept.stdout.split()[-1] == "3"


def test_an_import_says_what_is_new_and_what_was_here(
    small: Path, clips: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_glb(clips / "shrug.glb", [clip("shrug")])
    assert main(["import", str(small), str(clips)]) == 0
    assert "1 new, 3 " in capsys.readouterr().out


def test_info_on_a_folder_and_on_a_foreign_glb_says_so(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", str(tmp_path)]) == 1
    assert "is a folder" in capsys.readouterr().err
    assert main(["export", str(small), "-o", str(tmp_path / "game")]) == 0
    (glb,) = (tmp_path / "game").glob("*.glb")
    glb.write_bytes(glb.read_bytes() + bytes(4))
    capsys.readouterr()
    assert main(["info", str(glb.with_suffix(".json"))]) == 1
    assert "small.json" in (err := capsys.readouterr().err) and glb.name in err
