"""The BVH reader and writer: every shape of file that breaks readers, then plain ones."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.bvh.file import BvhStyle, read_bvh, write_bvh
from metagraph.formats.takes import FRAME_TIME, FROM_OFFSET
from metagraph.motion import rotation
from metagraph.motion.adopt import describe_difference
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

ROOT_CHANNELS = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"


def figure(
    rows: str = "0 90 0 0 0 0  10 0 0\n1 90 0 0 0 0  20 0 0\n",
    frames: int | str = 2,
    time: str = "0.0333333",
    root: str = ROOT_CHANNELS,
    child: str = "3 Zrotation Xrotation Yrotation",
) -> str:
    return f"""HIERARCHY
ROOT Hips
{{
\tOFFSET 0 0 0
\tCHANNELS {root}
\tJOINT Spine
\t{{
\t\tOFFSET 0 10 0
\t\tCHANNELS {child}
\t\tEnd Site
\t\t{{
\t\t\tOFFSET 0 5 0
\t\t}}
\t}}
}}
MOTION
Frames: {frames}
Frame Time: {time}
{rows}"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file to write."""
    return tmp_path / "clip.bvh"


def read(path: Path, text: str, scale: float | None = 0.01) -> Clip:
    path.write_bytes(text.encode())
    return read_bvh(path, scale)


def refused(path: Path, text: str, *words: str) -> FileError:
    with pytest.raises(FileError) as caught:
        read(path, text)
    assert caught.value.cause and caught.value.where and caught.value.remedy
    for word in words:
        assert word in str(caught.value)
    return caught.value


# --- refused, with the line

ROW = "0 90 0 0 0 0 1 0 0"


@pytest.mark.parametrize(
    ("frames", "rows", "words"),
    [
        (0, [], ("line 17", "no frames")),
        (2, [ROW, "0 nan 0 0 0 0 1 0 0"], ("line 20", "nan")),
        (2, [ROW, "0 1e400 0 0 0 0 1 0 0"], ("line 20",)),
        (2, [ROW, "0 90 0 0 0 0 1 0 oops"], ("line 20", "oops")),
        (3, [ROW, "0 90 0 0 0 0 1 0", ROW], ("line 20", "9 numbers")),
        (500, [ROW, ROW], ("line 17", "500", "2 rows")),
    ],
)
def test_rows_that_are_not_whole_are_refused_with_their_line(
    path: Path, frames: int, rows: list[str], words: tuple[str, ...]
) -> None:
    refused(path, figure(rows="".join(f"{row}\n" for row in rows), frames=frames), *words)


@pytest.mark.parametrize(("time", "fps"), [("33.3333", 30), ("8.33333", 120), ("41.7083", 1000 / 41.7083)])
def test_frame_times_in_milliseconds_are_corrected_and_reported(path: Path, time: str, fps: float) -> None:
    clip = read(path, figure(time=time))
    assert clip.fps == pytest.approx(fps) and any("milliseconds" in note for note in clip.notes)
    left = read_bvh(path, 0.01, (FRAME_TIME,))
    assert left.fps == pytest.approx(1 / float(time)) and not left.repairs[0].made


def test_decimal_commas_are_points_and_commas_in_names_stay(path: Path) -> None:
    text = figure(rows="0,5 90,25 0 0 0 0  10 0 0\n" * 2, time="0,0333333").replace("Spine", "Spine, upper")
    clip = read(path, text)
    np.testing.assert_allclose(clip.translations[0, 0], [0.005, 0.9025, 0], atol=1e-6)
    assert clip.fps == 30 and clip.skeleton.names[1] == "Spine, upper"
    assert any("commas" in note for note in clip.notes)
    whole = read(path, figure(rows="0 90 0 0 0 0  10 0 0\n" * 2, time="1").replace("Spine", "Spine,1"))
    assert whole.skeleton.names[1] == "Spine,1" and not any("commas" in note for note in whole.notes)


