"""Keypoints of a video or a camera for commands: asks before the estimator is installed, shows progress."""

from __future__ import annotations

import signal
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from metagraph.formats.filmed.film import FilmedKeypoints
    from metagraph.mimicry.keypoint_layouts import KeypointTrack

DEFAULT_CAMERA = "0"


def add_camera_arguments(parser: ArgumentParser) -> None:
    """Add the options that say which camera films for how long, and where its keypoints are written."""
    parser.add_argument(
        "--camera",
        nargs="?",
        const=DEFAULT_CAMERA,
        metavar="DEVICE",
        help="film the person before a camera, in place of a file: a number from 0, or the system's name for "
        "it, such as /dev/video0 (default: 0)",
    )
    parser.add_argument("--seconds", type=float, help="how long the camera films (default: until Ctrl+C)")
    parser.add_argument(
        "--save-keypoints",
        type=Path,
        metavar="FILE",
        help="write the keypoints found in a video or before a camera (.jsonl), to mimic them again",
    )


def read_person(options: Namespace, picture: tuple[int, int] | None) -> KeypointTrack:
    """Return the keypoints of the file or the camera that the options name. picture: width and height of the
    pictures that a file of keypoints was made of. Raises FileError, ValueError for options that exclude each
    other, EstimatorError, CameraError.
    """
    from metagraph.formats.filmed.film import write_filmed_keypoints
    from metagraph.formats.filmed.video import VideoFile, is_video
    from metagraph.formats.keypoints.reader import read_keypoints

    path: Path | None = options.keypoints
    if (path is None) == (options.camera is None):
        raise ValueError("give a file of keypoints, a video, or --camera: one of them")
    if options.seconds is not None and options.camera is None:
        raise ValueError("--seconds says how long the camera films: give --camera, too")
    if options.seconds is not None and not 0 < options.seconds <= 36000:
        raise ValueError("--seconds must be more than 0 and at most 36000")
    if path is not None and not is_video(path):
        if options.save_keypoints is not None:
            raise ValueError("--save-keypoints is for a video or a camera")
        return read_keypoints(path, options.fps, picture)
    if path is not None:
        VideoFile(path).close()  # what is no video is refused before anything is installed for it
    require_estimator(options)
    filmed = _film(options) if path is None else _read_video(options, path)
    if options.save_keypoints is not None:
        options.save_keypoints.parent.mkdir(parents=True, exist_ok=True)
        write_filmed_keypoints(filmed, options.save_keypoints)
    return filmed.track


def require_estimator(options: Namespace) -> None:
    """Install the estimator if it is missing and somebody at the terminal agrees. Raises
    EstimatorMissingError.
    """
    from metagraph.common.extra_steps import ExtraError, install_extra
    from metagraph.common.extras import EXTRAS, is_installed
    from metagraph.formats.filmed.estimator import EXTRA, EstimatorError, EstimatorMissingError

    if is_installed(EXTRA):
        return
    if options.json or not sys.stdin.isatty():
        raise EstimatorMissingError
    extra = EXTRAS[EXTRA]
    asked = (
        f"Videos and cameras need MediaPipe ({extra.megabytes} MB on disk, {extra.licence}), from PyPI. "
        "Pictures stay on this computer. Install it? [y/N] "
    )
    if input(asked).strip().lower() not in ("y", "yes"):
        raise EstimatorMissingError
    print("installing ...", file=sys.stderr)
    try:
        install_extra(EXTRA)
    except ExtraError as error:
        raise EstimatorError(str(error)) from None


def _read_video(options: Namespace, path: Path) -> FilmedKeypoints:
    from app.cli.progress_line import ProgressLine
    from metagraph.formats.filmed.film import film_video

    line = ProgressLine(options, "Looking at pictures")
    try:
        return film_video(path, line.tell)
    finally:
        line.finish()


def _film(options: Namespace) -> FilmedKeypoints:
    """Film until the time is over, or Ctrl+C, which ends the film and not the command."""
    from metagraph.formats.filmed.film import film_camera

    stopped = False

    def stop(*_: object) -> None:
        nonlocal stopped
        stopped = True

    shown = sys.stderr.isatty() and not options.json
    before = signal.signal(signal.SIGINT, stop)
    try:
        how = f"for {options.seconds:g} s" if options.seconds is not None else "until Ctrl+C"
        print(f"Filming {how} ...", file=sys.stderr)
        return film_camera(
            options.camera,
            options.seconds,
            lambda at: print(f"\r{at:6.1f} s", end="", file=sys.stderr, flush=True) if shown else None,
            lambda: stopped,
        )
    finally:
        signal.signal(signal.SIGINT, before)
        if shown:
            print(file=sys.stderr)
