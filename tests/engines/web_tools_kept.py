"""What npm installed for the tests, kept as Metagraph keeps it: in a folder of its own, with nothing from
the net.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from metagraph.engines.targets import web_tools
from tests.browsing import MODULES


@contextmanager
def kept_web_tools(folder: Path) -> Iterator[Path]:
    """Have exports find three.js and esbuild in a folder; skip where npm did not install them."""
    for name in ("three", "@esbuild"):
        if not (MODULES / name).is_dir():
            pytest.skip("needs three.js and esbuild (python3 run.py test fetches them where npm is)")
    modules = folder / "node_modules"
    for name in web_tools.NEEDED:
        (modules / "three" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(MODULES / "three" / name, modules / "three" / name)
    shutil.copytree(MODULES / "@esbuild", modules / "@esbuild", dirs_exist_ok=True)
    for path in (folder, *folder.rglob("*")):
        path.chmod(path.stat().st_mode & ~0o022)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(web_tools, "find_web_tools_folder", lambda: folder)
        yield folder
