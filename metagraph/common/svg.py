"""Pieces of plots as SVG text, drawn by us so that a report needs nothing beside it. Colours come from the
page's style, light or dark.
"""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.common.xml_text import escape

WIDTH = 640


def number(value: float) -> str:
    """Return a coordinate, the same on every machine."""
    return f"{value:.1f}".removesuffix(".0")


def line(x1: float, y1: float, x2: float, y2: float, css: str = "") -> str:
    named = f" class='{css}'" if css else ""
    return f"<line{named} x1='{number(x1)}' y1='{number(y1)}' x2='{number(x2)}' y2='{number(y2)}'/>"


def dot(x: float, y: float, r: float) -> str:
    return f"<circle cx='{number(x)}' cy='{number(y)}' r='{number(r)}'/>"


def text(x: float, y: float, words: str, css: str, anchor: str) -> str:
    return (
        f"<text class='{css}' x='{number(x)}' y='{number(y)}' text-anchor='{anchor}'>{escape(words)}</text>"
    )


def svg(height: float, parts: Sequence[str], title: str) -> str:
    """Return a drawing WIDTH wide."""
    shape = f"viewBox='0 0 {WIDTH} {number(height)}' role='img' aria-label='{escape(title, quote=True)}'"
    return f"<svg xmlns='http://www.w3.org/2000/svg' {shape}>{''.join(parts)}</svg>"
