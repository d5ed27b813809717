"""Programs in C++ that play what is translated as Python plays it: one for each test of such a kind."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from metagraph.graph.edits import set_settings
from metagraph.graph.model import LIMBS, Markov, MetaGraph, Project
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planning import markov
from metagraph.playback.planning.mood import Mood, MoodFrom, Moods
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.planning.vigour import measure_vigour
from metagraph.playback.timing import phases

SEED, UNTIL, BUSY = 7, 120.0, 3.25  # of what a model writes
LAYER_SEED = 11
MOODS = Moods(Mood(), (MoodFrom("sad", 600.0, -0.7, -0.4), MoodFrom("loud", 2400.0, 0.5, 0.9, 1.5)))
TEXTS = (
    "Hello there, how are you?", "Thought - tion sch.", "Größe über Straße!", "Ποιος είσαι; Ξέρω.",
    "Хорошо, ещё щука", "日本語が好き", "한국어 말",
    "naïve e\u0301te\u0301", "x2 30 (ok)", "  \u3000blank\u00a0 ",
    "\U0001f642 fun", "…", "Հայերեն",
)  # fmt: skip


def programs(sample: Project) -> dict[str, str]:
    """Return the programs by name."""
    return {"letters": letters(), "replanned": replanned(), "layer": layer(layered(sample))}


def letters() -> str:
    """What letters become: pieces, how far the mouth is open, and accents."""
    texts = ", ".join(json.dumps(t, ensure_ascii=False) for t in TEXTS)
    return f"""
#include "graphemes.hpp"
using namespace metagraph;
int main(int, char**) {{
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
    return 0;
}}
"""


def replanned() -> str:
    """What a model writes, and what replanning makes of it."""
    states = ", ".join(f'{{"{limb}", "{kind}"}}' for limb, kind in markov.ARMS.states)
    rows = ", ".join("{" + ", ".join(repr(p) for p in row) + "}" for row in markov.ARMS.matrix)
    return f"""
#include "replan.hpp"
#include "markov.hpp"
using namespace metagraph;
int main(int, char**) {{
    const List<std::tuple<std::string, std::string>> states{{{states}}};
    const List<List<double>> matrix{{{rows}}};
    const auto chain = lang::made<Markov>("arms", states, matrix, {markov.ARMS.gap!r});
    auto [metas, cursor] = markov::write(chain, {SEED}, {UNTIL});
    std::cout << choice::key32({SEED}, {{"a", "ü"}}) << " " << metas.size() << " " << cursor->number
              << " " << cursor->state << " " << lang::fixed(cursor->time, 9) << std::endl;
    const auto wave = lang::made<MetaRequest>(
        "wave", "arms", "gesture", 10.0, 8.0, std::nullopt, List<std::string>{{}}, std::nullopt,
        std::nullopt, 3);
    const auto nod = lang::made<MetaRequest>("nod", "arms", "fidget", 12.0);
    metas.push_back(lang::made<MetaAction>(wave, 10.0, 18.0));
    metas.push_back(lang::made<MetaAction>(nod, 12.0, 13.5));
    auto [placed, reports] = replan::replan(metas, lang::made<Settings>(), {BUSY!r});
    for (const auto& m : placed)
        std::cout << m->key() << " " << m->request->kind << " " << m->request->limb.value_or("-") << " "
                  << lang::fixed(m->start, 9) << " " << lang::fixed(m->end, 9) << std::endl;
    for (const auto& r : reports)
        std::cout << r->request << " " << r->outcome << " " << r->message << std::endl;
    return 0;
}}
"""


def layered(sample: Project) -> Project:
    """Return the sample project as a layer of it is played in C++: its actions have no contacts."""
    project = set_settings(sample, rest=0.2, memory=90.0, variety=0.4)
    bare = {i: replace(x, contacts=()) for i, x in project.graphs["arms"].actions.items()}
    return project.with_graph(replace(project.graphs["arms"], actions=bare))  # the table below has none


def kinds_of(graph: MetaGraph) -> set[str]:
    return {kind for _, kind in graph.index}


def layer(project: Project) -> str:
    """What an hour of a project's arms holds."""
    graph = project.graphs["arms"]
    return f"""
#include "layer_planning.hpp"
using namespace metagraph;
using lang::made;
{_graph_in_cpp(project, graph)}
int main(int, char**) {{
    const auto project = made<Project>(settings(), phases_of(), vigours());
    const auto graph = made<MetaGraph>("arms", stances(), actions(), {_text(graph.start or "")});
    const Set<std::string> kinds{{{", ".join(map(_text, sorted(kinds_of(graph))))}}};
    auto plan = made<LayerPlan>("arms");
    List<Ref<Report>> reports;
    const auto every = requests();
    const auto extend = [&](double now, int first, int last, Set<std::string> gone, double end) {{
        const auto drafted = layer_planning::draft(
            project, graph, chain(), kinds, plan, reports, {LAYER_SEED}, now,
            lang::part(every, first, last), gone, gone, end, std::nullopt,
            made<Moods>(made<Mood>(), List<Ref<MoodFrom>>{{made<MoodFrom>("sad", 600.0, -0.7, -0.4),
                made<MoodFrom>("loud", 2400.0, 0.5, 0.9, 1.5)}}),
            made<Track>());
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
    return 0;
}}
"""