def walker(root: str, offset: float) -> str:
    """Return a person whose hips' positions are `root`, their OFFSET `offset` up, in centimetres."""

    def joint(name: str, at: str, *below: str) -> str:
        inside = "\n".join(below) or "End Site\n{\nOFFSET 0 -5 10\n}"
        return f"JOINT {name}\n{{\nOFFSET {at}\nCHANNELS 3 Zrotation Xrotation Yrotation\n{inside}\n}}"

    legs = [
        joint(f"{s}UpLeg", f"{x} 0 0", joint(f"{s}Leg", "0 -45 0", joint(f"{s}Foot", "0 -45 0")))
        for s, x in (("Left", 10), ("Right", -10))
    ]
    body = joint("Spine", "0 20 0", joint("Neck", "0 35 0", joint("Head", "0 10 0")))
    head = f"HIERARCHY\nROOT Hips\n{{\nOFFSET 0 {offset} 0\nCHANNELS {ROOT_CHANNELS}\n"
    row = f"{root} 0 0 0 " + "0 0 0 " * 9
    return (
        f"{head}{legs[0]}\n{legs[1]}\n{body}\n}}\nMOTION\nFrames: 5\nFrame Time: 0.0333333\n" + f"{row}\n" * 5
    )


@pytest.mark.parametrize(
    ("root", "offset", "added"),
    [
        ("0 1 0", 95, True),
        ("3 95 2", 95, False),
        ("0 95 0", 0, False),
        ("0 2 0", 0, False),
        ("0 40 0", 95, False),
    ],
)
def test_root_positions_relative_to_offset_are_known_by_feet_under_the_floor(
    path: Path, root: str, offset: float, added: bool
) -> None:
    clip = read(path, walker(root, offset), None)
    assert any(r.name == FROM_OFFSET for r in clip.repairs) == added
    if added:
        assert clip.translations[0, 0, 1] == pytest.approx(0.96)
        assert read_bvh(path, None, (FROM_OFFSET,)).translations[0, 0, 1] == pytest.approx(0.01)


def test_positions_that_would_take_the_bones_their_length_are_relative_to_offset(path: Path) -> None:
    child = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    clip = read(path, figure(child=child, rows="0 90 0 0 0 0  0 0.1 0 10 0 0\n" * 2))
    assert clip.pose_at(0).translations[1, 1] == pytest.approx(0.101)
    whole = read(path, figure(child=child, rows="0 90 0 0 0 0  0 10 0 10 0 0\n" * 2))
    assert whole.pose_at(0).translations[1, 1] == pytest.approx(0.1) and not whole.repairs


@pytest.mark.parametrize("time", ["0", "-0.03", "nan", "inf", "fast", ""])
def test_a_senseless_frame_time_is_refused(path: Path, time: str) -> None:
    refused(path, figure(time=time))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (figure().replace("HIERARCHY", "HIERARCH"), "line 1"),
        (figure().replace("MOTION", "MOTIONS"), "its end"),
        (figure().replace("OFFSET 0 10 0", "OFFSET 0 ten 0"), "line 8"),
        (figure().replace("OFFSET 0 10 0", ""), "line 6"),
        (figure().replace("3 Zrotation", "4 Zrotation"), "line 10"),
        (figure().replace("3 Zrotation", "x Zrotation"), "line 9"),
        (figure().replace("\t}\n}\n", "\t}\n"), "line"),
        (figure().replace("\t}\n}\n", "\t}\n}\n}\n"), "line 16"),
        (figure().replace("JOINT Spine", "JOINT"), ""),
        (figure().replace("{", "", 1), "line"),
        (figure().replace("Frames:", "Frame:"), "line 16"),
    ],
)
def test_a_broken_header_is_refused_with_its_line(path: Path, text: str, line: str) -> None:
    if line:
        assert line in refused(path, text).where
    else:
        assert read(path, text).skeleton.names[1] == "joint"


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read_bvh(tmp_path / "none.bvh")


# --- accepted, with a note


@pytest.mark.parametrize("frames", [1, 3])
def test_one_row_more_or_fewer_than_promised_is_accepted_with_a_note(path: Path, frames: int) -> None:
    clip = read(path, figure(frames=frames))
    assert clip.frames == 2
    assert any("Frames:" in note for note in clip.notes)


def test_a_last_row_cut_off_is_dropped_with_a_note(path: Path) -> None:
    clip = read(path, figure(rows="0 90 0 0 0 0 1 0 0\n0 90 0 0 0 0 1 0 0\n0 90 0", frames=3))
    assert clip.frames == 2
    assert any("cut off" in note for note in clip.notes)


