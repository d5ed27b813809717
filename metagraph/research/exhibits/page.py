"""Exhibits as one page that needs nothing beside it, and as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.common.xml_text import escape
from metagraph.research.exhibits.exhibit import Exhibit, ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.published import PAPERS
from metagraph.research.generation import figures
from metagraph.research.study.reports.style import STYLE

_STYLE = f"""
body {{ max-width: 1000px; }} .wide-table {{ overflow-x: auto; }}
.paper {{ --c: var(--s2); }} .ours {{ --c: var(--s1); }} .ink {{ --c: var(--text); }}
rect.paper, rect.ours, .paper circle, .ours circle {{ fill: var(--c); }}
line.edge {{ stroke: var(--text); stroke-width: 1.2; }} text.small {{ font-size: 10px; fill: var(--dim); }}
td:first-child {{ min-width: 90px; }} td, th {{ padding-right: 14px; }}
nav {{ columns: 2; font-size: 13px; margin: 12px 0 24px; }} nav b {{ display: block; margin-top: 8px; }}
nav a {{ display: block; padding: 2px 0; text-decoration: none; }}
h2 {{ border-top: 1px solid var(--line); padding-top: 18px; }}
{figures.STYLE}
polyline.curve {{ fill: none; stroke: var(--c); stroke-width: 1.8; }}
"""
Made = tuple[Exhibit, MadeExhibit, float]  # and the seconds it took


def format_exhibits(made: Sequence[Made], told: Mapping[str, str]) -> str:
    """Return the page. told: what stands at its top."""
    parts = ["<h1>The papers' exhibits, made again</h1>", "<div class='card'>"]
    parts += [f"<p>{escape(k)}: {escape(v)}</p>" for k, v in told.items()]
    parts += [
        "<p class='dim'>What was published is purple in drawings, what was made here green.</p></div>",
        "<nav>",
    ]
    before = ""
    for exhibit, _, _ in made:
        if exhibit.paper != before:
            parts.append(f"<b>{escape(PAPERS[exhibit.paper])}</b>")
            before = exhibit.paper
        parts.append(f"<a href='#{exhibit.name}'>{escape(f'{exhibit.place}: {exhibit.title}')}</a>")
    parts.append("</nav>")
    for exhibit, shown, seconds in made:
        parts += _exhibit(exhibit, shown, seconds)
    head = "<meta charset='utf-8'><title>The papers' exhibits</title>"
    body = "\n".join(parts)
    style = f"<style>{STYLE}{_STYLE}</style>"
    return f"<!DOCTYPE html><html lang='en'><head>{head}{style}</head><body>{body}</body></html>\n"


def _exhibit(exhibit: Exhibit, shown: MadeExhibit, seconds: float) -> list[str]:
    title = f"{exhibit.title} <span class='dim'>{escape(exhibit.place)}</span>"
    out = [f"<h2 id='{exhibit.name}'>{title}</h2>"]
    out.append(f"<p class='dim'>{escape(PAPERS[exhibit.paper])}</p>")
    out.append(f"<p class='dim'>Made of {escape(shown.material)}. It took {seconds:.1f} s.</p>")
    if shown.missing:
        out.append(f"<p class='warn'>Missing: {escape(shown.missing)}</p>")
    out += [f"<p>{escape(words)}</p>" for words in shown.says]
    for part in shown.parts:
        if isinstance(part, ExhibitDrawing):
            out.append(f"<figure>{part.svg}<figcaption>{escape(part.caption)}</figcaption></figure>")
        else:
            out.append(_table(part))
    return out


def _table(table: ExhibitTable) -> str:
    head = "".join(f"<th>{escape(c)}</th>" for c in table.columns)
    body = "".join(f"<tr>{''.join(f'<td>{escape(c)}</td>' for c in row)}</tr>" for row in table.rows)
    rows = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return f"<h3>{escape(table.caption)}</h3><div class='wide-table'>{rows}</div>"


def exhibit_as_text(exhibit: Exhibit, shown: MadeExhibit) -> str:
    """Return an exhibit as text: its tables and what it says."""
    lines = [f"{exhibit.name}: {exhibit.title} ({exhibit.paper}, {exhibit.place})"]
    if shown.missing:
        return "\n".join([*lines, f"  missing: {shown.missing}"])
    for part in shown.parts:
        if isinstance(part, ExhibitTable):
            rows = [part.columns, *part.rows]
            wide = [max(len(r[k]) for r in rows) for k in range(len(part.columns))]
            lines.append(f"  {part.caption}")
            lines += [
                "    " + "  ".join(c.ljust(w) for c, w in zip(r, wide, strict=True)).rstrip() for r in rows
            ]
    return "\n".join([*lines, *(f"  {words}" for words in shown.says)])


def encode_exhibits(made: Sequence[Made]) -> list[dict[str, Any]]:
    """Return exhibits as plain data."""
    return [
        {
            "exhibit": e.name,
            "paper": e.paper,
            "place": e.place,
            "material": s.material,
            "missing": s.missing or None,
            "says": list(s.says),
            "tables": [
                {"caption": p.caption, "columns": list(p.columns), "rows": [list(r) for r in p.rows]}
                for p in s.parts
                if isinstance(p, ExhibitTable)
            ],
            "numbers": s.numbers,
            "seconds": round(seconds, 2),
        }
        for e, s, seconds in made
    ]
