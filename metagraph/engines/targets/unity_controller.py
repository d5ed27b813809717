"""Unity without a plug-in: an Animator Controller, an Avatar Mask for each layer, and the clips, as Unity's
own text assets.

Parameters, for each layer: the integers `<layer>_stance` and `<layer>_action`, and the trigger
`<layer>_play`, see `metagraph.engines.engine_machine`. At the bottom is a layer that holds the base pose; the
body overwrites it, arms and head add to it what their clips differ from it.

Each stance is a sub-state machine. What ends leads to the sub-state machine of its end stance, whose entry
transitions choose: the action that was asked for, else the transition towards the stance that was asked for,
else the loop. So a state needs three transitions instead of one to each other state. Only loops, which are
left at any time, have a transition to each action of their stance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from metagraph.common.wording import phrase
from metagraph.engines.engine_machine import EngineState, Machine, list_machines, make_animations
from metagraph.engines.engine_names import name_files
from metagraph.engines.targets.losses import CROSSFADE, MACHINE, PROPS, WEIGHTS
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.engines.targets.unity_clips import Moving, format_clip_asset
from metagraph.engines.targets.unity_package import PackedAsset, pack_assets
from metagraph.engines.targets.unity_yaml import (
    CLIP,
    CONTROLLER,
    ENTRY,
    MASK,
    NOTHING,
    STATE,
    STATES,
    TRANSITION,
    Inline,
    find_joint_path,
    main_id,
    make_guid,
    make_local_id,
    make_object_fields,
    to,
    write_asset,
    write_meta,
)
from metagraph.formats.atomic import write_atomically
from metagraph.graph import anatomy
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

BASE = "base"  # the layer at the bottom, its state and clip
IF, EQUALS, DIFFERS = 1, 6, 7  # modes of conditions
ROWS = 20  # of states in a column of the Animator window
INTEGER, TRIGGER = 3, 9  # types of parameters
Row = tuple[int, int, str, Mapping[str, Any]]

MOMENT = Loss(
    phrase(
        "a request that comes after an action's earliest exit waits until the action ends, "
        "because an exit time is a single moment"
    )
)
BLENDS = Loss(phrase("the length of a blend depends on the action that ends, not on the one that begins"))
ELSEWHERE = Loss(
    phrase("a request for an action of another stance is lost if it comes while an action plays")
)
UNTRIED = phrase("written field by field as Unity writes its own files; not tested in Unity")


def write_unity_controller(
    project: Project,
    name: str,
    built: tuple[Machine, ...],
    clips: Mapping[str, str],
    seconds: Mapping[str, float],
) -> bytes:
    """Return the AnimatorController. clips: state name -> what its clip's file is called, without ending.
    seconds: of each clip.
    """
    parameters, layers = [], [_layer(BASE, NOTHING, False)]
    for machine in built:
        begin = machine.stances[machine.start.action.stance]
        for word, kind, value in (("stance", INTEGER, begin), ("action", INTEGER, 0), ("play", TRIGGER, 0)):
            parameter: dict[str, Any] = {
                "m_Name": f"{machine.layer}_{word}",
                "m_Type": kind,
                "m_DefaultFloat": 0,
                "m_DefaultInt": value,
            }
            parameters.append(
                parameter | {"m_DefaultBool": 0, "m_Controller": Inline(fileID=main_id(CONTROLLER))}
            )
        layers.append(
            _layer(machine.layer, to(MASK, project.name, f"{machine.layer}.mask"), machine.layer != "body")
        )
    whole = make_object_fields(
        0, name, serializedVersion=5, m_AnimatorParameters=parameters, m_AnimatorLayers=layers
    )
    objects: list[Row] = [(CONTROLLER, main_id(CONTROLLER), "AnimatorController", whole)]
    objects += [
        _machine(BASE, make_local_id("layer", BASE), [BASE], BASE),
        _state(BASE, to(CLIP, project.name, f"{BASE}.anim"), []),
    ]
    for machine in built:
        subs = {stance: make_local_id("stance", machine.layer, stance) for stance in machine.stances}
        top = make_local_id("layer", machine.layer)
        objects.append(_machine(machine.layer, top, [], machine.start.name, [*subs.values()]))
        names = {ident: stance.name for ident, stance in machine.graph.stances.items()}
        for stance, ident in subs.items():
            own = [state.name for state in machine.states if state.action.stance == stance]
            entering = list(_entries(machine, stance))
            rest = machine.rest(stance).name
            objects.append(_machine(names[stance], ident, own, rest, (), entering))
            objects += entering
        for state in machine.states:
            leaving = list(_transitions(machine, state, seconds[state.name], subs))
            clip = to(CLIP, project.name, f"{clips[state.name]}.anim")
            objects.append(_state(state.name, clip, leaving, state.action.name))
            objects += leaving
    return write_asset(*objects)


def _layer(name: str, mask: Inline, adds: bool) -> dict[str, Any]:
    out: dict[str, Any] = {
        "serializedVersion": 5,
        "m_Name": name,
        "m_StateMachine": Inline(fileID=make_local_id("layer", name)),
        "m_Mask": mask,
    }
    out |= {
        "m_Motions": [],
        "m_Behaviours": [],
        "m_BlendingMode": int(adds),
        "m_SyncedLayerIndex": -1,
        "m_DefaultWeight": 1,
    }
    return out | {
        "m_IKPass": 0,
        "m_SyncedLayerAffectsTiming": 0,
        "m_Controller": Inline(fileID=main_id(CONTROLLER)),
    }


def _machine(
    name: str,
    ident: int,
    states: Sequence[str],
    start: str,
    below: Sequence[int] = (),
    entering: Sequence[Row] = (),
) -> Row:
    """Return a state machine. states: the names of its own; below: the ids of state machines in it."""
    children = [
        {
            "serializedVersion": 1,
            "m_State": Inline(fileID=make_local_id(state)),
            "m_Position": _at(300 + 260 * (n // ROWS), 120 + 60 * (n % ROWS)),
        }
        for n, state in enumerate(states)
    ]
    within = [
        {
            "serializedVersion": 1,
            "m_StateMachine": Inline(fileID=ident),
            "m_Position": _at(300, 120 + 60 * row),
        }
        for row, ident in enumerate(below)
    ]
    own: dict[str, Any] = {
        "m_ChildStates": children,
        "m_ChildStateMachines": within,
        "m_AnyStateTransitions": [],
        "m_EntryTransitions": [Inline(fileID=row[1]) for row in entering],
    }
    own |= {
        "m_StateMachineTransitions": Inline(),
        "m_StateMachineBehaviours": [],
        "m_AnyStatePosition": _at(50, 20),
    }
    own |= {
        "m_EntryPosition": _at(50, 120),
        "m_ExitPosition": _at(50, 220),
        "m_ParentStateMachinePosition": _at(50, 320),
    }
    own |= {"m_DefaultState": Inline(fileID=make_local_id(start))}
    return (
        STATES,
        ident,
        "AnimatorStateMachine",
        make_object_fields(1, name, 6, **own),
    )


def _state(name: str, motion: Inline, leaving: list[Row], called: str = "") -> Row:
    """Return a state, whose tag says what its action is called."""
    own: dict[str, Any] = {
        "m_Speed": 1,
        "m_CycleOffset": 0,
        "m_Transitions": [Inline(fileID=row[1]) for row in leaving],
    }
    own |= {
        "m_StateMachineBehaviours": [],
        "m_Position": _at(50, 50),
        "m_IKOnFeet": 0,
        "m_WriteDefaultValues": 1,
        "m_Mirror": 0,
    }
    own |= dict.fromkeys(
        (
            "m_SpeedParameterActive",
            "m_MirrorParameterActive",
            "m_CycleOffsetParameterActive",
            "m_TimeParameterActive",
        ),
        0,
    )
    own |= {
        "m_Motion": motion,
        "m_Tag": called,
        "m_SpeedParameter": "",
        "m_MirrorParameter": "",
        "m_CycleOffsetParameter": "",
    }
    return (
        STATE,
        make_local_id(name),
        "AnimatorState",
        make_object_fields(1, name, 6, **own, m_TimeParameter=""),
    )


def _at(x: int, y: int) -> Inline:
    return Inline(x=x, y=y, z=0)


def _transitions(
    machine: Machine, state: EngineState, seconds: float, subs: Mapping[str, int]
) -> Iterator[Row]:
    """Yield the transitions that leave a state, those that come first to be taken first."""
    arrows = machine.leaving[state.name]
    if state.loop:
        for on in ("action", "stance"):
            for arrow in (a for a in arrows if a.on == on):
                for value in arrow.values:
                    yield _transition(state, arrow.target, _ask(machine, on, value), arrow.blend, 0.0)
        return
    end = str(find_end_stance(state.action))
    done = next(a for a in arrows if a.on == "done")
    # What ends while it is still blended in would miss its exit, and stay for ever.
    blends = [a.blend for leaving in machine.leaving.values() for a in leaving if a.target is state]
    shown = max(blends, default=0.0) + 0.05
    leave = min((a.leave or 0.0 for a in arrows if a.on != "done"), default=None)
    pulled = [_condition(IF, f"{machine.layer}_play", 0)]
    elsewhere = [_condition(DIFFERS, f"{machine.layer}_stance", machine.stances[end])]
    if leave is not None:
        blend = max(a.blend for a in arrows if a.on != "done")
        yield _transition(state, end, pulled, blend, leave / seconds, subs)
        if any(a.on == "stance" for a in arrows):
            yield _transition(state, end, elsewhere, blend, leave / seconds, subs)
    yield _transition(state, end, [], done.blend, max(done.leave or 0.0, shown) / seconds, subs)


def _ask(machine: Machine, on: str, value: int) -> list[dict[str, Any]]:
    """Return the conditions of a request."""
    conditions = [_condition(EQUALS, f"{machine.layer}_{on}", value)]
    return [*conditions, _condition(IF, f"{machine.layer}_play", 0)] if on == "action" else conditions


def _entries(machine: Machine, stance: str) -> Iterator[Row]:
    """Yield the transitions from the entry of a stance: to what was asked for."""
    for on in ("action", "stance"):
        for arrow in (a for a in machine.leaving[machine.rest(stance).name] if a.on == on):
            for value in arrow.values:
                own: dict[str, Any] = {
                    "m_Conditions": _ask(machine, on, value),
                    "m_DstStateMachine": NOTHING,
                    "m_DstState": Inline(fileID=make_local_id(arrow.target.name)),
                    "m_Solo": 0,
                    "m_Mute": 0,
                    "m_IsExit": 0,
                    "serializedVersion": 1,
                }
                ident = make_local_id("entry", machine.layer, stance, arrow.target.name, on, str(value))
                yield ENTRY, ident, "AnimatorTransition", make_object_fields(1, "", **own)


def _condition(mode: int, parameter: str, value: int) -> dict[str, Any]:
    return {"m_ConditionMode": mode, "m_ConditionEvent": parameter, "m_EventTreshold": value}  # (sic)


def _transition(
    source: EngineState,
    target: EngineState | str,
    conditions: list[dict[str, Any]],
    blend: float,
    leave: float,
    subs: Mapping[str, int] | None = None,
) -> Row:
    """Return a transition to a state, or to a stance's sub-state machine."""
    to_state = isinstance(target, EngineState)
    own: dict[str, Any] = {
        "m_Conditions": conditions,
        "m_DstStateMachine": NOTHING if to_state else Inline(fileID=(subs or {})[str(target)]),
        "m_DstState": Inline(fileID=make_local_id(target.name))
        if isinstance(target, EngineState)
        else NOTHING,
        "m_Solo": 0,
        "m_Mute": 0,
        "m_IsExit": 0,
        "serializedVersion": 3,
        "m_TransitionDuration": blend,
        "m_TransitionOffset": 0,
        "m_ExitTime": leave,
        "m_HasExitTime": int(leave > 0),
        "m_HasFixedDuration": 1,
        "m_InterruptionSource": 0,
    }
    asked = [f"{c['m_ConditionMode']} {c['m_ConditionEvent']} {c['m_EventTreshold']}" for c in conditions]
    name = target.name if isinstance(target, EngineState) else target
    return (
        TRANSITION,
        make_local_id(source.name, name, *asked),
        "AnimatorStateTransition",
        make_object_fields(1, "", **own, m_OrderedInterruption=1, m_CanTransitionToSelf=1),
    )