def test_repeated_names_are_made_unique_with_a_note(path: Path) -> None:
    clip = read(path, figure().replace("JOINT Spine", "JOINT Hips"))
    assert clip.skeleton.names == ("Hips", "Hips_2")
    assert any("names of their own" in note for note in clip.notes)


# --- accepted as they are


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "ZXZ"])
def test_every_channel_order_turns_the_first_named_axis_outermost(path: Path, order: str) -> None:
    names = " ".join(f"{axis}rotation" for axis in order)
    clip = read(path, figure(rows="0 90 0 0 0 0  10 200 -30\n" * 2, child=f"3 {names}"))
    expected = rotation.from_euler(np.radians([10, 200, -30]), order)
    assert rotation.measure_angle_between(clip.rotations[0, 1].astype(float), expected) < 1e-6


@pytest.mark.parametrize(
    ("child", "values", "angles"),
    [
        ("0", "", (0, 0, 0)),
        ("1 Xrotation", "40", (0, 40, 0)),
        ("2 Zrotation Yrotation", "20 30", (20, 0, 30)),
        ("6 Zrotation Xrotation Yrotation Xposition Yposition Zposition", "20 40 30 1 2 3", (20, 40, 30)),
        ("6 Xposition Zrotation Yposition Xrotation Zposition Yrotation", "1 20 2 40 3 30", (20, 40, 30)),
        (
            "9 Xposition Yposition Zposition Zrotation Xrotation Yrotation Xscale Yscale Zscale",
            "1 2 3 20 40 30 1 1 1",
            (20, 40, 30),
        ),
    ],
)
def test_any_number_of_channels_in_any_arrangement(
    path: Path, child: str, values: str, angles: tuple[float, ...]
) -> None:
    clip = read(path, figure(rows=f"0 90 0 0 0 0 {values}\n" * 2, child=child))
    expected = rotation.from_euler(np.radians(angles), "ZXY")
    assert rotation.measure_angle_between(clip.rotations[0, 1].astype(float), expected) < 1e-6
    if "position" in child:
        assert clip.translated == (0, 1)
        np.testing.assert_allclose(clip.translations[0, 1], [0.01, 0.02, 0.03], atol=1e-7)


def test_rotation_before_position_leaves_the_position_unturned(path: Path) -> None:
    clip = read(
        path,
        figure(
            rows="10 20 30 1 2 3  0 0 0\n" * 2,
            root="6 Zrotation Xrotation Yrotation Xposition Yposition Zposition",
        ),
    )
    np.testing.assert_allclose(clip.root[0], [0.01, 0.02, 0.03], atol=1e-7)


def test_line_ends_tabs_exponents_signs_and_a_byte_order_mark_do_not_matter(path: Path) -> None:
    plain = read(path, figure(rows="0 90 0 0 0 0 10 -0.5 0\n0 90 0 0 0 0 20 100 0\n"))
    odd = figure(rows="0 9.0e+1 -0 0 0 0 1E1 -.5 +0.\n\n\t0\t900e-1 0 0 0 0 20 1.0e2 0  \n\n").replace(
        "\n", "\r\n"
    )
    clip = read(path, "\ufeff" + odd)
    np.testing.assert_array_equal(clip.rotations, plain.rotations)
    np.testing.assert_array_equal(clip.translations, plain.translations)


def test_numbers_of_many_digits_keep_their_precision(path: Path) -> None:
    clip = read(
        path,
        figure(rows="0.12345678901234567890123 90 0 0 0 0 123456789012345678901234567890e-28 0 0\n" * 2),
        1.0,
    )
    assert clip.root[0, 0] == np.float32(0.12345678901234568)
    assert (
        abs(
            np.degrees(rotation.measure_angle_between(clip.rotations[0, 1], rotation.IDENTITY)) - 12.345678901
        )
        < 1e-4
    )


