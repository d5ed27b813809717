"""A conversation on stage: both characters, whose plan is seen, sound, keeping and writing it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.cli.parser import main
from app.stage.conversation_plans import ConversationPlans, keep_conversation
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import open_project, save_project
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.graph.model import Project
from metagraph.graph.requests import Gesture, Look, Place, Play
from preview.figure import SkinnedFigure

ROOT = Path(__file__).parents[3]
RATE = 16000


def conversation(folder: Path) -> Conversation:
    """Two who hum in turn, with their sound."""
    import soundfile

    t = np.arange(8 * RATE) / RATE
    hum = 0.3 * np.sin(2 * np.pi * 150 * t) + 0.1 * np.sin(2 * np.pi * 700 * t)
    sound = np.stack([hum * ((t >= a) & (t < b)) for a, b in ((1.0, 3.0), (4.0, 6.0))], 1)
    soundfile.write(folder / "talk.wav", sound + np.random.default_rng(1).normal(0, 1e-4, sound.shape), RATE)
    ada = (Segment("clause", 1.0, 3.0, 2.2, "hello to you"), Segment("hesitation", 3.2, 3.6, None, "um"))
    ben = (Segment("clause", 4.0, 6.0, 5.0, "hello"), Segment("response", 3.0, 3.15, None, "yes"))
    sides = (
        Side(name="Ada", audio="talk.wav", channel=0, segments=ada),
        Side(name="Ben", audio="talk.wav", channel=1, segments=tuple(sorted(ben, key=lambda s: s.start))),
    )
    every = tuple(
        msgspec.structs.replace(
            s, rates=msgspec.structs.replace(s.rates, clause=1.0, response=1.0, hesitation=1.0)
        )
        for s in sides
    )
    return Conversation(name="Greeting", length=8.0, sides=every)


@pytest.fixture(scope="module")
def saved(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a project file, talk.metagraph.yaml, and its conversation of id v9000; tests change
    copies.
    """
    folder = tmp_path_factory.mktemp("talk")
    talks = {"v9000": conversation(folder)}
    whole = make_paths_absolute(sample, ROOT / "sample_clips")
    save_project(
        replace(whole, conversations=talks, lines={}, performances={}), folder / "talk.metagraph.yaml"
    )
    return folder


@pytest.fixture
def talking(saved: Path, tmp_path: Path) -> Path:
    """The project file with the conversation."""
    shutil.copytree(saved, tmp_path, dirs_exist_ok=True)
    return tmp_path / "talk.metagraph.yaml"


@pytest.fixture
def staged(drive, talking):
    """The window with the conversation on stage."""
    drive.files.open(talking)
    drive.wait(lambda: drive.document.folder == talking.parent and drive.performance.skeleton() is not None)
    drive.session.onstage.set_conversation("v9000")
    drive.wait(lambda: bool(drive.performance.shown.others))
    return drive


@pytest.mark.nightly
def test_both_are_seen_each_on_its_place_and_the_camera_sees_both(staged):
    staged.wait(lambda: len(staged.preview.scene().actors) == 2)
    low, high = staged.preview.scene().bounds()
    assert high[0] - low[0] > 1.3
    scene = staged.preview.scene()
    assert scene.actors[0].positions[..., 0].mean() < 0 < scene.actors[1].positions[..., 0].mean()


@pytest.mark.nightly
def test_the_timeline_shows_one_sides_plan_and_the_other_when_it_is_chosen(staged):
    names = [staged.timeline.stage.itemText(n) for n in range(staged.timeline.stage.count())]
    assert names[-2:] == ["Greeting: Ada", "Greeting: Ben"]
    assert staged.timeline.stage.currentText() == "Greeting: Ada"
    assert [a.stroke for a in staged.performance.asks if isinstance(a, Gesture)] == [2.2]
    staged.timeline.stage.setFocus()
    QTest.keyClick(staged.timeline.stage, Qt.Key.Key_Down)
    staged.wait(lambda: staged.performance.shown.side == 1)
    assert [a.stroke for a in staged.performance.asks if isinstance(a, Gesture | Play)] == [5.0]
    assert staged.preview.scene().actors[0].positions[..., 0].mean() < 0, "nobody moves to another place"


@pytest.mark.nightly
def test_improvised_takes_the_conversation_off_stage(staged):
    staged.timeline.stage.setFocus()
    QTest.keyClick(staged.timeline.stage, Qt.Key.Key_Up)
    assert staged.session.onstage.conversation is None
    staged.wait(lambda: not staged.performance.shown.others)