def requests(graph: MetaGraph) -> list[MetaRequest]:
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
    double likelihood, double cooldown, double spacing, double prominence
) {
    const auto timing = made<Timing>(start, number(end), blend_in, blend_out, false, number(leave));
    const auto apart = spacing == spacing ? std::optional<int>(static_cast<int>(spacing)) : std::nullopt;
    return made<Action>(
        id, clip, kind, layer, stance, name, text(end_stance), timing, limb, split(joints), split(tags),
        likelihood, cooldown, apart, List<Ref<ContactSpan>>(),
        List<std::tuple<std::string, double>>(), "", "", prominence);
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
            measure_prominence(project, a),
        ]
        lists = ["\n".join(each) for each in (a.joints, a.tags)]
        given = ", ".join([*map(_word, [*words, *lists]), *map(_or_nan, numbers)])
        actions.append(f"out.push_back(action({given}));")
        found = phases.find_phases(project, a)
        own = ", ".join(
            map(repr, (found.start, found.ready, found.stroke, found.stroke_end, found.relax, found.end))
        )
        phases_.append(f"out[{_text(a.id)}] = made<Phases>({own});")
        vigours.append(f"out[{_text(a.id)}] = {measure_vigour(project, a)!r};")
    stances = ", ".join(
        f"made<Stance>({_text(s.id)}, {_text(s.layer)}, {_text(s.name)})" for s in graph.stances.values()
    )
    asked = []
    for r in requests(graph):
        words = [r.id, r.layer, r.kind, r.action, r.limb, r.stance]
        lists = ["\n".join(each) for each in (r.tags, r.among)]
        numbers = [r.start, r.duration, r.stroke, r.hold, r.late]
        flags = [str(r.priority), str(r.resume).lower(), str(r.prepare).lower()]
        given = ", ".join([*map(_word, [*words, *lists]), *map(_or_nan, numbers), *flags])
        asked.append(f"out.push_back(request({given}));")
    s = project.settings
    twice = str(s.never_twice).lower()
    settings = f"{s.alpha!r}, {s.seed}, {twice}, {s.shortest!r}, {s.wait!r}, {s.memory!r}, {s.rest!r}"
    settings += f", {s.lookahead!r}, {s.variety!r}"
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
            f"List<List<double>>{{{rows}}}, {_rest_of_chain(markov.ARMS)}); }}",
        )
    )  # fmt: skip


def _rest_of_chain(chain: Markov) -> str:
    """Return what a model has besides states and their probabilities, as arguments."""
    pairs = ", ".join(f"{{{a!r}, {b!r}}}" for a, b in chain.lengths)
    modes = ", ".join("{" + ", ".join(map(repr, row)) + "}" for row in chain.modes)
    return (
        f"{chain.gap!r}, {chain.positive!r}, {chain.negative!r}, "
        f"List<std::string>{{{', '.join(map(_text, chain.tags))}}}, "
        f"List<std::tuple<double, double>>{{{pairs}}}, List<List<double>>{{{modes}}}"
    )