@pytest.mark.parametrize(
    ("time", "fps"),
    [
        ("0.0333333", 30), (".0083333", 120), ("0.008333", 120), ("0.016667", 60), ("0.04", 25),
        ("0.033", 30),
        ("0.016666666666666666", 60), ("0.0417083750417", 1 / 0.0417083750417),
        ("0.0333667", 1 / 0.0333667), ("1", 1), ("0.017", 60), ("0.016", 60), ("0.03", 30), ("0.042", 24),
        ("0.01", 100), ("0.02", 50),
    ],
)  # fmt: skip
def test_frame_times_give_whole_rates_only_where_their_digits_say_so(
    path: Path, time: str, fps: float
) -> None:
    assert read(path, figure(time=time)).fps == pytest.approx(fps, rel=1e-12)


def test_a_frame_time_of_few_digits_is_reported(path: Path) -> None:
    assert read(path, figure(time="0.03")).notes == (
        "its frame time of 0.03 s was read as 30 frames a second",
    )
    assert read(path, figure(time="0.033")).notes == ()


def test_braces_and_keywords_may_stand_anywhere(path: Path) -> None:
    text = figure().replace("ROOT Hips\n{", "root  Left Hip {").replace("End Site\n\t\t{", "end site {")
    assert read(path, text).skeleton.names == ("Left Hip", "Spine")