@pytest.mark.nightly
def test_both_are_heard_each_where_it_speaks(staged):
    staged.wait(lambda: len(staged.sound.parts) == 2)
    heard = [np.flatnonzero(np.abs(samples) > 0.1) / 44100 + at for at, samples in staged.sound.parts]
    assert [round(float(h.min())) for h in heard] == [1, 4]
    assert [round(float(h.max())) for h in heard] == [3, 6]


@pytest.mark.nightly
def test_it_plays_to_its_end_and_stops_there(staged):
    staged.session.transport.loop = False
    staged.session.transport.seek(7.9)
    staged.session.transport.set_playing(True)
    staged.shell.stage.playhead.advance(0.5)
    assert staged.session.transport.seconds == 8.0 and not staged.session.transport.playing


@pytest.mark.nightly
def test_another_seed_is_the_conversations_own_and_undone(staged):
    before = staged.document.project.settings.seed
    staged.timeline.seed.setValue(77)
    assert staged.document.project.conversations["v9000"].seed == 77
    assert staged.document.project.settings.seed == before
    staged.document.undo_stack.undo()
    assert staged.document.project.conversations["v9000"].seed == 1
    staged.timeline.seed.setValue(0xFFFFFFFF)  # the largest a project may have
    assert staged.document.project.conversations["v9000"].seed == 0xFFFFFFFF
    assert staged.timeline.seed.text() == "4294967295"


@pytest.mark.nightly
def test_kept_as_performances_both_can_be_played_and_undone_at_once(staged):
    before = staged.document.project
    staged.performance.keep_conversation()
    kept = staged.document.project.performances
    assert [p.name for p in kept.values()] == ["Greeting: Ada", "Greeting: Ben"]
    assert staged.session.onstage.conversation is None and staged.session.onstage.performance == next(
        iter(kept)
    )
    assert {line.channel for line in staged.document.project.lines.values()} == {0, 1}
    staged.wait(
        lambda: not staged.performance.shown.others and bool(staged.performance.shown.plan.track.speeches)
    )
    staged.document.undo_stack.undo()
    assert (
        staged.document.project.performances == before.performances
        and staged.document.project.lines == before.lines
    )


@pytest.mark.nightly
def test_a_side_moved_by_another_project_uses_that_ones_clips_and_one_that_cannot_be_read_is_told(talking):
    folder = talking.parent
    project = open_project(talking).project
    talk = project.conversations["v9000"]
    other = replace(project, conversations={}, settings=replace(project.settings, alpha=9.0))
    save_project(make_paths_absolute(other, folder), folder / "other.metagraph.yaml")
    for path, alpha, told in (
        ("other.metagraph.yaml", 9.0, False),
        ("missing.metagraph.yaml", project.settings.alpha, True),
    ):
        sides = (talk.sides[0], msgspec.structs.replace(talk.sides[1], project=path))
        shown = ConversationPlans().show(
            replace(project, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)}),
            "v9000",
            folder,
        )
        assert shown.everyone[1].project.settings.alpha == alpha
        assert any("missing" in note for note in shown.notes) == told


@pytest.mark.nightly
def test_a_side_is_drawn_with_a_character_of_its_own_whose_face_it_has(talking):
    folder = talking.parent
    project = open_project(talking).project
    talk = project.conversations["v9000"]
    shutil.copy(ROOT / "sample_clips" / "ben.glb", folder / "guest.glb")
    shutil.copy(ROOT / "sample_clips" / "mannequin.glb", folder / "plain.glb")
    plans = ConversationPlans()
    for path, targets in (("guest.glb", True), ("plain.glb", False)):
        sides = (talk.sides[0], msgspec.structs.replace(talk.sides[1], character=path))
        own = replace(project, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)})
        first, second = plans.show(own, "v9000", folder).everyone
        assert first.project.character == project.character
        assert Path(second.project.character).name == path
        assert ("jawOpen" in second.project.face.morphs) == targets
        spoken = [second.morphs(t).get("jawOpen", 0.0) for t in np.arange(4.2, 6.0, 0.1)]
        assert (max(spoken) > 0.1) == targets, "its mouth moves as its own face can"
    sides = (talk.sides[0], msgspec.structs.replace(talk.sides[1], character="missing.glb"))
    own = replace(project, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)})
    shown = plans.show(own, "v9000", folder)
    assert shown.everyone[1].project.character == project.character
    assert any("missing.glb" in note for note in shown.notes)


