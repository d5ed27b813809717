"""C3D: the binary file of motion capture laboratories, read by the package `c3d`."""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np

from metagraph.common.budgets import KEYPOINT_FRAMES, KEYPOINTS_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.markers.marker_take import (
    AGAIN,
    MOST_MARKERS,
    MarkerTake,
    check_rate,
    find_metres,
    hide_zeros,
)


@guard_reader
def read_c3d(path: str | Path) -> MarkerTake:
    """Return the markers of a C3D file; forces, voltages and what else it holds are left out. Raises
    FileError.
    """
    import c3d

    path = Path(path)
    data = read_file(path, KEYPOINTS_FILE)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its own doubts about a file's head
            reader = c3d.Reader(io.BytesIO(data))
            count, frames = int(reader.point_used), int(reader.last_frame - reader.first_frame + 1)
            names = [str(label).strip() for label in reader.point_labels][:count]
            rate, unit = float(reader.point_rate), str(reader.get("POINT:UNITS").string_value or "mm")
            if not 0 < count <= MOST_MARKERS or not 0 < frames <= KEYPOINT_FRAMES:
                raise FileError(
                    path,
                    phrase("it has {count:,} markers and {frames:,} frames", count=count, frames=frames),
                    "",
                    AGAIN,
                )
            found = [points[:, :4] for _, points, _ in reader.read_frames(analog_transform=False)]
    except FileError:
        raise
    except Exception:  # the package checks little, and fails in many ways
        raise FileError(path, phrase("it is not a whole C3D file"), "", AGAIN) from None
    metres = find_metres(path, unit)
    table = np.array(found, float).reshape(len(found), count, 4)
    places = table[..., :3] * metres
    places[table[..., 3] < 0] = np.nan  # a residual below 0: the marker was not seen
    hide_zeros(places)
    places[~(np.abs(places) < 1e6).all(-1)] = np.nan
    names += [f"unnamed {n}" for n in range(len(names), count)]
    notes = (
        ()
        if len(found) == frames
        else (phrase("it ends after {count} of its {frames} frames", count=len(found), frames=frames),)
    )
    return MarkerTake(tuple(names), check_rate(path, rate), places, notes)
