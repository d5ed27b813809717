"""Planning and posing: python tests/benchmarks/bench_playback.py [characters]

Plan of one hour; one pose of one character; a frame of a crowd in which everyone has a plan and a time of
their own, against the same work in plain NumPy, batched over characters; what the life layers add to a frame.
Medians on the sample project; crowds in interleaved runs of ten frames, as a crowd plays frame after frame.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph import anatomy, edits  # noqa: E402
from metagraph.graph.model import LAYERS, Layer, Project  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.motion.skeleton import Pose  # noqa: E402
from metagraph.playback import loops  # noqa: E402
from metagraph.playback.composer import playable, rig  # noqa: E402
from metagraph.playback.crowd import Crowd  # noqa: E402
from metagraph.playback.life.schedule import Schedule, schedule  # noqa: E402
from metagraph.playback.life.track import LookAt, Speech, track_of  # noqa: E402
from metagraph.playback.plan import Plan  # noqa: E402
from metagraph.playback.planner import extend, make_plan  # noqa: E402
from metagraph.playback.player import ease, pose_at  # noqa: E402

FAR = 1e7  # seconds between the plans of two characters on the one time line on which NumPy looks them all up


class Batched:
    """The crowd's work as one would write it in plain NumPy: everything laid out beforehand, no loop over
    characters.
    """

    def __init__(self, project: Project, plans: list[Plan]) -> None:
        self.rig = rig(project)
        self.count = len(plans)
        self.layers = {layer: self._lay(project, plans, layer) for layer in LAYERS}

    def _lay(self, project: Project, plans: list[Plan], layer: Layer) -> dict[str, Any]:
        reach, ground = self.rig.reach[layer], self.rig.ground
        first: dict[int, int] = {}
        rotations, translations, places = [], [], 0

        def frames(action: Any) -> tuple[int, int, float]:
            nonlocal places
            motion = playable(project, action)
            assert motion is not None
            if id(motion) not in first:
                offsets = ground.offsets(motion, reach)
                away = np.zeros((motion.frames, len(reach.joints), 3), np.float32)
                away[:, offsets.moved] = offsets.translations
                rotations.append(offsets.rotations)
                translations.append(away)
                first[id(motion)] = places
                places += motion.frames
            return first[id(motion)], motion.frames, motion.fps

        masks = [np.ones(len(ground.skeleton), np.float32)]
        rests, cues = [], []
        for n, plan in enumerate(plans):
            for rest in plan.layers[layer].rests:
                start, end = project.span(rest.action)
                assert rest.action.timing.blend_in == 0, "the sample's loops have no seams"
                rests.append(
                    (
                        n * FAR + rest.fade_start,
                        rest.fade,
                        rest.start,
                        start,
                        end - start,
                        *frames(rest.action),
                    )
                )
            for cue in plan.layers[layer].cues:
                mask = anatomy.mask(project, cue.action)
                if mask is not None and not any(mask is m for m in masks):
                    masks.append(mask)
                kept = next((i for i, m in enumerate(masks) if m is mask), 0)
                cues.append(
                    (
                        n * FAR + cue.start,
                        cue.start,
                        cue.end,
                        cue.entry,
                        cue.blend_in,
                        cue.blend_out,
                        kept,
                        *frames(cue.action),
                    )
                )
        return {
            "joints": reach.joints,
            "rests": np.array(rests).T,
            "cues": np.array(cues).T,
            "masks": np.array(masks)[:, reach.joints],
            "rotations": np.concatenate(rotations),
            "translations": np.concatenate(translations),
        }

    def poses(self, times: np.ndarray) -> Pose:
        line = times + np.arange(self.count) * FAR
        base = self.rig.ground.base
        rotations = np.repeat(base.rotations[None], self.count, 0)
        translations = np.repeat(base.translations[None], self.count, 0)
        for tables in self.layers.values():
            turned, away = self._layer(tables, times, line)
            joints = tables["joints"]
            rotations[:, joints] = rotation.multiply(rotations[:, joints], turned)
            translations[:, joints] += away
        return Pose(rotation.normalize(rotations), translations)

    def _sample(
        self,
        tables: dict[str, Any],
        first: np.ndarray,
        frames: np.ndarray,
        fps: np.ndarray,
        seconds: np.ndarray,
    ) -> Any:
        at = np.clip(seconds * fps, 0, frames - 1)
        low = np.minimum(at.astype(np.int64), np.maximum(0, frames - 2).astype(np.int64))
        w = (at - low).astype(np.float32)[:, None, None]
        a = first.astype(np.int64) + low
        b = first.astype(np.int64) + np.minimum(low + 1, frames - 1).astype(np.int64)
        r, t = tables["rotations"], tables["translations"]
        mixed = r[a] + (r[b] - r[a]) * w
        mixed /= np.sqrt(np.einsum("...i,...i->...", mixed, mixed))[..., None]
        return mixed, t[a] + (t[b] - t[a]) * w

    def _layer(self, tables: dict[str, Any], times: np.ndarray, line: np.ndarray) -> Any:
        rests, cues = tables["rests"], tables["cues"]
        place = np.searchsorted(cues[0], line, "right") - 1
        cue = cues[:, np.maximum(place, 0)]
        playing = (place >= 0) & (cue[0] <= line) & (times < cue[2]) & (line - cue[0] < FAR / 2)
        rising, falling = playing & (times < cue[1] + cue[4]), playing & (times >= cue[2] - cue[5])
        masked = playing & (cue[6] > 0)
        joints = len(tables["joints"])
        rotations, translations = (
            np.empty((len(times), joints, 4), np.float32),
            np.empty((len(times), joints, 3), np.float32),
        )
        need = np.flatnonzero(~playing | rising | falling | masked)
        stance: Any = None
        if len(need):
            stance = self._stance(tables, rests, times[need], line[need])
            rotations[need], translations[need] = stance
        on = np.flatnonzero(playing)
        if len(on):
            c = cue[:, on]
            r, t = self._sample(tables, c[7], c[8], c[9], c[3] + times[on] - c[1])
            lead = np.flatnonzero((rising | falling)[on])
            if len(lead):
                k, at = c[:, lead], times[on][lead]
                edge = np.where(rising[on][lead], k[3], k[3] + k[2] - k[1])
                e_r, e_t = self._sample(tables, k[7], k[8], k[9], edge)
                up = np.where(k[4] > 0, ease((at - k[1]) / np.where(k[4] > 0, k[4], 1)), 1)
                down = np.where(k[5] > 0, ease((k[2] - at) / np.where(k[5] > 0, k[5], 1)), 1)
                w = (1 - up * down).astype(np.float32)[:, None, None]
                s_r, s_t = rotations[on][lead], translations[on][lead]
                apart = rotation.multiply(rotation.conjugate(e_r), s_r)
                part = apart * np.where(apart[..., 3:] < 0, -w, w)
                part[..., 3:] += 1 - w
                part /= np.sqrt(np.einsum("...i,...i->...", part, part))[..., None]
                r[lead] = rotation.multiply(r[lead], part)
                t[lead] += (s_t - e_t) * w
            show = tables["masks"][c[6].astype(np.int64)][..., None] > 0
            rotations[on] = np.where(show, r, rotations[on])
            translations[on] = np.where(show, t, translations[on])
        return rotations, translations

    def _stance(self, tables: dict[str, Any], rests: np.ndarray, times: np.ndarray, line: np.ndarray) -> Any:
        place = np.maximum(np.searchsorted(rests[0], line, "right") - 1, 0)
        rest = rests[:, place]
        r, t = self._sample(tables, rest[5], rest[6], rest[7], rest[3] + np.mod(times - rest[2], rest[4]))
        fading = np.flatnonzero(line < rest[0] + rest[1])
        if len(fading):
            old, new, at = rests[:, place[fading] - 1], rest[:, fading], times[fading]
            o_r, o_t = self._sample(tables, old[5], old[6], old[7], old[3] + np.mod(at - old[2], old[4]))
            w = ease((line[fading] - new[0]) / new[1]).astype(np.float32)
            r[fading] = rotation.nlerp(o_r, r[fading], np.broadcast_to(w[:, None], r[fading].shape[:-1]))
            t[fading] = o_t + (t[fading] - o_t) * w[:, None, None]
        return r, t


def clock(work: Callable[[], object]) -> float:
    """Milliseconds."""
    start = time.perf_counter()
    work()
    return (time.perf_counter() - start) * 1e3


def row(words: str, values: list[float], note: str = "") -> None:
    print(f"  {words:46} {statistics.median(values):9.3f} {min(values):9.3f}  {note}", flush=True)


def crowded(project: Project, copies: int) -> Project:
    """Every gesture and fidget `copies` times: hundreds of candidates a stance."""
    for layer in LAYERS:
        for action in list(project.graphs[layer].actions.values()):
            if action.kind in ("gesture", "fidget"):
                project = edits.place(project, [action.clip] * copies, layer, action.kind, action.stance)
    return project


def lively(project: Project) -> None:
    """What the life layers cost one character that talks and looks about: a frame of each kind in turn."""
    text = (
        "Well, I think that we should go there tomorrow, because the weather will be fine and everybody "
        "has time."
    )
    asks = [Speech(f"s{n}", 9.0 * n, 9.0 * n + 7.5, None, text) for n in range(60)]
    looks = [LookAt(f"l{n}", 7.0 * n, 7.0 * n + 4.0, (np.sin(n), 1.5, 1.0)) for n in range(80)]
    plan = make_plan(project, 600.0)
    track = track_of([*asks, *looks])
    life = schedule(project.life, track, {}, 1, 600.0, Schedule(), 0.0)
    plan = replace(plan, track=track, life=life)
    bare: list[float] = []
    whole: list[float] = []
    planned: list[float] = []
    running = make_plan(project, 12.0)
    pose_at(plan, project, 1.0)
    for n in range(600):
        at, now = 100 + n / 60, n / 60
        bare.append(clock(lambda at=at: pose_at(plan, project, at, alive=False)))  # type: ignore[misc]
        whole.append(clock(lambda at=at: pose_at(plan, project, at)))  # type: ignore[misc]
        began = time.perf_counter()
        running = replace(
            running, life=schedule(project.life, running.track, {}, 1, 12.0 + now, running.life, now)
        )
        planned.append((time.perf_counter() - began) * 1e3)
    times = np.arange(3600) / 60
    print("\none character, talking and looking about")
    row("a frame of the layers", bare)
    row(
        "a frame of layers and life",
        whole,
        f"life adds {statistics.median(whole) - statistics.median(bare):.3f}",
    )
    row("what drawing life ahead adds to a tick", planned, f"mean {statistics.mean(planned):.3f}")
    row(
        "one minute at 60 fps, a frame",
        [clock(lambda: pose_at(plan, project, times)) / 3600 for _ in range(3)],
    )
    hour = [clock(lambda: schedule(project.life, track, {}, 1, 3600.0, Schedule(), 0.0)) for _ in range(5)]
    row("an hour of life, drawn at once", hour)


def one_character(project: Project, plan: Plan) -> None:
    """A pose and where its joints are, at one time after the other as a preview asks, and at any: NumPy and
    the compiled loops in turn, the processor's microseconds.
    """
    loops.load()
    modules = [(x, x.now) for x in loops.LOOPS]
    drawn = np.random.default_rng(1).uniform(0, 120, 400)
    print("\none character, the processor's us: NumPy, compiled loops")
    for words, times, alive in (
        ("pose_at without life, any time", drawn, False),
        ("pose_at without life, 60 a second", np.arange(400) / 60, False),
        ("pose_at with life and weight, any time", drawn, True),
        ("pose_at with life and weight, 60 a second", np.arange(400) / 60, True),
    ):
        taken: tuple[list[int], list[int]] = ([], [])
        after: tuple[list[int], list[int]] = ([], [])
        for begin in range(0, len(times), 50):
            for side in (0, 1):
                for x, module in modules:
                    x.now = module if side else None
                pose_at(plan, project, float(times[begin]), alive)
                for time_ in times[begin : begin + 50].tolist():
                    start = time.thread_time_ns()
                    pose = pose_at(plan, project, time_, alive)
                    done = time.thread_time_ns()
                    project.skeleton.globals(pose)  # type: ignore[union-attr]
                    taken[side].append(done - start)
                    after[side].append(time.thread_time_ns() - done)
        row(words, [n / 1e3 for n in taken[0]], f"{statistics.median(taken[1]) / 1e3:9.1f}")
        row(
            "  and Skeleton.globals", [n / 1e3 for n in after[0]], f"{statistics.median(after[1]) / 1e3:9.1f}"
        )
    minute = np.arange(3600) / 60
    for alive in (False, True):
        whole: list[float] = []
        for side in (0, 1):
            for x, module in modules:
                x.now = module if side else None
            start = time.thread_time_ns()
            pose_at(plan, project, minute, alive)
            whole.append((time.thread_time_ns() - start) / 3.6e6)
        row(
            f"one minute at 60 fps, a frame, {'alive' if alive else 'without life'}",
            whole[:1],
            f"{whole[1]:9.1f}",
        )
    for x, _ in modules:
        x.now = None


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    sample = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    assert sample.skeleton is not None
    joints = len(sample.skeleton)
    print(
        f"sample project: {joints} joints, three layers; {os.cpu_count()} cores\n  {'':46} {'median':>9} "
        f"{'best':>9}  ms"
    )

    hour = make_plan(sample, 3600)
    cues = sum(len(lane.cues) for lane in hour.layers.values())
    row("plan of one hour", [clock(lambda: make_plan(sample, 3600)) for _ in range(7)], f"{cues} cues")
    many = crowded(sample, 24)
    most = max(len(bucket) for graph in many.graphs.values() for bucket in graph.index.values())
    row(
        "plan of one hour, hundreds of candidates",
        [clock(lambda: make_plan(many, 3600)) for _ in range(3)],
        f"up to {most} a draw",
    )
    row(
        "extend an hour's plan by a minute",
        [clock(lambda: extend(sample, hour, 3590, (), 3660)) for _ in range(7)],
    )
    day = make_plan(sample, 36000)
    row(
        "extend a plan of ten hours by a minute",
        [clock(lambda: extend(sample, day, 35990, (), 36060)) for _ in range(7)],
    )

    times = np.random.default_rng(1).uniform(0, 3600, 400)
    pose_at(hour, sample, times, alive=False)
    row(
        "pose_at without life, one time",
        [clock(lambda t=t: pose_at(hour, sample, t, alive=False)) for t in times],
    )  # type: ignore[misc]
    minute = np.arange(3600) / 60
    row(
        "the same, one minute at 60 fps, a frame",
        [clock(lambda: pose_at(hour, sample, minute, alive=False)) / 3600 for _ in range(3)],
    )
    one_character(sample, make_plan(sample, 120))
    lively(sample)

    plans = [make_plan(sample, 60, seed=seed) for seed in range(count)]
    start = time.perf_counter()
    crowd = Crowd(sample, plans)
    laid = (time.perf_counter() - start) * 1e3
    first = clock(lambda: crowd.globals(0.0))
    print(
        f"\n{count} characters, each its own plan and time (laid out in {laid:.0f} ms, first frame with "
        f"numba's import {first:.0f} ms)"
    )
    batched = Batched(sample, plans)
    moments = np.random.default_rng(2).uniform(0, 60, count)
    ours, theirs = crowd.poses(moments), batched.poses(moments)
    turn = rotation.angle_between(ours.rotations.astype(float), theirs.rotations.astype(float)).max()
    print(
        f"  they agree to {turn:.1e} radians, {np.abs(ours.translations - theirs.translations).max():.1e} m"
    )
    frame, model = crowd.poses(moments), crowd.globals(moments)  # each frame is written over the last
    works: list[tuple[list[float], Callable[[np.ndarray], object]]] = [
        ([], lambda at: crowd.poses(at, frame)),
        ([], lambda at: batched.poses(at)),
        ([], lambda at: crowd.globals(at, model)),
        ([], lambda at: sample.skeleton.globals(batched.poses(at))),  # type: ignore[union-attr]
    ]
    for n in range(0, 60, 10):
        for taken, work in works:
            for k in range(n, n + 10):
                taken.append(clock(lambda at=(moments + k / 60) % 60, work=work: work(at)))  # type: ignore[misc]
    compiled, plain, both, globally = (taken for taken, _ in works)
    row("Crowd.poses", compiled)
    row(
        "plain NumPy, batched",
        plain,
        f"{statistics.median(plain) / statistics.median(compiled):.1f} times as long",
    )
    row("Crowd.globals", both)
    row(
        "plain NumPy, batched, and Skeleton.globals",
        globally,
        f"{statistics.median(globally) / statistics.median(both):.1f} times as long",
    )
    some = [
        clock(lambda n=n: pose_at(plans[n], sample, moments[n], alive=False)) for n in range(min(count, 300))
    ]  # type: ignore[misc]
    row("pose_at for each, all of them", [statistics.median(some) * count])


if __name__ == "__main__":
    main()
