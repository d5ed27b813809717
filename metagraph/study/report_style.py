"""How a report looks, and what it says of its methods."""

from __future__ import annotations

STYLE = """
:root { color-scheme: dark light; --ground: #17181b; --card: #25282d; --line: #34383f; --text: #dfe3e8; --dim: #9aa1ab; --warn: #e8c24a;
  --meta: #3fb8a6; --manual: #f0a63c; --s0: #5aa3f0; --s1: #a98bf0; --s2: #3fb8a6; --s3: #e57373; --s4: #8a929c; --inside: #101114; }
@media (prefers-color-scheme: light) {
  :root { --ground: #f6f7f8; --card: #fff; --line: #d5d9de; --text: #1d2126; --dim: #59616b; --warn: #7d5b00;
    --meta: #127065; --manual: #a35c00; --s0: #1a63b8; --s1: #6a45c4; --s2: #127065; --s3: #b3372f; --s4: #626a74; --inside: #fff; }
}
@media print {
  :root { color-scheme: light; --ground: #fff; --card: #fff; --line: #ccc; --text: #000; --dim: #444; --warn: #5c4300;
    --meta: #127065; --manual: #a35c00; --s0: #1a63b8; --s1: #6a45c4; --s2: #127065; --s3: #b3372f; --s4: #626a74; --inside: #fff; }
  body { max-width: none; padding: 0; font-size: 11px; } h2 { break-after: avoid; } figure, table, .card { break-inside: avoid; }
  svg, rect, circle { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
body { margin: 0 auto; max-width: 900px; padding: 28px 24px 60px; background: var(--ground); color: var(--text);
  font: 14px/1.5 system-ui, sans-serif; }
h1 { font-size: 24px; margin: 0 0 14px; } h2 { font-size: 18px; margin: 40px 0 8px; } h3 { font-size: 15px; margin: 24px 0 6px; }
p { margin: 8px 0; } ul { margin: 8px 0; padding-left: 20px; } .dim, figcaption { color: var(--dim); } .warn { color: var(--warn); }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 10px 18px; margin: 12px 0; }
.big { font-size: 19px; line-height: 1.4; }
figure { margin: 16px 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 14px 14px 10px; }
figcaption { font-size: 13px; margin-top: 6px; text-align: center; }
svg { display: block; width: 100%; max-width: 680px; height: auto; margin: 0 auto; font: 12px system-ui, sans-serif; }
table { border-collapse: collapse; font-size: 13px; width: 100%; margin: 12px 0; font-variant-numeric: tabular-nums; }
th { text-align: left; color: var(--dim); font-weight: 500; }
th, td { padding: 5px 10px 5px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td .dim { white-space: nowrap; } td:first-child { min-width: 190px; } td:last-child { white-space: nowrap; }
dt { font-weight: 600; margin-top: 8px; } dd { margin: 0 0 4px; color: var(--dim); }
text { fill: var(--text); } text.dim { fill: var(--dim); } text.inside { fill: var(--inside); font-weight: 600; }
line.grid { stroke: var(--line); } line.one { stroke: var(--dim); stroke-dasharray: 4 3; }
.person line { stroke: var(--dim); stroke-opacity: .55; } .person circle { fill: var(--dim); }
.person:hover line { stroke: var(--text); stroke-width: 2.5; stroke-opacity: 1; }
.meta line { stroke: var(--meta); } .meta circle { fill: var(--meta); } text.meta { fill: var(--meta); font-weight: 600; }
.manual line { stroke: var(--manual); } .manual circle { fill: var(--manual); } text.manual { fill: var(--manual); font-weight: 600; }
.wide { stroke-width: 2.5; }
.s0 { fill: var(--s0); } .s1 { fill: var(--s1); } .s2 { fill: var(--s2); } .s3 { fill: var(--s3); } .s4 { fill: var(--s4); }
"""

METHODS = """<dl>
<dt>Times</dt><dd>Active seconds of a task, without pauses and without gaps of more than a minute. Each person counts once, by the
geometric mean over the tasks done in both conditions. Means are geometric, their intervals those of Student's t on logs (95 %).</dd>
<dt>Ratio</dt><dd>The geometric mean of each person's ratio, with the t interval of the logs' differences; paired t test on logs,
two-sided. Where nobody did both, Welch's test on logs.</dd>
<dt>Ranks</dt><dd>Wilcoxon's signed-rank test, ties sharing their ranks and zeros by Pratt; every outcome is counted up to 25 pairs,
beyond by the normal distribution with a correction for continuity. Rank biserial: the share of ranks for, less that against.</dd>
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
<dt>Several tests</dt><dd>Holm's correction, over the tasks, and over time, F1 and the ratings.</dd>
</dl>"""
