"""The example study: training, and tasks of 10 and 20 sample clips with their right answers; and the pilot, of
25 minutes. `python -m sample_clips.make.study`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.touch import Touch
from sample_clips.make.numbered_ids import numbered_ids
from sample_clips.make.projects import HERE, sample

FOLDER = HERE / "study"
PILOT = HERE / "pilot"

# As the paper's animator was shown: 2 stances, 1 gesture, 1 fidget, 2 transitions.
TRAINING = (
    "body_weight_both__stance",
    "body_weight_left__stance",
    "body_weight_both__lean_in_01",
    "body_weight_left__heel_lift_01",
    "body_weight_both__to__weight_left",
    "body_weight_left__to__weight_both",
)
TASKS = {
    "ten": (
        "hands_at_sides__stance",
        "on_hips__stance",
        "hands_at_sides__beat_small_rt_01",
        "hands_at_sides__open_palms_bt_01",
        "hands_at_sides__adjust_sleeve_bt_01",
        "on_hips__shrug_bt_01",
        "on_hips__point_you_rt_01",
        "on_hips__readjust_bt_01",
        "hands_at_sides__to__on_hips",
        "on_hips__to__hands_at_sides",
    ),
    "twenty": (
        "hands_at_sides__stance",
        "arms_crossed__stance",
        "hands_clasped__stance",
        "hands_at_sides__wave_hello_rt_01",
        "hands_at_sides__shrug_bt_01",
        "arms_crossed__shrug_bt_01",
        "arms_crossed__point_you_rt_01",
        "hands_clasped__beat_small_bt_01",
        "hands_clasped__open_palms_bt_01",
        "hands_at_sides__swing_arms_bt_01",
        "arms_crossed__rub_arm_rt_01",
        "hands_clasped__rub_hands_bt_01",
        "hands_at_sides__to__arms_crossed",
        "arms_crossed__to__hands_at_sides",
        "hands_at_sides__to__hands_clasped",
        "hands_clasped__to__hands_at_sides",
        "head_straight__stance",
        "head_straight__nod_single_01",
        "head_straight__shake_01",
        "head_straight__neck_stretch_01",
    ),
}
TITLES = {"ten": "Ten clips", "twenty": "Twenty clips", "six": "Six clips", "eight": "Eight clips"}
PILOT_TASKS = {
    "six": (
        "hands_at_sides__stance",
        "on_hips__stance",
        "hands_at_sides__open_palms_bt_01",
        "on_hips__readjust_bt_01",
        "hands_at_sides__to__on_hips",
        "on_hips__to__hands_at_sides",
    ),
    "eight": (
        "hands_at_sides__stance",
        "arms_crossed__stance",
        "hands_at_sides__wave_hello_rt_01",
        "hands_at_sides__shrug_bt_01",
        "arms_crossed__shrug_bt_01",
        "arms_crossed__rub_arm_rt_01",
        "hands_at_sides__to__arms_crossed",
        "arms_crossed__to__hands_at_sides",
    ),
}

HEAD = """\
# An example study: the meta-graph against a state machine drawn by hand, on 10 and on 20 clips. Everybody has names in one of the two
# tasks and numbers in the other. docs/researchers/study-file.md says what each field does.
study: 1
title: Two ways to wire a character
participants: 16
seed: 1
conditions: [meta, manual]
order: latin
names: both
breaks: 5
questionnaires: [sus, tlx]
when: after_condition
tolerance: 0.1
consent: |
  You will wire motion clips to a talking character, with two editors. It takes about two hours.

  - Taking part is voluntary. You may stop at any time, without giving a reason.
  - It is recorded when you edit, look and listen, and how often you press keys and buttons and move the mouse. It is never recorded
    which keys, nor what you type.
  - Nothing leaves this computer. Your data is kept under a number, not your name.

  *This is an example. Put the text your ethics board agreed to here.*
instructions: |
  A character rests in a **stance**: a loop. Out of a stance it plays **gestures**, which say something, and **fidgets**, which do not,
  and goes back to it. A **transition** takes it from one stance to another.

  Where clips have names, a name tells the stance first, then what the clip is: `on_hips__shrug_bt_01` is a shrug out of *on hips*,
  `hands_at_sides__to__on_hips` the transition between the two. Where clips have numbers, watch them. Fidgets are what one does without
  thinking: adjusting, rubbing, swinging.

  Please wire all clips of each task so that the character can play every one of them, and get back to where it began.
thanks: |
  That was all. Please tell the experimenter that you are done.
