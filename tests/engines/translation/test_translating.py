"""What is translated says the same in every language, and the runtimes hold what is translated."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.translation.listing import LISTING, NATIVE, RUNTIMES, Translated
from metagraph.engines.translation.lowering import module_of
from metagraph.engines.translation.printing import TranslationError
from metagraph.engines.translation.source import Source, SubsetError
from metagraph.engines.translation.translating import printed, read, understood
from metagraph.graph.edits import set_settings
from metagraph.graph.model import LIMBS, MetaGraph, Project, Settings
from metagraph.playback import layer_planning, markov, phases, replan
from metagraph.playback.choice import key32
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import read_aloud, spelled
from metagraph.playback.life.mouth import accents_of, mouth_track
from metagraph.playback.mood import Mood, MoodFrom, Moods
from metagraph.playback.plan import LayerPlan, MetaAction, MetaRequest, Report
from metagraph.playback.vigour import vigour
from tests.engines.test_runtime_cpp import SELDOM
from tests.engines.translation import every_means

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
MEANS = [f.__name__ for f in every_means.MEANS]
SAID = [f() for f in every_means.MEANS]


EVERY = Translated("tests.engines.translation.every_means", "every_means")


@pytest.fixture(scope="module")
def sources() -> dict[Translated, Source]:
    """What is translated and the module of all means, read at once: to read takes most of the time."""
    return understood([*LISTING, EVERY], ROOT)


def test_the_runtimes_hold_what_is_translated_today(sources: dict[Translated, Source]) -> None:
    """Else: `.venv/bin/python -m metagraph.engines.translation`."""
    made = printed({one: module_of(sources[one]) for one in LISTING}, NATIVE)
    assert not [path for path, text in made.items() if (RUNTIMES / path).read_text(encoding="utf-8") != text]


@pytest.fixture(scope="module")
def means(sources: dict[Translated, Source]) -> dict[str, str]:
    """The module of all means, in each language."""
    wanted = ("MEANS",)
    one, source = EVERY, sources[EVERY]
    names = {n for d in source.tree.defs for n in [getattr(d, "name", "")] if n} | {"STEP", "WORDS"}
    source.only = tuple(names - set(wanted))
    return {Path(path).suffix: text for path, text in printed({one: module_of(source)}, {}).items()}


def test_javascript_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("needs Node")
    (tmp_path / "every_means.mjs").write_text(means[".js"].replace("basics.js", "basics.mjs"))
    shutil.copy(RUNTIMES / "javascript" / "basics.js", tmp_path / "basics.mjs")
    calls = ", ".join(f"m.{name}()" for name in MEANS)
    code = f"import * as m from './every_means.mjs'; for (const said of [{calls}]) console.log(said);"
    (tmp_path / "all.mjs").write_text(code)
    done = subprocess.run(["node", "all.mjs"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert _plain(done.stdout) == SAID, done.stderr


def test_csharp_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("mcs") is None or shutil.which("mono") is None:
        pytest.skip("needs Mono's compiler and runtime (mcs, mono)")
    (tmp_path / "EveryMeans.cs").write_text(means[".cs"])
    calls = "\n".join(f"System.Console.WriteLine(Metagraph.EveryMeansRules.{_pascal(n)}());" for n in MEANS)
    (tmp_path / "All.cs").write_text(f"static class All {{ static void Main() {{ {calls} }} }}")
    core = [RUNTIMES / "unity" / "Core" / name for name in ("Basics.cs", "Language.cs")]
    command = ["mcs", "-langversion:7.2", "-out:all.exe", "EveryMeans.cs", "All.cs", *map(str, core)]
    made = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert made.returncode == 0, made.stdout + made.stderr
    done = subprocess.run(["mono", "all.exe"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert _plain(done.stdout) == SAID, done.stderr


def test_cpp_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("needs g++")
    (tmp_path / "every_means.hpp").write_text(means[".hpp"])
    calls = "\n".join(f"    std::cout << metagraph::every_means::{name}() << std::endl;" for name in MEANS)
    assert _compiled(f'#include "every_means.hpp"\nint main() {{\n{calls}\n}}\n', tmp_path) == SAID


def test_in_cpp_models_write_and_plans_are_made_anew_as_in_python(tmp_path: Path) -> None:
    """The whole way through what is translated: draws, what a model writes, what replanning makes of it."""
    if shutil.which("g++") is None:
        pytest.skip("needs g++")
    seed, until, busy = 7, 120.0, 3.25
    metas, cursor = markov.write(markov.ARMS, seed, until)
    request = MetaRequest("wave", "arms", "gesture", 10.0, 8.0, priority=3)
    asked = [
        MetaAction(request, 10.0, 18.0),
        MetaAction(MetaRequest("nod", "arms", "fidget", 12.0), 12.0, 13.5),
    ]
    placed, reports = replan.replan([*metas, *asked], Settings(), busy)
    said = [f"{key32(seed, 'a', 'ü')} {len(metas)} {cursor.number} {cursor.state} {cursor.time:.9f}"]
    said += [f"{m.key} {m.request.kind} {m.request.limb or '-'} {m.start:.9f} {m.end:.9f}" for m in placed]
    said += [f"{r.request} {r.outcome} {r.message}" for r in reports]
    states = ", ".join(f'{{"{limb}", "{kind}"}}' for limb, kind in markov.ARMS.states)
    rows = ", ".join("{" + ", ".join(repr(p) for p in row) + "}" for row in markov.ARMS.matrix)
    code = f"""