def make_avatar_mask(skeleton: Skeleton, machine: Machine) -> bytes:
    """Return a layer's AvatarMask: all joints, those of the layer with weight 1."""
    elements = [{"m_Path": "", "m_Weight": 1}]
    elements += [
        {"m_Path": find_joint_path(skeleton, j), "m_Weight": int(name in machine.joints)}
        for j, name in enumerate(skeleton.names)
    ]
    human = "01000000" * 13  # the body parts of humanoid rigs
    whole = make_object_fields(0, machine.layer, m_Mask=human, m_Elements=elements)
    return write_asset((MASK, main_id(MASK), "AvatarMask", whole))


def write(order: ExportOrder) -> ExportedFiles:
    """Write controller, masks and clips as one package of Unity's, a guide, and the mesh as a GLB, where
    there is one.
    """
    from metagraph.formats.gltf.writer import write_glb

    project, built = order.project, list_machines(order.project)
    skeleton = project.skeleton
    assert skeleton is not None
    body, notes = find_ordered_mesh(order)
    assets: dict[str, PackedAsset] = {}

    def put(name: str, content: bytes, klass: int) -> None:
        guid = make_guid(project.name, name)
        assets[f"Assets/{order.stem}/{name}"] = PackedAsset(guid, content, write_meta(guid, klass))

    states = [state for machine in built for state in machine.states]
    clips = {clip.name: clip for clip in make_animations(project, built)}
    # Not all file systems tell "Wave" from "wave".
    names = {name: file.lower() for name, file in name_files({s.name: s.action.id for s in states}).items()}
    base = anatomy.get_base_pose(project)
    off = np.abs(base.translations - skeleton.rest_translations).max(1) > 1e-6
    shifted = {*np.flatnonzero(off).tolist()}.union(*(clip.translated for clip in clips.values()))
    still = Clip(BASE, skeleton, 30, np.stack([base.rotations] * 2), np.stack([base.translations[:1]] * 2))
    put(
        f"{BASE}.anim",
        format_clip_asset(still, BASE, _moving(range(len(skeleton)), shifted), base, True, None),
        CLIP,
    )
    reference = to(CLIP, project.name, f"{BASE}.anim")
    for machine in built:
        put(f"{machine.layer}.mask", make_avatar_mask(skeleton, machine), MASK)
        moving = _moving([skeleton.index(name) for name in machine.joints], shifted)
        for state in machine.states:
            order.tell(len(assets), len(states) + len(built) + 3, state.name)
            pose = None if machine.layer == "body" else reference
            name = names[state.name]
            put(
                f"{name}.anim",
                format_clip_asset(clips[state.name], name, moving, base, state.loop, pose),
                CLIP,
            )
    seconds = {name: clip.duration for name, clip in clips.items()}
    put(
        f"{order.stem}.controller",
        write_unity_controller(project, order.stem, built, names, seconds),
        CONTROLLER,
    )
    made = [order.folder / f"{order.stem}.unitypackage", order.folder / f"{order.stem}.unity.md"]
    write_atomically(made[0], pack_assets(assets))
    write_atomically(made[1], write_unity_guide(order.stem, skeleton, built).encode())
    if body is not None:
        made.append(order.folder / f"{order.stem}.glb")
        write_glb(made[-1], [], body)
    order.tell(1, 1, "done")
    slashed = [name for name in skeleton.names if "/" in name]
    if slashed:
        notes += (f"Unity's paths cannot lead to joints with a slash in their names: {', '.join(slashed)}",)
    return ExportedFiles(tuple(made), notes)


