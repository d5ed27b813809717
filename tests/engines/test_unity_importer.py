"""Unity's importer, animation job and humanoid retargeting, moved by stand-ins: none of it ran in Unity."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.engines.targets.unity_humanoid import spell_human_bone, write_humanoid
from metagraph.formats.store import open_project
from metagraph.graph.model import Project
from tests.engines.csharp_runtime import STICK, UnityStandIn, compiled, mono, needs_mono

IMPORTING = r"""
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using Metagraph;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;
using UnityEngine.Animations;
using UnityEngine.Experimental.Animations;
using UnityEngine.Playables;

public static class Importing
{
    private static Graph graph;

    // What glTFast makes of the GLB: an object for each joint, and a mesh.
    private static GameObject Model()
    {
        var root = new GameObject("model");
        root.AddComponent<Animation>();
        var joints = new List<Transform>();
        foreach (JointInfo joint in graph.Joints)
        {
            Transform made = new GameObject(joint.Name).transform;
            made.SetParent(joint.Parent < 0 ? root.transform : joints[joint.Parent], false);
            joints.Add(made);
        }
        return root;
    }

    private static void Call(object actor, string method)
    {
        actor.GetType().GetMethod(method, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(actor, null);
    }

    private static void Frame(MetagraphCharacter actor)
    {
        Time.deltaTime = 0.02f;
        Call(actor, "Update");
        PlayableGraph.Evaluate();
        Call(actor, "LateUpdate");
    }

    private static double Apart(MetagraphCharacter actor, Func<int, Transform> shown)
    {
        BodyPose pose = actor.Character.Pose(actor.alive);
        double far = 0;
        for (int j = 0; j < graph.Joints.Length; j++)
        {
            Transform joint = shown(j);
            Quaternion q = joint.localRotation;
            far = Math.Max(far, Math.Abs(q.x - pose.Rotations[4 * j]) + Math.Abs(q.y + pose.Rotations[4 * j + 1]));
            far = Math.Max(far, Math.Abs(q.z + pose.Rotations[4 * j + 2]) + Math.Abs(q.w - pose.Rotations[4 * j + 3]));
            far = Math.Max(far, Math.Abs(joint.localPosition.x + pose.Translations[3 * j]));
            far = Math.Max(far, Math.Abs(joint.localPosition.y - pose.Translations[3 * j + 1]));
        }
        return far;
    }

    public static int Main(string[] args)
    {
        string path = args[0];
        var context = new AssetImportContext { assetPath = path };
        var importer = new MetagraphImporter();
        if (args.Length > 1)
        {
            importer.OnImportAsset(context);
            context.told.ForEach(Console.WriteLine);
            return 0;
        }
        graph = Graph.Load(File.ReadAllText(Path.ChangeExtension(path, ".json")), File.ReadAllBytes(path), "stick");
        string model = MetagraphImporter.GatherDependenciesFromSourceFile(path).Single();
        AssetDatabase.known[model] = Model();
        importer.OnImportAsset(context);
        context.told.ForEach(Console.WriteLine);
        var figure = (GameObject)context.main;
        var character = figure.GetComponent<MetagraphCharacter>();
        Console.WriteLine("alone " + (figure.GetComponent<Animation>() == null));
        Console.WriteLine("main " + figure.name + " " + ReferenceEquals(character.asset, context.made["export"]));
        Console.WriteLine("needs " + string.Join(" ", context.needs.Select(Path.GetFileName).ToArray()));

        List<AnimationClip> clips = context.made.Values.OfType<AnimationClip>().ToList();
        double off = 0;
        int looping = 0;
        foreach (ClipEntry entry in graph.Clips.Values.Where(entry => entry.Motion != null))
        {
            AnimationClip clip = clips.Single(one => one.name == entry.Name);
            looping += clip.loops ? 1 : 0;
            string joint = "";
            for (int j = 0; j < graph.Joints.Length; j = graph.Joints.ToList().FindIndex(one => one.Parent == j))
            {
                joint += (j > 0 ? "/" : "") + graph.Joints[j].Name;
                AnimationCurve turn = clip.curves[joint + ":m_LocalRotation.y"];
                foreach (Keyframe key in turn.keys)
                {
                    int frame = (int)Math.Round(key.time * entry.Motion.Fps);
                    off = Math.Max(off, Math.Abs(key.value + entry.Motion.Rotations[4 * (frame * entry.Motion.Joints + j) + 1]));
                }
                if (!graph.Joints.Any(one => one.Parent == j))
                {
                    break;
                }
            }
            off = Math.Max(off, Math.Abs(clip.frameRate - Math.Round(clip.frameRate)));
        }
        Console.WriteLine("clips " + (clips.Count == graph.Clips.Count) + " " + (looping > 0 && looping < clips.Count) + " " + (off < 1e-4));

        // A job, where there is an Animator.
        figure.AddComponent<Animator>();
        Call(character, "Awake");
        character.Gesture();
        for (int n = 0; n < 100; n++)
        {
            Frame(character);
        }
        Transform[] below = figure.transform.GetComponentsInChildren<Transform>(true);
        Func<int, Transform> shown = j => below.First(one => one.name == graph.Joints[j].Name);
        Console.WriteLine("job " + PlayableGraph.playing + " " + (Apart(character, shown) < 1e-5)
            + " " + AnimationPlayableOutputExtensions.source + " " + AnimationPlayableOutputExtensions.order);
        Call(character, "OnDestroy");
        Console.WriteLine("left " + PlayableGraph.playing + " " + Unity.Collections.NativeArray<Quaternion>.open);
        PlayableGraph.jobs.Clear();

        // Another figure, a humanoid: a hidden skeleton takes the pose, and the muscles carry it over.
        var other = new GameObject("other");
        other.AddComponent<Animator>().avatar = new Avatar();
        var carried = other.AddComponent<MetagraphCharacter>();
        carried.asset = character.asset;
        carried.output = PoseOutput.Humanoid;
        Call(carried, "Awake");
        if (carried.Character == null)
        {
            return 0;
        }
        for (int n = 0; n < 10; n++)
        {
            Frame(carried);
        }
        Transform hidden = HumanPoseHandler.carried[0];
        Transform[] joints = hidden.GetComponentsInChildren<Transform>(true);
        Func<int, Transform> within = j => joints.First(one => one.name == graph.Joints[j].Name);
        Console.WriteLine("humanoid " + (HumanPoseHandler.carried.Count / 2) + " " + ReferenceEquals(HumanPoseHandler.carried[1], other.transform)
            + " " + (Apart(carried, within) < 1e-5) + " " + hidden.gameObject.hideFlags);
        Call(carried, "OnDestroy");
        Console.WriteLine("destroyed " + UnityEngine.Object.destroyed.Count);
        return 0;
    }
}
"""


@pytest.fixture(scope="module")
def importing(unity: UnityStandIn) -> Path:
    source = unity.folder / "importing.cs"
    source.write_text(IMPORTING)
    return compiled(unity.folder / "importing.exe", source, references=(*unity.all, unity.editor))


@pytest.fixture
def export(tmp_path: Path) -> Path:
    """An export as it lies in somebody's Assets."""
    shutil.copy(STICK / "stick.json", tmp_path)
    return Path(shutil.copy(STICK / "stick.glb", tmp_path / "stick.metagraph"))


@needs_mono
def test_the_importer_makes_a_character_and_clips_and_a_job_shows_its_poses(
    importing: Path, export: Path
) -> None:
    done = mono(importing, export)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.splitlines() == [
        "alone True",
        "main stick True",
        "needs stick.json stick.glb",
        "clips True True True",
        "job 1 True PreviousInputs 100",
        "left 0 0",
        "error: stick: is not a humanoid. Choose another Output, or assign the joints in Metagraph.",
    ]


@needs_mono
def test_poses_are_carried_over_to_a_humanoid(importing: Path, export: Path) -> None:
    joints = json.loads((STICK / "stick.json").read_bytes())["joints"]
    count = len(joints)
    bones = {"Hips": joints[0]["name"]}
    made = {"bones": bones, "rotations": [0, 0, 0, 1] * count, "translations": [0, 0.1, 0] * count}
    export.with_name("stick.humanoid.json").write_text(json.dumps(made))
    done = mono(importing, export)
    assert done.returncode == 0, done.stdout + done.stderr
    *_, carried, gone = done.stdout.splitlines()
    assert carried == "humanoid 10 True True HideAndDontSave"
    assert gone == "destroyed 2"


@needs_mono
def test_the_importer_says_what_is_wrong(importing: Path, export: Path) -> None:
    export.with_suffix(".json").unlink()
    assert "stick.json does not lie beside it" in mono(importing, export, "only").stdout
    export.with_suffix(".json").write_bytes((STICK / "stick.json").read_bytes())
    assert "stick.glb is not imported" in mono(importing, export, "only").stdout
    export.write_bytes(b"no GLB")
    assert mono(importing, export, "only").stdout.startswith("error: ")


def test_an_export_names_the_bones_of_a_humanoid_as_unity_does(few: Path) -> None:
    project = open_project(few).project
    written = write_humanoid(project)
    assert written is not None and project.skeleton is not None
    found = json.loads(written)
    assert found["bones"].items() >= {
        "Hips": "Hips", "LeftUpperArm": "LeftUpperArm", "Left Thumb Proximal": "LeftThumb1",
        "Right Little Distal": "RightLittle3", "RightToes": "RightToes",
    }.items()  # fmt: skip
    assert {*found["bones"].values()} <= {*project.skeleton.names}
    turns = np.reshape(found["rotations"], (-1, 4))
    assert len(turns) == len(project.skeleton) and np.abs(np.linalg.norm(turns, axis=1) - 1).max() < 1e-4
    assert spell_human_bone("leftThumbProximal") == "Left Thumb Intermediate"


def test_a_figure_that_is_no_humanoid_has_no_bones(toy: object) -> None:
    project: Project = toy.project()  # type: ignore[attr-defined]
    assert write_humanoid(replace(project, roles={"left_foot": ""})) is None
