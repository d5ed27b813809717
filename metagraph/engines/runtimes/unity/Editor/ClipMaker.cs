using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace Metagraph
{
    /// <summary>Makes AnimationClips of an export's clips, for the objects below a figure.</summary>
    public sealed class ClipMaker
    {
        private static readonly string[] Turns = { "m_LocalRotation.x", "m_LocalRotation.y", "m_LocalRotation.z", "m_LocalRotation.w" };
        private static readonly string[] Places = { "m_LocalPosition.x", "m_LocalPosition.y", "m_LocalPosition.z" };
        private const float Off = 1e-4f; // a curve that moves less stands still

        private readonly Graph graph;
        private readonly string[] paths; // of joints
        private readonly HashSet<ClipEntry> looping = new HashSet<ClipEntry>();
        private readonly List<KeyValuePair<string, Mesh>> faces = new List<KeyValuePair<string, Mesh>>();

        public ClipMaker(Graph graph, Transform figure)
        {
            this.graph = graph;
            var below = new Dictionary<string, string>();
            foreach (Transform one in figure.GetComponentsInChildren<Transform>(true))
            {
                if (!below.ContainsKey(one.name))
                {
                    below[one.name] = AnimationUtility.CalculateTransformPath(one, figure);
                }
            }
            paths = new string[graph.Joints.Length];
            for (int j = 0; j < paths.Length; j++)
            {
                JointInfo joint = graph.Joints[j];
                if (!below.TryGetValue(joint.Name, out paths[j]))
                {
                    paths[j] = joint.Parent < 0 ? joint.Name : paths[joint.Parent] + "/" + joint.Name;
                }
            }
            foreach (SkinnedMeshRenderer face in figure.GetComponentsInChildren<SkinnedMeshRenderer>(true))
            {
                if (face.sharedMesh != null)
                {
                    string path = AnimationUtility.CalculateTransformPath(face.transform, figure);
                    faces.Add(new KeyValuePair<string, Mesh>(path, face.sharedMesh));
                }
            }
            foreach (LayerGraph layer in graph.Layers.Values)
            {
                foreach (GraphAction action in layer.Actions.Values)
                {
                    if (action.Kind == "stance")
                    {
                        looping.Add(action.Clip);
                    }
                }
            }
        }

        /// <summary>Make the clip, at a whole number of frames a second. Clips of stances loop.</summary>
        public AnimationClip Make(ClipEntry entry)
        {
            Clip motion = entry.Motion;
            var made = new AnimationClip { name = entry.Name, frameRate = Math.Max(1, (int)Math.Round(motion.Fps)) };
            for (int j = 0; j < paths.Length; j++)
            {
                int joint = j;
                Add(made, paths[j], Turns, motion, f => UnitySpace.Rotation(motion.Rotations, f * motion.Joints + joint));
            }
            for (int t = 0; t < motion.Translated.Length; t++)
            {
                int place = t;
                Add(made, paths[motion.Translated[t]], motion, f => UnitySpace.Position(motion.Translations, f * motion.Translated.Length + place));
            }
            for (int k = 0; k < motion.Morphs.Length; k++)
            {
                AddShape(made, motion, k);
            }
            made.EnsureQuaternionContinuity();
            AnimationClipSettings settings = AnimationUtility.GetAnimationClipSettings(made);
            settings.loopTime = looping.Contains(entry);
            AnimationUtility.SetAnimationClipSettings(made, settings);
            return made;
        }

        private static void Add(AnimationClip made, string path, string[] names, Clip motion, Func<int, Quaternion> at)
        {
            var values = new float[4][];
            for (int c = 0; c < 4; c++)
            {
                values[c] = new float[motion.Frames];
            }
            for (int f = 0; f < motion.Frames; f++)
            {
                Quaternion q = at(f);
                values[0][f] = q.x;
                values[1][f] = q.y;
                values[2][f] = q.z;
                values[3][f] = q.w;
            }
            AddCurves(made, path, typeof(Transform), names, values, motion.Fps);
        }

        private static void Add(AnimationClip made, string path, Clip motion, Func<int, Vector3> at)
        {
            var values = new float[3][];
            for (int c = 0; c < 3; c++)
            {
                values[c] = new float[motion.Frames];
            }
            for (int f = 0; f < motion.Frames; f++)
            {
                Vector3 place = at(f);
                values[0][f] = place.x;
                values[1][f] = place.y;
                values[2][f] = place.z;
            }
            AddCurves(made, path, typeof(Transform), Places, values, motion.Fps);
        }

        private void AddShape(AnimationClip made, Clip motion, int column)
        {
            string shape = graph.Morphs[motion.Morphs[column]];
            foreach (KeyValuePair<string, Mesh> face in faces)
            {
                int index = face.Value.GetBlendShapeIndex(shape);
                if (index < 0)
                {
                    continue;
                }
                float full = face.Value.GetBlendShapeFrameWeight(index, face.Value.GetBlendShapeFrameCount(index) - 1);
                var values = new float[motion.Frames];
                for (int f = 0; f < motion.Frames; f++)
                {
                    values[f] = motion.Weights[f * motion.Morphs.Length + column] * full;
                }
                string[] names = { "blendShape." + shape };
                AddCurves(made, face.Key, typeof(SkinnedMeshRenderer), names, new[] { values }, motion.Fps);
            }
        }

        /// <summary>Add curves that belong together: with a key for each frame, or one where all stand still.</summary>
        private static void AddCurves(AnimationClip made, string path, Type type, string[] names, float[][] values, double fps)
        {
            bool still = true;
            foreach (float[] row in values)
            {
                foreach (float value in row)
                {
                    still &= Math.Abs(value - row[0]) <= Off;
                }
            }
            for (int c = 0; c < names.Length; c++)
            {
                var keys = new Keyframe[still ? Math.Min(2, values[c].Length) : values[c].Length];
                for (int n = 0; n < keys.Length; n++)
                {
                    int frame = still ? n * (values[c].Length - 1) : n;
                    keys[n] = new Keyframe(
                        (float)(frame / fps), values[c][frame], Slope(values[c], frame - 1, still, fps), Slope(values[c], frame, still, fps));
                }
                var curve = new AnimationCurve(keys);
                AnimationUtility.SetEditorCurve(made, EditorCurveBinding.FloatCurve(path, type, names[c]), curve);
            }
        }

        /// <summary>The slope of the straight line behind a frame.</summary>
        private static float Slope(float[] values, int frame, bool still, double fps)
        {
            bool inside = !still && frame >= 0 && frame < values.Length - 1;
            return inside ? (float)((values[frame + 1] - values[frame]) * fps) : 0;
        }
    }
}
