"""The C# runtime fits Unity's types: compiled against these by name, and moved by hand; never run in the engine."""

from __future__ import annotations

import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from metagraph import __version__
from metagraph.engines.targets import registry
from tests.engines.csharp_runtime import CORE, RUNTIME, STICK, UnityStandIn, compiled, mono, needs_mono

pytestmark = needs_mono


SCENE = r"""
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using Metagraph;
using UnityEngine;

public static class Scene
{
    public static void Main(string[] args)
    {
        var actor = new MetagraphCharacter { seed = 3, transform = new Transform() };
        if (args.Length > 0)
        {
            actor.export = new TextAsset { name = "stick", text = File.ReadAllText(args[0] + ".json") };
            actor.glb = new TextAsset { bytes = File.ReadAllBytes(args[0] + ".glb") };
        }
        Graph graph = args.Length > 0 ? Graph.Load(actor.export.text, actor.glb.bytes) : null;
        foreach (JointInfo joint in graph != null ? graph.Joints : new JointInfo[0])
        {
            Component.all.Add(new Transform { name = joint.Name });
        }
        Component.all.Add(new SkinnedMeshRenderer { sharedMesh = new Mesh() });
        actor.begin.AddListener((layer, action, meta) => Console.WriteLine("begin " + layer + " " + meta));
        Call(actor, "Awake");
        Frame(actor);
        string id = actor.Gesture("no such tag");
        string[] asked =
        {
            actor.Gesture(), actor.Look(new Vector3(1, 1.5f, 2)), actor.Place("door", new Vector3(1, 1, 1)), actor.Look("door"),
            actor.Say("a \"few\" words\n"), actor.Go("nowhere"), actor.Ask("nonsense"),
        };
        for (int frame = 0; frame < 150; frame++)
        {
            Time.deltaTime = 0.02f;
            Frame(actor);
        }
        Answer unknown = actor.AnswerTo(id);
        Console.WriteLine("pieces " + actor.SayPiece("Hello").Count + " " + string.Join(" ", actor.SayPiece(" there! No", true).ToArray()));
        string[] typed =
        {
            actor.Mood("happy", 0.5f), actor.Mode("listening"), actor.Mode(null), actor.Mood("nonsense"), actor.Withdraw("nothing"), actor.Interrupt(),
        };
        for (int frame = 0; frame < 10; frame++)
        {
            Frame(actor);
        }
        Console.WriteLine("typed " + string.Join(" ", typed.Select(one => one == null ? "nothing" : actor.AnswerTo(one).State).ToArray()));
        actor.gestures = false;
        Console.WriteLine("plain " + (actor.Say("Hello there!") ?? "nothing"));
        if (graph == null)
        {
            Console.WriteLine(actor.enabled + " " + (id ?? "nothing") + " " + (unknown == null ? "nothing" : unknown.State));
            return;
        }
        Console.WriteLine(string.Join(" ", asked.Select(one => actor.AnswerTo(one).State).ToArray()));
        Console.WriteLine(actor.Character.Plan.Track.Looks[0].To.Point[0]);
        // Forward kinematics by what Unity shows; mirrored, it must be where the pose is.
        var positions = new double[3 * graph.Joints.Length];
        actor.Character.Pose().Positions(graph, positions);
        var turned = new Quat[graph.Joints.Length];
        var at = new Vec[turned.Length];
        double far = 0;
        for (int j = 0; j < turned.Length; j++)
        {
            var shown = (Transform)Component.all[j];
            int parent = graph.Joints[j].Parent;
            Quat above = parent < 0 ? Quat.Identity : turned[parent];
            Quaternion q = shown.localRotation;
            turned[j] = above * new Quat(q.x, q.y, q.z, q.w);
            at[j] = above.Rotate(new Vec(shown.localPosition.x, shown.localPosition.y, shown.localPosition.z));
            at[j] = parent < 0 ? at[j] : at[j] + at[parent];
            Vec apart = at[j] - new Vec(-positions[3 * j], positions[3 * j + 1], positions[3 * j + 2]);
            far = Math.Max(far, Math.Sqrt(Vec.Dot(apart, apart)));
        }
        Console.WriteLine(far < 1e-5 ? "mirrored" : "apart by " + far.ToString(CultureInfo.InvariantCulture));
    }

    private static void Frame(object actor)
    {
        Call(actor, "Update");
        Call(actor, "LateUpdate");
    }

    private static void Call(object actor, string method)
    {
        actor.GetType().GetMethod(method, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(actor, null);
    }
}
"""


