using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>Which joint is which bone of Unity's humanoid, and the T pose: local rotations [J] xyzw and translations [J] xyz.</summary>
    public sealed class HumanoidBones
    {
        /// <summary>The bone as Unity calls it -> the joint's name.</summary>
        public readonly Dictionary<string, string> Bones = new Dictionary<string, string>();
        public readonly float[] Rotations, Translations;

        /// <summary>Read the export's file .humanoid.json. Throws MetagraphException.</summary>
        public HumanoidBones(string json, int joints)
        {
            var read = new Node(Json.Parse(json), "humanoid");
            foreach (string bone in read["bones"].Names)
            {
                Bones[bone] = read["bones"][bone].Text;
            }
            Rotations = Array.ConvertAll(read["rotations"].Numbers(4 * joints), value => (float)value);
            Translations = Array.ConvertAll(read["translations"].Numbers(3 * joints), value => (float)value);
        }
    }
}
