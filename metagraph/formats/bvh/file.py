"""Read and write BVH motion files."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import (
    CLIP_SECONDS,
    FRAME_SECONDS,
    FRAMES,
    JOINTS,
    JOINTS_DEEP,
    MIB,
    MOTION_FILE,
    OUT_OF_PROPORTION,
    Allowance,
)
from metagraph.common.files import read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.bvh.decimal_text import read_decimals
from metagraph.formats.bvh.space import USUAL, find_relative_joints, find_unit, is_z_up, stand_up
from metagraph.formats.takes import FRAME_TIME, FROM_OFFSET, UNIT, UP, drop_stray_poses, note_repair
from metagraph.motion import rotation
from metagraph.motion.clip import Clip, Repair
from metagraph.motion.roles import find_missing_roles, find_roles
from metagraph.motion.skeleton import Skeleton, make_names_unique

Array = NDArray[Any]

_LONGEST_HEADER = 16 * MIB
_USUAL_RATES = (24, 25, 30, 48, 50, 60, 72, 90, 100, 120, 144, 200, 240)
_SLOWEST = 4.0  # seconds, from which on a frame time is taken for milliseconds
_NUMBERS = re.compile(rb"(?im)^[ \t]*(?:OFFSET|Frame Time:|[-+\d])[^\r\n]*")  # lines that have numbers
_COMMA = re.compile(rb"(?<=\d),(?=\d)")
_DAMAGED = phrase("The file is damaged: export it again.")
_TO_Y_UP = rotation.from_axis_angle([1, 0, 0], -np.pi / 2)


@dataclass
class _Joint:
    name: str
    parent: int
    line: int
    offset: tuple[float, ...] = ()
    channels: list[str] = field(default_factory=list)


@np.errstate(all="ignore")  # broken files can overflow; the checks refuse them without a warning
def read_bvh(path: str | Path, scale: float | None = None, as_is: Collection[str] = ()) -> Clip:
    """Return the motion of a BVH file in metres, Y up.

    `scale` is in metres per unit of the file. BVH states no unit: without `scale`, the unit is the one that
    makes the skeleton a human between 1.2 and 2.5 m tall (centimetres if none does), and the notes name it. A
    file with Z up is turned. `as_is` names repairs (`takes.REPAIRS`) not to make; the unit is then
    centimetres, as in most files. Positions replace a joint's OFFSET. The rest pose has zero rotations and
    stands on the ground over the origin. Raises FileError with the line.
    """
    path = Path(path)
    data = read_file(path, MOTION_FILE)
    head = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    if head[:9].upper() != b"HIERARCHY":
        raise FileError(
            path,
            phrase("it does not begin with HIERARCHY"),
            phrase("line 1"),
            phrase("Check that it is a BVH file."),
        )
    notes: list[str] = []
    if b"," in data and not re.search(rb"\d\.\d", data):
        before, data = data, _NUMBERS.sub(lambda row: _COMMA.sub(b".", row[0]), data)
        if data != before:
            notes.append(phrase("its decimal commas were read as points"))
    motion = re.search(rb"(?im)^[ \t]*MOTION[ \t]*\r?$", data)
    if motion is None:
        raise FileError(
            path, phrase("it has no MOTION section"), phrase("its end"), phrase("Export it with its motion.")
        )
    if motion.start() > _LONGEST_HEADER:
        raise FileError(path, phrase("its HIERARCHY is too long"), phrase("its HIERARCHY"), _DAMAGED)
    joints = _Header(path, data[: motion.start()].decode("utf-8", "replace")).joints()
    values, fps, repairs = _motion(
        path, data, motion.end(), sum(len(j.channels) for j in joints), notes, as_is
    )
    _afford(path, len(data), len(values), joints)
    return _clip(path, joints, values, fps, scale, notes, repairs, as_is)


def _afford(path: Path, size: int, frames: int, joints: list[_Joint]) -> None:
    """Refuse a file that would take far more memory than its size: joints without channels take no space in
    it.
    """

    def refuse(where: str) -> None:
        raise FileError(path, OUT_OF_PROPORTION, where, phrase("Remove the joints that do not move."))

    placed = sum(any(name[1] == "p" for name in joint.channels) for joint in joints)
    Allowance(size, refuse).spend(frames * (len(joints) * 64 + placed * 96), f"its {len(joints)} joints")


class _Header:
    """The HIERARCHY section as words with their lines."""

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.words: list[tuple[str, int]] = []
        for number, line in enumerate(text.lstrip("\ufeff").splitlines(), 1):
            self.words += [(word, number) for word in line.replace("{", " { ").replace("}", " } ").split()]
        self.at = 0
        self.found: list[_Joint] = []
        self.stack: list[int] = []  # open braces; -1 for an End Site
        self.opened: int | None = None  # the joint whose brace comes next

    def fail(self, cause: str, line: int, remedy: str = _DAMAGED) -> NoReturn:
        raise FileError(self.path, cause, phrase("line {line}", line=line), remedy)

    def next(self) -> tuple[str, int]:
        if self.at >= len(self.words):
            self.fail(phrase("the HIERARCHY section ends too early"), self.words[-1][1] if self.words else 1)
        self.at += 1
        return self.words[self.at - 1]

    def number(self) -> float:
        word, line = self.next()
        try:
            value = float(word)
        except ValueError:
            self.fail(phrase("'{word}' is not a number", word=word[:40]), line)
        if not abs(value) < 1e9:
            self.fail(phrase("{word} is not a plausible number", word=word[:40]), line)
        return value

    def joints(self) -> list[_Joint]:
        """Return the joints, parents first, each with its offset and channels."""
        self.next()
        while self.at < len(self.words):
            word, line = self.next()
            kind = word.upper()
            if self.opened is not None and kind != "{":
                self.fail(phrase("expected '{{', found '{word}'", word=word[:40]), line)
            match kind:
                case "ROOT" | "JOINT" | "END":
                    self._begin(word, kind, line)
                case "{":
                    self._open(line)
                case "}":
                    self._close(line)
                case "OFFSET":
                    self._offset(line)
                case "CHANNELS":
                    self._channels(line)
                case _:
                    self.fail(phrase("'{word}' is not expected here", word=word[:40]), line)
        self._whole()
        return self.found

    def _begin(self, word: str, kind: str, line: int) -> None:
        """Read the name of a joint or an End Site."""
        if kind == "ROOT" and self.stack:
            self.fail(phrase("a ROOT is inside another joint"), line)
        if kind != "ROOT" and (not self.stack or self.stack[-1] < 0):
            self.fail(phrase("a {word} is outside any joint", word=word[:10]), line)
        name = []
        while self.at < len(self.words) and self.words[self.at][0] != "{":
            name.append(self.next()[0])
            if len(name) > 64:
                self.fail(phrase("no '{{' follows {kind}", kind=kind), line)
        if kind == "END":
            self.opened = -1
            return
        if len(self.found) >= JOINTS:
            self.fail(
                phrase("it has more than {JOINTS} joints, the maximum for a character", JOINTS=JOINTS), line
            )
        self.found.append(_Joint(" ".join(name), self.stack[-1] if self.stack else -1, line))
        self.opened = len(self.found) - 1

    def _open(self, line: int) -> None:
        if self.opened is None:
            self.fail(phrase("'{' without a joint"), line)
        if len(self.stack) >= JOINTS_DEEP:
            self.fail(
                phrase("its joint hierarchy is more than {most} levels deep", most=JOINTS_DEEP),
                line,
                phrase("Remove ropes, hair and cloth, or export only the character."),
            )
        self.stack.append(self.opened)
        self.opened = None

    def _close(self, line: int) -> None:
        if not self.stack:
            self.fail(phrase("'}' without a '{'"), line)
        self.stack.pop()

    def _offset(self, line: int) -> None:
        if not self.stack:
            self.fail(phrase("OFFSET outside any joint"), line)
        offset = (self.number(), self.number(), self.number())
        if self.stack[-1] >= 0:
            self.found[self.stack[-1]].offset = offset

    def _channels(self, line: int) -> None:
        if not self.stack or self.stack[-1] < 0:
            self.fail(phrase("CHANNELS outside any joint"), line)
        joint = self.found[self.stack[-1]]
        word, _ = self.next()
        if not word.isdecimal() or len(word) > 9 or int(word) > 64:
            self.fail(phrase("'{word}' is not a channel count", word=word[:40]), line)
        if joint.channels:
            self.fail(phrase("joint '{name}' has CHANNELS twice", name=joint.name), line)
        for _ in range(int(word)):
            channel, at = self.next()
            if not re.fullmatch(r"(?i)[xyz](position|rotation|scale)", channel):
                self.fail(
                    phrase("'{channel}' is not a channel", channel=channel[:40]),
                    at,
                    phrase("Make the number after CHANNELS match the names that follow it."),
                )
            if channel.lower() in joint.channels and channel[1].lower() == "p":
                self.fail(phrase("channel {channel} is listed twice", channel=channel), at)
            joint.channels.append(channel.lower())

    def _whole(self) -> None:
        """Refuse a section that ends within a joint, has no joint, or has one without an OFFSET."""
        if self.stack:
            self.fail(phrase("{count} '}}' are missing", count=len(self.stack)), self.words[-1][1])
        if not self.found:
            self.fail(phrase("there is no ROOT"), 1)
        for joint in self.found:
            if not joint.offset:
                self.fail(phrase("joint '{name}' has no OFFSET", name=joint.name), joint.line)


def _motion(
    path: Path, data: bytes, at: int, channels: int, notes: list[str], as_is: Collection[str]
) -> tuple[Array, float, list[Repair]]:
    """Return the rows `[F, C]`, frames per second, and what was repaired of the frame time."""
    head = re.compile(
        rb"\s*Frames[ \t]*:[ \t]*(\S*)\s*Frame[ \t]*Time[ \t]*:[ \t]*(\S*)", re.IGNORECASE
    ).match(data, at)
    if head is None:
        raise FileError(
            path,
            phrase("'Frames:' and 'Frame Time:' do not follow MOTION"),
            phrase("line {line}", line=_line(data, at)),
            _DAMAGED,
        )
    where = f"line {_line(data, head.start(1))}"
    try:
        promised, step = int(head[1]), float(head[2])
    except ValueError:
        raise FileError(
            path, phrase("'Frames:' and 'Frame Time:' are not numbers"), where, _DAMAGED
        ) from None
    digits, repairs = head[2].decode("ascii", "replace"), []
    if _SLOWEST <= step <= 1000 * _SLOWEST:
        words = phrase(
            "its frame time of {time:g} is milliseconds: {rate:.4g} frames a second",
            time=step,
            rate=1000 / step,
        )
        milliseconds = FRAME_TIME not in as_is or step > FRAME_SECONDS[1]
        repairs.append(Repair(FRAME_TIME, words, milliseconds))
        if milliseconds:
            step, digits = step / 1000, "0.000" + digits.partition(".")[2]
    if not FRAME_SECONDS[0] <= step <= FRAME_SECONDS[1]:
        raise FileError(
            path,
            phrase("a frame time of {step:g} s is not plausible", step=step),
            phrase("line {line}", line=_line(data, head.start(2))),
            phrase("Write the seconds per frame, such as 0.0333333."),
        )
    if channels == 0:
        raise FileError(
            path,
            phrase("no joint has any CHANNELS"),
            phrase("its HIERARCHY"),
            phrase("Export it with rotation channels."),
        )
    start = head.end()
    numbers = _numbers(path, data, start, channels)
    rows, rest = divmod(len(numbers), channels)
    if rows > FRAMES or (rows - 1) * step > CLIP_SECONDS:
        cause = phrase("it has {rows:,} frames, {value:.0f} s", rows=rows, value=rows * step)
        raise FileError(path, cause, where, phrase("Cut the take into pieces."))
    if rows == 0 or (promised <= 0 and rows > 1):
        cause = (
            phrase("'Frames:' says {promised} but {rows} rows follow", promised=promised, rows=rows)
            if rows
            else phrase("it has no frames")
        )
        raise FileError(path, cause, where, phrase("Export it with its motion."))
    if (rest and rows + 1 < promised) or abs(rows - promised) > 1:
        line = _uneven_row(data, start, channels)
        cause = (
            phrase("this row does not have {channels} numbers", channels=channels)
            if line
            else phrase(
                "'Frames:' says {promised} but {rows} rows of {channels} numbers follow",
                promised=promised,
                rows=rows,
                channels=channels,
            )
        )
        raise FileError(
            path,
            cause,
            phrase("line {line}", line=line) if line else where,
            phrase("Change it to {rows}, or export the file again.", rows=rows) if not line else _DAMAGED,
        )
    if rest:
        line = _uneven_row(data, start, channels)
        if line and line < _line(data, len(data.rstrip())):
            raise FileError(
                path,
                phrase("this row does not have {channels} numbers", channels=channels),
                phrase("line {line}", line=line),
                _DAMAGED,
            )
        notes.append("its last row was cut off and was dropped")
    if rows != promised:
        notes.append(f"'Frames:' says {promised}, the file has {rows}")
    return numbers[: rows * channels].reshape(rows, channels), _fps(digits, step, notes), repairs


def _line(data: bytes, at: int) -> int:
    return data.count(b"\n", 0, at) + 1


def _uneven_row(data: bytes, start: int, channels: int) -> int:
    """Return the line of the first row that does not have `channels` numbers, or 0."""
    first = _line(data, start)
    for i, row in enumerate(data[start:].split(b"\n")):
        words = len(row.split())
        if words and words != channels:
            return first + i
    return 0


def _fps(text: str, step: float, notes: list[str]) -> float:
    """Return the frames per second, rounded to an integer if the frame time equals it within its last written
    digit: to a usual rate where one does, since 0.017 s are 60 rather than 59.
    """
    digits = re.fullmatch(r"\d*\.?(\d*)", text)
    whole = float(round(1 / step))
    if digits is None or not whole:
        return 1 / step
    most = 1.001 * 10.0 ** -len(digits[1])
    usual = min(_USUAL_RATES, key=lambda rate: abs(1 / rate - step))
    if abs(whole * step - 1) > 1e-9 and abs(1 / usual - step) <= most and abs(usual * step - 1) < 0.15:
        if abs(usual * step - 1) > 0.025:
            notes.append(
                phrase("its frame time of {step} s was read as {fps} frames a second", step=text, fps=usual)
            )
        return float(usual)
    if abs(1 / whole - step) <= most and abs(whole * step - 1) < 0.02:
        return whole
    return 1 / step


def _numbers(path: Path, data: bytes, start: int, channels: int) -> Array:
    """Return every number after `start` as float64."""
    try:
        numbers = read_decimals(data, start)
        if (np.abs(numbers) <= 1e9).all():
            return numbers
    except ValueError:
        pass
    first = _line(data, start)
    for i, row in enumerate(data[start:].split(b"\n")):
        for word in row.split():
            try:
                fine = abs(float(word)) <= 1e9
            except ValueError:
                fine = False
            if not fine:
                text = word[:40].decode("utf-8", "replace")
                raise FileError(
                    path,
                    phrase("'{text}' is not a plausible number", text=text),
                    phrase("line {value}", value=first + i),
                    _DAMAGED,
                )
    raise FileError(
        path,
        phrase("it contains bytes that are not numbers"),
        phrase("line {line}", line=first),
        _DAMAGED,
    )


def _rotations(values: Array, joints: list[_Joint], columns: list[list[int]]) -> Array:
    """Return local rotations `[F, J, 4]` float32, with neighbouring frames on the same side."""
    frames = len(values)
    turns = [
        [c for c, name in zip(own, joint.channels, strict=True) if name[1] == "r"]
        for joint, own in zip(joints, columns, strict=True)
    ]
    orders = ["".join(name[0] for name in joint.channels if name[1] == "r") for joint in joints]
    out = rotation.make_identity_rotations((frames, len(joints)))
    for order in set(orders) - {""}:
        same = [i for i, o in enumerate(orders) if o == order]
        angles = np.radians(values[:, [turns[i] for i in same]])
        out[:, same] = rotation.from_euler(angles, order)
    return rotation.make_continuous(out.astype(np.float32))


def _clip(
    path: Path,
    joints: list[_Joint],
    values: Array,
    fps: float,
    scale: float | None,
    notes: list[str],
    repairs: list[Repair],
    as_is: Collection[str],
) -> Clip:
    """Build the clip from channels, units and axes."""
    names = make_names_unique([j.name for j in joints])
    if names != tuple(j.name for j in joints):
        notes.append("joints without a name or with a repeated one were given names of their own")
    if any(name[1] == "s" for j in joints for name in j.channels):
        notes.append("scale channels were left out")
    parents = np.array([j.parent for j in joints])
    offsets = np.array([j.offset for j in joints])
    columns = _columns(joints)
    placed = _placed(joints, columns, offsets, values)
    rotations = _rotations(values, joints, columns)
    skeleton = Skeleton(names, parents.copy(), rotation.make_identity_rotations((len(joints),)), offsets)
    roles = find_roles(skeleton)
    if find_missing_roles(roles):  # of unknown names the shape tells, as of a figure with Y up
        upright = replace(skeleton, rest_translations=rotation.rotate_vectors(_TO_Y_UP, offsets))
        turned = find_roles(upright)
        roles = roles if find_missing_roles(turned) else turned

    scale, found = _metres(skeleton, roles, scale, notes, as_is)
    repairs += found
    offsets = offsets * scale
    placed = {i: p * scale for i, p in placed.items()}
    up, rest_too = is_z_up(skeleton, roles, rotations, placed, offsets)
    rest_rotations = rotation.make_identity_rotations((len(joints),))
    if up:
        repairs.append(Repair(UP, phrase("its Z axis points up: turned to Y up"), UP not in as_is))
    if up and UP not in as_is:
        roots = np.flatnonzero(parents < 0)
        _turn_up(roots, rotations, offsets, placed)
        if rest_too:
            rest_rotations[roots] = _TO_Y_UP
    relative = find_relative_joints(
        Skeleton(names, parents.copy(), rest_rotations.copy(), offsets.copy()), roles, rotations, placed
    )
    if relative:
        words = (
            phrase(
                "the root's positions are relative to its OFFSET, which was added: the feet are then on the "
                "floor"
            )
            if relative == [0]
            else phrase(
                "the positions of {count} joints are relative to their OFFSET, which was added",
                count=len(relative),
            )
        )
        repairs.append(Repair(FROM_OFFSET, words, FROM_OFFSET not in as_is))
        if FROM_OFFSET not in as_is:
            for i in relative:
                placed[i] = placed[i] + offsets[i]
    stand_up(
        offsets,
        parents,
        rest_rotations,
        {i for i, p in placed.items() if i == 0 or np.abs(p - offsets[i]).max() > 1e-4},
    )
    skeleton = Skeleton(names, parents, rest_rotations, offsets)
    moving = [i for i, p in sorted(placed.items()) if i == 0 or np.abs(p - offsets[i]).max() > 1e-5]
    translations = np.stack([placed[i] for i in moving], 1)
    clip = Clip(path.stem, skeleton, fps, rotations, translations, tuple(moving), notes=tuple(notes))
    for repair in repairs:
        clip = note_repair(clip, repair)
    return drop_stray_poses([clip], as_is)[0]


def _columns(joints: list[_Joint]) -> list[list[int]]:
    """Return the columns of each joint's channels in the rows of numbers."""
    columns, at = [], 0
    for joint in joints:
        columns.append(list(range(at, at + len(joint.channels))))
        at += len(joint.channels)
    return columns