#include "replan.hpp"
#include "markov.hpp"
using namespace metagraph;
int main() {{
    const List<std::tuple<std::string, std::string>> states{{{states}}};
    const List<List<double>> matrix{{{rows}}};
    const auto chain = lang::made<Markov>("arms", states, matrix, {markov.ARMS.gap!r});
    auto [metas, cursor] = markov::write(chain, {seed}, {until});
    std::cout << choice::key32({seed}, {{"a", "ü"}}) << " " << metas.size() << " " << cursor->number
              << " " << cursor->state << " " << lang::fixed(cursor->time, 9) << std::endl;
    const auto wave = lang::made<MetaRequest>(
        "wave", "arms", "gesture", 10.0, 8.0, std::nullopt, List<std::string>{{}}, std::nullopt,
        std::nullopt, 3);
    const auto nod = lang::made<MetaRequest>("nod", "arms", "fidget", 12.0);
    metas.push_back(lang::made<MetaAction>(wave, 10.0, 18.0));
    metas.push_back(lang::made<MetaAction>(nod, 12.0, 13.5));
    auto [placed, reports] = replan::replan(metas, lang::made<Settings>(), {busy!r});
    for (const auto& m : placed)
        std::cout << m->key() << " " << m->request->kind << " " << m->request->limb.value_or("-") << " "
                  << lang::fixed(m->start, 9) << " " << lang::fixed(m->end, 9) << std::endl;
    for (const auto& r : reports)
        std::cout << r->request << " " << r->outcome << " " << r->message << std::endl;
}}
"""
    assert _compiled(code, tmp_path) == said


MOODS = Moods(Mood(), (MoodFrom("sad", 600.0, -0.7, -0.4), MoodFrom("loud", 2400.0, 0.5, 0.9, 1.5)))


def test_in_cpp_a_layer_plays_what_it_plays_in_python(sample: Project, tmp_path: Path) -> None:
    """An hour of the sample's arms: what the model writes, with requests of every kind between, each action,
    rest and report.
    """
    if shutil.which("g++") is None:
        pytest.skip("needs g++")
    project = set_settings(sample, rest=0.2, memory=90.0)
    bare = {i: replace(x, contacts=()) for i, x in project.graphs["arms"].actions.items()}
    project = project.with_graph(replace(project.graphs["arms"], actions=bare))  # the table below has none
    graph, seed = project.graphs["arms"], 11
    kinds = {kind for _, kind in graph.index}
    plan, reports, every = LayerPlan("arms"), list[Report](), _requests(graph)
    for now, fresh, gone, end in (
        (0.0, every[:60], set[str](), 1800.0),
        (1500.0, every[60:], {"r2", "r50"}, 3600.0),
        (3550.0, [], set[str](), 3660.0),
    ):
        drafted = layer_planning.draft(
            project, graph, markov.ARMS, kinds, plan, reports, seed, now, fresh, gone, end, None, MOODS
        )
        plan = drafted.performed(drafted.placed, end)
        reports = drafted.reports
    said = [
        f"{c.action.id} {c.stance} {c.then} {c.meta} "
        + " ".join(f"{x:.9f}" for x in (c.start, c.end, c.entry, c.blend_in, c.hold, c.extent, c.tempo))
        for c in plan.cues
    ]
    said += [f"{r.stance} {r.action.id} {r.start:.9f} {r.fade_start:.9f} {r.fade:.9f}" for r in plan.rests]
    said += [f"{r.request} {r.outcome} {r.message}" for r in reports]
    outcomes = {r.outcome for r in reports}
    assert len(plan.cues) > 800 and len(outcomes) >= 8, outcomes
    code = f"""