@pytest.fixture(scope="module")
def scene(unity: UnityStandIn) -> Path:
    """A program that does to the component what the engine would."""
    program = unity.folder / "scene.cs"
    program.write_text(SCENE)
    return compiled(unity.folder / "scene.exe", program, references=unity.all)


@pytest.mark.nightly
def test_the_component_moves_joints_as_unity_shows_them(scene: Path) -> None:
    done = mono(scene, STICK / "stick")
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    states = lines[-3].split()
    assert set(states[:5]) <= {"planned", "late", "done"}
    assert states[5:] == ["refused", "refused"]
    assert float(lines[-2]) == -1  # to the right in Unity is to the left in glTF
    assert lines[-1] == "mirrored"
    assert any(line.startswith("begin arms") for line in lines)
    assert "pieces 0 said#2 said#3" in lines, "said#1 was said whole; a sentence is said once it is whole"
    typed = next(line for line in lines if line.startswith("typed")).split()[1:]
    assert set(typed[:3]) <= {"planned", "done"} and typed[3] == "refused" and typed[5] == "done", typed
    assert any(line.startswith("plain #") for line in lines), "without gestures it is a request as any other"


def test_a_component_without_its_files_says_so_and_stays_quiet(scene: Path) -> None:
    done = mono(scene)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("error: ")
    assert done.stdout.splitlines()[-3:] == [
        "typed nothing nothing nothing nothing nothing nothing",
        "plain nothing",
        "False nothing nothing",
    ]


SHARING = r"""
using System;
using System.IO;
using System.Reflection;
using Metagraph;
using UnityEngine;

public static class Sharing
{
    private static TextAsset text, bytes;

    private static MetagraphCharacter Made(TextAsset glb)
    {
        var actor = new MetagraphCharacter { seed = 3, transform = new Transform(), export = text, glb = glb };
        Call(actor, "Awake");
        return actor;
    }

    private static void Call(MetagraphCharacter actor, string name)
    {
        BindingFlags any = BindingFlags.Instance | BindingFlags.Static | BindingFlags.NonPublic;
        typeof(MetagraphCharacter).GetMethod(name, any).Invoke(actor, null);
    }

    public static void Main(string[] args)
    {
        text = new TextAsset { name = "stick", text = File.ReadAllText(args[0] + ".json") };
        bytes = new TextAsset { bytes = File.ReadAllBytes(args[0] + ".glb") };
        MetagraphCharacter broken = Made(new TextAsset { bytes = new byte[3] });
        MetagraphCharacter first = Made(bytes), second = Made(bytes), other = Made(new TextAsset { bytes = bytes.bytes });
        Console.WriteLine(broken.Character == null);
        Console.WriteLine(ReferenceEquals(first.Character.Graph, second.Character.Graph));
        Console.WriteLine(ReferenceEquals(first.Character.Graph, other.Character.Graph));
        Console.WriteLine(ReferenceEquals(first.Character, second.Character));
        Call(null, "Forget");
        Console.WriteLine(ReferenceEquals(first.Character.Graph, Made(bytes).Character.Graph));
        GC.KeepAlive(first);
    }
}
"""


