"""Exports appear whole or not at all, under names that every system takes, with nobody else's files in them."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.common.file_names import fold_file_name
from metagraph.engines.export import export_project
from metagraph.engines.targets import placing, registry
from metagraph.engines.targets.placing import RECORD, Staging
from metagraph.engines.targets.target import Contents
from metagraph.errors import FileError
from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Line
from tests import wavs
from tests.thorough import many

TARGETS = tuple(registry.list_targets())
SAMPLE = Path(__file__).parents[2] / "sample_clips" / "sample.metagraph.yaml"


@pytest.fixture
def small(toy: Any) -> Project:
    return toy.project()


def files(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def long_named(project: Project) -> Project:
    graphs = {
        layer: replace(
            graph,
            actions={i: replace(a, name="A" * 400 + i) for i, a in graph.actions.items()},
            stances={i: replace(s, name="S" * 400 + i) for i, s in graph.stances.items()},
        )
        for layer, graph in project.graphs.items()
    }
    return replace(project, name="n" * 400, graphs=graphs)


@pytest.mark.nightly
@pytest.mark.parametrize("name", TARGETS)
def test_names_of_any_length_are_exported_whole(small: Project, tmp_path: Path, name: str) -> None:
    project = long_named(small)
    if name == "vrm":  # is of a mesh, which has a body's bones
        project = long_named(open_project(SAMPLE).project)
    contents = Contents(SAMPLE.with_name("ada.glb") if name == "vrm" else None)
    made = registry.write_for_target(project, name, tmp_path / "out", contents)
    assert all(path.is_file() for path in made.files)
    assert all(len(part.encode()) <= 255 for f in files(tmp_path) for part in f.split("/"))


@pytest.mark.parametrize("called", ["CON", "nul.txt", "a:b", "../../x", "x\ud800", "...", ""])
def test_projects_of_any_name_are_exported(small: Project, tmp_path: Path, called: str) -> None:
    project = replace(small, name=called)
    made = registry.write_for_target(project, "metagraph", tmp_path / "out")
    assert set(files(tmp_path / "out")) == {RECORD, *(p.name for p in made.files)}
    assert not {p.stem.casefold() for p in made.files} & {"con", "nul", "nul.txt"}
    assert made.files[0].read_bytes().decode("utf-8")


def test_actions_that_differ_in_capitals_alone_have_files_of_their_own(
    small: Project, tmp_path: Path
) -> None:
    arms = small.graphs["arms"]
    actions = {
        i: replace(a, name="wave" if n % 2 else "Wave") for n, (i, a) in enumerate(arms.actions.items())
    }
    project = replace(small, graphs={**small.graphs, "arms": replace(arms, actions=actions)})
    for name in ("smartbody", "unity-controller"):
        made = registry.write_for_target(project, name, tmp_path / name)
        assert len({fold_file_name(str(p)) for p in made.files}) == len(made.files)


def failing(real: Callable[..., Any], after: int) -> Callable[..., Any]:
    """Return Path.replace that fails once, at its turn `after`, as a full disk or an open file makes it."""
    turns = [0]

    def replaced(self: Path, to: Path) -> Any:
        turns[0] += 1
        if turns[0] == after:
            raise OSError(28, "No space left on device", str(to))
        return real(self, to)

    return replaced


@pytest.mark.nightly
@pytest.mark.parametrize("stood", [False, True])
def test_what_fails_half_way_leaves_everything_as_it_was(
    small: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stood: bool
) -> None:
    out = tmp_path / "deep" / "out"
    if stood:
        registry.write_for_target(small, "javascript", out)
        (out / "mine.txt").write_text("mine")
    before = files(tmp_path)
    edited = replace(small, settings=replace(small.settings, seed=99))
    real = Path.replace
    moves = 0
    for after in range(1, 200, many(6, 1)):
        monkeypatch.setattr(Path, "replace", failing(real, after))
        try:
            registry.write_for_target(edited, "javascript", out)
        except FileError as error:
            moves += 1
            assert error.remedy
            monkeypatch.setattr(Path, "replace", real)
            assert files(tmp_path) == before, after
            assert stood or not (tmp_path / "deep").exists()
            continue
        break
    monkeypatch.setattr(Path, "replace", real)
    assert moves > many(5, 30) and files(tmp_path) != before
    assert not stood or (out / "mine.txt").read_text() == "mine"


def test_a_folder_in_the_way_is_not_taken_away(small: Project, tmp_path: Path) -> None:
    made = registry.write_for_target(small, "metagraph", tmp_path)
    made.files[0].unlink()
    made.files[0].mkdir()
    (made.files[0] / "precious").write_text("x")
    with pytest.raises(FileError, match="folder"):
        registry.write_for_target(small, "metagraph", tmp_path, overwrite=True)
    assert (made.files[0] / "precious").read_text() == "x"


def test_interrupted_staging_puts_back_what_stood_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a").write_text("old")
    real = Path.replace

    def interrupted(self: Path, to: Path) -> Any:
        if to.name == "b":
            raise KeyboardInterrupt
        return real(self, to)

    with pytest.raises(KeyboardInterrupt), Staging(tmp_path) as staged:
        for name in ("a", "b"):
            (staged.path / name).write_text("new")
        monkeypatch.setattr(Path, "replace", interrupted)
        staged.move(["a", "b"])
    assert files(tmp_path) == {"a": b"old"}


def test_a_record_that_names_files_elsewhere_takes_none_away(small: Project, tmp_path: Path) -> None:
    out = tmp_path / "out"
    registry.write_for_target(small, "metagraph", out)
    victim = tmp_path / "victim"
    victim.write_text("x")
    record = msgspec.json.decode((out / RECORD).read_bytes(), type=placing.ExportRecord)
    spoilt = {**record.files, "../victim": placing.digest(victim)}
    (out / RECORD).write_bytes(msgspec.json.encode(msgspec.structs.replace(record, files=spoilt)))
    registry.write_for_target(small, "metagraph", out)
    assert victim.read_text() == "x"


# --- sounds


def wav(path: Path) -> Path:
    """Write a tenth of a second of silence."""
    return wavs.wav(path, 16000, bytes(3200))


def with_lines(project: Project, **sounds: str) -> Project:
    return replace(project, lines={i: Line(text=i, audio=name) for i, name in sounds.items()})


def test_what_is_no_sound_is_never_copied(small: Project, tmp_path: Path) -> None:
    base = tmp_path / "project"
    base.mkdir()
    (base / "key.wav").write_text("-----BEGIN PRIVATE KEY-----")
    (tmp_path / "passwd").write_text("root:x:0")
    if hasattr(os, "mkfifo"):
        os.mkfifo(base / "pipe.wav")
    names = {
        "a": str(tmp_path / "passwd"),
        "b": "../passwd",
        "c": "key.wav",
        "d": "pipe.wav",
        "e": "x" * 5000,
    }
    project = with_lines(small, **names, f="a\0b", g=".")
    made = registry.write_for_target(
        project, "metagraph", tmp_path / "out", Contents(base=base, chosen=lambda path: True)
    )
    assert not (tmp_path / "out" / "lines").exists()
    assert all(b"root:" not in data and b"PRIVATE" not in data for data in files(tmp_path / "out").values())
    assert sum("is left out" in w for w in made.warnings) == 7
    assert str(tmp_path).encode() not in made.files[0].read_bytes()  # nor is it told where it lies


def test_a_sound_outside_the_project_s_folder_is_copied_where_the_user_chose_it(
    small: Project, tmp_path: Path
) -> None:
    base, outside = tmp_path / "project", wav(tmp_path / "voice" / "hi.wav")
    wav(base / "in" / "ho.wav")
    project = with_lines(small, out="../voice/hi.wav", whole=outside.as_posix(), inner="in/ho.wav")
    made = registry.write_for_target(project, "metagraph", tmp_path / "a", Contents(base=base))
    assert set(files(tmp_path / "a")) - {RECORD} == {
        *(p.name for p in made.files[:2]),
        "lines/ho.wav",
        "README.md",
    }
    assert sum("outside the project's folder" in w for w in made.warnings) == 2
    asked: list[Path] = []
    registry.write_for_target(
        project,
        "metagraph",
        tmp_path / "b",
        Contents(base=base, chosen=lambda p: bool(asked.append(p) or True)),
    )
    assert {f for f in files(tmp_path / "b") if f.startswith("lines/")} == {
        "lines/hi.wav",
        "lines/hi-2.wav",
        "lines/ho.wav",
    }
    assert len(asked) == 2


@pytest.mark.parametrize(
    ("target", "kept"),
    [("godot", {"a.wav", "b.wav", "c.ogg", "d.wav", "e.wav"}), ("unity", {"a.wav", "b.wav", "c.ogg", "d.aiff", "e.wav"}),
     ("javascript", {"a.flac", "b.wav", "c.ogg", "d.aiff", "e.wav"})],
)  # fmt: skip
def test_sounds_that_an_engine_does_not_import_become_wav_files(
    small: Project, tmp_path: Path, target: str, kept: set[str]
) -> None:
    import soundfile

    base = tmp_path / "project"
    base.mkdir()
    samples = np.linspace(-0.5, 0.5, 3200).reshape(-1, 2)
    for name in ("a.flac", "b.wav", "c.ogg", "d.aiff"):
        soundfile.write(base / name, samples, 16000)
    soundfile.write(base / "e.wav", samples, 16000, subtype="IMA_ADPCM")
    project = with_lines(small, **{name: name for name in ("a.flac", "b.wav", "c.ogg", "d.aiff", "e.wav")})
    out = tmp_path / "out"
    made = registry.write_for_target(project, target, out, Contents(base=base))
    assert {p.name for p in (out / "lines").iterdir()} == kept
    said = msgspec.json.decode(made.files[0].read_bytes())["lines"].values()
    assert {line["audio"] for line in said} == {f"lines/{name}" for name in kept}
    read, rate = soundfile.read(out / "lines" / min(kept))
    assert rate == 16000 and np.abs(read - samples).max() < 1e-4
    assert (out / "lines" / "b.wav").read_bytes() == (base / "b.wav").read_bytes()
    changed = soundfile.info(str(out / "lines" / "e.wav")).subtype == "PCM_16"
    assert changed == (target != "javascript")


def test_a_link_out_of_the_project_s_folder_is_outside(small: Project, tmp_path: Path) -> None:
    base = tmp_path / "project"
    base.mkdir()
    try:
        (base / "hi.wav").symlink_to(wav(tmp_path / "hi.wav"))
    except OSError:
        pytest.skip("links are not to be had here")
    made = registry.write_for_target(
        with_lines(small, a="hi.wav"), "metagraph", tmp_path / "out", Contents(base=base)
    )
    assert any("outside" in w for w in made.warnings)


def test_the_plain_export_is_whole_as_well(
    small: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    export_project(small, tmp_path)
    before = files(tmp_path)
    monkeypatch.setattr(Path, "replace", failing(Path.replace, 4))
    with pytest.raises(FileError):
        export_project(replace(small, settings=replace(small.settings, seed=3)), tmp_path)
    assert files(tmp_path) == before


@pytest.mark.nightly
def test_an_export_killed_at_any_step_is_whole_or_reported_and_the_next_one_is_whole(
    small: Project, tmp_path: Path
) -> None:
    """At each of the steps that move files: none is missing, and JSON and GLB never differ in silence."""
    from metagraph.engines.reading import read_export

    others = edits.remove_clips(small, [next(a.clip for a in small.actions() if a.kind == "gesture")])
    states = {}
    for name, project in (("old", small), ("new", others)):
        registry.write_for_target(project, "metagraph", tmp_path / name)
        states[name] = files(tmp_path / name)
    assert states["old"]["toy.glb"] != states["new"]["toy.glb"]
    mixed = 0
    for step in range(1, 10):
        folder = tmp_path / f"killed {step}"
        registry.write_for_target(small, "metagraph", folder)
        pid = os.fork()
        if pid == 0:
            _export_until(others, folder, step)
        if os.waitpid(pid, 0)[1] == 0:
            break  # there are no more steps
        found = {name: content for name, content in files(folder).items() if not name.startswith(".")}
        assert found.keys() == {"toy.json", "toy.glb", "README.md"}
        assert all(content in (states["old"][n], states["new"][n]) for n, content in found.items())
        whole = any(all(states[s][n] == content for n, content in found.items()) for s in states)
        try:
            read_export(folder / "toy.json")
            assert whole
        except FileError as error:
            assert not whole and "is not the GLB that toy.json was written with" in str(error)
            mixed += 1
        registry.write_for_target(others, "metagraph", folder)
        assert files(folder) == states["new"], "and nothing hidden is left"
    assert 3 <= step < 9 and mixed <= 1


def _export_until(project: Project, folder: Path, step: int) -> None:
    """Export in a process that ends, as by a kill, before the file that is moved as number `step`."""
    real, count = Path.replace, 0

    def replace(self: Path, target: Path) -> Path:
        nonlocal count
        count += ".saving" not in str(self)
        if count == step:
            os._exit(9)
        return real(self, target)

    Path.replace = replace  # type: ignore[method-assign]
    registry.write_for_target(project, "metagraph", folder)
    os._exit(0)


def test_staging_folders_of_living_exports_and_folders_of_like_names_stay(tmp_path: Path) -> None:
    with Staging(tmp_path) as first, Staging(tmp_path) as second:
        assert first.path.is_dir() and second.path.is_dir()
    (tmp_path / ".exporting-of-mine").mkdir()
    with Staging(tmp_path):
        assert (tmp_path / ".exporting-of-mine").is_dir()