#include <cmath>
#include <sstream>
#include "layer_planning.hpp"
using namespace metagraph;
using lang::made;
{_graph_in_cpp(project, graph)}
int main() {{
    const auto project = made<Project>(settings(), phases_of(), vigours());
    const auto graph = made<MetaGraph>("arms", stances(), actions(), {_text(graph.start or "")});
    const Set<std::string> kinds{{{", ".join(map(_text, sorted(kinds)))}}};
    auto plan = made<LayerPlan>("arms");
    List<Ref<Report>> reports;
    const auto every = requests();
    const auto extend = [&](double now, int first, int last, Set<std::string> gone, double end) {{
        const auto drafted = layer_planning::draft(
            project, graph, chain(), kinds, plan, reports, {seed}, now, lang::part(every, first, last), gone,
            end, std::nullopt, made<Moods>(made<Mood>(), List<Ref<MoodFrom>>{{
                made<MoodFrom>("sad", 600.0, -0.7, -0.4), made<MoodFrom>("loud", 2400.0, 0.5, 0.9, 1.5)}}));
        plan = drafted->performed(drafted->placed, end);
        reports = drafted->reports;
    }};
    extend(0.0, 0, 60, {{}}, 1800.0);
    extend(1500.0, 60, 120, {{"r2", "r50"}}, 3600.0);
    extend(3550.0, 0, 0, {{}}, 3660.0);
    for (const auto& c : plan->cues) {{
        std::cout << c->action->id << " " << c->stance << " " << c->then << " " << c->meta;
        for (double x : {{c->start, c->end, c->entry, c->blend_in, c->hold, c->extent, c->tempo}})
            std::cout << " " << lang::fixed(x, 9);
        std::cout << "\\n";
    }}
    for (const auto& r : plan->rests)
        std::cout << r->stance << " " << r->action->id << " " << lang::fixed(r->start, 9) << " "
                  << lang::fixed(r->fade_start, 9) << " " << lang::fixed(r->fade, 9) << "\\n";
    for (const auto& r : reports)
        std::cout << r->request << " " << r->outcome << " " << r->message << "\\n";
}}
"""
    assert _compiled(code, tmp_path) == said


def _requests(graph: MetaGraph) -> list[MetaRequest]:
    """Requests of every kind, some of which cannot be met."""
    stances, actions = list(graph.stances), list(graph.actions.values())
    gestures = [a for a in actions if a.kind == "gesture"]
    out = []
    for n in range(60):
        at, limb = 20.0 + 55.0 * n, LIMBS[n % 3]
        more: dict[str, Any] = [
            {"kind": "gesture", "limb": limb},
            {"kind": "gesture", "tags": ("positive",), "hold": 2.0, "stroke": at + 1.7},
            {"kind": "transition", "stance": stances[n % len(stances)]},
            {"kind": "gesture", "action": gestures[n % len(gestures)].id, "prepare": False},
            {"kind": "fidget", "duration": 0.4, "tags": ("nowhere",)},
            {"kind": "gesture", "action": "none"},
            {"kind": "gesture", "priority": 5, "among": (gestures[0].id, gestures[3].id)},
            {"kind": "transition", "stance": "none"},
        ][n % 8]
        out.append(MetaRequest(f"r{n}", "arms", start=at, **more))
        if n % 3 == 0:  # on time or not at all, with a stroke that may be shared
            out.append(
                MetaRequest(f"q{n}", "arms", "gesture", at + 2.0, stroke=at + 3.0 + 0.02 * n, late=n / 60)
            )
        else:
            out.append(MetaRequest(f"q{n}", "arms", "gesture", at + 0.4, 0.3, priority=n % 4))
    return out


def _text(value: str | None) -> str:
    return "std::nullopt" if value is None else json.dumps(value, ensure_ascii=False)


def _word(value: str | None) -> str:
    return "nullptr" if value is None else json.dumps(value, ensure_ascii=False)


def _or_nan(value: float | None) -> str:
    return "NAN" if value is None else repr(value)


# What has tables of plain words and numbers is compiled in a third of the time.
MAKERS = """
using Word = const char*;
static std::optional<std::string> text(Word x) { return x ? std::optional<std::string>(x) : std::nullopt; }
static std::optional<double> number(double x) { return x == x ? std::optional<double>(x) : std::nullopt; }
static List<std::string> split(Word x) {
    std::istringstream in(x);
    List<std::string> out;
    for (std::string word; std::getline(in, word);) out.push_back(word);
    return out;
}
static Ref<Action> action(
    Word id, Word clip, Word kind, Word layer, Word stance, Word name, Word end_stance, Word limb,
    Word joints, Word tags, double start, double end, double blend_in, double blend_out, double leave,
    double likelihood, double cooldown, double spacing
) {
    const auto timing = made<Timing>(start, number(end), blend_in, blend_out, false, number(leave));
    const auto apart = spacing == spacing ? std::optional<int>(static_cast<int>(spacing)) : std::nullopt;
    return made<Action>(
        id, clip, kind, layer, stance, name, text(end_stance), timing, limb, split(joints), split(tags),
        likelihood, cooldown, apart);
}
static Ref<MetaRequest> request(
    Word id, Word layer, Word kind, Word action, Word limb, Word stance, Word tags, Word among,
    double start, double duration, double stroke, double hold, double late, int priority, bool resume,
    bool prepare
) {
    return made<MetaRequest>(
        id, layer, kind, start, number(duration), text(action), split(tags), text(limb), text(stance),
        priority, resume, number(stroke), number(hold), prepare, split(among), number(late));
}
"""


def _graph_in_cpp(project: Project, graph: MetaGraph) -> str:
    """What a layer is made of, as functions that give it."""
    actions, phases_, vigours = [], [], []
    for a in graph.actions.values():
        t = a.timing
        words = [a.id, a.clip, a.kind, a.layer, a.stance, a.name, a.end_stance, a.limb]
        numbers = [
            t.start,
            t.end,
            t.blend_in,
            t.blend_out,
            t.earliest_exit,
            a.likelihood,
            a.cooldown,
            a.spacing,
        ]
        lists = ["\n".join(each) for each in (a.joints, a.tags)]
        given = ", ".join([*map(_word, [*words, *lists]), *map(_or_nan, numbers)])
        actions.append(f"out.push_back(action({given}));")
        found = phases.phases(project, a)
        own = ", ".join(
            map(repr, (found.start, found.ready, found.stroke, found.stroke_end, found.relax, found.end))
        )
        phases_.append(f"out[{_text(a.id)}] = made<Phases>({own});")
        vigours.append(f"out[{_text(a.id)}] = {vigour(project, a)!r};")
    stances = ", ".join(
        f"made<Stance>({_text(s.id)}, {_text(s.layer)}, {_text(s.name)})" for s in graph.stances.values()
    )
    asked = []
    for r in _requests(graph):
        words = [r.id, r.layer, r.kind, r.action, r.limb, r.stance]
        lists = ["\n".join(each) for each in (r.tags, r.among)]
        numbers = [r.start, r.duration, r.stroke, r.hold, r.late]
        flags = [str(r.priority), str(r.resume).lower(), str(r.prepare).lower()]
        given = ", ".join([*map(_word, [*words, *lists]), *map(_or_nan, numbers), *flags])
        asked.append(f"out.push_back(request({given}));")
    s = project.settings
    twice = str(s.never_twice).lower()
    settings = f"{s.alpha!r}, {s.seed}, {twice}, {s.shortest!r}, {s.wait!r}, {s.memory!r}, {s.rest!r}"
    states = ", ".join(f'{{"{limb}", "{kind}"}}' for limb, kind in markov.ARMS.states)
    rows = ", ".join("{" + ", ".join(repr(p) for p in row) + "}" for row in markov.ARMS.matrix)
    return "\n".join(
        (
            MAKERS,
            f"Ref<Settings> settings() {{ return made<Settings>({settings}); }}",
            f"List<Ref<Stance>> stances() {{ return {{{stances}}}; }}",
            "List<Ref<Action>> actions() { List<Ref<Action>> out;", *actions, "return out; }",
            "Map<std::string, Ref<Phases>> phases_of() { Map<std::string, Ref<Phases>> out;",
            *phases_, "return out; }",
            "Map<std::string, double> vigours() { Map<std::string, double> out;", *vigours, "return out; }",
            "List<Ref<MetaRequest>> requests() { List<Ref<MetaRequest>> out;", *asked, "return out; }",
            "Ref<Markov> chain() {",
            f"return made<Markov>(\"arms\", List<std::tuple<std::string, std::string>>{{{states}}},",
            f"List<List<double>>{{{rows}}}, {markov.ARMS.gap!r}); }}",
        )
    )  # fmt: skip


TEXTS = (
    "Hello there, how are you?", "Thought - tion sch.", "Größe über Straße!", "Ποιος είσαι; Ξέρω.",
    "Хорошо, ещё щука", "日本語が好き", "한국어 말",
    "naïve e\u0301te\u0301", "x2 30 (ok)", "  \u3000blank\u00a0 ",
    "\U0001f642 fun", "…", "Հայերեն",
)  # fmt: skip


def test_in_cpp_letters_become_the_mouth_shapes_they_become_in_python(tmp_path: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("needs g++")
    said = []
    for text in TEXTS:
        read = spelled(ALPHABET, text, 2.0)
        rows = mouth_track(read.pieces, 2.0)
        said.append(
            " ".join(["pieces", *(f"{p.viseme} {p.start:.6f} {p.strength:.6f}" for p in read.pieces)])
        )
        said.append(f"{sum(sum(row[10:]) for row in rows):.6f} {read_aloud(ALPHABET, text):.6f}")
        accents = accents_of(read.peaks, read.strengths)
        said.append(" ".join(["accents", *(f"{x:.6f}" for x in accents)]))
    texts = ", ".join(json.dumps(t, ensure_ascii=False) for t in TEXTS)
    code = f"""