training:
"""
PILOT_HEAD = (
    HEAD.replace(
        "# An example study: the meta-graph against a state machine drawn by hand, on 10 and on 20 clips. Everybody has names in one of the two\n"
        "# tasks and numbers in the other.",
        "# A pilot of 25 minutes: the meta-graph against a state machine drawn by hand, on 6 and on 8 clips. `metagraph study pilot` runs it.\n"
        "# Everybody has names in one of the two tasks and numbers in the other.",
    )
    .replace("title: Two ways to wire a character", "title: Two ways to wire a character (pilot)")
    .replace("participants: 16", "participants: 8")
    .replace("breaks: 5\n", "")
    .replace("questionnaires: [sus, tlx]\n", "questionnaires: [sus]\n")
    .replace("about two hours", "about 25 minutes")
)
LEARN = {
    "meta": """\
    1. Drop the two stances onto the card in the middle: each becomes a stance.
    2. Choose a stance above, and drop its gesture and its fidget onto *Gesture* and *Fidget*.
    3. Drop the transitions onto *Transition*; choose there where they end.

    All connections follow from that. Choose *Body* at the top: these clips move the body. Try everything; nothing counts yet.
""",
    "manual": """\
    1. Drop clips into the editor: each becomes a state. Stances loop.
    2. Drag from a state's edge to another to draw a link: from a stance to each gesture, fidget and transition out of it, and back from
       each to the stance it ends in.
    3. Links to gestures and transitions wait for a request; links back are taken when the clip has finished.

    Choose *Body* at the top: these clips move the body. Try everything; nothing counts yet.
""",
}


def clips(names: tuple[str, ...]) -> str:
    """Return a list of clips as the study file has it."""
    return "".join(f"  - ../clips/{name}.glb\n" for name in names)


def text() -> str:
    """Return the study file of the example."""
    minutes = {"ten": 30.0, "twenty": 60.0}
    return HEAD + _trained(15) + _tasks(TASKS, minutes)


def pilot_text() -> str:
    """Return the study file of the pilot: at most 3 minutes of practice and 7 of tasks in each condition."""
    return PILOT_HEAD + _trained(3) + _tasks(PILOT_TASKS, {"six": 3.0, "eight": 4.0})


def _trained(minutes: int) -> str:
    return "".join(
        f"- condition: {condition}\n  minutes: {minutes}\n  instructions: |\n{words}  clips:\n{clips(TRAINING)}"
        for condition, words in LEARN.items()
    )


def _tasks(tasks: Mapping[str, tuple[str, ...]], minutes: Mapping[str, float]) -> str:
    out = "tasks:\n"
    for task, names in tasks.items():
        some = "arms and head, " if any(n.startswith("head_") for n in names) else ""
        out += (
            f"- id: {task}\n  title: {TITLES[task]}\n  minutes: {minutes[task]:g}\n  "
            f"reference: {task}{SUFFIX}\n"
            f"  instructions: Wire all clips, {some}each to its stance.\n"
            f"  clips:\n{clips(names)}"
        )
    return out


@numbered_ids()
def reference(task: str, whole: Project) -> Project:
    """Return the right answer to a task: the sample project with its clips alone."""
    keep = set((TASKS | PILOT_TASKS)[task])
    project = edits.remove_clips(whole, [c.id for c in whole.clips.values() if c.name not in keep])
    for layer in LAYERS:
        for stance in list(project.graphs[layer].stances):
            if not project.graphs[layer].of(stance, "stance"):
                project = edits.remove_stance(project, stance)
    return edits.rename_project(project, TITLES[task])


def main() -> None:
    for folder, said in ((FOLDER, text()), (PILOT, pilot_text())):
        folder.mkdir(exist_ok=True)
        (folder / "study.yaml").write_text(said, encoding="utf-8")
    whole = sample()
    whole = replace(whole, lines={}, performances={}, conversations={}, timelines={}, touch=Touch())
    # A participant wires what is there to be wired: no lines, no contacts, and the plain mannequin.
    bare = {a.id: {"contacts": ()} for layer in LAYERS for a in whole.graphs[layer].actions.values()}
    whole = edits.set_character(edits.update_each(whole, bare), "mannequin.glb")
    for task in (*TASKS, *PILOT_TASKS):
        path = (FOLDER if task in TASKS else PILOT) / f"{task}{SUFFIX}"
        save_project(reference(task, whole), path, HERE / f"sample{SUFFIX}")
        print(path.name, f"{path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
