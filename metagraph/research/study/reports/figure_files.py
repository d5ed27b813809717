"""Figures of a report as files of their own, which any drawing program opens: what the page's style says is
written into each mark. Light colours, on white.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree import ElementTree

from metagraph.research.study.reports.style import CONDITION_COLOURS, PART_COLOURS

SPACE = "http://www.w3.org/2000/svg"
TEXT, DIM, GRID = "#1d2126", "#59616b", "#d5d9de"
FONT = "Helvetica, Arial, 'Liberation Sans', sans-serif"


def make_standalone_svg(drawing: str, width_mm: float = 170.0) -> str:
    """Return a report's drawing as an SVG file of its own. width_mm: on paper, as wide as a page's text."""
    ElementTree.register_namespace("", SPACE)
    root = ElementTree.fromstring(drawing)
    wide, high = (float(v) for v in root.attrib["viewBox"].split()[2:])
    root.set("width", f"{width_mm:g}mm")
    root.set("height", f"{width_mm * high / wide:.1f}mm")
    root.set("font-family", FONT)
    root.set("font-size", "12")
    _walk(root, {})
    ground = ElementTree.Element(
        f"{{{SPACE}}}rect", {"width": f"{wide:g}", "height": f"{high:g}", "fill": "#ffffff"}
    )
    root.insert(0, ground)
    return f"<?xml version='1.0' encoding='UTF-8'?>\n{ElementTree.tostring(root, encoding='unicode')}\n"


def _walk(node: ElementTree.Element, inherited: Mapping[str, str]) -> None:
    css = node.attrib.pop("class", "").split()
    style = dict(inherited)
    for name in css:
        if name in CONDITION_COLOURS:
            style["colour"] = CONDITION_COLOURS[name]
        if name == "person":
            style["colour"], style["faint"] = DIM, "yes"
    kind = node.tag.rpartition("}")[2]
    if kind == "line":
        node.set(
            "stroke",
            GRID if "grid" in css else DIM if {"one", "edge"} & {*css} else style.get("colour", TEXT),
        )
        node.set("stroke-width", "2.5" if "wide" in css else "1")
        if "one" in css:
            node.set("stroke-dasharray", "4 3")
        if style.get("faint"):
            node.set("stroke-opacity", "0.55")
    elif kind == "circle":
        node.set("fill", style.get("colour", TEXT))
    elif kind == "rect":
        part = next((c for c in css if c in PART_COLOURS), None)
        node.set("fill", PART_COLOURS[part] if part else "#ffffff")
        if "box" in css:
            node.set("stroke", DIM)
    elif kind == "text":
        own = next((CONDITION_COLOURS[c] for c in css if c in CONDITION_COLOURS), None)
        node.set("fill", own or ("#ffffff" if "inside" in css else DIM if "dim" in css else TEXT))
        if own or "inside" in css:
            node.set("font-weight", "600")
    for child in node:
        _walk(child, style)
