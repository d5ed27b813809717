"""The program that tests of C++ run: one for all, since to compile takes longer than to run. Its first word
says which of its parts runs.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from metagraph.engines.targets.runtimes import copy_runtime
from metagraph.graph.model import Project
from tests.engines.mutants import broken

ROOT = Path(__file__).resolve().parents[2]
RUNTIMES = ROOT / "metagraph" / "engines" / "runtimes"
RUNTIME = RUNTIMES / "cpp"
UNREAL = RUNTIMES / "unreal"
STAND_IN = Path(__file__).parent / "unreal_stand_in"

needs_compiler = pytest.mark.skipif(shutil.which("g++") is None, reason="needs a C++ compiler (g++)")

# What of Unreal the plugin includes, as public plugins name it.
ENGINE = {
    "CoreMinimal.h", "Engine/DataAsset.h", "Components/ActorComponent.h", "Components/SkeletalMeshComponent.h",
    "GameFramework/Actor.h", "Animation/AnimNodeBase.h", "Animation/AnimInstance.h", "Animation/AnimCurveTypes.h", "Animation/AnimInstanceProxy.h",
    "BoneContainer.h", "Modules/ModuleManager.h", "AnimGraphNode_Base.h", "Factories/Factory.h", "Misc/FeedbackContext.h",
    "Misc/FileHelper.h", "Misc/Paths.h",
}  # fmt: skip

# That the compiler tidies its memory seldom takes an eighth off its time.
SELDOM = ("--param", "ggc-min-heapsize=600000", "--param", "ggc-min-expand=200")
# Nobody unwinds a stack without exceptions, and what is not moved in memory is written a little faster.
PLAIN = ("-O0", "-fno-asynchronous-unwind-tables", "-fno-pic", "-no-pie")
STRICT = ("-Wall", "-Wextra", "-Werror", "-fno-exceptions", "-fno-rtti")
FLAGS = (*SELDOM, *PLAIN, *STRICT)
# The program is kept for as long as nothing of it changes: to compile it takes half a minute.
KEPT = ROOT / ".pytest_cache" / "cpp"


def compiled(source: Path, program: Path, *more: str | Path, standard: str = "c++17") -> Path:
    """Compile one source with all warnings as errors, as engines do that have no exceptions."""
    done = subprocess.run(
        ["g++", f"-std={standard}", *FLAGS, *map(str, more), str(source), "-o", str(program)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr[:4000]
    return program


def ran(program: Path, *words: object, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(program), *map(str, words)],
        capture_output=True, text=True, timeout=120, check=False, env={**os.environ, **environment},
    )  # fmt: skip


# What is broken: a file, a rule's expression, what it is instead, and which case notices.
MUTANTS = [
    ("pose.hpp", "lead(other_, stance_, 1 - weight, count)", "lead(other_, stance_, weight, count)", "sparse: arms: strokes that are planned on"),
    ("pose.hpp", "FADE_BEYOND = 0.866", "FADE_BEYOND = 0.0", "sparse: arms: strokes that are planned on"),
    ("pose.hpp", "elapsed >= period", "elapsed < 0", "standing: the models alone"),
    ("pose.hpp", "rotation::ease((time - rest.fade_start) / rest.fade)", "1.0", "standing: the models alone"),
    ("pose.hpp", "weight == 1 ?", "weight > 0 ?", "varied: nothing is asked"),
    ("pose.hpp", "cue->hold <= 0", "cue->hold <= 1e9", "sparse: arms: holds and preparations"),
    ("pose.hpp", "cue_times::seam_left(cue, time)", "0.0", "repeating: arms: a50 repeats"),
    ("pose.hpp", "blending && cue->repeats()", "false", "repeating: arms: a50 repeats"),
    ("loading.hpp", "json.maybe(\"repeat\").within_or(0, 1e9, 0)", "0.0", "repeating: head: a76 repeats"),
    ("loading.hpp", "arm || masked", "masked", "standing: the models alone"),
    ("loading.hpp", "masked = !action.joints.empty()", "masked = action.joints.size() > 1000", "standing: arms: strokes in a mood"),
    ("glb.hpp", "std::clamp((time - track.times[key]) / span, 0.0, 1.0)", "0.0", "quiet: the models alone"),
    ("enliven.hpp", "full_ * breath.w", "2 * full_ * breath.w", "slow: the models alone"),
    ("solve.hpp", "shut + blink * (1 - shut)", "shut + blink", "quiet: the models in four moods"),
    ("solve.hpp", "2 * share);", "share);", "quiet: a thing that moves"),
    ("gaze.hpp", "since > start", "since > 1e9", "standing: chatter 1"),
    ("gaze.hpp", "moved - turned", "now - came", "quiet: a thing that moves"),
    ("lips.hpp", "(time - speech.end) / CLOSING", "(time - speech.end) / 1e-9", "quiet: stressed syllables"),
    ("schedule.hpp", "ways->breathing", "1.0", "calm: the models in four moods"),
    ("items.hpp", "speech->priority < last->priority", "false", "quiet: words that are said"),
    ("hearing.hpp", "bool turns = holds6;", "bool turns = false;", "sparse: modes asked for live"),
    ("meaning.hpp", "at + *inner->at", "at", "stick: lines"),
    ("directing.hpp", "state->track->stays_at(state->graph->layer, now)", "false", "sparse: arms: to stay"),
]  # fmt: skip


def _switched(path: Path, number: int, rule: str, instead: str) -> str:
    """Return a source in which a rule is followed, or broken where MUTANT says so; it stays one expression."""
    if rule.endswith((";", "?")):
        end = rule[-1]
        head, _, tail = rule[:-1].rpartition(" = ")
        other = instead[:-1].rpartition(" = ")[2]
        lead = f"{head} = " if head else ""
        if rule == "2 * share);":
            return broken(path, rule, f"(MUTANT == {number} ? 1 : 2) * share);")
        return broken(path, rule, f"{lead}(MUTANT == {number} ? ({other}) : ({tail})){end}")
    if " = " in rule or " += " in rule:
        head, sign, tail = re.split(r" (=|\+=) ", rule, maxsplit=1)
        other = re.split(r" (?:=|\+=) ", instead, maxsplit=1)[1]
        return broken(path, rule, f"{head} {sign} (MUTANT == {number} ? ({other}) : ({tail}))")
    return broken(path, rule, f"(MUTANT == {number} ? ({instead}) : ({rule}))")


PROBE = r"""
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#define main unreal
#include "play.cpp"  // before the core, which has to bear with Unreal's macros
#undef main
#define main shipped
#include "conformance.cpp"
#undef main
#define main example
#include "example.cpp"
#undef main
PARTS
using namespace metagraph;

