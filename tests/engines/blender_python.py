"""Blender itself in tests.

`METAGRAPH_BPY` names a Python that imports bpy (pip install bpy, in an environment of its own: 360 MB).
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec

import pytest


def find_blender() -> str:
    """Return a Python that imports bpy; skip the test where there is none."""
    named = os.environ.get("METAGRAPH_BPY")
    if named:
        return named
    if find_spec("bpy") is None:
        pytest.skip("needs Blender as a module: METAGRAPH_BPY=<a Python that imports bpy>")
    return sys.executable