@pytest.mark.nightly
def test_the_characters_of_both_are_drawn(staged):
    plain = str(ROOT / "sample_clips" / "mannequin.glb")
    staged.document.edit(
        "Give a side a character",
        lambda project: conversation_edits.change_side(project, "v9000", 1, character=plain),
    )

    def drawn() -> set[str]:
        figures = [a.figure for a in staged.preview.scene().actors]
        return {mesh for f in figures if isinstance(f, SkinnedFigure) for mesh in f.meshes}

    staged.wait(lambda: drawn() == {"Ada", "Mannequin"})


@pytest.mark.nightly
def test_two_other_projects_are_each_read_once(talking, monkeypatch):
    from app.stage import conversation_plans as stage

    folder, read = talking.parent, []
    project = open_project(talking).project
    talk = project.conversations["v9000"]
    for name in ("one", "two"):
        save_project(
            make_paths_absolute(replace(project, conversations={}), folder), folder / f"{name}.metagraph.yaml"
        )
    whole = stage.open_whole
    monkeypatch.setattr(stage, "open_whole", lambda path: (read.append(path.name), whole(path))[1])
    sides = tuple(
        msgspec.structs.replace(s, project=f"{n}.metagraph.yaml")
        for s, n in zip(talk.sides, ("one", "two"), strict=True)
    )
    both, own = (
        ConversationPlans(),
        replace(project, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)}),
    )
    for _ in range(3):
        both.show(own, "v9000", folder)
    assert read == ["one.metagraph.yaml", "two.metagraph.yaml"]
    both.show(project, "v9000", folder)
    both.show(own, "v9000", folder)
    assert len(read) == 4, "what no side needs is not kept"


@pytest.mark.nightly
def test_a_side_can_move_with_a_clip_instead_of_its_graph_and_still_speaks_and_a_lost_one_is_told(talking):
    project = open_project(talking).project
    talk = project.conversations["v9000"]
    clip = next(e for e in project.clips.values() if e.name.endswith("wave_hello_rt_01"))

    def shown(motion: str | None):
        sides = (msgspec.structs.replace(talk.sides[0], motion=motion), talk.sides[1])
        return ConversationPlans().show(
            replace(project, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)}),
            "v9000",
            talking.parent,
        )

    still, moved, lost = shown(None), shown(clip.id), shown("c0")
    arm = project.skeleton.index("RightUpperArm") if "RightUpperArm" in project.skeleton else 10
    times = np.linspace(0, clip.duration, 7)
    assert (
        np.abs(moved.pose(times).rotations[:, arm] - clip.motion.pose_at(times).rotations[:, arm]).max()
        < 1e-3
    )
    assert np.array_equal(moved.pose(1.0).rotations, moved.pose(np.array([1.0])).rotations[0])
    assert moved.pose(100.0) is not None, "beyond its end it holds its last pose"
    assert moved.plan.track.speeches == still.plan.track.speeches != ()
    assert moved.others[0].motion is None
    assert lost.motion is None and any("missing" in note for note in lost.notes)


@pytest.mark.nightly
def test_a_generated_clip_moves_what_is_above_the_hips_and_is_written_so(talking, tmp_path):
    from app.cli.render_command import bake_to
    from metagraph.formats.bvh.file import read_bvh
    from metagraph.graph import anatomy

    project = open_project(talking).project
    life = msgspec.structs.replace(project.life, follow_through=0.0)  # legs answer a plan's arms alone
    project = replace(project, life=life)
    talk = project.conversations["v9000"]
    clip = next(e for e in project.clips.values() if e.name.endswith("wave_hello_rt_01"))

    def shown(made_by: str, motion: str | None = clip.id):
        sides = (msgspec.structs.replace(talk.sides[0], motion=motion), talk.sides[1])
        clips = {**project.clips, clip.id: replace(clip, made_by=made_by)}
        talks = {"v9000": msgspec.structs.replace(talk, sides=sides)}
        return ConversationPlans().show(
            replace(project, clips=clips, conversations=talks), "v9000", talking.parent
        )

    plain, made = shown("", None), shown("anna")
    parts = np.array(anatomy.project_parts(project))
    times = np.linspace(0.4, clip.duration - 0.4, 9)
    apart = np.abs(plain.pose(times).rotations - made.pose(times).rotations).max((0, 2))
    assert apart[parts == "legs"].max() < 1e-6 and apart[parts == "arms"].max() > 0.1
    after = clip.duration + 0.5
    assert np.allclose(plain.pose(after).rotations, made.pose(after).rotations, atol=1e-6)
    assert made.morphs(1.0).keys() == plain.morphs(1.0).keys()
    bake_to(tmp_path / "made.bvh", made, 2.0, 30.0, talking.parent)
    written = read_bvh(tmp_path / "made.bvh")
    arm = project.skeleton.names[int(np.argmax(apart * (parts == "arms")))]
    at = written.skeleton.names.index(arm)
    wanted = made.pose(1.0).rotations[project.skeleton.index(arm)]
    assert abs(float(written.pose_at(1.0).rotations[at] @ wanted)) > 0.999


