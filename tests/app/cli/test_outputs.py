"""Every command keeps to the same rules when it writes; projects that are changed in place are locked, and
keep their earlier versions.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.cli import outputs
from app.cli.outputs import FOLDERS, NEVER, OUTPUTS, WRITTEN, ProjectOutput
from app.cli.parser import COMMANDS, _parser, main
from app.project.version_count import count_kept_versions, set_version_count
from metagraph.errors import FileError
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.project.versions import list_earlier_versions
from metagraph.formats.store import SUFFIX, open_project, read_project, save_project
from metagraph.graph import edits
from tests.projects import clip

ROOT = Path(__file__).resolve().parents[3]


def leaves(parser: argparse.ArgumentParser, name: str) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    nested = [a for a in parser._actions if isinstance(a, argparse._SubParsersAction)]
    if not nested:
        yield name, parser
    for action in nested:
        for inner, part in action.choices.items():
            yield from leaves(part, f"{name} {inner}")


def commands() -> dict[str, argparse.ArgumentParser]:
    out = {}
    for name in COMMANDS:
        whole = next(a for a in _parser(name)._actions if isinstance(a, argparse._SubParsersAction))
        out |= dict(leaves(whole.choices[name], name))
    return out


# Options of type Path that are read, in all commands. A new one goes here, or among the outputs.
READ = {
    *(
        "base",
        "ours",
        "theirs",
        "project",
        "path",
        "paths",
        "labels",
        "folder",
        "patterns",
        "annotation",
        "sounds",
        "takes",
        "voice",
    ),
    *(
        "keypoints",
        "audio",
        "words",
        "study",
        "others",
        "like",
        "log",
        "recording",
        "pilot",
        "plan",
        "answers",
    ),
    *("model", "speech", "first", "given", "floor", "new", "again", "words_list", "transcripts"),
    *("one", "other"),
}


def test_each_option_that_names_a_file_is_known_as_read_or_written() -> None:
    for name, parser in commands().items():
        command, action = name.split()[0], name.split()[-1] if " " in name else None
        for option in parser._actions:
            if option.type is not Path:
                continue
            written = option.dest in OUTPUTS or (command, action, option.dest) in WRITTEN
            assert written != (option.dest in READ), f"{name} {option.dest}"


def test_each_command_with_an_output_may_be_told_to_overwrite_and_no_other() -> None:
    for name, parser in commands().items():
        command, action = name.split()[0], name.split()[-1] if " " in name else None
        known = {option.dest for option in parser._actions}
        writes = bool(known & {*OUTPUTS}) or any((c, a) == (command, action) for c, a, _ in WRITTEN)
        assert ("overwrite" in known) == (writes and (command, action) not in NEVER), name


def test_the_commands_that_are_named_are_there() -> None:
    names = {(n.split()[0], n.split()[-1] if " " in n else None) for n in commands()}
    assert {*FOLDERS, *NEVER, *((c, a) for c, a, _ in WRITTEN)} <= names


def test_projects_are_written_by_one_way_alone() -> None:
    """A command that saves by other means keeps no version, and asks nobody."""
    found = [
        p.name
        for p in Path(outputs.__file__).parent.glob("*.py")
        if "save_project(" in p.read_text(encoding="utf-8")
    ]
    assert found == ["live_command.py"], "which keeps a session in a new project where its own takes none"


# --- with files


@pytest.fixture
def project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """A project of three clips in which something plays."""
    (tmp_path / "clips").mkdir()
    for name in ("idle", "wave", "nod"):
        write_glb(tmp_path / "clips" / f"{name}.glb", [clip(name)])
    path = tmp_path / f"small{SUFFIX}"
    assert main(["import", str(path), str(tmp_path / "clips")]) == 0
    made = open_project(path).project
    of = {entry.name: ident for ident, entry in made.clips.items()}
    made = edits.add_stance(made, "arms", "rest", [of["idle"]])
    (stance,) = made.graphs["arms"].stances
    save_project(edits.place_clips(made, [of["wave"], of["nod"]], "arms", "gesture", stance), path)
    capsys.readouterr()
    return path


COMMAND_LINES: dict[str, Callable[[Path, Path], list[str]]] = {
    "a.bvh": lambda p, o: ["render", str(p), "-s", "1", "-o", str(o)],
    "a.glb": lambda p, o: ["render", str(p), "-s", "1", "-o", str(o)],
    "a.usda": lambda p, o: ["render", str(p), "-s", "1", "-o", str(o)],
    f"b{SUFFIX}": lambda p, o: ["contacts", str(p), "-o", str(o), "--clear"],
    "small.tools.json": lambda p, o: ["export", str(p), "-o", str(o.parent), "--tools"],
    "vectors.json": lambda p, o: ["export", str(p), "-o", str(o.parent), "--vectors"],
    "small.json": lambda p, o: ["export", str(p), "-o", str(o.parent)],
}


@pytest.mark.parametrize("name", COMMAND_LINES)
def test_what_somebody_else_made_stays_and_what_the_command_made_is_made_anew(
    project: Path, tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out" / name
    out.parent.mkdir()
    (out.parent / "beside.txt").write_text("mine")
    line = COMMAND_LINES[name](project, out)
    out.write_text("work")
    assert main(line) == 1 and out.read_text() == "work"
    assert "--overwrite" in capsys.readouterr().err
    assert main([*line, "--overwrite"]) == 0 and out.read_bytes() != b"work"
    assert main(line) == 0, "its own"
    made = out.read_bytes()
    out.write_bytes(made + b"\n")
    assert main(line) == 1 and out.read_bytes() == made + b"\n", "changed by hand"
    assert (out.parent / "beside.txt").read_text() == "mine"


@pytest.mark.parametrize("more", [[], ["--overwrite"]], ids=["asking", "overwriting"])
@pytest.mark.parametrize("what", ["clips/wave.glb", f"small{SUFFIX}"])
def test_a_render_never_replaces_what_its_project_is_made_of(
    project: Path, what: str, more: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = project.parent / what
    before = source.read_bytes()
    link = tmp_path / f"link{source.suffix if source.suffix == '.glb' else '.bvh'}"
    link.symlink_to(source)
    names = [link] if source == project else [link, source]
    for out in names:
        assert main(["render", str(project), "-s", "1", "-o", str(out), *more]) == 1
    assert source.read_bytes() == before and "Write to another file" in capsys.readouterr().err


@pytest.mark.parametrize(
    "line",
    [
        ["import", "{p}", "{c}"],
        ["moods", "{p}", "--mood", "happy"],
        ["contacts", "{p}", "--clear"],
        ["contacts", "{p}", "-o", "{p}", "--overwrite"],
        ["label", "{p}"],
        ["label", "{c}", "-o", "{p}", "--overwrite"],
    ],
    ids=lambda line: " ".join(line[:1]),
)
def test_a_project_that_another_process_has_open_is_left_alone(
    project: Path, line: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    code = "import sys\nfrom pathlib import Path\nfrom metagraph.formats.locking import *\n"
    code += (
        "lock = Lock(Path(sys.argv[1]), make_owner()); lock.acquire(); print(lock.held, flush=True); input()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(project)],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None and process.stdout.readline() == "True\n"
        before = project.read_bytes()
        done = [x.format(p=project, c=project.parent / "clips") for x in line]
        assert main(done) == 1 and project.read_bytes() == before
        assert project.name in capsys.readouterr().err
    finally:
        process.communicate("\n")


def test_a_project_changed_in_place_keeps_its_earlier_versions(project: Path) -> None:
    before = project.read_bytes()
    assert main(["moods", str(project), "--mood", "happy"]) == 0
    assert main(["moods", str(project), "--mood", "happy"]) == 0, "nothing changes"
    (version,) = list_earlier_versions(project)
    assert version.path.read_bytes() == before
    assert not list(project.parent.glob(".*lock"))
    set_version_count(0)
    assert main(["moods", str(project), "--mood", "sad"]) == 0
    assert len(list_earlier_versions(project)) == 1


def test_how_many_are_kept_is_one_setting(monkeypatch: pytest.MonkeyPatch) -> None:
    assert count_kept_versions() == 3
    set_version_count(7)
    assert count_kept_versions() == 7
    monkeypatch.setenv("METAGRAPH_VERSIONS", "2")
    assert count_kept_versions() == 2
    monkeypatch.setenv("METAGRAPH_VERSIONS", "many")
    assert count_kept_versions() == 3


def test_a_project_that_was_written_meanwhile_is_left_as_it_is(project: Path) -> None:
    with ProjectOutput(project) as output:
        made = open_project(project).project
        project.write_bytes(project.read_bytes() + b"\n# by hand\n")
        with pytest.raises(FileError, match="Run the command again"):
            output.save(made)
    assert project.read_bytes().endswith(b"# by hand\n")


# --- labelling a folder again


def test_a_second_label_adds_what_is_new_and_leaves_what_a_person_set(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "talk"
    folder.mkdir()
    ours = sorted((ROOT / "sample_clips" / "clips").glob("on_hips__*.glb"))
    for path in ours[:6]:
        shutil.copy(path, folder)
    line = ["label", str(folder), "--no-pictures", "--play", "0", "--json"]
    assert main(line) in (0, 3)
    path = tmp_path / f"talk{SUFFIX}"
    capsys.readouterr()
    project = open_project(path).project
    action = next(a for a in project.actions() if a.kind != "stance")
    stance = next(iter(project.graphs[action.layer].stances))
    project = edits.update_actions(project, [action.id], likelihood=0.25, tags=("by hand",))
    project = edits.rename_stance(project, stance, "My stance")
    project = edits.set_weight(project, action.layer, "legs", 0.5)
    gone = next(a for a in project.actions() if a.kind != "stance" and a.id != action.id)
    project = edits.remove_actions(project, [gone.id])
    save_project(project, path)
    before = path.read_bytes()
    assert main(line) in (0, 3)
    data = json.loads(capsys.readouterr().out)
    assert (data["added"], data["skipped"], data["kept"], data["waiting"]) == (0, 6, 6, 1)
    assert path.read_bytes() == before
    shutil.copy(ours[6], folder)
    assert main(line) in (0, 3)
    data = json.loads(capsys.readouterr().out)
    assert (data["added"], data["kept"]) == (1, 6)
    after = read_project(path)
    assert set(project.clips) < set(after.clips) and len(after.clips) == 7
    for one in project.actions():
        assert after.action(one.id) == one, "what was set stays"
    assert {i: s for g in project.graphs.values() for i, s in g.stances.items()}.items() <= {
        i: s for g in after.graphs.values() for i, s in g.stances.items()
    }.items()
    assert after.graphs[action.layer].weight("legs") == 0.5 and after.base == project.base
    assert not after.uses.get(gone.clip), "what was taken away is not put back"
    assert list_earlier_versions(path)[0].path.read_bytes() == before


def test_a_report_that_was_changed_is_kept_beside_the_new_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "talk"
    folder.mkdir()
    *first, later = sorted((ROOT / "sample_clips" / "clips").glob("on_hips__*.glb"))[:4]
    for path in first:
        shutil.copy(path, folder)
    assert main(["label", str(folder), "--no-pictures", "--play", "0"]) in (0, 3)
    (tmp_path / "talk.labels.html").write_text("my notes")
    shutil.copy(later, folder)
    assert main(["label", str(folder), "--no-pictures", "--play", "0"]) in (0, 3)
    assert (tmp_path / "talk.labels.html").read_text() == "my notes"
    assert "talk.labels 2.html" in capsys.readouterr().out
