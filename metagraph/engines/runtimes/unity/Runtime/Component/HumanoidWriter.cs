using System.Collections.Generic;
using UnityEngine;

namespace Metagraph
{
    /// <summary>
    /// Poses on any humanoid avatar. A hidden skeleton of the export's joints takes the pose, and Unity's muscles carry it over.
    /// </summary>
    internal sealed class HumanoidWriter : IPoseWriter
    {
        private readonly GameObject root;
        private readonly Avatar avatar;
        private readonly TransformWriter shown;
        private readonly HumanPoseHandler from, to;
        private HumanPose pose;

        /// <summary>humanoid: bones and T pose, as the export has them. Throws MetagraphException.</summary>
        public HumanoidWriter(Graph graph, string humanoid, Animator target)
        {
            if (string.IsNullOrEmpty(humanoid))
            {
                throw new MetagraphException(graph.Name, "is not a humanoid", "Choose another Output, or assign the joints in Metagraph.");
            }
            if (target == null || target.avatar == null || !target.avatar.isHuman)
            {
                const string remedy = "Import the model with the rig Humanoid, or choose another Output.";
                throw new MetagraphException(graph.Name, "finds no Animator with a humanoid avatar", remedy);
            }
            root = new GameObject("Metagraph humanoid") { hideFlags = HideFlags.HideAndDontSave };
            var joints = new Transform[graph.Joints.Length];
            HumanDescription described = Describe(graph, new HumanoidBones(humanoid, joints.Length), joints);
            avatar = AvatarBuilder.BuildHumanAvatar(root, described);
            if (!avatar.isValid)
            {
                Dispose();
                throw new MetagraphException(graph.Name, "makes no humanoid avatar", "Unity's log says which bone it lacks.");
            }
            shown = new TransformWriter(joints);
            from = new HumanPoseHandler(avatar, root.transform);
            to = new HumanPoseHandler(target.avatar, target.transform);
        }

        public bool Early
        {
            get { return false; }
        }

        public void Write(BodyPose body)
        {
            shown.Write(body);
            from.GetHumanPose(ref pose);
            to.SetHumanPose(ref pose);
        }

        public void Dispose()
        {
            if (from != null)
            {
                from.Dispose();
                to.Dispose();
            }
            Object.Destroy(avatar);
            Object.Destroy(root);
        }

        /// <summary>Make the joints below the root, in the T pose, and say which is which bone.</summary>
        private HumanDescription Describe(Graph graph, HumanoidBones found, Transform[] joints)
        {
            var bones = new List<SkeletonBone> { Bone(root.transform) };
            for (int j = 0; j < joints.Length; j++)
            {
                int parent = graph.Joints[j].Parent;
                joints[j] = new GameObject(graph.Joints[j].Name).transform;
                joints[j].SetParent(parent < 0 ? root.transform : joints[parent], false);
                joints[j].localRotation = UnitySpace.Rotation(found.Rotations, j);
                joints[j].localPosition = UnitySpace.Position(found.Translations, j);
                bones.Add(Bone(joints[j]));
            }
            var human = new List<HumanBone>();
            foreach (KeyValuePair<string, string> one in found.Bones)
            {
                human.Add(new HumanBone { humanName = one.Key, boneName = one.Value, limit = new HumanLimit { useDefaultValues = true } });
            }
            return new HumanDescription
            {
                human = human.ToArray(), skeleton = bones.ToArray(), upperArmTwist = 0.5f, lowerArmTwist = 0.5f,
                upperLegTwist = 0.5f, lowerLegTwist = 0.5f, armStretch = 0.05f, legStretch = 0.05f, feetSpacing = 0,
                hasTranslationDoF = false,
            };
        }

        private static SkeletonBone Bone(Transform joint)
        {
            return new SkeletonBone
            {
                name = joint.name, position = joint.localPosition, rotation = joint.localRotation, scale = new Vector3(1, 1, 1),
            };
        }
    }
}