static std::string read(const std::string& path) { return conformance::file(path).value_or(""); }

static Loaded loaded(const std::string& json) {
    const std::string text = read(json), glb = read(json.substr(0, json.size() - 4) + "glb");
    return load(text, reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size(), json.substr(json.rfind('/') + 1));
}

/// Reads lines and writes them in small letters.
static int lowered() {
    for (std::string one; std::getline(std::cin, one);) std::cout << lang::lowered(one) << '\n';
    return 0;
}

/// Reads pairs of numbers and writes what is left of their divisions, with all bits.
static int left() {
    for (double a, b; std::cin >> a >> b;) std::cout << std::hexfloat << lang::modulo(a, b) << '\n';
    return 0;
}

static int live(Character& character, const Json& steps) {
    List<std::string> ids;
    for (const Json& step : steps.items) {
        for (const Json& ask : step.items[1].items) ids.push_back(character.ask(ask.text));
        character.update(step.items[0].number);
        character.pose();
        character.morphs();
        for (const Happening& e : character.events()) {
            std::cout << json::text(Json::list({"event", e.kind, e.layer, e.action, e.meta, e.at})) << "\n";
        }
    }
    std::cout << json::text(Json::list({"now", character.now()})) << "\n";
    for (const std::string& id : ids) {
        const Answer a = character.answer(id);
        std::cout << json::text(Json::list({"answer", id, a.state, Json::maybe(a.at), Json::maybe(a.until), a.why})) << "\n";
    }
    for (const std::string& layer : graph::LAYERS) {
        for (const auto& c : character.plan().layers.at(layer)->cues) {
            std::cout << json::text(Json::list({"cue", layer, c->action->id, c->start, c->end, c->meta})) << "\n";
        }
    }
    return 0;
}

int main(int count, char** words) {
    const std::string what = words[1];
    if (what == "conformance") return shipped(count - 1, words + 1);
    if (what == "example") return example();
    if (what == "unreal") return unreal(count - 1, words + 1);
    if (what == "lowered") return lowered();
    if (what == "left") return left();
    CHOICES
    const std::string text = read(words[count - 1]);
    json::Parser parser(text);
    const Json data = parser.parse();
    if (what == "json") {
        std::cout << (parser.wrong.empty() ? json::text(data) : parser.wrong) << "\n";
        return 0;
    }
    if (what == "voices") {
        for (const Json& one : data.items) {
            const Ref<Voice> voice = voice::from_text(one.text, 2.5);
            List<Json> accents(voice->accents.begin(), voice->accents.end());
            Json weights = Json::list();
            for (const float weight : voice->weights) weights.items.push_back(static_cast<double>(weight));
            std::cout << json::text(Json::list({Json::list(accents), weights})) << "\n";
        }
        return 0;
    }
    const Loaded export_ = loaded(words[2]);
    if (export_.graph == nullptr) {
        std::cout << export_.error << "\n";
        return 3;
    }
    for (const auto& problem : export_.graph->problems) std::cout << problem << "\n";
    if (what != "live") return 0;
    CharacterOptions options;
    options.seed = 5;
    Character character(export_.graph, options);
    return live(character, data);
}
"""


def example() -> str:
    """Return the README's program, with what else it shows in it."""
    found = re.findall(r"```cpp\n(.*?)```", (RUNTIME / "README.md").read_text(), re.DOTALL)
    program, *more = found
    return str(program).replace("    for (double now = 0;", "".join(more) + "    for (double now = 0;", 1)


