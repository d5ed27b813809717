"""The conversation paper's user study, recomputed from its counts."""

from __future__ import annotations

from metagraph.research.exhibits import drawings
from metagraph.research.exhibits.exhibit import ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import ExhibitMaterial
from metagraph.research.exhibits.preferences import list_preferences


def exhibit_ratings(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 6: what people preferred, by the published test and by an exact one."""
    rows, bars = [], []
    found = list_preferences()
    for r in found:
        g = r.rating
        rows.append(
            (
                f"{g.first} over {g.second}",
                f"{g.chosen} of {g.answers} ({r.share:.1%})",
                f"{r.low:.0%} to {r.high:.0%}",
                f"{g.chi:g}, p = {g.p:.4g}",
                f"{r.chi:.4f}, p = {r.p:.4g}",
                f"{r.exact:.3g}",
                f"{r.corrected:.3g}",
                ("significant" if g.starred else "not significant")
                + (": holds" if r.holds else ": DOES NOT HOLD"),
            )
        )
        bars.append((f"over {g.second}", [("paper", r.share, r.low, r.high)]))
    wrong = [r for r in found if not r.holds]
    says = (
        "The published chi-square values come out to the last printed digit, but only by holding each "
        "share against its own complement as two independent samples of n answers each (R's prop.test of c "
        "and n - c in n and n). There was one sample of n answers: every answer is counted twice, and "
        "chi-square is about twice too large.",
        "The exact binomial test against a half: "
        + "; ".join(f"{r.rating.first} over {r.rating.second} p = {r.exact:.3g}" for r in found)
        + f". '{wrong[0].rating.second}', which the paper calls significant (p = {wrong[0].rating.p:g}), is "
        "not; 'no constraints' still is, by itself.",
        f"Of four tests the least p of an ablation is {found[3].exact:.3f}, by Holm "
        f"{found[3].corrected:.3f}: taken together only captured motion is surely told apart. And 40 people "
        "gave 20 answers each on 20 segments, so answers are not independent; the counts of each person "
        "were not published.",
        "The introduction says that 30 % preferred synthesized motion, section 8 says 31 %: 64 of 206 are "
        "31.1 %.",
    )
    head = ("", "preferred", "95 %", "printed", "recomputed", "exact p", "by Holm", "the paper's word")
    drawn = drawings.draw_paired_bars(
        bars, (("paper", "share that preferred the first"),), "share", "Preferences", 1.0, 0.5
    )
    return MadeExhibit(
        "counts of figure 6 and section 8.2",
        says,
        (
            ExhibitTable("Four comparisons", head, tuple(rows)),
            ExhibitDrawing("The dashed line is no preference", drawn),
        ),
        {r.rating.second: {"chi": r.chi, "p": r.p, "exact": r.exact, "holm": r.corrected} for r in found},
    )
