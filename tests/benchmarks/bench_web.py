"""How soon the web page shows its first pose: python tests/benchmarks/bench_web.py [project]

From the navigation to the first frame drawn, in headless Chromium with a software renderer, from a server on
this machine; median of five, of the sample project (152 clips) or another. Needs Node, Chromium and what
tests/package.json names.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from app.project.opening import open_whole  # noqa: E402
from metagraph.engines.targets import registry, web  # noqa: E402

RUNS = 5


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "sample_clips" / "sample.metagraph.yaml"
    project = open_whole(path).project
    web.tools = lambda folder: ROOT / "tests" / "node_modules"
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        made = registry.write(
            project, "web", folder, path.parent / project.character if project.character else None
        )
        shown = {"run": "performance.getEntriesByName('first pose')[0].startTime"}
        opened = {"url": "", "until": "performance.getEntriesByName('first pose').length"}
        (folder / "steps.json").write_text(json.dumps([opened, shown] * RUNS))
        command = [
            "node",
            str(ROOT / "tests" / "engines" / "run" / "browser.mjs"),
            str(folder),
            str(folder / "steps.json"),
        ]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
        size = sum(p.stat().st_size for p in made.files if p.suffix in (".json", ".glb")) / 1e6
    times = [row["value"] for row in map(json.loads, told) if "value" in row]
    spread = f"median of {RUNS} ({min(times):.0f} to {max(times):.0f})"
    print(f"{made.clips} clips, {size:.1f} MB: first pose after {statistics.median(times):.0f} ms, {spread}")


if __name__ == "__main__":
    main()