def unreal_sources() -> list[Path]:
    return sorted(p for p in UNREAL.rglob("*") if p.suffix in (".h", ".cpp"))


def made_of_unreal(folder: Path, core: Path | None = None) -> list[str]:
    """Put the plugin into a folder as an export writes it, or with another core, with what it includes of
    Unreal, and return where the compiler finds that.
    """
    plugin, names = folder / "Metagraph", folder / "engine"
    copy_runtime(UNREAL, plugin)
    within = plugin / "Source" / "Metagraph" / "Private" / "Core"
    copy_runtime(RUNTIME, within) if core is None else within.symlink_to(core)
    generated = {
        found for p in unreal_sources() for found in re.findall(r'"(\w+\.generated\.h)"', p.read_text())
    }
    for name in ENGINE | generated:
        (names / name).parent.mkdir(parents=True, exist_ok=True)
        (names / name).write_text("" if name in generated else '#pragma once\n#include "Unreal.h"\n')
    sides = [
        plugin / "Source" / module / side
        for module in ("Metagraph", "MetagraphEditor")
        for side in ("Public", "Private")
    ]
    return [f"-I{place}" for place in (names, STAND_IN, *sides)]


def write_probe(folder: Path, parts: dict[str, str]) -> list[str | Path]:
    """Write the program `probe.cpp`, with a switch for each mutant, and return where its compiler finds what it
    includes. parts: programs that include the runtime and what every program includes, by the word that runs
    them.
    """
    core = folder / "core"
    core.mkdir()
    for path in (*RUNTIME.glob("*.hpp"), RUNTIME / "conformance.cpp"):
        shutil.copy(path, core)
    for number, (name, rule, instead, _) in enumerate(MUTANTS, 1):
        (core / name).write_text(_switched(core / name, number, rule, instead))
    language = core / "language.hpp"
    switch = 'inline const int MUTANT = std::getenv("MUTANT") ? std::atoi(std::getenv("MUTANT")) : 0;\n'
    language.write_text(
        broken(language, "namespace metagraph {\n\ntemplate", f"{switch}namespace metagraph {{\n\ntemplate")
    )
    (core / "metagraph").symlink_to(core)
    (folder / "example.cpp").write_text(example())
    for name, text in parts.items():
        (folder / f"{name}.cpp").write_text(text)
    included = [f'namespace part_{name} {{\n#include "{name}.cpp"\n}}' for name in parts]
    choices = [f'if (what == "{name}") return part_{name}::main_(count - 1, words + 1);' for name in parts]
    (folder / "probe.cpp").write_text(
        PROBE.replace("PARTS", "\n".join(["#define main main_", *included, "#undef main"]), 1).replace(
            "CHOICES", "\n    ".join(choices), 1
        )
    )
    return ["-I", core, *made_of_unreal(folder, core)]


def make_probe(folder: Path, parts: dict[str, str]) -> None:
    """Write and compile the program `probe`."""
    places = write_probe(folder, parts)
    kept = KEPT / compiled_from(folder)
    if not kept.is_file():
        compiled(folder / "probe.cpp", folder / "probe", *places)
        shutil.rmtree(KEPT, ignore_errors=True)  # those of other sources are not needed any more
        KEPT.mkdir(parents=True)
        shutil.copy(folder / "probe", KEPT / "being copied")
        (KEPT / "being copied").rename(kept)
    shutil.copy(kept, folder / "probe")


def compiled_from(folder: Path) -> str:
    """Return a digest of what a program is compiled from and by: the files in a folder, what stands in for
    Unreal, the options and the compiler.
    """
    version = subprocess.run(["g++", "--version"], capture_output=True, timeout=60, check=True).stdout
    digest = hashlib.sha256(version + repr(FLAGS).encode())
    for place in (folder, STAND_IN):
        for path in sorted(path for path in place.rglob("*") if path.is_file()):
            content = path.read_bytes()
            digest.update(f"\n{path.relative_to(place)} {len(content)}\n".encode() + content)
    return digest.hexdigest()


def every_part(sample: Project) -> dict[str, str]:
    """Return the programs of several tests, by the word that runs them. sample: is played by one of them."""
    from tests.engines.test_talk_runtimes import CPP_PROGRAM
    from tests.engines.translation import in_cpp

    return {"talk": CPP_PROGRAM, **in_cpp.programs(sample)}
