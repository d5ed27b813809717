"""Godot without a plug-in: the root of an AnimationTree as a text resource, once for Godot 4 and once for
Godot 3.

The root is a blend tree that adds the layers one after the other onto nothing, each through a filter of the
joints it moves:

    base - add_body - add_arms - add_head - output          base: an empty blend space; Add2 needs something
    to add to
              |          |          |
             body       arms       head                     a state machine each:
             `parameters/<layer>/playback`

`parameters/add_<layer>/add_amount` is 0 in a new AnimationTree and has to be set to 1; a resource cannot say
so.

Godot 4 takes every animation as its offset from the bones' rest, which here is the base pose, and multiplies
the offsets in the tree's order: the composition of the contract. Godot 3 takes the mean of what it should
add; there each joint is left to one layer.

Filters hold the paths of tracks as the importers name them, from the scene's root: `Skeleton3D:<joint>` in
Godot 4, `Skeleton:<joint>` in Godot 3, whose older importers also spell `LeftHand` as `left_hand`; paths that
are not there do no harm. A skeleton of several roots hangs below `Armature`.

`travel()` looks for a way by the states' places, with their distance to the goal as the only cost (priority 0
takes the way behind out of it). So the states of a stance and the transitions that lead to it stand together,
and far from the next stance's: whatever leads straight to a stance is nearer to it than all else.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from typing import Literal

from metagraph.common.wording import phrase, plural_phrase
from metagraph.engines.engine_machine import Arrow, EngineState, Machine, list_machines, write_machine_glb
from metagraph.engines.targets.godot_scene import find_first_gesture, write_import_settings, write_tree_scene
from metagraph.engines.targets.losses import CROSSFADE, MACHINE, WEIGHTS
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.formats.atomic import write_atomically
from metagraph.graph import anatomy
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import Action, Layer, Part, Project

Version = Literal[3, 4]
Place = tuple[float, float]

OWNER: Mapping[Part, Layer] = {
    "legs": "body",
    "spine": "body",
    "arms": "arms",
    "head": "head",
    "face": "head",
}
AT_END, AUTO = 2, 2  # of Godot's enumerations of switch and advance modes
CELL = (240, 60)  # pixels a state takes up in the editor


def spell_for_godot(action: Action, name: str) -> str:
    """Return a state's name as Godot's importers leave it: they make a loop of each animation whose name ends
    in "loop" or "cycle", and take "_loop" and the like off, whatever digits are behind.
    """
    return f"{name}_{action.kind}" if re.search(r"(loops?|loop_mode|cycle)[\d_]*$", name.lower()) else name


class _Resources:
    """The sub-resources of a file, each kept once, as text. version: 3 numbers them, 4 names them."""

    def __init__(self, version: Version) -> None:
        self.version = version
        self._known: dict[str, int] = {}

    def add(self, kind: str, *fields: str) -> str:
        """Add one and return how others refer to it."""
        number = self._known.setdefault("\n".join((kind, *fields)), len(self._known) + 1)
        return f"SubResource( {number} )" if self.version == 3 else f'SubResource("{number}")'

    def text(self, kind: str, *fields: str) -> str:
        """Return the whole file, whose resource has these fields."""
        steps = f" load_steps={len(self._known) + 1} format=2" if self.version == 3 else " format=3"
        lines = [f'[gd_resource type="{kind}"{steps}]', ""]
        for known, number in self._known.items():
            name, *rest = known.split("\n")
            ident = f"{number}" if self.version == 3 else f'"{number}"'
            lines += [f'[sub_resource type="{name}" id={ident}]', *rest, ""]
        return "\n".join((*lines, "[resource]", *fields, ""))


def write_animation_tree(project: Project, built: tuple[Machine, ...], version: Version) -> str:
    """Return the AnimationTree's root as the text of a .tres file."""
    out = _Resources(version)
    filters = {m.layer: m.joints for m in built} if version == 4 else find_owned_joints(project, built)
    fields = [
        f"nodes/base/node = {out.add('AnimationNodeBlendSpace1D')}",
        "nodes/base/position = Vector2(0, 0)",
    ]
    wires: list[tuple[str, int, str]] = []
    before = "base"
    for column, machine in enumerate(built, 1):
        layer, adder = machine.layer, f"add_{machine.layer}"
        paths = ", ".join(
            json.dumps(p, ensure_ascii=False)
            for j in filters[layer]
            for p in list_track_paths(project, j, version)
        )
        add = out.add("AnimationNodeAdd2", "filter_enabled = true", f"filters = [{paths}]")
        fields += [
            f"nodes/{layer}/node = {_machine(out, machine)}",
            f"nodes/{layer}/position = Vector2({column * 300 - 200}, 200)",
        ]
        fields += [f"nodes/{adder}/node = {add}", f"nodes/{adder}/position = Vector2({column * 300}, 0)"]
        wires += [(adder, 0, before), (adder, 1, layer)]
        before = adder
    fields.append(f"nodes/output/position = Vector2({len(built) * 300 + 300}, 0)")
    fields.append(
        "node_connections = " + json.dumps([end for wire in [("output", 0, before), *wires] for end in wire])
    )
    return out.text("AnimationNodeBlendTree", *fields)