def _moving(joints: Any, shifted: set[int]) -> Moving:
    return Moving(tuple(joints), tuple(joint for joint in joints if joint in shifted))


def write_unity_guide(stem: str, skeleton: Skeleton, built: tuple[Machine, ...]) -> str:
    """Return what to do with the folder in Unity, and which number stands for which action and stance."""
    roots = " and ".join(f"`{skeleton.names[j]}`" for j in range(len(skeleton)) if skeleton.parents[j] < 0)
    machine = max(built, key=lambda m: len(m.states))
    layer, (stance, number) = machine.layer, list(machine.stances.items())[-1]
    play = next((s for s in machine.states if s.action.kind == "gesture"), machine.start)
    tables = "".join(_table(machine) for machine in built)
    return f"""# {stem} in Unity

These are Unity's own text assets; they need no plug-in. {UNTRIED[0].upper()}{UNTRIED[1:]}.

| File | What it is |
|---|---|
| `{stem}.unitypackage` | the Animator Controller, Avatar Masks and clips |
| `{stem}.glb` | the character's mesh, if the export has one |

## Steps

1. Open your Unity project and double-click `{stem}.unitypackage`. Press *Import*.
2. Put the character into the scene: `{stem}.glb`, with the package glTFast or UnityGLTF, or an FBX file with the same skeleton. In its
   import settings choose the rig *Generic*, and turn *Optimize Game Objects* off.
3. Put an `Animator` on the object that {roots} is directly in, with `{stem}.controller` as its Controller. Turn *Apply Root Motion* off.

## Requests

```csharp
animator.SetInteger("{layer}_stance", {number});   // go to "{_cell(machine.graph.stances[stance].name)}" by whatever leads there, and stay
animator.SetInteger("{layer}_action", {play.number});   // play "{_cell(play.action.name)}" ...
animator.SetTrigger("{layer}_play");        // ... once, as soon as what plays may be left
```

- Each stance is a sub-state machine. An action plays from its own stance, so go there first.
- If you request a transition as an action, set `<layer>_stance` to the stance it leads to. Else the layer goes back.
- While an action plays, a request waits for its earliest exit. A request for an action of another stance is lost then.
- The layer `{BASE}` holds the base pose. `body` overwrites it. Arms and head are additive to `{BASE}.anim`.
{tables}"""


def _table(machine: Machine) -> str:
    rows = [f"\n## {machine.layer}\n", f"| `{machine.layer}_stance` | stance |", "| --- | --- |"]
    rows += [
        f"| {number} | {_cell(machine.graph.stances[ident].name)} |"
        for ident, number in machine.stances.items()
    ]
    rows += [
        "",
        f"| `{machine.layer}_action` | action | kind | in stance | state |",
        "| --- | --- | --- | --- | --- |",
    ]
    for state in machine.states:
        action, stance = state.action, machine.graph.stances[state.action.stance]
        rows.append(
            f"| {state.number} | {_cell(action.name)} | {action.kind} | {_cell(stance.name)} | "
            f"`{state.name}` |"
        )
    return "\n".join(rows) + "\n"


def _cell(words: str) -> str:
    return " ".join(words.replace("|", "\\|").split())


TARGETS = (
    ExportTarget(
        "unity-controller",
        "Unity Animator Controller",
        phrase(
            "a Unity package with an Animator Controller, Avatar Masks and clips, a guide to them, "
            "and the mesh as a GLB"
        ),
        write,
        (*MACHINE, WEIGHTS, CROSSFADE, BLENDS, MOMENT, ELSEWHERE, PROPS),
        UNTRIED,
    ),
)
