"""Public names: each is defined in one module, and functions are called by what they do."""

from __future__ import annotations

import ast
from collections import defaultdict
from functools import cache
from pathlib import Path

from metagraph.engines.translation.listing import LISTING

ROOT = Path(__file__).parent.parent
# What every feature, command, export target and program offers under the same name.
PROTOCOLS = {"contribute", "add_arguments", "run", "write", "main"}
# Modules that are translated for the engines: their names are also those of the runtimes.
TRANSLATED = {Path(*one.module.split(".")).with_suffix(".py") for one in LISTING}
# Names of messages and study files, which their JSON Schemas have too.
KEPT = {"Condition", "Document", "Plan", "Poses", "apart", "length", "meta_of", "scaled"}
# Functions that the translated modules call and each runtime has by hand, under the same name.
NATIVE = {"begun", "named", "placed", "scaled", "stressed"}
# Words that end like participles and are none, or begin a verb phrase.
NO_PARTICIPLES = {"bed", "cut", "feed", "need", "put", "read", "seed", "set", "speed", "split", "spread"}
PARTICIPLES = {
    *("begun", "built", "done", "drawn", "felt", "given", "gone", "grown", "heard", "held", "kept", "known"),
    *("laid", "left", "lost", "made", "meant", "met", "said", "seen", "sent", "shown", "spent", "spoken"),
    *("stood", "sworn", "taken", "told", "worn", "wound", "written"),
}

# What names of functions begin with: verbs, and words for questions and for variants of a value.
VERBS = set(
    """
    ablate absorb accept access add address adopt align allocate allow analyse anchor answer append apply
    are arrange arrive as ask assemble assign assume attend bake batch begin bind blend break breathe
    bridge bring build bundle cache can change charge check choose claim clamp classify clean clear close
    collect combine compare compose compute conjugate connect continue contribute convert copy count cover
    crop crossfade cut declare decode decompose delay delete derive describe detect differs digest
    discover drag draw drive drop duplicate ease edit elide encode escape estimate evaluate exchange
    exhibit expand explain export extend fade fetch fill film filter find finish fit fix fold follow foresee
    forget format free freeze from gather generate get go grade group guard guess handle has hear hide hit
    hold holds identify import improvise infer install is join judge keep keeps key label land last lay
    lead leap learn leave level lie lift limit list load localize lock log look main make mark mask match
    matches may mean measure meet merge mimic mirror mismatch mix move moves multiply name needs normalize
    note nudge offer open order orthonormalise pack pad paint parse paste perceive perform pick place plan
    play plot predict prepare preregister print process project propose put quote rank reach read recall
    receive recover refuse register rehearse relabel relocate remake remember remove rename render reopen
    reorder repair repeat replace replay repoint report require reread resample reset resize restore
    retarget retime retire reveal reword rotate round route run sample save say scale score seal search
    see select send serve set settle shade share shift shorten show shuffle simplify simulate slip smooth
    snap soften solve sort spell spend split stack stand standardise start straighten strengthen strip suggest
    study summarise swap sweep sync synthesise synthesize tabulate take tell thin timed to tr track train
    translate try turn understand undo unpack unwrap update use uses vary verify wait walk warn watch
    weigh with withdraw write
    """.split()  # noqa: SIM905 - three hundred quotes more to read
)
# Names that stay: of plain mathematics, where each is clearer than a verb with it, and of marks on texts.
SHORT = {
    "exp",  # the exponential map from rotation vectors to quaternions
    "logistic",  # the logistic function
    "nlerp",  # normalised linear interpolation, as every book on animation calls it
    "phrase",  # marks a text in the domain, as `tr` does in the window; it is a verb, too
    "plural_phrase",  # marks a text that depends on a count, as `tr_plural` does in the window
    "relu",  # the rectified linear unit, as every book on networks calls it
    "sigmoid",  # the logistic function in such a network
    "silu",  # the sigmoid linear unit
    "slerp",  # spherical linear interpolation
    "pose_at",  # programs that others wrote ask for poses by this name, and every runtime has it as poseAt
    "state_folder",  # as they find what is kept beside a project
    "slerp_exact",  # slerp for keys that are far apart
}


@cache
def defined() -> dict[str, list[tuple[Path, ast.stmt]]]:
    """Return by name where public functions and classes are defined."""
    out = defaultdict(list)
    for root in ("app", "metagraph", "preview"):
        for path in sorted((ROOT / root).rglob("*.py")):
            if "runtimes" in path.parts:
                continue
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                    out[node.name].append((path.relative_to(ROOT), node))
    return out


def is_participle(name: str) -> bool:
    """Return whether a name begins with a participle that no noun follows, such as `kept` or `drawn_of`."""
    first, *rest = name.split("_")
    ends = first in PARTICIPLES or (first.endswith("ed") and first not in NO_PARTICIPLES)
    return ends and (not rest or rest[0] in ("at", "by", "for", "in", "of", "on", "to", "with"))


def test_a_public_name_is_defined_in_one_module() -> None:
    twice = {
        name: sorted({str(path) for path, _ in places})
        for name, places in defined().items()
        if len({path for path, _ in places}) > 1 and name not in PROTOCOLS | KEPT
    }
    assert not twice, "give one of each another name"


def test_no_function_is_called_by_a_bare_participle() -> None:
    found = [
        f"{path}: {name}"
        for name, places in defined().items()
        for path, node in places
        if isinstance(node, ast.FunctionDef) and is_participle(name)
        if path not in TRANSLATED and name not in NATIVE
    ]
    assert not found, "call them by a verb, such as find_, make_, list_, describe_"


def find_nouns() -> set[str]:
    """Return the names of public functions that do not begin with a verb, outside of translated modules."""
    return {
        name
        for name, places in defined().items()
        for path, node in places
        if isinstance(node, ast.FunctionDef) and name.split("_")[0] not in VERBS
        if path not in TRANSLATED and name not in PROTOCOLS | KEPT | NATIVE | SHORT
    }


def test_names_of_functions_begin_with_a_verb() -> None:
    assert not find_nouns(), "begin the names with a verb, or add a new verb to VERBS"


def test_participles_are_told_from_verbs_and_nouns() -> None:
    assert is_participle("kept") and is_participle("drawn_of") and is_participle("shifted")
    assert not any(map(is_participle, ("read", "set_start", "seed", "spoken_seconds", "keep", "find_kept")))