def find_owned_joints(project: Project, built: tuple[Machine, ...]) -> dict[Layer, tuple[str, ...]]:
    """Return for each layer the joints it alone moves where layers cannot be added: the one its part belongs
    to, or else the first that reaches it.
    """
    assert project.skeleton is not None
    out: dict[Layer, list[str]] = {m.layer: [] for m in built}
    for joint, part in zip(project.skeleton.names, anatomy.project_parts(project), strict=True):
        reaching = [m.layer for m in built if joint in m.joints]
        if reaching:
            out[OWNER[part] if OWNER[part] in reaching else reaching[0]].append(joint)
    return {layer: tuple(joints) for layer, joints in out.items()}


def list_track_paths(project: Project, joint: str, version: Version) -> tuple[str, ...]:
    """Return the paths that a joint's tracks may have in an imported scene."""
    assert project.skeleton is not None
    name = re.sub(r"[:/]", "_", joint)
    node = ("Armature/" if sum(p < 0 for p in project.skeleton.parents) > 1 else "") + (
        "Skeleton3D" if version == 4 else "Skeleton"
    )
    names = (name,) if version == 4 else (name, make_godot3_name(joint))
    return tuple(f"{node}:{n}" for n in dict.fromkeys(names))


def make_godot3_name(joint: str) -> str:
    """Return a joint's name as Godot 3 imports it unless told otherwise: LeftThumb1 -> left_thumb_1."""
    word = (
        r"(?<![A-Z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z]{2})|(?<![0-9])(?=[0-9])|(?<=[0-9])(?=[^0-9][a-z0-9])"
    )
    return re.sub(r"[^a-z0-9_ ]", "", re.sub(f"(?<=.)(?:{word})", "_", joint).lower())


def _machine(out: _Resources, machine: Machine) -> str:
    fields: list[str] = []
    for state, (x, y) in _places(machine):
        fields += [
            f"{_key(f'states/{state.name}/node')} = {_state(out, state)}",
            f"{_key(f'states/{state.name}/position')} = Vector2({x:.0f}, {y:.0f})",
        ]
    triplets = [f'"{a.source.name}", "{a.target.name}", {_transition(out, a)}' for a in _ways(machine)]
    if out.version == 4:
        first = out.add("AnimationNodeStateMachineTransition", f"advance_mode = {AUTO}")
        triplets.insert(0, f'"Start", "{machine.start.name}", {first}')
    fields.append(f"transitions = [{', '.join(triplets)}]")
    if out.version == 3:
        fields.append(f'start_node = "{machine.start.name}"')
    return out.add("AnimationNodeStateMachine", *fields)


def _key(key: str) -> str:
    """Return the name of a property as Godot writes it."""
    return key if key.isascii() else f'"{key}"'