def _placed(
    joints: list[_Joint], columns: list[list[int]], offsets: Array, values: Array
) -> dict[int, Array]:
    """Return the positions `[F, 3]` of the first joint and of joints with position channels. An axis without
    a channel keeps its OFFSET.
    """
    placed = {}
    for i, joint in enumerate(joints):
        axes = {name[0]: c for name, c in zip(joint.channels, columns[i], strict=True) if name[1] == "p"}
        if axes or i == 0:
            placed[i] = np.tile(offsets[i], (len(values), 1))
            for axis, column in axes.items():
                placed[i][:, "xyz".index(axis)] = values[:, column]
    return placed


def _metres(
    skeleton: Skeleton,
    roles: dict[str, int],
    scale: float | None,
    notes: list[str],
    as_is: Collection[str],
) -> tuple[float, list[Repair]]:
    """Return the metres per unit of a file, and the repair if these are not the usual ones. `scale` is given
    by the caller, or None. Raises ValueError if it makes no sense.
    """
    if scale is not None:
        if not (scale > 0 and np.isfinite(scale)):
            raise ValueError(f"a scale of {scale} metres per unit")
        return scale, []
    found, words = find_unit(skeleton, roles)
    if found == USUAL:
        notes.append(words)
        return found, []
    repair = Repair(UNIT, words, UNIT not in as_is)
    return (found if repair.made else USUAL), [repair]


