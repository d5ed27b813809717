"""`python -m sample_clips.make`: make every clip again, the same to the byte.

python -m sample_clips.make                     write sample_clips/clips/*.glb and sample_clips/seated/*.glb
python -m sample_clips.make --sheets out/sheets write a contact sheet of each as well
python -m sample_clips.make --only shrug        only clips whose name contains the word
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from metagraph.formats.gltf.writer import Keys, write_glb
from sample_clips.make.catalogue import RECIPES, SEATED
from sample_clips.make.clip_sheet import sheet
from sample_clips.make.recipe import animate

CLIPS = Path(__file__).resolve().parents[1] / "clips"
TOLERANCE = 1.5e-4  # of a quaternion's component, some 0.02 degrees: what keys are thinned out to
STANDING = 5e-5  # the same where legs stand, as fine as exports are: an ankle lies 0.9 m below the hips


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m sample_clips.make", description="Make the sample clips.")
    parser.add_argument("--only", default="", help="make only clips whose name contains this")
    parser.add_argument(
        "--folder",
        type=Path,
        default=CLIPS,
        help="where to write (default: sample_clips/clips); those of one who sits go to `seated` beside it",
    )
    parser.add_argument("--sheets", type=Path, help="write a picture of each clip into this folder")
    options = parser.parse_args()
    if options.sheets:
        options.sheets.mkdir(parents=True, exist_ok=True)
    began, size, count = time.perf_counter(), 0, 0
    for recipes, folder in ((RECIPES, options.folder), (SEATED, options.folder.with_name("seated"))):
        folder.mkdir(parents=True, exist_ok=True)
        for recipe in recipes:
            if options.only not in recipe.name:
                continue
            clip = animate(recipe)
            path = folder / f"{recipe.name}.glb"
            tolerance = STANDING if recipe.layer == "body" else TOLERANCE
            write_glb(path, [clip], keys=Keys(tolerance=tolerance, pose_nodes=True))
            size, count = size + path.stat().st_size, count + 1
            if options.sheets:
                sheet(clip, options.sheets / f"{recipe.name}.png")
        if not options.only:
            known = {f"{recipe.name}.glb" for recipe in recipes}
            for stale in sorted(folder.glob("*.glb")):
                if stale.name not in known:
                    stale.unlink()
    print(f"{count} clips, {size / 1e6:.2f} MB, {time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
