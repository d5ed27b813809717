"""What to do with an export: the steps for each target, and the README that stands in the export's folder."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from metagraph import __version__
from metagraph.common.wording import phrase
from metagraph.engines.targets.file_words import describe_files

README = "README.md"


@dataclass(frozen=True)
class NextSteps:
    """`steps` are what to do, in order, for people; `{stem}` is the name of the export's files. `code` is a
    first program in `language`, "" for none. `page` is the manual's page. `guide` is the page that the target
    writes itself, which then stands for the README; "" for none.
    """

    steps: tuple[str, ...]
    page: str
    language: str = ""
    code: str = ""
    guide: str = ""


STEPS: Mapping[str, NextSteps] = {
    "metagraph": NextSteps(
        (
            phrase("Load '{stem}.json' with the runtime of your language; '{stem}.glb' lies beside it."),
            phrase("Request gestures, speech and gaze, and apply the pose in each frame."),
        ),
        "engines/python",
        "python",
        'from metagraph import Character\n\ncharacter = Character("{stem}.json")\n'
        'character.ask({"do": "gesture"})\n'
        "for frame in range(150):\n    pose = character.update(frame / 30)\n"
        "    for event in character.events():\n        print(event.kind, event.action)\n",
    ),
    "web": NextSteps(
        (
            phrase("Serve this folder with any web server, for example: python3 -m http.server"),
            phrase(
                "Open the address that the server names. Scripts need a server; a double click is not enough."
            ),
        ),
        "engines/web-page",
        "html",
        '<script type="module" src="metagraph-character.js"></script>\n'
        '<metagraph-character id="me" src="{stem}.json"></metagraph-character>\n'
        "<button onclick=\"me.say('Hello!')\">Say hello</button>\n",
    ),
    "javascript": NextSteps(
        (
            phrase("Copy this folder to where your program or page can read it."),
            phrase("Import the runtime from 'metagraph/'. Its README describes three.js and all calls."),
        ),
        "engines/javascript",
        "js",
        'import { readFileSync } from "node:fs";\nimport { Character, load } from "./metagraph/index.js";\n\n'
        'const graph = load(readFileSync("{stem}.json", "utf8"), readFileSync("{stem}.glb"));\n'
        'const character = new Character(graph, { seed: 7 });\ncharacter.ask({ do: "gesture" });\n'
        "for (let now = 0; now < 5; now += 1 / 30) {\n  character.update(now);\n"
        "  for (const { kind, action } of character.events()) {\n"
        "    console.log(now.toFixed(2), kind, action);\n  }\n}\n",
    ),
    "godot": NextSteps(
        (
            phrase("Copy the contents of this folder into your Godot project."),
            phrase("Open '{stem}.tscn' and press F6: the character talks."),
            phrase("Change the requests in '{stem}.gd'. 'addons/metagraph/README.md' describes all of them."),
        ),
        "engines/godot",
        "gdscript",
        '$Performer.gesture(["greeting"])\n$Performer.say("Hello! How are you?")\n',
    ),
    "blender": NextSteps(
        (
            phrase(
                "In Blender 4.2 or later, pick the zip in Preferences > Get Extensions > Install from Disk."
            ),
            phrase("Choose File > Import > Metagraph export, and pick '{stem}.json'."),
        ),
        "engines/blender",
        guide="README.md",
    ),
    "unity-controller": NextSteps(
        (
            phrase("Open your Unity project, double-click '{stem}.unitypackage', and press Import."),
            phrase("'{stem}.unity.md' says how to set up the Animator, and lists the numbers for requests."),
        ),
        "engines/unity",
        guide="{stem}.unity.md",
    ),
    "unity": NextSteps(
        (
            phrase(
                "Copy 'Metagraph' into the Packages folder of your Unity project, and all else into Assets."
            ),
            phrase(
                "Drag the imported '{stem}.metagraph' into the scene. It is the character, with its clips."
            ),
            phrase("Press Play. Make requests from a script."),
        ),
        "engines/unity",
        "csharp",
        'character.Gesture("greeting");\ncharacter.Say("Hello! How are you?");\n',
    ),
    "cpp": NextSteps(
        (
            phrase("Put this folder on the include path of your program. The headers need only C++17."),
            phrase("Load the two files, make requests, and apply the pose in each frame."),
        ),
        "engines/cpp",
        "cpp",
        "#include <fstream>\n#include <iostream>\n#include <iterator>\n\n"
        '#include "metagraph/metagraph.hpp"\n\n'
        "std::string bytes(const char* path) {\n"
        "    std::ifstream in(path, std::ios::binary);\n"
        "    return std::string(std::istreambuf_iterator<char>(in), {});\n}\n\n"
        'int main() {\n    const std::string json = bytes("{stem}.json"), glb = bytes("{stem}.glb");\n'
        "    const auto* data = reinterpret_cast<const std::uint8_t*>(glb.data());\n"
        '    const metagraph::Loaded loaded = metagraph::load(json, data, glb.size(), "{stem}.json");\n'
        "    metagraph::Character character(loaded.graph);\n"
        '    character.ask(R"({"do": "gesture"})");\n    character.update(1.0);\n'
        '    std::cout << character.pose()[0].translation.y << "\\n";\n}\n',
    ),
    "unreal": NextSteps(
        (
            phrase("Export into the folder of your .uproject, open the project and let it build the plugin."),
            phrase("Import '{stem}.json' as a Metagraph asset and '{stem}.glb' as a skeletal mesh."),
            phrase("Give an actor the mesh and a Metagraph component with the asset. Press Play."),
        ),
        "engines/unreal",
        "cpp",
        "UMetagraphComponent* Character = Actor->FindComponentByClass<UMetagraphComponent>();\n"
        'Character->Gesture({TEXT("greeting")});\nCharacter->Say(TEXT("Hello! How are you?"));\n',
    ),
    "playcanvas": NextSteps(
        (
            phrase("Upload '{stem}.glb', and add an anim component to its entity."),
            phrase("Load '{stem}.animstategraph.json', and assign each animation to the state of its name."),
            phrase("Make requests with the numbers of '{stem}.numbers.json'."),
        ),
        "engines/playcanvas",
        "js",
        'entity.anim.setInteger("arms_stance", STANCE);  // go to a stance\n'
        'entity.anim.setInteger("arms_action", ACTION);  // play an action ...\n'
        'entity.anim.setTrigger("arms_play");  // ... once\n',
    ),
    "godot-tree": NextSteps(
        (
            phrase("Copy this folder into your Godot project."),
            phrase("Open '{stem}.tscn' and press F6: the character makes a gesture."),
            phrase("Request other states in '{stem}.gd'. '{stem}.godot.md' lists all of them."),
        ),
        "engines/godot",
        "gdscript",
        '$Tree.play("arms", "THE_NAME_OF_A_STATE")\n',
    ),
    "interactivity": NextSteps(
        (
            phrase("Load '{stem}.glb' in a viewer that supports KHR_interactivity. It plays by itself."),
            phrase("Send it the events of '{stem}.events.json'."),
        ),
        "engines/gltf-interactivity",
        "js",
        "// Babylon.js, once the GLB is in the scene\n"
        'import { FlowGraphCoordinator } from "@babylonjs/core/FlowGraph/flowGraphCoordinator.js";\n\n'
        "const [coordinator] = FlowGraphCoordinator.SceneCoordinators.get(scene);\n"
        "coordinator.notifyCustomEvent(EVENT, {});\n",
    ),
    "xstate": NextSteps(
        (
            phrase(
                "Create a machine of XState 5 from '{stem}.xstate.json', and provide 'play' and 'missed'."
            ),
            phrase("In 'play', start the animation of that name from '{stem}.glb'."),
        ),
        "engines/state-charts",
        "js",
        'import { readFileSync } from "node:fs";\nimport { createActor, createMachine } from "xstate";\n\n'
        'const chart = JSON.parse(readFileSync("{stem}.xstate.json", "utf8"));\n'
        "const play = (_, { animation, loop }) => console.log(animation, loop);\n"
        "const missed = ({ event }) => console.log(event.type, 'does not fit now');\n"
        "createActor(createMachine(chart).provide({ actions: { play, missed } })).start();\n",
    ),
    "scxml": NextSteps(
        (
            phrase("Run '{stem}.scxml' in an interpreter of SCXML."),
            phrase("Play the animation that each state names from '{stem}.glb'."),
        ),
        "engines/state-charts",
    ),
    "bml": NextSteps(
        (phrase("Send the blocks to a realizer. '{stem}.vocabulary.json' lists the names they may use."),),
        "engines/bml-systems",
    ),
    "vrm": NextSteps(
        (phrase("Load '{stem}.vrm' in a program that reads VRM 1.0."),),
        "engines/vrm",
        "js",
        'import { VRMLoaderPlugin } from "@pixiv/three-vrm";\n'
        'import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";\n\n'
        "const loader = new GLTFLoader();\nloader.register((parser) => new VRMLoaderPlugin(parser));\n"
        'const { vrm } = (await loader.loadAsync("{stem}.vrm")).userData;\nscene.add(vrm.scene);\n',
    ),
    "vrma": NextSteps(
        (
            phrase("Load an avatar in a program that plays VRM animations."),
            phrase(
                "Play a file on it. '{stem}.animations.json' says what each file is and in which stance "
                "it begins."
            ),
        ),
        "engines/vrm",
        "js",
        'import { createVRMAnimationClip, VRMAnimationLoaderPlugin } from "@pixiv/three-vrm-animation";\n'
        'import { AnimationMixer } from "three";\n'
        'import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";\n\n'
        "const loader = new GLTFLoader();\n"
        "loader.register((parser) => new VRMAnimationLoaderPlugin(parser));\n"
        "const { vrmAnimations } = (await loader.loadAsync(FILE)).userData;\n"
        "const mixer = new AnimationMixer(vrm.scene);\n"
        "mixer.clipAction(createVRMAnimationClip(vrmAnimations[0], vrm)).play();\n",
    ),
    "usd": NextSteps(
        (phrase("Open '{stem}.usda'. The variant set 'clip' chooses the clip that plays."),),
        "engines/usd",
        "python",
        "from pxr import Usd\n\n"
        'stage = Usd.Stage.Open("{stem}.usda")\n'
        'clips = stage.GetDefaultPrim().GetVariantSets().GetVariantSet("clip")\n'
        "print(clips.GetVariantNames())\n",
    ),
    "smartbody": NextSteps(
        (phrase("Load the motions of 'motions/', then run '{stem}_gestures.py'."),),
        "engines/bml-systems",
        "python",
        'scene.addAssetPath("motion", "motions")\nscene.loadAssets()\nscene.run("{stem}_gestures.py")\n',
    ),
    "sumerian": NextSteps(
        (phrase("Give 'gesture.json' to the host, and load its animations from '{stem}.glb'."),),
        "engines/bml-systems",
    ),
}


def find_next_steps(target: str) -> NextSteps:
    """Return the steps of a target. One that names none has the manual's page of all targets."""
    return STEPS.get(target, NextSteps((), "engines/index"))