def _turn_up(roots: Array, rotations: Array, offsets: Array, placed: dict[int, Array]) -> None:
    """Rotate the motion of a figure whose Z axis points up."""
    rotations[:, roots] = rotation.multiply(_TO_Y_UP, rotations[:, roots].astype(float))
    offsets[roots] = rotation.rotate_vectors(_TO_Y_UP, offsets[roots])
    for i in roots.tolist():
        if i in placed:
            placed[i] = rotation.rotate_vectors(_TO_Y_UP, placed[i])


@dataclass(frozen=True)
class BvhStyle:
    """How a BVH file is written. order: of its rotations, the outermost first, three of XYZ in any order.
    metres: whether lengths are metres, as Blender takes them, and not centimetres, as most programs do.
    every_place: whether each joint has positions, and not only those that move.
    """

    order: str = "ZXY"
    metres: bool = False
    every_place: bool = False


def write_bvh(clip: Clip, path: str | Path, style: BvhStyle | None = None) -> None:
    """Write a clip as BVH, in centimetres and ZXY unless a style says otherwise.

    BVH has no rest rotations and no morph targets: these are lost, the motion is not. Raises FileError, and
    ValueError for an order that is none.
    """
    style = style or BvhStyle()
    if sorted(style.order) != ["X", "Y", "Z"]:
        raise ValueError(f"the order of rotations has each of X, Y and Z once, '{style.order}' has not")
    skeleton = clip.skeleton
    scale = 1.0 if style.metres else 100.0
    placed = range(len(skeleton)) if style.every_place else clip.translated
    turns = " ".join(f"{axis}rotation" for axis in style.order)
    lines = ["HIERARCHY"]

    def describe(joint: int, depth: int) -> None:
        tab = "\t" * depth
        offset = skeleton.rest_translations[joint] * scale
        lines.append(
            f"{tab}{'ROOT' if skeleton.parents[joint] < 0 else 'JOINT'} "
            f"{skeleton.names[joint].replace(' ', '_')}"
        )
        lines.extend((f"{tab}{{", f"{tab}\tOFFSET {offset[0]:.6f} {offset[1]:.6f} {offset[2]:.6f}"))
        position = "6 Xposition Yposition Zposition" if joint in placed else "3"
        lines.append(f"{tab}\tCHANNELS {position} {turns}")
        order.append(joint)

    order: list[int] = []
    stack: list[tuple[int, int]] = [(i, 0) for i in reversed(np.flatnonzero(skeleton.parents < 0).tolist())]
    while stack:
        joint, depth = stack.pop()
        tab = "\t" * depth
        if joint < 0:
            lines.append(f"{tab}}}")
            continue
        describe(joint, depth)
        stack.append((-1, depth))
        stack.extend((child, depth + 1) for child in reversed(skeleton.children[joint]))
        if not skeleton.children[joint]:
            tip = skeleton.rest_translations[joint] * (scale / 2 if skeleton.parents[joint] >= 0 else 0)
            lines.extend(
                (
                    f"{tab}\tEnd Site",
                    f"{tab}\t{{",
                    f"{tab}\t\tOFFSET {tip[0]:.6f} {tip[1]:.6f} {tip[2]:.6f}",
                    f"{tab}\t}}",
                )
            )
    lines.extend(("MOTION", f"Frames: {clip.frames}", f"Frame Time: {1 / clip.fps:.12f}"))
    angles = np.degrees(rotation.to_euler(clip.rotations.astype(np.float64), style.order))
    places = clip.poses().translations.astype(np.float64)
    blocks = []
    for joint in order:
        if joint in placed:
            blocks.append(places[:, joint] * scale)
        blocks.append(angles[:, joint])
    rows = np.concatenate(blocks, 1)
    pattern = " ".join(["%.6f"] * rows.shape[1])
    lines.extend(pattern % tuple(row) for row in rows.tolist())
    write_atomically(Path(path), ("\n".join(lines) + "\n").encode())
