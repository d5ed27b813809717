"""`python -m sample_clips.make`: make every clip again, the same to the byte.

python -m sample_clips.make                     write sample_clips/clips/*.glb
python -m sample_clips.make --sheets out/sheets write a contact sheet of each as well
python -m sample_clips.make --only shrug        only clips whose name contains the word
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from metagraph.formats.gltf_writer import write_glb
from sample_clips.make.catalogue import RECIPES
from sample_clips.make.clip_sheet import sheet
from sample_clips.make.recipe import animate

CLIPS = Path(__file__).resolve().parents[1] / "clips"
TOLERANCE = 1.5e-4  # of a quaternion's component, some 0.02 degrees: what keys are thinned out to


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m sample_clips.make", description="Make the sample clips.")
    parser.add_argument("--only", default="", help="make only clips whose name contains this")
    parser.add_argument(
        "--folder", type=Path, default=CLIPS, help="where to write (default: sample_clips/clips)"
    )
    parser.add_argument("--sheets", type=Path, help="write a picture of each clip into this folder")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    if options.sheets:
        options.sheets.mkdir(parents=True, exist_ok=True)
    began, size, count = time.perf_counter(), 0, 0
    for recipe in RECIPES:
        if options.only not in recipe.name:
            continue
        clip = animate(recipe)
        path = options.folder / f"{recipe.name}.glb"
        write_glb(path, [clip], quantize=True, tolerance=TOLERANCE, pose_nodes=True)
        size, count = size + path.stat().st_size, count + 1
        if options.sheets:
            sheet(clip, options.sheets / f"{recipe.name}.png")
    if not options.only:
        known = {f"{recipe.name}.glb" for recipe in RECIPES}
        for stale in sorted(options.folder.glob("*.glb")):
            if stale.name not in known:
                stale.unlink()
    print(f"{count} clips, {size / 1e6:.2f} MB, {time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
