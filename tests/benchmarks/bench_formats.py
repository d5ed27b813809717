"""How fast clips are read, beside other readers: `python tests/benchmarks/bench_formats.py`.

BVH: 10,000 frames. GLB: clips with few joints. Peers are used when they can be imported: upc-pymotion, bvh,
bvhtoolbox, bvhio, pygltflib, cmeel-assimp (the C++ library, called as it is). Every round runs each reader
once, in turn; medians of five rounds. Import and compile times are not counted, on either side. Results
differ: ours gives names, parents, offsets, float32 quaternions and translations in metres; the peers give
Euler angles, text or trees (said beside each).
"""

from __future__ import annotations

import ctypes
import importlib
import re
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.bvh.file import read_bvh, write_bvh  # noqa: E402
from metagraph.formats.clips import import_clips  # noqa: E402
from metagraph.formats.gltf.reader import read_gltf_clips, write_glb  # noqa: E402
from metagraph.formats.gltf.writer import Keys  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.motion.clip import Clip  # noqa: E402
from sample_clips.make.mannequin_skeleton import mannequin_skeleton  # noqa: E402

DATA = ROOT.parent / "shared" / "data"
FRAMES, ROUNDS = 10_000, 5


def invented(frames: int) -> Clip:
    """Return smooth motion of every joint of the mannequin."""
    skeleton = mannequin_skeleton()
    t = np.arange(frames)[:, None] / 30
    phase = np.arange(len(skeleton))
    axes = np.random.default_rng(1).normal(size=(len(skeleton), 3))
    rotations = rotation.from_axis_angle(
        np.broadcast_to(axes, (frames, len(skeleton), 3)), 0.4 * np.sin(t + phase)
    )
    root = skeleton.rest_translations[0] + 0.1 * np.sin(t * [1, 2, 3])
    return Clip("invented", skeleton, 30, rotations, root[:, None])


def long_bvh(folder: Path) -> tuple[Path, str]:
    """Return a file of 10,000 frames: real clips put end to end when they are here, else an invented one."""
    path = folder / "long.bvh"
    files = sorted((DATA / "bandai-namco-1").glob("*.bvh"))
    if not files:
        write_bvh(invented(FRAMES), path)
        return path, "invented motion, 61 joints"
    rows: list[str] = []
    for file in files * 4:
        text = file.read_text()
        rows += text[re.search(r"Frame Time:.*\n", text).end() :].strip().splitlines()  # type: ignore[union-attr]
    head = files[0].read_text().split("MOTION")[0]
    path.write_text(
        f"{head}MOTION\nFrames: {FRAMES}\nFrame Time: 0.0333333\n" + "\n".join(rows[:FRAMES]) + "\n"
    )
    return path, "real clips end to end, 22 joints, 132 channels"


