using UnityEngine;

namespace Metagraph
{
    /// <summary>
    /// From the export's space to Unity's. glTF is right-handed, Unity left-handed: glTFast and UnityGLTF mirror the X axis when they
    /// import, so the same is done to poses.
    /// </summary>
    public static class UnitySpace
    {
        /// <summary>A joint's rotation, of rotations [J] xyzw.</summary>
        public static Quaternion Rotation(float[] rotations, int joint)
        {
            int at = 4 * joint;
            return new Quaternion(rotations[at], -rotations[at + 1], -rotations[at + 2], rotations[at + 3]);
        }

        /// <summary>A joint's position, of positions [J] xyz.</summary>
        public static Vector3 Position(float[] positions, int joint)
        {
            return new Vector3(-positions[3 * joint], positions[3 * joint + 1], positions[3 * joint + 2]);
        }
    }
}
