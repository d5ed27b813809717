"""What a listener takes up is the same in Python, JavaScript and C++, which are translated as C# and GDScript
are.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from metagraph.engines.translation.listing import RUNTIMES
from metagraph.playback.life.sympathy import Laugh, laughs_along, moods_taken_up
from metagraph.playback.planning.mood import Mood, MoodFrom, Moods

SPANS = [
    (3.0, 0.79, 0.11, 9.5),
    (12.0, -0.13, 0.79, 20.0),
    (20.2, -0.71, -0.37, 20.4),
    (30.0, 0.53, 0.6, 50.0),
]
LAUGHS = [(2.0 * n, 2.0 * n + 0.5 + 0.1 * n) for n in range(20)]
SEED, END = 7, 60.0


def said() -> list[str]:
    own = Moods(Mood(-0.2, 0.1, 1.0), [MoodFrom("own", 15.0, 0.4, 0.0, None, 18.0)])
    other = Moods(Mood(), [MoodFrom("o", a, v, r, None, b) for a, v, r, b in SPANS])
    found = moods_taken_up(own, other, END, 0.35, SEED, "side 1")
    found += laughs_along(own, [Laugh(a, b) for a, b in LAUGHS], 0.6, SEED, "side 1")
    return [f"{m.id} {m.start:.9f} {m.valence:.9f} {m.arousal:.9f} {m.end:.9f}" for m in found]


def test_python_takes_up_some() -> None:
    assert 10 < len(said()) < 25


def test_javascript_takes_up_the_same(tmp_path: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("needs Node")
    folder = (RUNTIMES / "javascript").as_uri()
    (tmp_path / "run.mjs").write_text(
        f"""
import {{ Laugh, laughsAlong, moodsTakenUp }} from "{folder}/sympathy.js";
import {{ Mood, MoodFrom, Moods }} from "{folder}/mood.js";
const own = new Moods(new Mood(-0.2, 0.1, 1), [new MoodFrom("own", 15, 0.4, 0, null, 18)]);
const spans = {[list(s) for s in SPANS]}, laughs = {[list(x) for x in LAUGHS]};
const other = new Moods(new Mood(), spans.map(([a, v, r, b]) => new MoodFrom("o", a, v, r, null, b)));
const found = moodsTakenUp(own, other, {END}, 0.35, {SEED}, "side 1");
found.push(...laughsAlong(own, laughs.map(([a, b]) => new Laugh(a, b)), 0.6, {SEED}, "side 1"));
for (const m of found) console.log(m.id, ...[m.start, m.valence, m.arousal, m.end].map((x) => x.toFixed(9)));
"""
    )
    done = subprocess.run(
        ["node", str(tmp_path / "run.mjs")], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.splitlines() == said()


@pytest.mark.nightly
def test_cpp_takes_up_the_same(tmp_path: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("needs g++")
    spans = ", ".join(
        f'lang::made<MoodFrom>("o", {a!r}, {v!r}, {r!r}, std::nullopt, {b!r})' for a, v, r, b in SPANS
    )
    laughs = ", ".join(f"lang::made<Laugh>({a!r}, {b!r})" for a, b in LAUGHS)
    (tmp_path / "run.cpp").write_text(
        f"""
#include <iostream>
#include "sympathy.hpp"
using namespace metagraph;
int main() {{
    const auto own = lang::made<Moods>(lang::made<Mood>(-0.2, 0.1, 1.0),
        List<Ref<MoodFrom>>{{lang::made<MoodFrom>("own", 15.0, 0.4, 0.0, std::nullopt, 18.0)}});
    const auto other = lang::made<Moods>(lang::made<Mood>(), List<Ref<MoodFrom>>{{{spans}}});
    auto found = sympathy::moods_taken_up(own, other, {END}, 0.35, {SEED}, "side 1");
    for (const auto& m : sympathy::laughs_along(own, List<Ref<Laugh>>{{{laughs}}}, 0.6, {SEED}, "side 1"))
        found.push_back(m);
    for (const auto& m : found)
        std::cout << m->id << " " << lang::fixed(m->start, 9) << " " << lang::fixed(*m->valence, 9) << " "
                  << lang::fixed(*m->arousal, 9) << " " << lang::fixed(m->end, 9) << std::endl;
}}
"""
    )
    program = tmp_path / "run"
    subprocess.run(
        ["g++", "-std=c++17", "-O0", f"-I{RUNTIMES / 'cpp'}", "-o", str(program), str(tmp_path / "run.cpp")],
        check=True,
        timeout=300,
    )
    done = subprocess.run([str(program)], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.splitlines() == said()