def available(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except Exception as error:  # a peer that does not import is a peer that is not here, whatever its reason
        print(f"  (skipped {name}: {type(error).__name__}: {error})"[:110])
        return None


def bvh_readers(path: Path) -> dict[str, Callable[[], Any]]:
    readers: dict[str, Callable[[], Any]] = {
        "read the bytes (limit)": path.read_bytes,
        "ours: clip with f32 quaternions": lambda: read_bvh(path),
    }
    if pymotion := available("pymotion.io.bvh"):

        def with_pymotion() -> Any:
            file = pymotion.BVH()
            file.load(str(path))
            return file.get_data()

        readers["upc-pymotion: quaternions"] = with_pymotion
    if bvh := available("bvh"):
        readers["bvh: lists of text"] = lambda: bvh.Bvh(path.read_text())
    if toolbox := available("bvhtoolbox"):
        readers["bvhtoolbox: tree and numbers"] = lambda: toolbox.BvhTree(path.read_text())
    if bvhio := available("bvhio"):
        readers["bvhio readAsBvh: tree of keyframes"] = lambda: bvhio.readAsBvh(str(path))
    return readers


def assimp() -> Callable[[Path], None] | None:
    """Return what has the C++ library read a file, and lets go of it; None if it is not installed."""
    place = Path("cmeel.prefix") / "lib" / "libassimp.so"
    found = [Path(folder) / place for folder in sys.path if (Path(folder) / place).exists()]
    if not found:
        print("  (skipped assimp: no cmeel-assimp)")
        return None
    library = ctypes.CDLL(str(found[0]))
    library.aiImportFile.restype = ctypes.c_void_p
    library.aiImportFile.argtypes = ctypes.c_char_p, ctypes.c_uint
    library.aiReleaseImport.argtypes = (ctypes.c_void_p,)

    def read(path: Path) -> None:
        scene = library.aiImportFile(str(path).encode(), 0)
        if not scene:
            raise ValueError(path)
        library.aiReleaseImport(scene)

    return read


def glb_readers(paths: list[Path]) -> dict[str, Callable[[], Any]]:
    readers: dict[str, Callable[[], Any]] = {
        "read the bytes (limit)": lambda: [p.read_bytes() for p in paths],
        "ours: clips": lambda: [read_gltf_clips(p) for p in paths],
    }
    if pygltflib := available("pygltflib"):
        types = {5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
        widths = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}

        def with_pygltflib() -> Any:
            out = []
            for p in paths:
                gltf = pygltflib.GLTF2().load(str(p))
                blob = gltf.binary_blob()
                for animation in gltf.animations:
                    for sampler in animation.samplers:
                        for index in (sampler.input, sampler.output):
                            accessor = gltf.accessors[index]
                            view = gltf.bufferViews[accessor.bufferView]
                            start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
                            count = accessor.count * widths[accessor.type]
                            out.append(np.frombuffer(blob, types[accessor.componentType], count, start))
            return out

        readers["pygltflib + frombuffer: raw keys"] = with_pygltflib
    if with_assimp := assimp():
        readers["assimp + C++: raw keys, meshes, nodes"] = lambda: [with_assimp(p) for p in paths]
    return readers


def race(readers: dict[str, Callable[[], Any]]) -> dict[str, float]:
    """Return median seconds by reader; rounds are interleaved."""
    times: dict[str, list[float]] = {name: [] for name in readers}
    failed = set()
    for round_ in range(ROUNDS + 1):
        for name, reader in readers.items():
            if name in failed:
                continue
            start = time.perf_counter()
            try:
                reader()
            except Exception as error:
                failed.add(name)
                print(f"  ({name} failed: {type(error).__name__}: {error})"[:110])
                continue
            if round_:  # the first round warms up
                times[name].append(time.perf_counter() - start)
    return {name: statistics.median(taken) for name, taken in times.items() if name not in failed}


def report(times: dict[str, float], ours: str, units: Callable[[float], str]) -> None:
    for name, seconds in times.items():
        print(f"  {name:38} {1e3 * seconds:9.2f} ms  {units(seconds):34} {seconds / times[ours]:8.2f} x ours")


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        path, what = long_bvh(folder)
        size = path.stat().st_size / 1e6
        print(f"BVH, {FRAMES} frames ({what}), {size:.1f} MB, medians of {ROUNDS}")
        times = race(bvh_readers(path))
        report(
            times,
            "ours: clip with f32 quaternions",
            lambda s: f"{FRAMES / s:10.0f} frames/s {size / s:6.0f} MB/s",
        )

        clip = invented(96)
        files = []
        for i in range(20):
            files.append(folder / f"clip{i}.glb")
            write_glb(files[-1], [clip.renamed(f"clip{i}")], keys=Keys(quantize=False, tolerance=0))
        print(
            f"\nGLB, 20 files of one clip, 96 frames, 61 joints each, {files[0].stat().st_size / 1e3:.0f} kB "
            "a file"
        )
        times = race(glb_readers(files))
        report(times, "ours: clips", lambda s: f"{1e3 * s / len(files):8.3f} ms a clip")

        for name in ("sumerian-hosts", "kaykit-rogue", "robot-expressive"):
            real = sorted((DATA / name).rglob("*.glb"))
            if real:
                count = len(import_clips(real).clips)
                print(f"\nGLB, {name}: {len(real)} real files, {count} clips")
                times = race(glb_readers(real))
                report(times, "ours: clips", lambda s, n=count: f"{1e3 * s / n:8.3f} ms a clip")


if __name__ == "__main__":
    main()
