"""What each file of an export is, in a few words, for the export's README."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fnmatch import fnmatchcase
from pathlib import PurePosixPath

# Patterns of names, "{stem}" for the export's; a folder ends with "/". The first that fits says it.
SHARED: Mapping[str, str] = {
    "{stem}.json": "the graph: stances, actions, tags and rules",
    "{stem}.glb": "the character, and its clips as animations",
    "lines/": "the sounds of lines",
    "requests.md": "all requests and their fields",
    "{stem}_parameters.gd": "a typed class of the character's parameters",
    "{stem}_parameters.hpp": "a typed class of the character's parameters",
    "{stem}.parameters.js": "a typed class of the character's parameters",
    "{stem}.parameters.d.ts": "its types",
    "*.cs": "a typed class of the character's parameters",
}
FILES: Mapping[str, Mapping[str, str]] = {
    "web": {
        "index.html": "a page that plays",
        "metagraph-character.js": "the element `metagraph-character`, with all it needs",
        "avatar.js": "shows the poses on other avatars; loaded only when a page asks for it",
        "player/": "the controls of the page",
    },
    "javascript": {"metagraph/": "the runtime, as ES modules; its README has all calls"},
    "cpp": {"metagraph/": "the runtime, as headers; its README has all calls"},
    "godot": {
        "{stem}.tscn": "a scene that plays",
        "{stem}.gd": "the scene's requests",
        "{stem}.motion": "the clips, which the add-on reads",
        "{stem}.glb": "the character, which Godot imports",
        "{stem}.glb.import": "how Godot imports it",
        "{stem}.library.tres": "an AnimationLibrary: an animation for each action",
        "{stem}.tree.tscn": "a scene whose AnimationTree plays them, without the add-on",
        "{stem}.tree.tres": "the root of that AnimationTree",
        "{stem}.tree.gd": "the script of that scene",
        "addons/": "the add-on; `addons/metagraph/README.md` has all calls",
        "godot3/": "what Godot 3 needs; Godot 4 ignores it",
    },
    "godot-tree": {
        "{stem}.tscn": "a scene for Godot 4 that plays",
        "{stem}.gd": "the scene's script",
        "{stem}.tres": "the root of an AnimationTree for Godot 4",
        "{stem}.godot3.tres": "the same for Godot 3",
        "{stem}.godot.md": "all states, and how to set up Godot 3",
        "{stem}.glb": "the character, and an animation for each state",
        "{stem}.glb.import": "how Godot imports it",
    },
    "unity": {
        "{stem}.metagraph": "the clips; the package makes the character of it",
        "{stem}.humanoid.json": "the bones of a humanoid, for retargeting",
        "{stem}.glb": "the character's mesh, which Unity imports with glTFast or UnityGLTF",
        "Metagraph/": "the package; its README has all calls",
    },
    "unreal": {"Plugins/": "the plugin; `Plugins/Metagraph/README.md` has all calls"},
    "playcanvas": {
        "{stem}.animstategraph.json": "the animation state graph",
        "{stem}.numbers.json": "the number of each stance and action, for requests",
        "{stem}.glb": "the character, and an animation for each state",
    },
    "interactivity": {
        "{stem}.glb": "the character, its animations and the behaviour graph that plays them",
        "{stem}.events.json": "the events that it listens to",
    },
    "xstate": {
        "{stem}.xstate.json": "the machine for XState 5",
        "{stem}.glb": "the character, and an animation for each state",
    },
    "scxml": {
        "{stem}.scxml": "the state chart",
        "{stem}.glb": "the character, and an animation for each state",
    },
    "bml": {
        "{stem}.vocabulary.json": "the names that blocks may use: gestures, postures, gazes",
        "line_*.bml": "a block for each line",
        "*.bml": "a block for a performance",
    },
    "smartbody": {
        "{stem}_gestures.py": "tells SmartBody the gestures and postures",
        "motions/": "a BVH file for each action",
    },
    "sumerian": {"gesture.json": "the gestures and the words they go with"},
    "vrm": {"{stem}.vrm": "the avatar: mesh, bones, expressions, licence and clips"},
    "vrma": {
        "{stem}.animations.json": "what each file is: kind, stance, length and tags",
        "*.vrma": "an animation for each action",
    },
    "usd": {
        "{stem}.usda": "the character with a variant for each clip",
        "{stem}_textures/": "its textures",
    },
}


def describe_files(target: str, stem: str, names: Iterable[str]) -> list[tuple[str, str]]:
    """Return what there is in an export's folder and what it is: files by name, those of one pattern and
    folders together. names: relative to the folder.
    """
    known = {
        pattern.replace("{stem}", stem): words
        for pattern, words in {**SHARED, **FILES.get(target, {})}.items()
    }
    order = [*(p for p in known if "*" not in p), *(p for p in known if "*" in p)]
    found: dict[str, list[str]] = {}
    words: dict[str, str] = {}
    for name in sorted(names):
        parts = PurePosixPath(name).parts
        top = f"{parts[0]}/" if len(parts) > 1 else name
        fitting = next((p for p in order if top == p or ("*" in p and fnmatchcase(top, p))), None)
        key = fitting if fitting is not None and "*" in fitting else top
        found.setdefault(key, []).append(top)
        words[key] = known[fitting] if fitting is not None else ""
    out = []
    for key, tops in found.items():
        several = f"{len(tops)} files" if len(tops) > 1 else ""
        out.append((key if several else tops[0], "; ".join(w for w in (words[key], several) if w)))
    return out