@pytest.mark.nightly
def test_characters_of_the_same_assets_read_them_once(scene: Path) -> None:
    source = scene.with_name("sharing.cs")
    source.write_text(SHARING)
    references = tuple(
        scene.with_name(name) for name in ("metagraph.dll", "UnityEngine.dll", "component.dll")
    )
    program = compiled(scene.with_name("sharing.exe"), source, references=references)
    done = subprocess.run(
        ["mono", str(program), str(STICK / "stick")], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    broken, shared, other, one, after = (line == "True" for line in lines if line in ("True", "False"))
    assert broken and shared and not (other or one or after)
    assert sum(line.startswith("error") for line in lines) == 1


def test_what_the_readme_shows_compiles(scene: Path) -> None:
    shown = [block.split("```")[0] for block in (RUNTIME / "README.md").read_text().split("```csharp")[1:]]
    assert len(shown) == 5
    source = scene.with_name("readme.cs")
    inner = (
        "public static class Shown { public static void Main() { float seconds = 0; "
        + shown[1]
        + shown[2]
        + shown[3]
        + shown[4]
        + " System.Console.Write(pose); } }"
    )
    source.write_text("using UnityEngine; using System.IO; using Metagraph;\n" + shown[0] + inner)
    references = tuple(
        scene.with_name(name) for name in ("metagraph.dll", "UnityEngine.dll", "component.dll")
    )
    compiled(scene.with_name("readme.exe"), source, references=references)


ADDING = r"""
using System;
using System.Runtime.CompilerServices;
using Metagraph;
using UnityEngine;

public static class Adding
{
    public static void Main()
    {
        RuntimeHelpers.RunClassConstructor(typeof(ExportFinder).TypeHandle);
        UnityEditor.AssetDatabase.known["Assets/people/ada.metagraph"] = new MetagraphExport { name = "ada" };
        var found = new MetagraphCharacter { gameObject = new GameObject { name = "Assets/people/ada.glb" } };
        UnityEditor.ObjectFactory.Add(found);
        UnityEditor.ObjectFactory.Add(new Transform());
        Console.WriteLine(found.asset.name + " " + (found.export == null));
        var alone = new MetagraphCharacter { gameObject = new GameObject { name = "" } };
        UnityEditor.ObjectFactory.Add(alone);
        var given = new MetagraphCharacter { gameObject = found.gameObject, export = new TextAsset { name = "mine" } };
        UnityEditor.ObjectFactory.Add(given);
        Console.WriteLine((alone.asset == null) + " " + given.export.name + " " + (given.asset == null));
    }
}
"""


def test_a_component_that_is_added_finds_its_export(unity: UnityStandIn) -> None:
    """The file beside the model; what is given already stays."""
    source = unity.folder / "adding.cs"
    source.write_text(ADDING)
    program = compiled(unity.folder / "adding.exe", source, references=(*unity.all, unity.editor))
    done = mono(program)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.splitlines() == [
        "ada True",
        "True mine True",
    ]


def test_the_packages_sample_compiles(scene: Path) -> None:
    references = tuple(
        scene.with_name(name) for name in ("metagraph.dll", "UnityEngine.dll", "component.dll")
    )
    sample = RUNTIME / "Samples~" / "Talking" / "Greeter.cs"
    compiled(scene.with_name("sample.dll"), sample, references=references)


def test_the_package_is_laid_out_as_unity_asks() -> None:
    """https://docs.unity3d.com/Manual/cus-layout.html: the folders, each with an assembly, and the pages."""
    package = json.loads((RUNTIME / "package.json").read_bytes())
    assert package["unity"] == "2021.3" and package["version"] == __version__
    assert re.fullmatch(r"[a-z0-9]+(\.[a-z0-9-]+){2,}", package["name"])
    assert all((RUNTIME / sample["path"]).is_dir() for sample in package["samples"])
    for page in (
        "README.md",
        "CHANGELOG.md",
        "LICENSE.md",
        "Third Party Notices.md",
        "Documentation~/index.md",
    ):
        assert (RUNTIME / page).stat().st_size
    changes = (RUNTIME / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{__version__}]" in changes
    assemblies = {path.parent: json.loads(path.read_bytes()) for path in RUNTIME.rglob("*.asmdef")}
    names = {each["name"] for each in assemblies.values()}
    assert len(names) == len(assemblies) == 5
    for source in RUNTIME.rglob("*.cs"):
        assert len([folder for folder in source.parents if folder in assemblies]) == 1, source
    for folder, each in assemblies.items():
        assert set(each["references"]) <= names
        within = folder.relative_to(RUNTIME).parts[0]
        assert (each.get("includePlatforms") == ["Editor"]) == (within in ("Editor", "Tests"))
    assert assemblies[RUNTIME / "Runtime" / "Core"]["noEngineReferences"]
    assert not any("UnityEngine" in path.read_text() for path in CORE)


def test_every_file_of_the_exported_package_has_an_id_that_stays(toy: Any, tmp_path: Path) -> None:
    """A component in somebody's scene is known by the id of its script."""
    metas: list[dict[str, str]] = []
    for name in ("first", "second"):
        project = replace(toy.project(), name=name)
        registry.write_for_target(project, "unity", tmp_path / name)
        package = tmp_path / name / "Metagraph"
        seen = {
            path.relative_to(package).as_posix(): path
            for path in package.rglob("*")
            if not any(part.endswith("~") for part in path.relative_to(package).parts)
        }
        assert {f for f in seen if not f.endswith(".meta")} == {f[:-5] for f in seen if f.endswith(".meta")}
        texts = {file: path.read_text() for file, path in seen.items() if file.endswith(".meta")}
        assert all(isinstance(yaml.safe_load(text)["guid"], str | int) for text in texts.values())
        metas.append({file: text.split("guid: ")[1][:32] for file, text in texts.items()})
    assert metas[0] == metas[1]
    assert len(set(metas[0].values())) == len(metas[0])