def _state(out: _Resources, state: EngineState) -> str:
    """Add a state's node, which notes what the action is called, and return how others refer to it."""
    called = json.dumps(state.action.name, ensure_ascii=False)
    if out.version == 3:
        noted = f'__meta__ = {{ "action": {called} }}'
        return out.add("AnimationNodeAnimation", f'animation = "{state.name}"', noted)
    own = (
        f"timeline_length = {state.seconds:.4f}",
        "stretch_time_scale = false",
        "start_offset = 0.0",
        "loop_mode = 1",
    )
    loop = (
        ("use_custom_timeline = true", *own) if state.loop and state.seconds > 0 else ()
    )  # from Godot 4.3 on; glTF has no loops
    return out.add(
        "AnimationNodeAnimation", f'animation = &"{state.name}"', *loop, f"metadata/action = {called}"
    )


def _ways(machine: Machine) -> Iterator[Arrow]:
    """Yield an arrow for each pair of states, since Godot has but one: what it is asked by does not matter to
    `travel()`.
    """
    seen: set[tuple[str, str]] = set()
    for arrow in machine.arrows:
        if (pair := (arrow.source.name, arrow.target.name)) not in seen:
            seen.add(pair)
            yield arrow


def _transition(out: _Resources, arrow: Arrow) -> str:
    fields = [f"xfade_time = {arrow.blend:.4g}", "priority = 0"]
    if arrow.leave is not None:
        fields.append(f"switch_mode = {AT_END}")
    if arrow.on == "done":
        fields.append("auto_advance = true" if out.version == 3 else f"advance_mode = {AUTO}")
    return out.add("AnimationNodeStateMachineTransition", *fields)


def _places(machine: Machine) -> Iterator[tuple[EngineState, Place]]:
    """Yield the states with their places: a block for each stance, blocks further apart than any is wide and
    high. From the loop in its corner outwards come the transitions in the order they were placed, since the
    nearest is taken, and then all else.
    """
    blocks: dict[str | None, list[EngineState]] = {
        stance: [machine.rest(stance)] for stance in machine.stances
    }
    for state in sorted(machine.states, key=lambda s: s.action.kind != "transition"):
        if state is not machine.rest(str(find_end_stance(state.action))):
            blocks[find_end_stance(state.action)].append(state)
    largest = max(len(b) for b in blocks.values())
    columns = math.ceil(math.sqrt(largest / 3))
    rows = math.ceil(largest / columns)
    cells = sorted(
        ((x * CELL[0], y * CELL[1]) for y in range(rows) for x in range(columns)),
        key=lambda cell: math.hypot(*cell),
    )
    size = columns * CELL[0], rows * CELL[1]
    step = size[0] + math.hypot(*size)
    for number, block in enumerate(blocks.values()):
        for state, (x, y) in zip(block, cells, strict=False):
            yield state, (number * step + x, y)


def write(order: ExportOrder) -> ExportedFiles:
    """Write both trees, the GLB, a scene that plays in Godot 4, and a guide."""
    project, stem = order.project, order.stem
    built = list_machines(project, spell_for_godot)
    glb = order.folder / f"{stem}.glb"
    body, notes = find_ordered_mesh(order)
    order.tell(0, 2, "clips")
    notes += write_machine_glb(project, built, glb, body, order.contents.base)
    order.tell(1, 2, "trees")
    texts = {
        f"{stem}.tres": write_animation_tree(project, built, 4),
        f"{stem}.godot3.tres": write_animation_tree(project, built, 3),
        f"{stem}.godot.md": write_godot_guide(stem, built),
    }
    for name, text in texts.items():
        write_atomically(order.folder / name, text.encode())
    made = [
        *(order.folder / name for name in texts),
        glb,
        write_import_settings(order.folder, glb.name, True),
    ]
    made += write_tree_scene(project, order.folder, stem, stem, built)
    order.tell(2, 2, "done")
    return ExportedFiles(tuple(made), notes)


