"""Two people's work on one project comes together, by hand and by Git, and what they disagree on is reported."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.formats.store import SUFFIX, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.model import Project
from tests.projects import clip

ROOT = Path(__file__).resolve().parents[3]
NAME = f"talk{SUFFIX}"


def beginning() -> Project:
    project = edits.add_clips(Project("talk"), [("clips/idle.glb", 0, "aa" * 32, clip("idle"))])
    return edits.add_stance(project, "arms", "rest", list(project.clips))


def with_gesture(project: Project, name: str) -> Project:
    """A person imports a clip and drops it on the stance."""
    after = edits.add_clips(project, [(f"clips/{name}.glb", 0, f"{len(name):02x}" * 32, clip(name))])
    (stance,) = after.graphs["arms"].stances
    return edits.place_clips(after, [*after.clips][-1:], "arms", "gesture", stance)


def gestures(project: Project) -> dict[str, str]:
    return {a.name: project.clips[a.clip].name for a in project.actions() if a.kind == "gesture"}


def three(tmp_path: Path, base: Project, ours: Project, theirs: Project) -> list[str]:
    paths = [tmp_path / f"{side}{SUFFIX}" for side in ("base", "ours", "theirs")]
    for path, project in zip(paths, (base, ours, theirs), strict=True):
        save_project(project, path)
    return [str(path) for path in paths]


def test_both_clips_are_there_and_each_gesture_plays_its_own(tmp_path: Path) -> None:
    base = beginning()
    paths = three(tmp_path, base, with_gesture(base, "wave"), with_gesture(base, "point"))
    assert main(["merge", *paths]) == 0
    merged = read_project(paths[1])
    assert gestures(merged) == {"wave": "wave", "point": "point"}
    assert not [p for p in check_project(merged) if p.code in ("swapped-clip", "lost-clip")]


def test_what_both_changed_is_ours_and_reported_in_the_projects_words(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    base = with_gesture(beginning(), "wave")
    (wave,) = (a.id for a in base.actions() if a.kind == "gesture")
    sides = [edits.update_actions(base, [wave], likelihood=x) for x in (2.0, 3.0)]
    paths = three(tmp_path, base, *sides)
    assert main(["merge", *paths, "--name", "show/talk"]) == 3
    said = capsys.readouterr()
    for piece in ("show/talk: ", "'wave'", "likelihood", "2 in ours", "3 in theirs"):
        assert piece in said.err, piece
    action = read_project(paths[1]).action(wave)
    assert action is not None and action.likelihood == 2.0


def test_theirs_can_be_preferred_and_the_result_written_elsewhere(tmp_path: Path) -> None:
    base = beginning()
    sides = [edits.set_settings(base, seed=seed) for seed in (5, 6)]
    paths = three(tmp_path, base, *sides)
    before = Path(paths[1]).read_bytes()
    out = tmp_path / f"merged{SUFFIX}"
    assert main(["merge", *paths, "--prefer", "theirs", "-o", str(out), "--json"]) == 3
    assert read_project(out).settings.seed == 6 and Path(paths[1]).read_bytes() == before


def test_json_lists_the_conflicts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    base = beginning()
    paths = three(tmp_path, base, *(edits.rename_project(base, name) for name in ("one", "two")))
    assert main(["merge", *paths, "--json"]) == 3
    found = json.loads(capsys.readouterr().out)
    (words,) = found["conflicts"]
    assert words.startswith("name: ") and "'one' in ours" in words and "'two' in theirs" in words


def test_where_both_added_the_project_there_is_no_base(tmp_path: Path) -> None:
    paths = three(tmp_path, beginning(), with_gesture(beginning(), "wave"), with_gesture(beginning(), "nod"))
    Path(paths[0]).write_bytes(b"")
    assert main(["merge", *paths]) in (0, 3)
    assert gestures(read_project(paths[1])) == {"wave": "wave", "nod": "nod"}


def test_what_is_not_there_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    paths = three(tmp_path, beginning(), beginning(), beginning())
    assert main(["merge", paths[0], str(tmp_path / "gone.yaml"), paths[2]]) == 1
    assert "gone.yaml" in capsys.readouterr().err
    assert main(["merge", paths[0]]) == 2 and "BASE OURS THEIRS" in capsys.readouterr().err


def test_the_setup_names_this_installation_and_git_can_run_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["merge", "--setup"]) == 0
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    (driver,) = (line for line in lines if line.startswith("git config"))
    assert str(Path(sys.executable).with_name("metagraph")) in driver
    assert f"*{SUFFIX} merge=metagraph" in lines and f"*{SUFFIX}.[0-9]*" in lines
    git(tmp_path, "init", "-q")
    git(tmp_path, *shlex.split(driver)[1:])
    assert git(tmp_path, "config", "merge.metagraph.driver").strip().endswith("merge %O %A %B --name %P")


def test_the_help_has_the_lines_that_git_needs(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["merge", "--help"])
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    assert "git config merge.metagraph.driver 'metagraph merge %O %A %B --name %P'" in lines
    assert f"*{SUFFIX} merge=metagraph" in lines


def test_a_file_that_is_no_project_is_refused_and_ours_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = three(tmp_path, beginning(), beginning(), beginning())
    Path(paths[2]).write_text("hello")
    before = Path(paths[1]).read_bytes()
    assert main(["merge", *paths]) == 1
    assert "theirs" in capsys.readouterr().err and Path(paths[1]).read_bytes() == before


def git(folder: Path, *words: str, fails: bool = False) -> str:
    person = {f"GIT_{role}_{part}": "a@b" for role in ("AUTHOR", "COMMITTER") for part in ("NAME", "EMAIL")}
    done = subprocess.run(
        ["git", *words],
        cwd=folder,
        env={**os.environ, **person, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture
def shared(tmp_path: Path) -> Path:
    """A project in a Git repository that merges projects as the documentation says."""
    git(tmp_path, "init", "-q", "-b", "main")
    command = f'"{sys.executable}" -P -c "import sys; sys.path.insert(0, {str(ROOT)!r}); from app.cli.parser import main; sys.exit(main())" merge %O %A %B --name %P'
    git(tmp_path, "config", "merge.metagraph.driver", command)
    (tmp_path / ".gitattributes").write_text(f"*{SUFFIX} merge=metagraph\n")
    save_project(beginning(), tmp_path / NAME)
    git(tmp_path, "add", "-A")
    git(tmp_path, "commit", "-qm", "begin")
    return tmp_path


def branch(folder: Path, name: str, project: Project) -> None:
    git(folder, "checkout", "-q", "-b", name, "main")
    save_project(project, folder / NAME)
    git(folder, "commit", "-qam", name)


@pytest.mark.nightly
def test_git_merges_two_branches_without_a_conflict(shared: Path) -> None:
    branch(shared, "mine", with_gesture(beginning(), "wave"))
    branch(shared, "theirs", with_gesture(beginning(), "point"))
    git(shared, "merge", "-q", "mine", "-m", "both")
    assert gestures(read_project(shared / NAME)) == {"wave": "wave", "point": "point"}
    assert git(shared, "status", "--porcelain") == ""


@pytest.mark.nightly
def test_git_stops_at_a_conflict_and_the_project_can_be_opened(shared: Path) -> None:
    branch(shared, "mine", edits.rename_project(beginning(), "mine"))
    branch(shared, "theirs", edits.rename_project(beginning(), "theirs"))
    said = git(shared, "merge", "mine", "-m", "both", fails=True)
    (line,) = [x for x in said.splitlines() if "'theirs'" in x and "'mine'" in x]
    assert line.strip().startswith(f"{NAME}: name: ")
    assert read_project(shared / NAME).name == "theirs"
    assert f"UU {NAME}" in git(shared, "status", "--porcelain")


def test_a_text_merge_that_keeps_one_sides_clip_is_found_by_check() -> None:
    """Two people had made `c12` before ids were distinguished; by hand somebody kept the wrong line."""
    from metagraph.formats.store import encode_project, parse_project

    base = beginning()
    (idle,) = base.clips
    texts = {}
    for name in ("wave", "point"):
        text = encode_project(with_gesture(base, name), Path(NAME)).decode()
        new = next(i for i in with_gesture(base, name).clips if i != idle)
        texts[name] = text.replace(new, "c12")
    ours, theirs = (text.splitlines(keepends=True) for text in texts.values())
    line = next(n for n, words in enumerate(ours) if "- {id: c12" in words)
    ours[line] = next(words for words in theirs if "- {id: c12" in words)
    project = parse_project("".join(ours), Path(NAME))
    (found,) = (p for p in check_project(project) if p.code == "swapped-clip")
    assert "'wave'" in found.message and "'point'" in found.message
    kept = parse_project(encode_project(project, Path(NAME)).decode(), Path(NAME))
    assert kept == project, "saving it does not hide the swap"


def test_a_file_with_gits_conflict_marks_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = "metagraph: 2\n<<<<<<< HEAD\nname: one\n=======\nname: two\n>>>>>>> theirs\n"
    (tmp_path / NAME).write_text(text)
    assert main(["check", str(tmp_path / NAME)]) == 1
    said = capsys.readouterr().err
    assert "line 2" in said and "Git" in said and "together.md" in said
