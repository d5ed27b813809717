"""Write a performance as a video, a contact sheet or plain motion in a process of its own, which draws
without disturbing the window.
"""

from __future__ import annotations

import subprocess
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path

from app.project.jobs import WindowJob
from app.translation import make_lazy_texts, tr
from metagraph.common.network_paths import is_allowed
from metagraph.common.programs import make_python_command, start
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import save_project
from metagraph.graph.model import Mode, Project
from preview.video import find_part_path

SUFFIXES = make_lazy_texts(
    lambda: {
        ".mp4": tr("Video with sound"),
        ".mov": tr("Video with alpha (MOV, ProRes 4444)"),
        ".webm": tr("Video with alpha (WebM, VP9)"),
        ".png": tr("Contact sheet"),
        ".glb": tr("Motion (GLB)"),
        ".bvh": tr("Motion (BVH)"),
    }
)


@dataclass(frozen=True)
class RenderOrder:
    """What to write.

    `performance` is the id of a kept one, None to improvise in `mode`. `conversation` is the id of one,
    then with all its sides. `size` is width and height in pixels. `light` and `background` are names from
    `preview.looks`; no background is the project's. `start` is the second at which it begins. `captions`
    shows words, `cuts` uses a conversation's camera cuts, and `sticks` draws a stick figure where a character
    has no mesh. `seat` is one of `preview.looks.SEATS`. `transparent` draws nothing behind the
    character, `blurred` blurs what is nearer or farther than the face.
    """

    out: Path
    performance: str | None
    seconds: float
    size: tuple[int, int] = (1280, 720)
    fps: float = 30.0
    theme: str = "dark"
    conversation: str | None = None
    light: str = "studio"
    background: str | None = None
    start: float = 0.0
    captions: bool = False
    cuts: bool = True
    sticks: bool = False
    mode: Mode = "talking"
    seat: str = "stool"
    transparent: bool = False
    blurred: bool = False


def write_rendering(project: Project, folder: Path, wanted: RenderOrder, job: WindowJob) -> Path:
    """Write it, on a job's thread. Raises RuntimeError with the reason. A cancelled job leaves nothing
    behind.
    """
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / "project.metagraph.yaml"
        save_project(make_paths_absolute(project, folder), copy)
        words = [
            "render",
            str(copy),
            "-o",
            str(wanted.out.absolute()),
            "-s",
            f"{wanted.seconds:.6f}",
            "--size",
            f"{wanted.size[0]}x{wanted.size[1]}",
            "--fps",
            f"{wanted.fps:g}",
            "--theme",
            wanted.theme,
            "--light",
            wanted.light,
            "--seat",
            wanted.seat,
            "--progress",
            "--start",
            f"{wanted.start:.6f}",
            "--captions" if wanted.captions else "--no-captions",
        ]
        if wanted.transparent:
            words.append("--transparent")
        elif wanted.blurred:
            words.append("--depth-of-field")
        if wanted.background is not None and not wanted.transparent:
            words += ["--background", wanted.background]
        if not wanted.cuts:
            words.append("--no-cuts")
        if wanted.sticks:
            words.append("--sticks")
        if is_allowed():
            words.append("--network")
        if wanted.performance is not None:
            words += ["--performance", wanted.performance]
        elif wanted.conversation is None:
            words += ["--mode", wanted.mode]
        if wanted.conversation is not None:
            words += ["--conversation", wanted.conversation]
        process = start(
            make_python_command("app.cli", *words),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        said: list[str] = []
        reader = threading.Thread(target=_listen, args=(process, job, said), daemon=True)
        reader.start()
        while process.poll() is None:
            if job.cancelled:
                process.terminate()
                process.wait()
                find_part_path(wanted.out).unlink(missing_ok=True)
                break
            reader.join(0.1)
        reader.join(5)
        if process.stderr is not None:
            process.stderr.close()
        if not job.cancelled and process.returncode != 0:
            raise RuntimeError(
                said[-1].removeprefix("metagraph: ")
                if said
                else tr("the render process stopped without an error message")
            )
    return wanted.out


def _listen(process: subprocess.Popen[str], job: WindowJob, said: list[str]) -> None:
    """Pass on progress, and keep other output."""
    assert process.stderr is not None
    for line in process.stderr:
        done, _, total = line.strip().partition("/")
        if done.isdigit() and total.isdigit():
            job.tell(int(done), int(total), tr("picture {done} of {total}", done=done, total=total))
        elif line.strip():
            said.append(line.strip())
