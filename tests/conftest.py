"""Fixtures every test may use."""

from __future__ import annotations

import copy
import gc
import hashlib
import math
import os
import sys
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path
from typing import Any, TextIO

import numpy as np
import pytest
from hypothesis import settings

from metagraph.common import files
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Layer, Life, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.speech import pitch, sound
from sample_clips.make.numbered_ids import numbered_ids as counting_ids
from tests import kernels, levels
from tests.browsing import browse
from tests.once import fitted_once, heard_once, read_once
from tests.run_notes import KEY, NOTES, catch_crash, take_crashes
from tests.thorough import NIGHTLY, THOROUGH

__all__ = ["browse"]

ROOT = Path(__file__).resolve().parents[1]

WORKER = os.environ.get("PYTEST_XDIST_WORKER", "")
os.environ["NUMBA_CACHE_DIR"] = str(kernels.provide(WORKER or "alone"))
os.environ["METAGRAPH_MOTION_CACHE"] = str(ROOT / ".pytest_cache" / "motion")
os.environ["METAGRAPH_MESH_CACHE"] = str(levels.HOME)

# A process reads and hears each sound once: the samples' conversations were heard a hundred times. Before
# others take these names from their modules.
sound.analyse_sound = heard_once(sound.analyse_sound)
sound.read_recording = read_once(sound.read_recording)
pitch.measure_pitch = heard_once(pitch.measure_pitch)

stated = os.fstat


def not_waiting(handle: int) -> None:
    """Stand in for `os.fsync`: nobody pulls the plug on tests, so that what is written need not have reached
    the disk, which takes some milliseconds thousands of times. A handle that is none is an error still.
    """
    stated(handle)


os.fsync = not_waiting

# Files that take longest, the longest first: begun late, one of them would keep one process busy while the
# others have nothing left.
LONG = (
    "engines/test_cpp_compiles.py",
    "engines/test_targets.py",
    "engines/test_avatar.py",
    "engines/test_runtime_godot4.py",
    "engines/translation/test_translating.py",
    "test_plain_words.py",
    "engines/test_vectors.py",
    "test_manual.py",
    "engines/test_runtime_unity.py",
    "formats/test_every_field.py",
    "label_zoo/test_faults.py",
    "engines/test_runtime_javascript.py",
    "formats/project/test_versions.py",
    "fuzz/test_readers.py",
    "app/features/agents/test_agents.py",
    "engines/stranger/test_stranger.py",
    "playback/planning/test_extend_performance.py",
    "synthesis/test_search.py",
    "playback/test_continuity.py",
    "app/features/character/test_watching.py",
    "app/cli/test_author_command.py",
    "app/cli/test_label_command.py",
    "app/cli/test_outputs.py",
    "fuzz/test_clip_files.py",
    "engines/test_target_unity_controller.py",
    "app/test_journey.py",
    "test_import_circles.py",
    "app/cli/test_parser.py",
    "app/features/labelling/test_review_dialog.py",
    "preview/default_body/test_figure.py",
    "app/authoring/test_tools.py",
    "app/shell/test_window.py",
    "app/features/manual/test_manual_editor.py",
    "playback/life/test_evaluate.py",
    "engines/test_character_utterances.py",
    "test_names.py",
    "app/authoring/test_author_line.py",
    "app/shell/test_studio_defaults.py",
    "formats/test_corpora.py",
    "app/cli/test_filmed_keypoints.py",
    "app/features/props/test_props_panel.py",
    "synthesis/test_blocks.py",
    "formats/gltf/test_reader.py",
    "app/shell/test_mnemonics.py",
    "engines/test_export.py",
    "app/features/conversation/test_conversation_panel.py",
    "app/widgets/test_joint_figure.py",
    "engines/test_engine_names.py",
)

# The gate must give the same answer twice. At the desk, examples are new each time, and twice as many.
settings.register_profile("gate", derandomize=True, deadline=None, max_examples=50)
settings.register_profile("desk", deadline=None)
settings.register_profile("thorough", deadline=None, max_examples=1000)
files.strict = True  # what a reader trips over is a bug to be seen here, though users are told in words

