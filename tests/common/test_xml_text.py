"""Text for XML: whatever is in it, a parser reads what we write."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

from hypothesis import example, given
from hypothesis import strategies as st

from metagraph.common import svg
from metagraph.common.xml_text import INSTEAD, clean_xml_text, describe_replaced, escape, quote_xml
from metagraph.research.study.reports.figure_files import make_standalone_svg

ROOT = Path(__file__).resolve().parents[2]


@given(st.text())
@example("\x00\x07\x1b\ufffe\uffff<&>\"'\r\n\t")
@example("\ud800 half a pair")
def test_any_text_stands_in_an_element_and_an_attribute(text: str) -> None:
    found = ElementTree.fromstring(f"<x a={quote_xml(text)} b='{escape(text)}'>{escape(text)}</x>")
    assert found.attrib["a"] == clean_xml_text(text)
    same_lines = clean_xml_text(text).replace("\r\n", "\n").replace("\r", "\n")
    assert (found.text or "") == same_lines


@given(st.text(st.characters(exclude_categories=("Cs",))))
def test_what_xml_can_hold_stays_as_it_is(text: str) -> None:
    if describe_replaced([text]) is None:
        assert clean_xml_text(text) == text
    else:
        assert INSTEAD in clean_xml_text(text)


def test_what_is_replaced_is_counted_and_told() -> None:
    assert describe_replaced(["plain", {"a": ["b", 3, None]}]) is None
    assert str(describe_replaced(["a\x00", {"k\x01": ["b\x02", "c"]}])).startswith("3 texts contain")


def test_a_figure_with_control_characters_in_its_words_is_read() -> None:
    drawing = svg.make_svg_drawing(20, [svg.draw_svg_text(0, 0, "a\x01<b>", "dim", "start")], "ti\x1btle'\"")
    ElementTree.fromstring(drawing)
    ElementTree.fromstring(make_standalone_svg(drawing).encode())


def test_nothing_that_writes_files_escapes_by_other_means() -> None:
    own = re.compile(r"from html import escape|saxutils|quoteattr")
    written = [*(ROOT / "metagraph").rglob("*.py"), *(ROOT / "app" / "cli").rglob("*.py")]
    assert not [p for p in written if own.search(p.read_text(encoding="utf-8"))]
