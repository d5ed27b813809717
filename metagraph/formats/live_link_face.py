"""Reading the CSV files of Live Link Face, Epic's app for telephones: 52 blend shapes of ARKit's, and how
head and eyes are turned.

Their first line names the columns: `Timecode`, `BlendShapeCount`, the shapes (EyeBlinkLeft ... TongueOut),
`HeadYaw`, `HeadPitch`, `HeadRoll`, and the same of `LeftEye` and `RightEye`, in radians. A timecode is
`hours:minutes:seconds:frame.part`; with `;` before the frame, numbers of frames are left out as in NTSC's
drop-frame timecode. A row whose count is 0 is of a moment without a face.

The clip is on a skeleton of its own, a head and two eyes, whose directions are those of a character that
looks along +Z; `metagraph.graph.face.takes` brings it onto a project's.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CLIP_SECONDS, MOTION_FILE
from metagraph.common.files import guard_reader, open_file
from metagraph.errors import FileError, clean_text
from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.takes import FACE_SKELETON
from metagraph.motion import rotation
from metagraph.motion.clip import Clip

Array = NDArray[Any]

TURNS = tuple(f"{of}{way}" for of in ("Head", "LeftEye", "RightEye") for way in ("Yaw", "Pitch", "Roll"))
RATES = (24, 25, 30, 48, 50, 60)
USUAL_RATE = 60
FASTEST = 240
SPARSE = 20  # frames for each row, in all
HOLE = 0.5  # seconds without a face from which on it is reported
_REMEDY = "Take the CSV file of a recording of Live Link Face as the app wrote it."
_TIME = re.compile(r"(\d{1,2}):(\d{1,2}):(\d{1,2})([:;])(\d{1,3})(?:\.(\d{1,9}))?$")
_SEMICOLONS = ("semicolons separate its columns; its decimal commas were read as points",)
_LONGEST = 64_000  # characters a line
_AGREE = 0.3  # how well eyes' angles have to go with the shapes that say where they look


def is_live_link(head: bytes) -> bool:
    """Whether a file that begins so is a recording of Live Link Face."""
    line = (
        head.lstrip(b"\xef\xbb\xbf \t\r\n").split(b"\n", 1)[0].lower().replace(b" ", b"").replace(b'"', b"")
    )
    return line.startswith((b"timecode,blendshapecount", b"timecode;blendshapecount"))


@guard_reader
def read_live_link(path: str | Path) -> Clip:
    """Return a recording as a clip at a constant rate, on `FACE_SKELETON`. Raises FileError."""
    path = Path(path)
    columns: list[tuple[int, str]] = []
    unknown: list[str] = []
    width, separator = 0, ","
    stamps: list[tuple[int, int, float, bool]] = []  # second of the day, frame, part of it, drop-frame
    rows: list[list[float]] = []
    empty = 0
    torn: FileError | None = None
    with open_file(path, MOTION_FILE) as file:
        number = 0
        while line := file.readline(_LONGEST):
            number += 1
            text = _text(path, line, number).strip()
            if not width:
                separator = ";" if ";" in text else ","
            cells = _cells(text, separator)
            if not any(cells):
                continue
            if torn is not None:
                raise torn
            if not width:
                columns, unknown = _columns(path, cells)
                width = len(cells)
                continue
            if len(rows) > CLIP_SECONDS * FASTEST:
                raise FileError(path, "it is longer than six hours", f"line {number}", "Cut it into pieces.")
            try:
                stamp = _stamp(path, cells[0], number)
                lost = len(cells) > 1 and cells[1] == "0"
                if lost or len(cells) < width:
                    if not lost:
                        raise FileError(
                            path, f"there are {len(cells)} values, not {width}", f"line {number}", _REMEDY
                        )
                    empty += 1
                    continue
                rows.append(_values(path, cells, columns, number))
                stamps.append(stamp)
            except FileError as error:
                torn = error  # told, unless it is the last line: a recording that was cut off
    if not width:
        raise FileError(path, "it is empty", "line 1", _REMEDY)
    if not rows:
        if torn is not None:
            raise torn
        raise FileError(path, "no row has a face", f"line {2 + empty}", _REMEDY)
    notes = list(_SEMICOLONS) if separator == ";" else []
    if torn is not None:
        notes.append("its last line is cut off and was left out")
    if unknown:
        notes.append(f"columns nobody knows were left out: {', '.join(map(clean_text, unknown[:6]))}")
    times, rate, told = _times(stamps)
    notes += told
    return _clip(path, [name for _, name in columns], times, np.array(rows), rate, notes, empty)


def _cells(text: str, separator: str) -> list[str]:
    """Return the cells of a line; between semicolons commas are decimal points."""
    if separator == ";":
        text = text.replace(",", ".")
    return [cell.strip().strip('"') for cell in text.split(separator)]


def _text(path: Path, line: bytes, number: int) -> str:
    if len(line) >= _LONGEST:
        raise FileError(path, "a line is too long", f"line {number}", _REMEDY)
    try:
        return line.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise FileError(path, "it is no text in UTF-8", f"line {number}", _REMEDY) from None


def _columns(path: Path, cells: list[str]) -> tuple[list[tuple[int, str]], list[str]]:
    """Return the columns that are read, each with the name we have for it, and the names of the others."""
    known = {name.lower(): name for name in (*ARKIT, *TURNS)}
    if [c.lower() for c in cells[:2]] != ["timecode", "blendshapecount"]:
        raise FileError(
            path, "it does not begin with the columns Timecode and BlendShapeCount", "line 1", _REMEDY
        )
    found: dict[str, int] = {}
    unknown: list[str] = []
    for n, cell in enumerate(cells[2:], 2):
        name = known.get(cell.lower())
        if name is None:
            unknown.append(cell)
        elif name in found:
            raise FileError(path, f"there are two columns '{cell}'", "line 1", _REMEDY)
        else:
            found[name] = n
    if not any(name in found for name in ARKIT):
        raise FileError(path, "it has no column of a blend shape", "line 1", _REMEDY)
    return [(n, name) for name, n in found.items()], unknown


def _stamp(path: Path, text: str, number: int) -> tuple[int, int, float, bool]:
    found = _TIME.match(text)
    if found is None:
        raise FileError(
            path,
            f"'{clean_text(text[:40])}' is no timecode (hours:minutes:seconds:frame)",
            f"line {number}",
            _REMEDY,
        )
    hours, minutes, seconds, mark, frame, part = found.groups()
    if int(hours) > 23 or int(minutes) > 59 or int(seconds) > 59 or int(frame) >= FASTEST:
        raise FileError(path, f"'{text}' is no time of day", f"line {number}", _REMEDY)
    whole = (int(hours) * 60 + int(minutes)) * 60 + int(seconds)
    return whole, int(frame), float(f"0.{part}") if part else 0.0, mark == ";"


def _values(path: Path, cells: list[str], columns: list[tuple[int, str]], number: int) -> list[float]:
    out: list[float] = []
    for n, name in columns:
        try:
            value = float(cells[n])
        except ValueError:
            value = float("nan")
        if not abs(value) <= (1000 if name in TURNS else 10):
            raise FileError(
                path,
                f"'{clean_text(cells[n][:40])}' is no value of {name}",
                f"line {number}, column {n + 1}",
                _REMEDY,
            )
        out.append(value)
    return out


def _times(stamps: list[tuple[int, int, float, bool]]) -> tuple[Array, float, list[str]]:
    """Return seconds from the first row, how many frames a second there are, and what is to be told."""
    second, frame, part, drop = (np.array(column) for column in zip(*stamps, strict=True))
    told: list[str] = []
    most = int(frame.max())
    if np.ptp(second) >= 2:  # a whole second went by: its last frame tells the rate
        rate = next((r for r in RATES if r > most), most + 1)
    else:
        rate = max(USUAL_RATE, most + 1)
        told.append(f"it is too short to show its rate; {rate} frames a second were assumed")
    if drop.any():
        # Of every minute but each tenth the first numbers are left out: 2 of 30, 4 of 60.
        left_out = 4 if rate > 30 else 2
        minutes = second // 60
        count = second * rate + frame + part - left_out * (minutes - minutes // 10)
        exact = rate * 1000 / 1001
        seconds = count / exact
        day = 86_400 * 1.0
    else:
        exact, day = float(rate), 86_400.0
        seconds = second + (frame + part) / rate
    seconds = seconds + day * np.cumsum(np.r_[0, np.diff(seconds) < -day / 2])  # past midnight
    return seconds - seconds[0], exact, told


def _clip(
    path: Path, names: list[str], times: Array, values: Array, rate: float, notes: list[str], empty: int
) -> Clip:
    ahead = times > np.maximum.accumulate(np.r_[-1.0, times[:-1]])
    if not ahead.all():
        notes.append(f"{int((~ahead).sum())} rows that do not come after the one before were left out")
        times, values = times[ahead], values[ahead]
    if times[-1] > CLIP_SECONDS:
        raise FileError(path, "it is longer than six hours", "its timecodes", "Cut it into pieces.")
    holes = np.diff(times)
    if empty or (len(holes) and holes.max() > HOLE):
        told = f"{empty} rows without a face" if empty else "timecodes leave some out"
        notes.append(f"{told}: what is between was filled in (at most {holes.max(initial=0):.2f} s)")
    if times[-1] * rate > SPARSE * len(times) + 600 * rate:
        raise FileError(
            path, f"{len(times)} rows are spread over {times[-1]:.0f} s", "its timecodes", _REMEDY
        )
    grid = np.arange(round(times[-1] * rate) + 1) / rate
    even = np.stack([np.interp(grid, times, column) for column in values.T], 1)
    of = dict(zip(names, even.T, strict=True))
    shapes = tuple(name for name in ARKIT if name in of)
    turns = {name: of.get(name, np.zeros(len(grid))) for name in TURNS}
    if max(np.abs(v).max() for v in turns.values()) > 2 * np.pi:
        notes.append("its angles were read as degrees")
        turns = {name: np.radians(v) for name, v in turns.items()}
    rotations, more = _turned(of, turns)
    still = np.zeros((len(grid), 1, 3))
    weights = np.stack([of[name] for name in shapes], 1)
    return Clip(
        path.stem, FACE_SKELETON, rate, rotation.make_continuous(rotations), still, (0,), shapes, weights,
        (*notes, *more),
    )  # fmt: skip


def _turned(of: dict[str, Array], turns: dict[str, Array]) -> tuple[Array, list[str]]:
    """Return the rotations of head and eyes `[F, 3, 4]`, and what is to be told.

    Which way an angle of an eye goes is given by the shapes that say where it looks; the head's goes the same
    way. Where they do not tell, as Unreal turns: yaw to its own right, pitch up. The head's usual direction
    is straight ahead: a telephone seldom is.
    """
    notes: list[str] = []
    looks: dict[str, list[tuple[Array, Array]]] = {"Yaw": [], "Pitch": []}  # angle, and how far left and up
    for side, left in (("Left", ("Out", "In")), ("Right", ("In", "Out"))):
        for way, pair in (("Yaw", left), ("Pitch", ("Up", "Down"))):
            a, b = (of.get(f"eyeLook{p}{side}") for p in pair)
            if a is not None and b is not None:
                looks[way].append((turns[f"{side}Eye{way}"], a - b))
    signs: dict[str, float] = {"Yaw": -1.0, "Pitch": 1.0}
    eyes = True
    for way, pairs in looks.items():
        angle = np.concatenate([p[0] - p[0].mean() for p in pairs]) if pairs else np.zeros(1)
        look = np.concatenate([p[1] - p[1].mean() for p in pairs]) if pairs else np.zeros(1)
        size = float(np.linalg.norm(angle) * np.linalg.norm(look))
        agree = float(angle @ look) / size if size > 1e-6 else 0.0
        if abs(agree) > _AGREE:
            signs[way] = float(np.sign(agree))
        else:
            eyes = False
    out = rotation.make_identity_rotations((len(next(iter(turns.values()))), 3))
    for n, name in enumerate(("Head", "LeftEye", "RightEye")):
        if n and not eyes:
            break
        yaw, pitch, roll = (turns[f"{name}{way}"] for way in ("Yaw", "Pitch", "Roll"))
        if n == 0:
            middle = [float(np.median(v)) for v in (yaw, pitch, roll)]
            yaw, pitch, roll = (v - m for v, m in zip((yaw, pitch, roll), middle, strict=True))
            if max(map(abs, middle)) > np.radians(5):
                degrees = ", ".join(f"{np.degrees(m):.0f}" for m in middle)
                notes.append(
                    f"its usual direction (yaw, pitch, roll {degrees} degrees) is straight ahead now"
                )
        about = (signs["Yaw"] * yaw, -signs["Pitch"] * pitch, roll if n == 0 else 0 * roll)
        turn = [
            rotation.from_axis_angle(np.eye(3)[axis], angle)
            for axis, angle in zip((1, 0, 2), about, strict=True)
        ]
        out[:, n] = rotation.multiply(rotation.multiply(turn[0], turn[1]), turn[2])
    return out, notes
