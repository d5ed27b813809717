"""How a report looks, and what it says of its methods."""

from __future__ import annotations

from collections.abc import Mapping

# On light ground, as on paper; then on dark.
CONDITION_COLOURS: Mapping[str, str] = {
    "meta": "#127065", "manual": "#a35c00", "unreal": "#1a63b8", "unity": "#6a45c4", "godot": "#b3372f",
    "blender": "#8a1c5c",
}  # fmt: skip
_DARK_CONDITIONS = ("#3fb8a6", "#f0a63c", "#5aa3f0", "#a98bf0", "#e57373", "#e08ab8")
_PARTS = (
    "#1a63b8",
    "#127065",
    "#6a45c4",
    "#a35c00",
    "#626a74",
    "#8a1c5c",
    "#3b6d11",
    "#4a4fb5",
    "#b3372f",
    "#7d5b00",
    "#2f4858",
)
_DARK_PARTS = (
    "#5aa3f0",
    "#3fb8a6",
    "#a98bf0",
    "#f0a63c",
    "#8a929c",
    "#e07bb5",
    "#8fc95a",
    "#8f96f5",
    "#e57373",
    "#d9b44a",
    "#7fa0b5",
)
PART_COLOURS: Mapping[str, str] = {f"s{n}": c for n, c in enumerate(_PARTS)}


def _colours(conditions: tuple[str, ...], parts: tuple[str, ...]) -> str:
    named = (*zip(CONDITION_COLOURS, conditions, strict=True), *zip(PART_COLOURS, parts, strict=True))
    return "".join(f" --{name}: {colour};" for name, colour in named)


_LIGHT = _colours(tuple(CONDITION_COLOURS.values()), _PARTS) + " --inside: #fff;"
_DARK = _colours(_DARK_CONDITIONS, _DARK_PARTS) + " --inside: #101114;"
STYLE = f"""
:root {{ color-scheme: dark light; --ground: #17181b; --card: #25282d; --line: #34383f; --text: #dfe3e8; --dim: #9aa1ab; --warn: #e8c24a;{_DARK} }}
@media (prefers-color-scheme: light) {{
  :root {{ --ground: #f6f7f8; --card: #fff; --line: #d5d9de; --text: #1d2126; --dim: #59616b; --warn: #7d5b00;{_LIGHT} }}
}}
@media print {{
  :root {{ color-scheme: light; --ground: #fff; --card: #fff; --line: #ccc; --text: #000; --dim: #444; --warn: #5c4300;{_LIGHT} }}
  body {{ max-width: none; padding: 0; font-size: 11px; }} h2, h3 {{ break-after: avoid; }} figure, table, tr, .card {{ break-inside: avoid; }}
  svg, rect, circle {{ print-color-adjust: exact; -webkit-print-color-adjust: exact; }} .take {{ display: none; }}
}}
body {{ margin: 0 auto; max-width: 900px; padding: 28px 24px 60px; background: var(--ground); color: var(--text);
  font: 14px/1.5 system-ui, sans-serif; }}
h1 {{ font-size: 24px; margin: 0 0 14px; }} h2 {{ font-size: 18px; margin: 40px 0 8px; }} h3 {{ font-size: 15px; margin: 24px 0 6px; }}
p {{ margin: 8px 0; }} ul {{ margin: 8px 0; padding-left: 20px; }} .dim, figcaption {{ color: var(--dim); }} .warn {{ color: var(--warn); }}
a {{ color: inherit; }} .take {{ margin-left: 10px; font-size: 12px; }}
.card {{ background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 10px 18px; margin: 12px 0; }}
.big {{ font-size: 19px; line-height: 1.4; }}
figure {{ margin: 16px 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 14px 14px 10px; }}
figcaption {{ font-size: 13px; margin-top: 6px; text-align: center; }}
svg {{ display: block; width: 100%; max-width: 680px; height: auto; margin: 0 auto; font: 12px system-ui, sans-serif; }}
table {{ border-collapse: collapse; font-size: 13px; width: 100%; margin: 12px 0; font-variant-numeric: tabular-nums; }}
th {{ text-align: left; color: var(--dim); font-weight: 500; }}
th, td {{ padding: 5px 10px 5px 0; border-bottom: 1px solid var(--line); vertical-align: top; }}
td .dim, td:has(b) {{ white-space: nowrap; }} td:first-child {{ min-width: 190px; }}
dt {{ font-weight: 600; margin-top: 8px; }} dd {{ margin: 0 0 4px; color: var(--dim); }}
text {{ fill: var(--text); }} text.dim {{ fill: var(--dim); }} text.inside {{ fill: var(--inside); font-weight: 600; }}
line.grid {{ stroke: var(--line); }} line.one {{ stroke: var(--dim); stroke-dasharray: 4 3; }} line.edge {{ stroke: var(--dim); }}
rect.box {{ fill: var(--ground); stroke: var(--dim); }}
.person line {{ stroke: var(--dim); stroke-opacity: .55; }} .person circle {{ fill: var(--dim); }}
.person:hover line {{ stroke: var(--text); stroke-width: 2.5; stroke-opacity: 1; }}
{"".join(f".{c} line {{ stroke: var(--{c}); }} .{c} circle {{ fill: var(--{c}); }} text.{c} {{ fill: var(--{c}); font-weight: 600; }}" for c in CONDITION_COLOURS)}
.wide {{ stroke-width: 2.5; }}
{"".join(f".{p} {{ fill: var(--{p}); }}" for p in PART_COLOURS)}
"""

