"""The code of the recipes in CONTRIBUTING.md, which tests run."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "CONTRIBUTING.md"


def code_of(recipe: str) -> str:
    """Return the first block of code of a recipe."""
    text = PAGE.read_text(encoding="utf-8").split(f"### {recipe}\n")[1].split("\n### ")[0]
    found = re.search(r"```python\n(.*?)```", text, re.S)
    assert found is not None, recipe
    return found[1]
