"""Pieces of plots as SVG text, drawn by us so that a report needs nothing beside it. Colours come from the
page's style, light or dark.
"""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.common.xml_text import escape

WIDTH = 640


def format_px(value: float) -> str:
    """Return a coordinate, the same on every machine."""
    return f"{value:.1f}".removesuffix(".0")


def draw_svg_line(x1: float, y1: float, x2: float, y2: float, css: str = "") -> str:
    """Return a line from (x1, y1) to (x2, y2), pixels. css: its class."""
    named = f" class='{css}'" if css else ""
    return (
        f"<line{named} x1='{format_px(x1)}' y1='{format_px(y1)}' x2='{format_px(x2)}' y2='{format_px(y2)}'/>"
    )


def draw_svg_dot(x: float, y: float, r: float) -> str:
    """Return a dot of radius r about (x, y), pixels."""
    return f"<circle cx='{format_px(x)}' cy='{format_px(y)}' r='{format_px(r)}'/>"


def draw_svg_text(x: float, y: float, words: str, css: str, anchor: str) -> str:
    """Return words at (x, y), pixels. css: their class. anchor: which end of them is there (SVG's
    text-anchor).
    """
    place = f"x='{format_px(x)}' y='{format_px(y)}' text-anchor='{anchor}'"
    return f"<text class='{css}' {place}>{escape(words)}</text>"


def make_svg_drawing(height: float, parts: Sequence[str], title: str) -> str:
    """Return a drawing WIDTH wide."""
    shape = f"viewBox='0 0 {WIDTH} {format_px(height)}' role='img' aria-label='{escape(title, quote=True)}'"
    return f"<svg xmlns='http://www.w3.org/2000/svg' {shape}>{''.join(parts)}</svg>"