settings.load_profile("thorough" if THOROUGH else "gate" if os.environ.get("CI") else "desk")


ALL_NOTES = pytest.StashKey[dict[str, dict[str, str]]]()
CRASH = pytest.StashKey[TextIO]()


def pytest_configure(config: pytest.Config) -> None:
    """Before the first process starts, compile what tests would wait for longer than a window is given."""
    config.stash[NOTES], config.stash[ALL_NOTES] = {}, {}
    gc.disable()
    if config.getoption("numprocesses", None):
        kernels.make()


def pytest_sessionstart(session: pytest.Session) -> None:
    """What a process that crashes says of it is read at the end: it is lost among what others print."""
    if WORKER:
        session.config.stash[CRASH] = catch_crash(WORKER)
    else:
        take_crashes()  # of a run before


def pytest_report_header() -> str:
    """Say what is left for the night."""
    return "" if NIGHTLY else "nightly tests run with METAGRAPH_NIGHTLY=1, or when their file is named"


@cache
def named_files(words: tuple[str, ...]) -> frozenset[Path]:
    """Return the files that were named when pytest was started."""
    return frozenset(Path(word.partition("::")[0]).resolve() for word in words if word.partition("::")[0])


def is_for_the_night(node: pytest.Item | pytest.Collector, obj: object = None) -> bool:
    """Return whether something is marked `nightly` and left out now: its file was not named."""
    if NIGHTLY or node.path in named_files(tuple(node.config.args)):
        return False
    marks = getattr(obj, "pytestmark", ())
    return any(m.name == "nightly" for m in marks) or node.get_closest_marker("nightly") is not None


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: pytest.Collector, obj: object) -> list[pytest.Item] | None:
    """Make no tests that are left out: there are as many cases of them as of all others."""
    return [] if callable(obj) and is_for_the_night(collector, obj) else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out single cases that are marked nightly. Put the files that take longest first; the others keep
    their order.
    """
    left = [item for item in items if is_for_the_night(item)]
    if left:
        config.hook.pytest_deselected(items=left)
        later = set(left)
        items[:] = [item for item in items if item not in later]
    place = {str(ROOT / "tests" / name): n for n, name in enumerate(LONG)}
    items.sort(key=lambda item: place.get(str(item.path), len(LONG)))


def pytest_collection_finish() -> None:
    """What was collected stays: there is no need to look through a million objects for rubbish again and
    again.
    """
    gc.enable()
    gc.collect()
    gc.freeze()
    gc.set_threshold(5000)  # a look through all that files share took a thirtieth of the time


def pytest_sessionfinish(session: pytest.Session) -> None:
    """A process of several tells the one that started it how it fared."""
    session.config.stash[NOTES]["peak memory"] = f"{memory():,.0f} MB"
    if WORKER:
        session.config.workeroutput[KEY] = session.config.stash[NOTES]  # type: ignore[attr-defined]


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:
    node.config.stash[ALL_NOTES][node.gateway.id] = getattr(node, "workeroutput", {}).get(KEY, {})


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Say at the end how much memory the tests took, so that nothing grows unseen, and what else is noted."""
    every = config.stash[ALL_NOTES] or {"this process": config.stash[NOTES]}
    for about in dict.fromkeys(about for notes in every.values() for about in notes):
        said = [f"{name} {notes[about]}" for name, notes in sorted(every.items()) if about in notes]
        terminalreporter.write_line(f"{about}: {', '.join(said)}")
    for process, lines in ({} if WORKER else take_crashes()).items():
        terminalreporter.write_line("\n".join((f"{process} crashed:", *lines)))


def memory() -> float:
    """Return the most memory this process ever held, megabytes; nan where the system does not tell."""
    try:
        import resource
    except ImportError:
        return math.nan
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


