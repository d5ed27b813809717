"""Recordings of Live Link Face: their times and angles, what is wrong with broken ones, where they land."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.clips import find_clip_files, read_clips
from metagraph.formats.gltf.reader import read_morph_targets
from metagraph.formats.imports import import_files
from metagraph.formats.live_link_face import TURNS, read_live_link
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.curves import fit_curves_to_face
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.face.takes import find_face_joints
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.playback.planner import make_plan
from tests.posing import pose_at

SAMPLES = Path(__file__).parents[2] / "sample_clips"
HEADER = "Timecode,BlendShapeCount," + ",".join(n[0].upper() + n[1:] for n in ARKIT) + "," + ",".join(TURNS)


def stamp(n: int, rate: int = 60, begin: int = 3600 * 12 + 61, mark: str = ":") -> str:
    seconds, frame = divmod(n, rate)
    seconds = (seconds + begin) % 86400
    h, m, s = seconds // 3600, seconds // 60 % 60, seconds % 60
    return f"{h:02d}:{m:02d}:{s:02d}{mark}{frame:02d}.{n % 1000:03d}"


def row(time: str, values: dict[str, float] | None = None) -> str:
    values = values or {}
    return ",".join([time, "61", *(f"{values.get(n, 0.0):.8f}" for n in (*ARKIT, *TURNS))])


def written(folder: Path, rows: list[str], header: str = HEADER, name: str = "take.csv") -> Path:
    path = folder / name
    path.write_bytes(("\ufeff" + "\r\n".join([header, *rows]) + "\r\n").encode())
    return path


def nod(n: int) -> dict[str, float]:
    """A head that turns, eyes that look to the left and up, a jaw that opens."""
    x = n / 180
    return {
        "jawOpen": x, "eyeBlinkLeft": 0.5, "eyeLookOutLeft": x, "eyeLookInRight": x, "eyeLookUpLeft": x,
        "eyeLookUpRight": x, "LeftEyeYaw": -0.4 * x, "RightEyeYaw": -0.4 * x, "LeftEyePitch": 0.3 * x,
        "RightEyePitch": 0.3 * x, "HeadYaw": 0.2 - 0.5 * x, "HeadPitch": 0.1,
    }  # fmt: skip


def test_tables_with_semicolons_and_decimal_commas_are_read_alike(tmp_path: Path) -> None:
    plain = written(tmp_path, [row(stamp(n), nod(n)) for n in range(90)])
    parted = tmp_path / "parted.csv"
    parted.write_text(plain.read_text("utf-8").replace(",", ";").replace(".", ","), encoding="utf-8")
    (one,), (other,) = read_clips(plain), read_clips(parted)
    np.testing.assert_array_equal(one.weights, other.weights)
    assert any("semicolons" in note for note in other.notes) and find_clip_files(tmp_path) == [parted, plain]


def test_61_values_a_row_become_52_curves_and_turns_at_the_rate_of_the_timecode(tmp_path: Path) -> None:
    clip = read_live_link(written(tmp_path, [row(stamp(n), nod(n)) for n in range(181)]))
    assert clip.morphs == ARKIT and clip.fps == 60 and clip.frames == 181
    assert clip.morphs_at(1.5)["jawOpen"] == pytest.approx(0.5, abs=0.01)
    left = rotation.rotate_vectors(clip.rotations[180, 1], np.array([0, 0, 1.0]))
    assert left[0] > 0.2 and left[1] > 0.2, "eyes look where the shapes say, whatever the angles' signs"
    head = rotation.rotate_vectors(clip.rotations[[0, 90, 180], 0], np.array([0, 0, 1.0]))
    assert head[0, 0] < -0.2 < abs(head[1, 0]) + 0.2 and abs(head[1, 0]) < 0.02 and head[2, 0] > 0.2
    assert any("straight ahead" in note for note in clip.notes)


@pytest.mark.parametrize(("rate", "mark", "fps"), [(60, ":", 60.0), (30, ":", 30.0), (24, ":", 24.0)])
def test_the_last_frame_of_a_second_tells_the_rate(tmp_path: Path, rate: int, mark: str, fps: float) -> None:
    rows = [row(stamp(n, rate, mark=mark), {"jawOpen": n / 200}) for n in range(3 * rate)]
    clip = read_live_link(written(tmp_path, rows))
    assert clip.fps == fps and clip.duration == pytest.approx(3 - 1 / rate, abs=1.5 / rate)


def test_drop_frame_timecode_runs_at_59_94(tmp_path: Path) -> None:
    # 00:00:59;59 is followed by 00:01:00;04.
    times = [f"00:00:{s:02d};{f:02d}" for s in (57, 58, 59) for f in range(60)]
    times += [f"00:01:00;{f:02d}" for f in range(4, 60)]
    clip = read_live_link(written(tmp_path, [row(t) for t in times]))
    assert clip.fps == pytest.approx(60000 / 1001)
    assert clip.frames == len(times), "no hole where numbers are left out"


def test_midnight_lost_faces_and_missing_rows_leave_no_hole(tmp_path: Path) -> None:
    rows = [row(stamp(n, begin=86399), {"jawOpen": n / 200}) for n in range(150) if not 70 < n < 110]
    rows.insert(20, "23:59:59:20.010,0")
    clip = read_live_link(written(tmp_path, rows))
    assert clip.duration == pytest.approx(149 / 60, abs=0.02)
    assert clip.morphs_at(1.5)["jawOpen"] == pytest.approx(0.45, abs=0.01)
    assert any("1 rows without a face" in note for note in clip.notes)


def test_a_recording_that_was_cut_off_is_read_to_its_last_whole_line(tmp_path: Path) -> None:
    clip = read_live_link(written(tmp_path, [*(row(stamp(n)) for n in range(130)), "12:01:03:11.1,61,0.1"]))
    assert clip.frames == 130 and any("cut off" in note for note in clip.notes)


@pytest.mark.parametrize(
    ("rows", "header", "where"),
    [
        ([row("12:00:00:00")], "Timecode,EyeBlinkLeft", "line 1"),
        ([row("12:00:00:00")], "Timecode,BlendShapeCount,a,b", "line 1"),
        ([], HEADER, "line 2"),
        (["12:00:00:00,0"], HEADER, "line 3"),
        ([row("01:00:00:00"), row("06:00:00:01")], HEADER, "its timecodes"),
        ([row("12:00:00:400"), row("12:00:00:01")], HEADER, "line 2"),
        ([row("soon"), row("12:00:00:01")], HEADER, "line 2"),
        ([row("12:61:00:00"), row("12:00:00:01")], HEADER, "line 2"),
        ([row("12:0:0:0").replace("0.00000000", "much", 1), row("12:00:00:01")], HEADER, "line 2, column 3"),
        ([row("12:0:0:0").replace("0.00000000", "1e30", 1), row("12:00:00:01")], HEADER, "line 2, column 3"),
        ([row("12:00:00:00") + ",", "x"], HEADER, "line 3"),
    ],
)  # fmt: skip
def test_errors_name_line_cause_and_remedy(tmp_path: Path, rows: list[str], header: str, where: str) -> None:
    if where == "line 3" and rows[-1] == "x":
        rows = [*rows, row("12:00:00:01")]
    with pytest.raises(FileError) as error:
        read_live_link(written(tmp_path, rows, header))
    assert error.value.where == where and error.value.remedy.endswith(".") and error.value.cause


def test_other_tables_are_no_clips(tmp_path: Path) -> None:
    written(tmp_path, [row(stamp(0))])
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    assert [p.name for p in find_clip_files(tmp_path)] == ["take.csv"]
    with pytest.raises(FileError, match=r"other\.csv"):
        read_clips(tmp_path / "other.csv")


@pytest.fixture(scope="module")
def sample() -> Project:
    project = open_project(SAMPLES / "sample.metagraph.yaml").project
    return with_morphs(project, read_morph_targets(SAMPLES / "ada.glb"))


def test_on_a_character_the_face_moves_and_nothing_else(sample: Project, tmp_path: Path) -> None:
    written(tmp_path, [row(stamp(n), nod(n)) for n in range(181)])
    stance = next(iter(sample.graphs["head"].stances))
    after = import_files(sample, SAMPLES, [tmp_path / "take.csv"]).into(sample)
    clip = list(after.clips)[-1]
    after = edits.place_clips(after, [clip], "head", "gesture", stance)
    action = list(after.graphs["head"].actions.values())[-1]
    assert (
        action.joints == find_face_joints(after) and "Head" in action.joints and "Hips" not in action.joints
    )
    entry = after.clips[clip]
    assert entry.motion is not None
    made = fit_curves_to_face(after, entry.motion)
    assert made.morphs_at(1.5)["jawOpen"] == pytest.approx(0.5, abs=0.01)
    assert not {m for m in made.morphs if m.startswith(("eyeLook", "eyeBlink"))}, "joints do these"
    skeleton = after.skeleton
    assert skeleton is not None
    turned, _ = skeleton.globals(made.pose_at(3.0))
    base, _ = skeleton.globals(made.pose_at(1.5))
    head = skeleton.index("Head")
    ahead = rotation.rotate_vectors(
        rotation.multiply(turned[head], rotation.conjugate(base[head])), np.array([0, 0, 1.0])
    )
    assert ahead[0] > 0.2, "to its left"
    plan = make_plan(after, 1.0, [])
    assert pose_at(plan, after, 0.5).rotations.shape[-2] == len(skeleton)


def test_it_is_there_again_when_the_project_is_opened(sample: Project, tmp_path: Path) -> None:
    path = written(tmp_path, [row(stamp(n), nod(n)) for n in range(181)])
    after = import_files(sample, SAMPLES, [path]).into(sample)
    clip = list(after.clips)[-1]
    after = edits.remove_clips(after, [c for c in after.clips if c not in (clip, after.base.clip)])
    save_project(after, tmp_path / "a.metagraph.yaml", SAMPLES / "sample.metagraph.yaml")
    opened = open_project(tmp_path / "a.metagraph.yaml").project
    a, b = after.clips[clip].motion, opened.clips[clip].motion
    assert a is not None and b is not None
    np.testing.assert_allclose(a.rotations, b.rotations, atol=1e-6)


def test_a_face_alone_is_no_project(tmp_path: Path) -> None:
    written(tmp_path, [row(stamp(n)) for n in range(3)])
    result = import_files(Project(), None, [tmp_path / "take.csv"])
    assert not result.loaded and "head" in result.failures[0]
