using System;
using System.Collections.Generic;
using Unity.Collections;
using UnityEngine;
using UnityEngine.Animations;
using UnityEngine.Experimental.Animations; // where the source and the order of an output still are
using UnityEngine.Playables;

namespace Metagraph
{
    /// <summary>How poses reach the figure.</summary>
    public enum PoseOutput
    {
        /// <summary>An animation job where the object has an Animator, else transforms.</summary>
        Automatic,
        /// <summary>Set transforms in LateUpdate, after all animation.</summary>
        Transforms,
        /// <summary>An animation job of the Animator, so that Animation Rigging and IK come after.</summary>
        AnimationJob,
        /// <summary>Retarget to the Animator's humanoid avatar.</summary>
        Humanoid,
    }

    /// <summary>Shows a pose each frame.</summary>
    internal interface IPoseWriter : IDisposable
    {
        /// <summary>Whether it wants the pose before animators are evaluated, in Update; else after them, in LateUpdate.</summary>
        bool Early { get; }

        void Write(BodyPose pose);
    }

    /// <summary>Sets the transforms of joints.</summary>
    internal sealed class TransformWriter : IPoseWriter
    {
        private readonly Transform[] joints;

        /// <summary>joints: of a graph, null where there is none.</summary>
        public TransformWriter(Transform[] joints)
        {
            this.joints = joints;
        }

        public bool Early
        {
            get { return false; }
        }

        public void Write(BodyPose pose)
        {
            for (int j = 0; j < joints.Length; j++)
            {
                if (joints[j] != null)
                {
                    joints[j].localRotation = UnitySpace.Rotation(pose.Rotations, j);
                    joints[j].localPosition = UnitySpace.Position(pose.Translations, j);
                }
            }
        }

        public void Dispose() { }
    }

    /// <summary>Puts a pose into an animation stream.</summary>
    public struct PoseJob : IAnimationJob
    {
        public NativeArray<TransformStreamHandle> joints;
        [ReadOnly]
        public NativeArray<Quaternion> rotations;
        [ReadOnly]
        public NativeArray<Vector3> positions;

        public void ProcessRootMotion(AnimationStream stream) { }

        public void ProcessAnimation(AnimationStream stream)
        {
            for (int n = 0; n < joints.Length; n++)
            {
                TransformStreamHandle joint = joints[n];
                joint.SetLocalRotation(stream, rotations[n]);
                joint.SetLocalPosition(stream, positions[n]);
            }
        }
    }

    /// <summary>
    /// Poses as a PlayableGraph of an Animator. It is evaluated after the Animator's controller, and before the rigs of Animation
    /// Rigging, whose output has the order 1000.
    /// </summary>
    internal sealed class PlayableWriter : IPoseWriter
    {
        public const ushort Order = 100;
        private readonly List<int> places = new List<int>(); // of the joints that the job moves
        private PlayableGraph graph;
        private NativeArray<TransformStreamHandle> handles;
        private NativeArray<Quaternion> rotations;
        private NativeArray<Vector3> positions;

        public PlayableWriter(Animator animator, Transform[] joints)
        {
            for (int j = 0; j < joints.Length; j++)
            {
                if (joints[j] != null)
                {
                    places.Add(j);
                }
            }
            handles = new NativeArray<TransformStreamHandle>(places.Count, Allocator.Persistent);
            rotations = new NativeArray<Quaternion>(places.Count, Allocator.Persistent);
            positions = new NativeArray<Vector3>(places.Count, Allocator.Persistent);
            for (int n = 0; n < places.Count; n++)
            {
                Transform joint = joints[places[n]];
                handles[n] = animator.BindStreamTransform(joint);
                rotations[n] = joint.localRotation;
                positions[n] = joint.localPosition;
            }
            graph = PlayableGraph.Create("Metagraph");
            graph.SetTimeUpdateMode(DirectorUpdateMode.GameTime);
            var job = new PoseJob { joints = handles, rotations = rotations, positions = positions };
            AnimationScriptPlayable playable = AnimationScriptPlayable.Create(graph, job);
            AnimationPlayableOutput output = AnimationPlayableOutput.Create(graph, "Metagraph", animator);
            output.SetAnimationStreamSource(AnimationStreamSource.PreviousInputs);
            output.SetSortingOrder(Order);
            output.SetSourcePlayable(playable);
            graph.Play();
        }

        public bool Early
        {
            get { return true; }
        }

        public void Write(BodyPose pose)
        {
            for (int n = 0; n < places.Count; n++)
            {
                rotations[n] = UnitySpace.Rotation(pose.Rotations, places[n]);
                positions[n] = UnitySpace.Position(pose.Translations, places[n]);
            }
        }

        public void Dispose()
        {
            if (graph.IsValid())
            {
                graph.Destroy();
            }
            if (handles.IsCreated)
            {
                handles.Dispose();
                rotations.Dispose();
                positions.Dispose();
            }
        }
    }
}