def list_steps(target: str, stem: str) -> tuple[str, ...]:
    """Return what to do with an export of files called `stem`, in words."""
    return tuple(phrase(str(step), stem=stem) for step in find_next_steps(target).steps)


# Targets whose runtime plans live.
PLAYED = ("javascript", "godot", "unity", "cpp", "unreal", "metagraph")
IDLES = (
    "The preview of Metagraph plays a character that talks. Here it idles until you ask for another mode: "
    '`{"do": "mode", "mode": "talking"}`.'
)


def make_readme(
    target: str, title: str, what: str, stem: str, files: Iterable[str], losses: Sequence[str]
) -> str:
    """Return the README of an export: its files, what to do, the first lines of code, and what is lost.

    title, what: the target's title and what it writes, in words. files: names relative to the folder.
    """
    found = find_next_steps(target)
    lines = [f"# {stem}: {title}", "", f"Made by Metagraph {__version__}: {what}."]
    steps = [f"{n}. {step}" for n, step in enumerate(list_steps(target, stem), 1)]
    lines += ["", "## Steps", "", *steps] if steps else []
    if found.code:
        lines += ["", f"```{found.language}", found.code.replace("{stem}", stem).rstrip(), "```"]
    if target in PLAYED:
        lines += ["", IDLES]
    lines += ["", f"The manual's page `{found.page}` has more.", "", "## Files", "", "| File | What it is |"]
    lines += ["|---|---|"]
    lines += [f"| `{name}` | {words} |" for name, words in describe_files(target, stem, files)]
    lines += ["", "## What is lost", ""]
    lines += [f"- {loss[:1].upper()}{loss[1:]}." for loss in losses] or ["Nothing."]
    return "\n".join(lines) + "\n"