@pytest.fixture(scope="session")
def qapp() -> object:
    """The application as the program makes it, so that windows can be opened later in this process, too."""
    from app.main import prepare_application

    return prepare_application()


@pytest.fixture(scope="module")
def numbered_ids() -> Iterator[None]:
    """What tests of a module make has the ids c1, c2, s3 and so on, in the order in which it is made."""
    with counting_ids():
        yield


@pytest.fixture(scope="module")
def quick_codes() -> Iterator[None]:
    """The codes of perceptual studies are sealed in few rounds: that each takes long is reported in
    `tests/research/study/perceive/test_sealed.py`, and pages in browsers open what took as long as it does.
    """
    from metagraph.research.study.perceive import sealed

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sealed, "ROUNDS", 10)
        yield


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real clips made by others; tests that need it skip where it is not."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("the folder of real clips (../shared/data) is not here")
    return folder


@pytest.fixture(scope="session")
def zoo_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The files of characters as studios have them, by name; made here."""
    from tests import zoo

    return zoo.make(tmp_path_factory.mktemp("zoo"))


class Toy:
    """Builds small projects whose motion is known: arms that swing and a head that turns, on sixteen
    joints.
    """

    def __init__(self) -> None:
        from metagraph.motion.skeleton import Skeleton

        rows = [
            ("Hips", -1, (0, 1.0, 0)),
            ("Spine", 0, (0, 0.2, 0)),
            ("Neck", 1, (0, 0.3, 0)),
            ("Head", 2, (0, 0.1, 0)),
            ("LeftUpperArm", 1, (0.2, 0.25, 0)),
            ("LeftLowerArm", 4, (0.3, 0, 0)),
            ("LeftHand", 5, (0.25, 0, 0)),
            ("RightUpperArm", 1, (-0.2, 0.25, 0)),
            ("RightLowerArm", 7, (-0.3, 0, 0)),
            ("RightHand", 8, (-0.25, 0, 0)),
            ("LeftUpperLeg", 0, (0.1, -0.05, 0)),
            ("LeftLowerLeg", 10, (0, -0.45, 0)),
            ("LeftFoot", 11, (0, -0.45, 0)),
            ("RightUpperLeg", 0, (-0.1, -0.05, 0)),
            ("RightLowerLeg", 13, (0, -0.45, 0)),
            ("RightFoot", 14, (0, -0.45, 0)),
        ]
        names, parents, offsets = zip(*rows, strict=True)
        self.skeleton = Skeleton(
            names, np.array(parents), np.tile([0.0, 0, 0, 1], (len(rows), 1)), np.array(offsets, float)
        )

    def clip(
        self,
        name: str,
        seconds: float = 1.0,
        start: float = 0.0,
        end: float | None = None,
        swing: float = 0.6,
        fps: float = 30,
    ) -> Clip:
        """A clip in which the arms go from angle `start` to `end` by way of `swing` more radians; head and
        hips sway along.
        """
        frames = round(seconds * fps) + 1
        x = np.linspace(0, 1, frames)
        angle = (
            start
            + ((start if end is None else end) - start) * (3 * x**2 - 2 * x**3)
            + swing * np.sin(np.pi * x) ** 2
        )
        rotations = np.tile(self.skeleton.rest_rotations, (frames, 1, 1))
        for joint, axis, share in (
            ("LeftUpperArm", (0, 0, 1.0), 1),
            ("RightUpperArm", (0, 0, -1.0), 0.8),
            ("Head", (1.0, 0, 0), 0.3),
        ):
            rotations[:, self.skeleton.index(joint)] = rotation.from_axis_angle(np.array(axis), angle * share)
        translations = np.tile(self.skeleton.rest_translations[:1], (frames, 1, 1))
        translations[:, 0, 0] += 0.03 * swing * np.sin(np.pi * x) ** 2
        return Clip(name, self.skeleton, fps, rotations, translations)

    @counting_ids()
    def project(self, layer: Layer = "arms", loop: float = 2.0) -> Project:
        """Stances rest, up, far on one layer, joined rest <-> up <-> far; gestures, fidgets and transitions
        named after themselves.
        """
        angles = {"rest": 0.0, "up": 0.8, "far": 1.4}
        clips = [self.clip(f"{name} loop", loop, angle, swing=0.05) for name, angle in angles.items()]
        lengths = {
            "rest short": 0.6,
            "rest beat lf": 0.9,
            "rest wave rt": 1.2,
            "rest long": 2.4,
            "up beat": 0.7,
            "up point": 1.1,
        }
        lengths |= {"rest scratch": 1.0, "rest cough": 0.8, "up yawn": 1.0}
        clips += [self.clip(name, seconds, angles[name.split()[0]]) for name, seconds in lengths.items()]
        ways = (("rest", "up"), ("up", "rest"), ("up", "far"), ("far", "up"))
        clips += [self.clip(f"{a} to {b}", 0.8, angles[a], angles[b]) for a, b in ways]
        project = edits.add_clips(
            Project("toy", life=Life(on=False)), [(f"{c.name}.glb", 0, "", c) for c in clips]
        )
        clip = {entry.name: entry.id for entry in project.clips.values()}
        for name in angles:
            project = edits.add_stance(project, layer, name, [clip[f"{name} loop"]])
        stance = {s.name: s.id for s in project.graphs[layer].stances.values()}
        for kind, names in (
            ("gesture", ("rest short", "rest beat lf", "rest wave rt", "rest long", "up beat", "up point")),
            ("fidget", ("rest scratch", "rest cough", "up yawn")),
        ):
            for name in names:
                project = edits.place_clips(project, [clip[name]], layer, kind, stance[name.split()[0]])  # type: ignore[arg-type]
        for a, b in ways:
            project = edits.place_clips(
                project, [clip[f"{a} to {b}"]], layer, "transition", stance[a], stance[b]
            )
        return edits.set_base(project, clip["rest loop"])

    @staticmethod
    def id(project: Project, name: str) -> str:
        """The id of the stance, else the action, else the clip of that name."""
        for layer in LAYERS:
            for stance in project.graphs[layer].stances.values():
                if stance.name == name:
                    return stance.id
        for action in project.actions():
            if action.name == name:
                return action.id
        return next(entry.id for entry in project.clips.values() if entry.name == name)


@pytest.fixture(scope="session")
def toy() -> Toy:
    return Toy()


@pytest.fixture(scope="session", autouse=True)
def sample_clips_read_once() -> None:
    """A process decodes each sample clip once, wherever a copy of it lies: opening the sample project a
    hundred times cost more than most of what is tested on it. Files that differ in a byte are read.
    """
    from metagraph.formats.gltf import reader as gltf
    from metagraph.formats.project import clip_loading

    read = gltf.read_gltf_clips
    known: dict[tuple[str, bytes, frozenset[str]], list[Clip]] = {}
    samples = {path.name for path in (ROOT / "sample_clips" / "clips").glob("*.glb")}

    def read_once(path: str | Path, as_is: Collection[str] = ()) -> list[Clip]:
        path = Path(path)
        if path.name not in samples or not path.is_file():
            return read(path, as_is)
        key = (path.name, hashlib.sha256(path.read_bytes()).digest(), frozenset(as_is))
        if key not in known:
            known[key] = read(path, as_is)
        return [copy.copy(clip) for clip in known[key]]  # each reader has clips of its own to lose

    gltf.read_gltf_clips = read_once
    clip_loading._Loading._fitted = fitted_once(clip_loading._Loading._fitted)  # type: ignore[method-assign]


@pytest.fixture(scope="session")
def sample() -> Project:
    """The sample project, its clips loaded."""
    from metagraph.formats.store import open_project

    return open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project


@pytest.fixture(scope="session")
def few(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of the sample project with a tenth of its clips; read only."""
    from tests.projects import few_of_the_sample

    return few_of_the_sample(tmp_path_factory.mktemp("few"))