def write_godot_guide(stem: str, built: tuple[Machine, ...]) -> str:
    """Return in Markdown how a scene plays the tree, and the states there are."""
    layers = ", ".join(f'"{m.layer}"' for m in built)
    loops = ", ".join(f'"{s.name}"' for m in built for s in m.states if s.loop)
    layer, first = find_first_gesture(built)
    parts = [GUIDE.format(stem=stem, layers=layers, loops=loops, layer=layer, state=first)]
    for machine in built:
        parts.append(f"\n### {machine.layer}\n\n| stance | loop |\n|---|---|\n")
        names = {ident: stance.name.replace("|", "\\|") for ident, stance in machine.graph.stances.items()}
        parts += [f"| {names[ident]} | `{machine.rest(ident).name}` |\n" for ident in machine.stances]
        parts.append("\n| state | action | seconds | in | then |\n|---|---|---|---|---|\n")
        for state in machine.states:
            if state is not machine.rest(state.action.stance):
                here, there = names[state.action.stance], names[str(find_end_stance(state.action))]
                called = state.action.name.replace("|", "\\|")
                parts.append(
                    f"| `{state.name}` | {called} | {state.seconds:.2f} | {here} | "
                    f"{there if there != here else ''} |\n"
                )
    return "".join(parts)


GUIDE = """# {stem} in Godot

| File | What it is |
|---|---|
| `{stem}.tscn`, `{stem}.gd` | a scene for Godot 4.3 or later whose AnimationTree plays |
| `{stem}.tres` | the root of the AnimationTree |
| `{stem}.glb` | the character, and an animation for each state |
| `{stem}.godot3.tres` | the root for Godot 3; delete it in Godot 4 |

## Godot 4

1. Copy this folder into your Godot project.
2. Open `{stem}.tscn` and press F6. The character makes a gesture.
3. Request other states:

```gdscript
$Tree.play("{layer}", "{state}")
```

Keep the GLB's import settings. A bone map changes the rest pose, and with it the poses.

## Godot 3

Instance the GLB in a scene. Add an AnimationTree as its child, with this script:

```gdscript
extends AnimationTree

func _ready():
	var player = get_node("../AnimationPlayer")
	for loop in [{loops}]:
		player.get_animation(loop).loop = true
	tree_root = load("res://{stem}.godot3.tres")
	anim_player = get_path_to(player)
	for layer in [{layers}]:
		set("parameters/add_" + layer + "/add_amount", 1.0)
	active = true

func play(layer, state):
	get("parameters/" + layer + "/playback").travel(state)
```

## Requests

- To go to a stance, request its loop. The tree plays the transitions on the way.
- To play a gesture or fidget, request its name. The layer goes to its stance first, and comes back to the loop at the end.
- `travel(state)` does not restart the state that plays. `start(state)` does, without a blend.

## States
"""


def _left_early(project: Project) -> int:
    return sum(1 for a in project.actions() if a.kind != "stance" and a.timing.earliest_exit is not None)


LOSSES: tuple[Loss, ...] = (
    Loss(
        phrase(
            "Godot 4: layers are added to the skeleton's rest pose; retargeting on import changes "
            "the rest pose and so all poses"
        )
    ),
    Loss(
        phrase(
            "Godot 3: layers are not added: only the body layer moves spine and legs, only the "
            "arms layer the arms, only the head layer head and face"
        )
    ),
    Loss(
        plural_phrase(
            "{count} action that can exit early plays to its end",
            "{count} actions that can exit early play to their end",
            0,
        ),
        _left_early,
    ),
    Loss(phrase("an action that already plays does not restart when you request it again")),
    Loss(phrase("if no transition joins two stances, the path between them can differ from the planner's")),
)
TARGETS = (
    ExportTarget(
        "godot-tree",
        "Godot AnimationTree (.tres)",
        phrase(
            "a scene and an AnimationTree root for Godot 4, a root for Godot 3, a guide to their "
            "states, and one GLB with an animation for each state"
        ),
        write,
        (*MACHINE, WEIGHTS, CROSSFADE, *LOSSES),
    ),
)
