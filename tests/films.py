"""Films for tests, and an estimator that needs no MediaPipe."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from metagraph.common import extras
from metagraph.common.extras import EXTRAS
from metagraph.formats.filmed import estimator

STAND_IN = "tests.formats.filmed.stand_in_estimator"


def make_film(
    path: Path,
    seconds: Sequence[float],
    dark: Iterable[int] = (),
    sound: bool = False,
    size: tuple[int, int] = (64, 32),
) -> Path:
    """Write a video with a picture at each of these times; all are bright above and black below, those in
    `dark` black. sound: with a second of silence.
    """
    import av

    hidden = set(dark)
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=1000, options={"bf": "0"})
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        stream.codec_context.time_base = Fraction(1, 1000)
        heard = container.add_stream("aac", rate=8000, layout="mono") if sound else None
        for n, at in enumerate(seconds):
            picture = np.zeros((size[1], size[0], 3), np.uint8)
            if n not in hidden:
                picture[: size[1] // 2, : size[0] // 2] = 255
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
            frame.pts, frame.time_base = round(at * 1000), Fraction(1, 1000)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
        if heard is not None:
            silence = av.AudioFrame.from_ndarray(np.zeros((1, 8000), np.float32), "fltp", "mono")
            silence.sample_rate = 8000
            container.mux(heard.encode(silence))
            container.mux(heard.encode())
    return path


def install_stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Have videos looked at by the stand-in; return the folder of its extra, below a folder of the test's."""
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: folder / kind)
    place = extras.find_extras_folder()
    assert place is not None
    for file in EXTRAS[estimator.EXTRA].holds:
        (place / estimator.EXTRA / file).parent.mkdir(parents=True, exist_ok=True)
        (place / estimator.EXTRA / file).touch()
    monkeypatch.setattr(extras, "is_own", lambda path: True)
    monkeypatch.setattr(estimator, "CHILD", STAND_IN)
    root = str(Path(__file__).resolve().parents[1])
    if root not in sys.path:
        monkeypatch.syspath_prepend(root)
    return place / estimator.EXTRA


def remove_stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the extra missing."""
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: folder / "nothing" / kind)