#include "graphemes.hpp"
using namespace metagraph;
int main() {{
    const auto alphabet = lang::made<Alphabet>();
    const auto told = [](double x) {{ return " " + lang::fixed(x, 6); }};
    for (const std::string text : {{{texts}}}) {{
        const auto read = graphemes::spelled(alphabet, text, 2.0);
        std::cout << "pieces";
        for (const auto& p : read->pieces)
            std::cout << " " << p->viseme << told(p->start) << told(p->strength);
        double open = 0;
        for (const auto& row : mouth::mouth_track(read->pieces, 2.0))
            for (int n = 10; n < 15; n++) open += row[n];
        std::cout << std::endl << lang::fixed(open, 6) << told(graphemes::read_aloud(alphabet, text));
        std::cout << std::endl << "accents";
        for (const double at : mouth::accents_of(read->peaks, read->strengths)) std::cout << told(at);
        std::cout << std::endl;
    }}
}}
"""
    assert _compiled(code, tmp_path) == said


def _compiled(code: str, folder: Path) -> list[str]:
    """Return what a program says, compiled without a warning."""
    (folder / "all.cpp").write_text("#include <iostream>\n" + code)
    places = ["-I", str(folder), "-I", str(RUNTIMES / "cpp")]
    command = ["g++", *SELDOM, "-std=c++17", "-Wall", "-Wextra", "-Werror", *places, "-o", "all", "all.cpp"]
    made = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert made.returncode == 0, made.stderr[:3000]
    done = subprocess.run(["./all"], cwd=folder, capture_output=True, text=True, timeout=60)
    return [line for line in done.stdout.splitlines() if line.strip()]


def test_gdscript_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    engine = shutil.which("godot3-server") or shutil.which("godot3")
    if engine is None:
        pytest.skip("needs Godot 3")
    (tmp_path / "every_means.gd").write_text(means[".gd"])
    shutil.copy(RUNTIMES / "godot" / "addons" / "metagraph" / "core" / "util.gd", tmp_path)
    (tmp_path / "project.godot").write_text("config_version=4\n")
    calls = "\n".join(f"\tprint(Means.{name}())" for name in MEANS)
    script = (
        f'extends SceneTree\nconst Means = preload("every_means.gd")\n\n\nfunc _init():\n{calls}\n\tquit()\n'
    )
    (tmp_path / "all.gd").write_text(script)
    command = [engine, "--no-window", "-s", "all.gd"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    said = [line for line in _plain(done.stdout) if not line.startswith("Godot Engine")]
    assert said == SAID, done.stdout + done.stderr


def _plain(out: str) -> list[str]:
    """Return lines, truth values written as Python writes them."""
    words = {"true": "True", "false": "False"}
    return [
        re.sub(r"\b(true|false)\b", lambda m: words[m.group()], line)
        for line in out.splitlines()
        if line.strip()
    ]


def _pascal(name: str) -> str:
    return name.title().replace("_", "")


REFUSED = {
    "def f() -> list[int]:\n    yield 1": "yields",
    "def f(x):\n    return x": "no types",
    "def f(**x: int) -> int:\n    return 1": "** arguments",
    "def f(x: int | str) -> int:\n    return 1": "of several types",
    "def f(x: str | None) -> int:\n    return 1 if x else 2": "whether a optional is true",
    "def f(x: list[int]) -> list[int]:\n    return x[::2]": "a slice with a step",
    "def f(x: list[int]) -> int:\n    with open('a') as g:\n        return len(x)": "WithStmt",
    "def f(x: dict[str, int]) -> dict[str, int]:\n    return {**x}": "** in a map",
    "def f(x: float) -> str:\n    return f'{x}'": "a float in a text",
    "def f(x: float) -> str:\n    return f'{x:.9f}'": "a way to write a number",
    "def f(x: float) -> float:\n    return x % 2.0": "% of numbers with fractions",
    "def f(x: dict[str, float]) -> None:\n    x['a'] *= 2.0": "a change of a map's entry in place",
    "def f(x: list[int]) -> int:\n    return max(x, key=lambda n: n)": "max",
    "def f() -> int:\n    a = b = 1\n    return a + b": "two targets",
    "def f(x: str) -> str:\n    return x.upper()": "'.upper()' of a str",
    "def f(x: str) -> list[str]:\n    return x.split(',')": "'.split()' at something else than blanks",
    "def f(x: str) -> str:\n    return x.strip('.')": "'.strip()' at something else than blanks",
    "class A:\n    @staticmethod\n    def s() -> int:\n        return 1": "decorator",
}


def test_what_is_outside_the_subset_is_refused_with_its_place_and_a_remedy(tmp_path: Path) -> None:
    modules = {f"m{n}": code for n, code in enumerate(REFUSED)}
    for name, code in modules.items():
        (tmp_path / f"{name}.py").write_text(code + "\n")
    quiet = {n for n, code in modules.items() if "def f(x):" in code or "f() -> list[int]" in code}
    found = {}
    for name in modules:
        one = Translated(name, name)
        if name in quiet:
            (tmp_path / f"{name}.py").write_text("# mypy: ignore-errors\n" + modules[name] + "\n")
    sources = understood([Translated(n, n) for n in modules], tmp_path)
    for one, source in sources.items():
        with pytest.raises(SubsetError) as told:
            module_of(source)
        found[one.module] = str(told.value)
    for (name, code), words in zip(modules.items(), REFUSED.values(), strict=True):
        assert words in found[name], (code, found[name])
        assert f"{name}.py, line " in found[name] and "; " in found[name]


def test_what_no_language_knows_is_told(tmp_path: Path) -> None:
    (tmp_path / "far.py").write_text("import os\n\n\ndef f() -> str:\n    return os.getcwd()\n")
    (tmp_path / "same.py").write_text("def f(a: list[int], b: list[int]) -> bool:\n    return a == b\n")
    (tmp_path / "own.py").write_text(
        "from dataclasses import dataclass\n\n\n@dataclass\nclass A:\n    x: int\n\n"
        "    def m(self) -> int:\n        return f(self.x)\n\n\ndef f(x: int) -> int:\n    return x\n"
    )
    wrong = {
        "far": "'os' is used, which is not translated",
        "own": "a method calls 'f' of its own module",
        "same": "whether two lists are equal",
    }
    for one, module in read([Translated(name, name) for name in wrong], tmp_path).items():
        with pytest.raises(TranslationError, match=wrong[one.module]):
            printed({one: module}, {})


def test_what_mypy_finds_wrong_is_told(tmp_path: Path) -> None:
    (tmp_path / "wrong.py").write_text("def f() -> int:\n    return 'x'\n")
    with pytest.raises(SubsetError, match=r"wrong.py:2: error"):
        read([Translated("wrong", "wrong")], tmp_path)
