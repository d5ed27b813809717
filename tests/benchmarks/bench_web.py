"""How soon the web page shows its first pose: python tests/benchmarks/bench_web.py [project]

From the navigation to the first frame drawn, in headless Chromium with a software renderer, from a server on
this machine; medians of seven in turns, of the sample project (152 clips) or another, with its GLB as it is
and packed, and the bytes of both. Needs Node, Chromium and what tests/package.json names.
"""

from __future__ import annotations

import gzip
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from app.project.opening import open_whole  # noqa: E402
from metagraph.engines.targets import registry, web_tools  # noqa: E402
from metagraph.engines.targets.target import Contents  # noqa: E402

RUNS = 7
KINDS = ("plain", "packed")


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "sample_clips" / "sample.metagraph.yaml"
    project = open_whole(path).project
    web_tools.find_web_tools_folder = lambda: ROOT / "tests"
    character = path.parent / project.character if project.character else None
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for kind in KINDS:
            made = registry.write_for_target(
                project, "web", folder / kind, Contents(character, compress=kind == "packed")
            )
            (glb,) = (p.read_bytes() for p in made.files if p.suffix == ".glb")
            size, zipped = len(glb) / 1e6, len(gzip.compress(glb, 6)) / 1e6
            print(f"{kind}: {made.clips} clips, GLB of {size:.2f} MB, {zipped:.2f} zipped")
        shown = {"run": "performance.getEntriesByName('first pose')[0].startTime"}
        until = "performance.getEntriesByName('first pose').length"
        steps = [
            step
            for _ in range(RUNS)
            for kind in KINDS
            for step in ({"url": f"{kind}/", "until": until}, shown)
        ]
        (folder / "steps.json").write_text(json.dumps(steps))
        command = [
            "node",
            str(ROOT / "tests" / "engines" / "run" / "browser.mjs"),
            str(folder),
            str(folder / "steps.json"),
        ]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    times = [row["value"] for row in map(json.loads, told) if "value" in row]
    for n, kind in enumerate(KINDS):
        own = times[n :: len(KINDS)]
        spread = f"median of {RUNS} ({min(own):.0f} to {max(own):.0f})"
        print(f"{kind}: first pose after {statistics.median(own):.0f} ms, {spread}")


if __name__ == "__main__":
    main()
