"""The code of the recipes in docs/contributing, which tests run."""

from __future__ import annotations

import re
from pathlib import Path

PAGES = Path(__file__).resolve().parents[1] / "docs" / "contributing"


def code_of(recipe: str) -> str:
    """Return the first block of code of a recipe: "Add a target" is the page add-a-target.md."""
    text = (PAGES / f"{recipe.lower().replace(' ', '-')}.md").read_text(encoding="utf-8")
    found = re.search(r"```python\n(.*?)```", text, re.S)
    assert found is not None and text.startswith(f"# {recipe}\n"), recipe
    return found[1]