def test_several_roots_make_one_skeleton_with_several_roots(path: Path) -> None:
    text = (
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nROOT b\n{\nOFFSET 5 0 "
        "0\nCHANNELS 1 "
        "Yrotation\n}\n"
    )
    clip = read(path, text + "MOTION\nFrames: 1\nFrame Time: 0.1\n10 20\n")
    assert clip.skeleton.parents.tolist() == [-1, -1]
    np.testing.assert_allclose(clip.skeleton.rest_translations[1], [0.05, 0, 0])


def test_a_thousand_nested_joints_are_read(path: Path) -> None:
    deep = (
        "".join(
            f"{'JOINT' if i else 'ROOT'} j{i} {{ OFFSET 0 1 0 CHANNELS 1 Xrotation\n" for i in range(1000)
        )
        + "}" * 1000
    )
    clip = read(path, f"HIERARCHY\n{deep}\nMOTION\nFrames: 1\nFrame Time: 0.1\n{'1 ' * 1000}\n")
    assert len(clip.skeleton) == 1000


def test_a_position_that_follows_the_offset_is_dropped(path: Path) -> None:
    rows = "0 90 0 0 0 0  0 10 0 5 5 5\n" * 2
    clip = read(
        path, figure(rows=rows, child="6 Xposition Yposition Zposition Zrotation Xrotation Yrotation")
    )
    assert clip.translated == (0,)


def test_the_first_frames_place_left_in_a_root_offset_does_not_make_another_skeleton(path: Path) -> None:
    one = read(path, figure())
    other = read(path, figure().replace("OFFSET 0 0 0\n\tCHANNELS 6", "OFFSET 3 93 -450\n\tCHANNELS 6"))
    assert one.skeleton == other.skeleton
    assert one.skeleton.globals(one.skeleton.rest)[1][:, 1].min() == pytest.approx(0)


# --- units and axes


def person(tmp_path: Path, metres: float, spin: np.ndarray | None = None) -> Path:
    """Write the mannequin's skeleton with `metres` per unit, as a standing clip turned by `spin`."""
    skeleton = mannequin_skeleton()
    scaled = Skeleton(
        skeleton.names, skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations / (metres * 100)
    )
    rotations = rotation.make_identity_rotations((3, len(skeleton))).astype(np.float32)
    root = np.tile(scaled.rest_translations[0], (3, 1))
    if spin is not None:
        rotations[:, 0] = spin
        root = rotation.rotate_vectors(spin, root)
    path = tmp_path / "person.bvh"
    write_bvh(Clip("person", scaled, 30, rotations, root[:, None]), path)
    return path


@pytest.mark.parametrize(
    ("metres", "name"),
    [(1.0, "metres"), (0.01, "centimetres"), (0.0254, "inches"), (0.001, "millimetres"), (0.0564, "CMU")],
)
def test_the_unit_is_the_one_that_makes_a_human_and_is_noted(
    tmp_path: Path, metres: float, name: str
) -> None:
    clip = read_bvh(person(tmp_path, metres))
    assert clip.skeleton.height == pytest.approx(mannequin_skeleton().height, rel=2e-3)
    assert any(name in note for note in clip.notes)


def test_a_given_scale_is_obeyed_and_not_noted(tmp_path: Path) -> None:
    clip = read_bvh(person(tmp_path, 0.01), scale=0.5)
    assert clip.skeleton.height == pytest.approx(mannequin_skeleton().height * 50, rel=1e-3)
    assert not any("units" in note for note in clip.notes)


def test_z_up_is_turned_to_y_up_with_a_note(tmp_path: Path) -> None:
    up = rotation.from_axis_angle([1, 0, 0], np.pi / 2)
    clip = read_bvh(person(tmp_path, 0.01, up))
    _, positions = clip.skeleton.globals(clip.poses()[0])
    head, foot = clip.skeleton.index("Head"), clip.skeleton.index("LeftFoot")
    assert positions[head, 1] - positions[foot, 1] > 1.3
    assert any("Z axis" in note for note in clip.notes)


def test_a_person_lying_down_is_left_lying(tmp_path: Path) -> None:
    down = rotation.from_axis_angle([1, 0, 0], np.pi / 2)
    path = person(tmp_path, 0.01, down)
    text = path.read_text().splitlines()
    rows = [row.split() for row in text[-3:]]
    path.write_text("\n".join([*text[:-3], *(" ".join(["0", "15", "0", *row[3:]]) for row in rows)]) + "\n")
    clip = read_bvh(path)
    assert not any("Z axis" in note for note in clip.notes)


def test_a_bind_pose_left_on_the_first_frame_is_dropped_with_a_note(tmp_path: Path) -> None:
    skeleton = mannequin_skeleton()
    rotations = rotation.make_identity_rotations((30, len(skeleton))).astype(np.float32)
    arm = skeleton.index("LeftUpperArm")
    rotations[1:, arm] = rotation.from_axis_angle(np.tile([0, 0, 1.0], (29, 1)), -0.7 + 0.01 * np.arange(29))
    path = tmp_path / "walk.bvh"
    write_bvh(
        Clip("walk", skeleton, 30, rotations, np.tile(skeleton.rest_translations[:1], (30, 1, 1))), path
    )
    clip = read_bvh(path)
    assert clip.frames == 29
    assert any("bind pose" in note for note in clip.notes)


# --- writing


@pytest.mark.parametrize(
    "style",
    [BvhStyle(), BvhStyle("YXZ", every_place=True), BvhStyle("XYZ", metres=True), BvhStyle("ZYX")],
    ids=lambda style: f"{style.order}{' metres' * style.metres}",
)
def test_written_and_read_back_the_motion_is_the_same(path: Path, style: BvhStyle) -> None:
    rng = np.random.default_rng(3)
    skeleton = mannequin_skeleton()
    rotations = rotation.normalize(rng.normal(size=(20, len(skeleton), 4))).astype(np.float32)
    translated = (0, 5, 9)
    translations = skeleton.rest_translations[list(translated)] + rng.normal(size=(20, 3, 3))
    clip = Clip("wild", skeleton, 24, rotation.make_continuous(rotations), translations, translated)
    write_bvh(clip, path, style)
    back = read_bvh(path, 1.0 if style.metres else 0.01)
    assert back.fps == 24 and back.frames == 20
    mine, theirs = skeleton.globals(clip.poses()), back.skeleton.globals(back.poses())
    order = [back.skeleton.index(name) for name in skeleton.names]
    np.testing.assert_allclose(theirs[1][:, order], mine[1], atol=2e-5)
    assert (
        rotation.measure_angle_between(theirs[0][:, order].astype(float), mine[0].astype(float)).max() < 1e-5
    )


def test_an_order_that_is_none_is_refused(path: Path) -> None:
    still = Clip(
        "x", mannequin_skeleton(), 30, mannequin_skeleton().rest.rotations[None], np.zeros((1, 1, 3))
    )
    with pytest.raises(ValueError, match="each of X, Y and Z once, 'XXY' has not"):
        write_bvh(still, path, BvhStyle("XXY"))


def test_writing_into_a_folder_that_cannot_be_made_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    skeleton = Skeleton(("a",), np.array([-1]), rotation.make_identity_rotations((1,)), np.zeros((1, 3)))
    with pytest.raises(FileError, match="cannot be written"):
        write_bvh(
            Clip("c", skeleton, 30, rotation.make_identity_rotations((1, 1)), np.zeros((1, 1, 3))),
            tmp_path / "file" / "clip.bvh",
        )


# --- two parsers, one answer


@pytest.fixture(scope="module")
def many_rows() -> list[str]:
    rng = np.random.default_rng(5)
    values = np.concatenate([rng.normal(size=(16000, 3)), rng.uniform(-720, 720, (16000, 6))], 1)
    return [" ".join(f"{v:.6g}" for v in row) for row in values]


@pytest.mark.parametrize("lines", ["blank ones between", "rows broken off in the middle"])
def test_a_large_file_reads_the_same_however_its_rows_are_broken(
    tmp_path: Path, many_rows: list[str], lines: str
) -> None:
    rows, path = list(many_rows), tmp_path / "large.bvh"
    path.write_text(figure(rows="\n".join(rows) + "\n", frames=16000))
    plain = read_bvh(path, 0.01)
    if lines == "blank ones between":
        rows[::100] = [row + "\n" for row in rows[::100]]
    else:
        rows[10:9000] = [row.replace(" ", "\n", 1) for row in rows[10:9000]]
    path.write_text(figure(rows="\n".join(rows) + "\n", frames=16000))
    broken = read_bvh(path, 0.01)
    np.testing.assert_array_equal(broken.rotations, plain.rotations)
    np.testing.assert_array_equal(broken.translations, plain.translations)
    assert (np.einsum("fji,fji->fj", plain.rotations[1:], plain.rotations[:-1]) >= 0).all()


@pytest.mark.parametrize("at", [3, 8000, 15990])
@pytest.mark.parametrize("word", ["1.1e9", "-2000000000", "1e400", "nan", "seven", "1.2.3", "4-"])
def test_what_is_no_sensible_number_in_a_large_file_is_told_with_its_line(
    tmp_path: Path, many_rows: list[str], at: int, word: str
) -> None:
    rows = list(many_rows)
    rows[at] = rows[at].rpartition(" ")[0] + " " + word
    path = tmp_path / "large.bvh"
    path.write_text(figure(rows="\n".join(rows) + "\n", frames=16000))
    line = path.read_text().count("\n") - len(rows) + at + 1
    with pytest.raises(FileError, match=rf"'{word}'") as caught:
        read_bvh(path)
    assert caught.value.where == f"line {line}"


def test_importing_the_reader_does_not_import_numba() -> None:
    code = (
        "import sys, metagraph.formats.bvh.file, metagraph.formats.clips; sys.exit('numba' in sys.modules or "
        "'scipy' in sys.modules)"
    )
    assert (
        subprocess.run(
            [sys.executable, "-c", code], cwd=Path(__file__).parents[3], check=False, timeout=300
        ).returncode
        == 0
    )


# --- real files


@pytest.mark.nightly
def test_real_files_read_as_people_of_human_size(shared_data: Path) -> None:
    from metagraph.motion.roles import find_roles, is_humanoid

    files = sorted((shared_data / "edge-bvh").glob("*.bvh")) + sorted(
        (shared_data / "bandai-namco-1").glob("*active*.bvh")
    )
    assert len(files) > 15
    for file in files:
        clip = read_bvh(file)
        roles = find_roles(clip.skeleton)
        if not is_humanoid(roles):
            continue
        _, positions = clip.skeleton.globals(clip.poses())
        tall = (positions[:, roles["head"], 1] - positions[:, roles["left_foot"], 1]).max()
        assert 1.1 < tall < 2.0, (file.name, tall)


def test_clips_of_one_actor_have_skeletons_that_go_together(shared_data: Path) -> None:
    skeletons = [read_bvh(f).skeleton for f in sorted((shared_data / "bandai-namco-1").glob("*_bye_*.bvh"))]
    assert len({s.fingerprint for s in skeletons}) <= 2  # one bone differs by 0.4 mm in some files
    assert all(describe_difference(s, skeletons[0]) is None for s in skeletons)