METHODS = """<dl>
<dt>Times</dt><dd>Active seconds of a task, without pauses and without gaps of more than a minute; how much those were is told. Each
person counts once, by the geometric mean over the tasks done in both conditions; who has no task in common is left out. Means are
geometric, their intervals those of Student's t on logs (95 %).</dd>
<dt>Ratio</dt><dd>The geometric mean of each person's ratio, with the t interval of the logs' differences; paired t test on logs,
two-sided. Where nobody did both, Welch's test on logs.</dd>
<dt>Tests</dt><dd>Of the time, of F1 and of the questionnaires' totals only, each a paired t test, which agrees with the interval beside it;
Holm's correction over all of them. Everything else has intervals and no p value.</dd>
<dt>Reckoned otherwise</dt><dd>By ranks: the middle of all means of two people's log ratios, with the interval of Wilcoxon's signed ranks
(Hodges and Lehmann 1963), exact up to 25 people. Censored: what was cut short lies above what was seen (Tobin 1958), intervals by the
profile likelihood, as wide as Student's where nothing is censored. Mixed model: log seconds of each task by condition, sitting, practice and task;
people, and people's ratios, deviate normally; restricted maximum likelihood, degrees of freedom by Satterthwaite. Odd: more than 3.5
deviations from the median, by the median deviation (Iglewicz and Hoaglin 1993).</dd>
<dt>Effect size</dt><dd>Cohen's d of paired differences with Hedges' exact correction; its interval is from the noncentral t
distribution.</dd>
<dt>Order</dt><dd>A cross-over of two periods: second sitting beside first, sums of those who began with the one beside the others, by
Welch.</dd>
<dt>Practice</dt><dd>Log seconds over the log of the clip's number, by least squares for each person; the slope is the mean over
people.</dd>
<dt>Mistakes</dt><dd>Machines are compared as states and connections, known by their clips: names of stances and the order of work do not
matter. F1 is the harmonic mean of precision and recall of connections. A jump is beyond the 95 % level of the Johnson S<sub>B</sub>
distribution of the reference clips' own changes between frames (Yang et al., section 6), its blend taken off. In a machine drawn by hand,
kind and stance follow from the links; where links to or from rest were forgotten, only that is counted.</dd>
<dt>Prediction</dt><dd>The keystroke-level model (Card, Moran and Newell 1980): K 0.28 s, P 1.10 s, B 0.10 s, H 0.40 s, M 1.35 s,
where the study file (<code>operators</code>) says nothing else;
a drag is a pointing with a button pressed and released; a thought for every edit and every step back.</dd>
</dl>"""