@pytest.mark.nightly
def test_it_is_written_from_the_command_line_as_a_video_with_sound_and_as_motion_for_each(talking, tmp_path):
    def run(*words: str) -> subprocess.CompletedProcess[str]:
        whole = [
            sys.executable,
            "-m",
            "app.cli",
            "render",
            str(talking),
            "--conversation",
            "Greeting",
            *words,
        ]
        return subprocess.run(whole, cwd=ROOT, capture_output=True, text=True, timeout=300)

    made = run("-o", str(tmp_path / "show.mp4"), "-s", "2.5", "--size", "160x90", "--fps", "10")
    assert made.returncode == 0, made.stderr
    import av

    with av.open(str(tmp_path / "show.mp4")) as container:
        assert {s.type for s in container.streams} == {"video", "audio"}
        loud = np.concatenate([np.abs(f.to_ndarray()[0]) for f in container.decode(audio=0)])
    assert loud[:40000].max() < 0.05 < loud[60000:].max()
    assert run("-o", str(tmp_path / "show.bvh"), "-s", "1").returncode == 0
    assert (tmp_path / "show-1.bvh").is_file() and (tmp_path / "show-2.bvh").is_file()
    wrong = subprocess.run(
        [sys.executable, "-m", "app.cli", "render", str(talking), "--conversation", "Nobody", "-o", "x.png"],
        cwd=ROOT, capture_output=True, text=True, timeout=100,
    )  # fmt: skip
    assert wrong.returncode == 1 and "it has 'Greeting'" in wrong.stderr


# --- more than two


@pytest.fixture
def three(talking: Path) -> Path:
    """The project file with a third who listens, of a conversation v9000."""
    opened = open_project(talking).project
    made = opened.conversations["v9000"]
    third = Side(name="Cleo", segments=(Segment("clause", 6.5, 7.5, 7.0, "and I", 0),))
    talk = msgspec.structs.replace(made, sides=(*made.sides, third))
    save_project(replace(opened, conversations={"v9000": talk}), talking)
    return talking


@pytest.mark.nightly
def test_all_of_three_are_shown_whichever_of_them_is_looked_at(three: Path) -> None:
    project = open_project(three).project
    for side in (0, 2, 7):
        shown = ConversationPlans().show(project, "v9000", three.parent, side)
        assert shown.side == (side if side < 3 else 0)
        assert [one.side for one in shown.everyone] == [0, 1, 2] and len(shown.others) == 2
        assert all(one.stand is not None for one in shown.everyone)


@pytest.mark.nightly
def test_what_three_do_is_kept_with_whom_they_look_at_and_plays_the_same(three: Path) -> None:
    from metagraph.playback.planning.running_plan import plan_performance
    from tests.posing import pose_at

    project = open_project(three).project
    shown = ConversationPlans().show(project, "v9000", three.parent)
    after, made = keep_conversation(project, "v9000", shown)
    assert [after.performances[i].name for i in made] == [f"Greeting: {n}" for n in ("Ada", "Ben", "Cleo")]
    times = np.arange(0.0, 8.0, 0.5)
    for ident, one in zip(made, shown.everyone, strict=True):
        kept = after.performances[ident]
        looks = {ask.to for ask in kept.asks if isinstance(ask, Look)}
        assert len(looks) == 2 and looks <= {ask.name for ask in kept.asks if isinstance(ask, Place)}
        plan = plan_performance(after, kept.asks, kept.length, kept.seed, idle=kept.idle)
        mine, theirs = pose_at(plan, after, times), one.pose(times)
        assert theirs is not None and np.allclose(mine.rotations, theirs.rotations)


@pytest.mark.nightly
def test_three_are_written_one_by_one(three: Path, tmp_path: Path) -> None:
    words = (
        "render",
        str(three),
        "--conversation",
        "Greeting",
        "-o",
        str(tmp_path / "a.bvh"),
        "--seconds",
        "1",
    )
    assert main(list(words)) == 0
    assert sorted(p.name for p in tmp_path.glob("a*.bvh")) == ["a-1.bvh", "a-2.bvh", "a-3.bvh"]
