"""`metagraph study replay`: a sitting seen again in the window, or as a video."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator
from pathlib import Path

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]
PATIENCE = 120.0  # seconds for a part's clips to be loaded, before a video is given up


def add_arguments(action: Action) -> None:
    """Add the action."""
    made = action("replay", "play a sitting again in the window, or as a video, from its log", replay)
    made.add_argument("study", type=Path, help="the study's folder, or its study.yaml")
    made.add_argument("participant", help="the participant's pseudonym")
    made.add_argument("--task", help="the task (default: the first part)")
    made.add_argument("--condition", help="the condition")
    made.add_argument("--speed", type=float, default=1.0, help="speed of the replay (default: 1)")
    made.add_argument(
        "--from",
        dest="start",
        type=float,
        default=0.0,
        help="seconds after the start of the part (default: 0)",
    )
    made.add_argument("--until", type=float, help="seconds after the start of the part (default: its end)")
    made.add_argument(
        "--video", type=Path, metavar="OUT.mp4", help="write a video, instead of playing in the window"
    )
    made.add_argument("--fps", type=float, default=10.0, help="frames a second of the video (default: 10)")


def replay(options: Namespace) -> int:
    """Open the window. Raises FileError, ValueError."""
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    study.plan.known(options.participant)
    if not options.speed > 0 or not 0 < options.fps <= 60:
        raise ValueError("--speed must be more than 0, and --fps at most 60")
    from app.main import make_window, prepare_application

    app = prepare_application()
    from app.features.study.study_replay import Replayer

    window = make_window()
    window.resize(1600, 1000)
    window.show()
    replayer = Replayer(window.shell, study, options.participant)
    wanted = [
        n
        for n, part in enumerate(replayer.parts)
        if options.task in (None, part.task) and options.condition in (None, part.condition)
    ]
    if not wanted:
        window.close()
        raise ValueError(f"{options.participant} has no part with that task and condition")
    replayer.bar.set_speed(options.speed)
    replayer.ready.connect(lambda: replayer.seek(options.start))
    if options.video is not None:
        return _video(options, app, window, replayer, wanted[0])
    replayer.ready.connect(lambda: replayer.set_playing(True))
    replayer.over.connect(window.close)
    replayer.bar.part.setCurrentIndex(wanted[0])
    replayer.choose(wanted[0])
    return app.exec()


def _video(options, app, window, replayer, number: int) -> int:
    from time import monotonic

    import numpy as np
    from PySide6.QtGui import QImage

    from app.cli.command_output import say
    from preview.video import write_video

    done: list[bool] = []
    replayer.ready.connect(lambda: done.append(True))
    replayer.bar.part.setCurrentIndex(number)
    replayer.choose(number)
    begun = monotonic()
    while not done:
        app.processEvents()
        if monotonic() - begun > PATIENCE:
            raise ValueError(f"the part could not be loaded: {replayer.bar.told.text()}")
    until = min(options.until or replayer.part.seconds, replayer.part.seconds)

    def pictures() -> Iterator[np.ndarray]:
        while True:
            for _ in range(3):
                app.processEvents()
            image = window.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
            rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
            yield rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3)
            if replayer.at >= until:
                return
            replayer.seek(min(until, replayer.at + options.speed / options.fps))

    try:
        count = write_video(options.video, pictures(), options.fps)
    finally:
        replayer.leave()
        window.close()
    say(options, f"{options.video}: {count} pictures", {"written": str(options.video), "pictures": count})
    return 0
