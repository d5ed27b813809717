// Stand-ins for the types of Unity that the package uses: names and signatures are Unity's, and they do what tests look at.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    using UnityEngine.Animations;
    public struct Vector3 { public float x, y, z; public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; } }
    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }
    public class Object
    {
        public string name { get; set; } = "";
        public HideFlags hideFlags;
        public static readonly List<Object> destroyed = new List<Object>();
        public static void Destroy(Object one) { destroyed.Add(one); }
        public static void DestroyImmediate(Object one)
        {
            var component = (Component)one;
            component.gameObject.components.Remove(component);
        }
        public static T Instantiate<T>(T one) where T : Object { return one; }
        public static bool operator ==(Object a, Object b) { return ReferenceEquals(a, b); }
        public static bool operator !=(Object a, Object b) { return !ReferenceEquals(a, b); }
        public override bool Equals(object other) { return ReferenceEquals(this, other); }
        public override int GetHashCode() { return 0; }
    }
    public enum HideFlags { None, HideAndDontSave = 61 }
    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject, new() { return new T(); }
    }
    public class TextAsset : Object { public string text = ""; public byte[] bytes = new byte[0]; }
    public class Mesh : Object
    {
        public List<string> shapes = new List<string>();
        public int GetBlendShapeIndex(string name) { return shapes.IndexOf(name); }
        public int GetBlendShapeFrameCount(int shape) { return 1; }
        public float GetBlendShapeFrameWeight(int shape, int frame) { return 100f; }
    }
    public sealed class GameObject : Object
    {
        public readonly List<Component> components = new List<Component>();
        public readonly Transform transform;
        public GameObject() : this("") { }
        public GameObject(string name) { this.name = name; transform = AddComponent<Transform>(); }
        public T AddComponent<T>() where T : Component, new()
        {
            var made = new T { gameObject = this };
            components.Add(made);
            made.transform = transform ?? made as Transform;
            made.name = name;
            return made;
        }
        public T GetComponent<T>() where T : class { return components.Find(c => c is T) as T; }
    }
    public sealed class RequireComponent : Attribute { public RequireComponent(Type type) { } }
    public class Component : Object
    {
        public GameObject gameObject;
        public T GetComponent<T>() where T : class { return gameObject != null ? gameObject.GetComponent<T>() : all.Find(c => c is T) as T; }
        public static List<Component> all = new List<Component>();
        public Transform transform;
        public T[] GetComponentsInChildren<T>(bool inactive) where T : class
        {
            if (gameObject != null)
            {
                var found = new List<T>();
                Gather(transform, found);
                return found.ToArray();
            }
            return all.FindAll(c => c is T).ConvertAll(c => (T)(object)c).ToArray();
        }
        private static void Gather<T>(Transform from, List<T> found) where T : class
        {
            foreach (Component one in from.gameObject.components)
            {
                if (one is T) { found.Add((T)(object)one); }
            }
            from.children.ForEach(child => Gather(child, found));
        }
    }
    public class Transform : Component
    {
        public Transform parent;
        public readonly List<Transform> children = new List<Transform>();
        public void SetParent(Transform to, bool stay) { parent = to; to.children.Add(this); }
        public Quaternion localRotation;
        public Vector3 localPosition;
        public Vector3 InverseTransformPoint(Vector3 world) { return world; }
    }
    public class Animation : Behaviour { }
    public class Animator : Behaviour
    {
        public Avatar avatar;
        public TransformStreamHandle BindStreamTransform(Transform one) { return new TransformStreamHandle { bound = one }; }
    }
    public class SkinnedMeshRenderer : Component
    {
        public Mesh sharedMesh;
        public Dictionary<int, float> weights = new Dictionary<int, float>();
        public void SetBlendShapeWeight(int index, float value) { weights[index] = value; }
    }
    public class Behaviour : Component { public bool enabled = true; }
    public class MonoBehaviour : Behaviour { }
    public static class Time { public static float deltaTime; }
    public static class Application { public static string streamingAssetsPath = ""; }
    public class Avatar : Object
    {
        public HumanDescription description;
        public bool isHuman = true, isValid = true;
    }
    public struct HumanLimit { public bool useDefaultValues; }
    public struct HumanBone { public string humanName, boneName; public HumanLimit limit; }
    public struct SkeletonBone { public string name; public Vector3 position, scale; public Quaternion rotation; }
    public struct HumanDescription
    {
        public HumanBone[] human;
        public SkeletonBone[] skeleton;
        public float upperArmTwist, lowerArmTwist, upperLegTwist, lowerLegTwist, armStretch, legStretch, feetSpacing;
        public bool hasTranslationDoF;
    }
    public static class AvatarBuilder
    {
        public static Avatar BuildHumanAvatar(GameObject root, HumanDescription described)
        {
            return new Avatar { description = described, isValid = Array.Exists(described.human, bone => bone.humanName == "Hips") };
        }
    }
    public struct HumanPose { public Transform source; }
    public sealed class HumanPoseHandler : IDisposable
    {
        public static readonly List<Transform> carried = new List<Transform>(); // from and to, in turn
        private readonly Transform root;
        public HumanPoseHandler(Avatar avatar, Transform root) { this.root = root; }
        public void GetHumanPose(ref HumanPose pose) { pose.source = root; }
        public void SetHumanPose(ref HumanPose pose) { carried.Add(pose.source); carried.Add(root); }
        public void Dispose() { }
    }
    public struct Keyframe
    {
        public float time, value, inTangent, outTangent;
        public Keyframe(float time, float value, float into, float away) { this.time = time; this.value = value; inTangent = into; outTangent = away; }
    }
    public sealed class AnimationCurve
    {
        public readonly Keyframe[] keys;
        public AnimationCurve(params Keyframe[] keys) { this.keys = keys; }
    }
    public sealed class AnimationClip : Object
    {
        public float frameRate = 60;
        public bool continuous, loops;
        public readonly Dictionary<string, AnimationCurve> curves = new Dictionary<string, AnimationCurve>();
        public void EnsureQuaternionContinuity() { continuous = true; }
    }
    public sealed class HideInInspector : Attribute { }
    public static class Debug
    {
        public static void Log(object message) { Console.WriteLine(message); }
        public static void LogWarning(object message, Object context) { Console.WriteLine("warning: " + message); }
        public static void LogError(object message, Object context) { Console.WriteLine("error: " + message); }
    }
    public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }
    public enum RuntimeInitializeLoadType { SubsystemRegistration }
    public sealed class RuntimeInitializeOnLoadMethodAttribute : Attribute
    {
        public RuntimeInitializeOnLoadMethodAttribute(RuntimeInitializeLoadType when) { }
    }
    public sealed class DisallowMultipleComponent : Attribute { }
    public sealed class AddComponentMenu : Attribute { public AddComponentMenu(string name) { } }
}

namespace UnityEngine.Events
{
    public abstract class UnityEvent<A, B, C>
    {
        private Action<A, B, C> listeners = (a, b, c) => { };
        public void AddListener(Action<A, B, C> listener) { listeners += listener; }
        public void Invoke(A a, B b, C c) { listeners(a, b, c); }
    }
}

namespace Unity.Collections
{
    public enum Allocator { Persistent = 4 }
    public sealed class ReadOnlyAttribute : Attribute { }
    public struct NativeArray<T> where T : struct
    {
        private T[] items;
        public static int open;
        public NativeArray(int length, Allocator allocator) { items = new T[length]; open++; }
        public int Length { get { return items.Length; } }
        public bool IsCreated { get { return items != null; } }
        public T this[int place] { get { return items[place]; } set { items[place] = value; } }
        public void Dispose() { items = null; open--; }
    }
}

namespace UnityEngine.Animations
{
    using UnityEngine.Playables;

    public struct AnimationStream { }
    public struct TransformStreamHandle
    {
        public Transform bound;
        public void SetLocalRotation(AnimationStream stream, Quaternion turn) { bound.localRotation = turn; }
        public void SetLocalPosition(AnimationStream stream, Vector3 place) { bound.localPosition = place; }
    }
    public interface IAnimationJob
    {
        void ProcessRootMotion(AnimationStream stream);
        void ProcessAnimation(AnimationStream stream);
    }
    public struct AnimationScriptPlayable
    {
        public IAnimationJob job;
        public static AnimationScriptPlayable Create<T>(PlayableGraph graph, T job) where T : struct, IAnimationJob
        {
            return new AnimationScriptPlayable { job = job };
        }
    }
    public struct AnimationPlayableOutput
    {
        public static AnimationPlayableOutput Create(PlayableGraph graph, string name, Animator target) { return new AnimationPlayableOutput(); }
    }
}

namespace UnityEngine.Playables
{
    public enum DirectorUpdateMode { DSPClock, GameTime }
    public struct PlayableGraph
    {
        public static readonly List<UnityEngine.Animations.IAnimationJob> jobs = new List<UnityEngine.Animations.IAnimationJob>();
        public static int playing;
        private bool valid;
        public static PlayableGraph Create(string name) { return new PlayableGraph { valid = true }; }
        public void SetTimeUpdateMode(DirectorUpdateMode mode) { }
        public void Play() { playing++; }
        public bool IsValid() { return valid; }
        public void Destroy() { playing--; valid = false; }
        /// What Unity does to all graphs between Update and LateUpdate.
        public static void Evaluate() { jobs.ForEach(job => job.ProcessAnimation(new UnityEngine.Animations.AnimationStream())); }
    }
}

namespace UnityEngine.Experimental.Animations
{
    using UnityEngine.Animations;
    using UnityEngine.Playables;

    public enum AnimationStreamSource { DefaultValues, PreviousInputs }
    public static class AnimationPlayableOutputExtensions
    {
        public static AnimationStreamSource source;
        public static int order;
        public static void SetAnimationStreamSource(this AnimationPlayableOutput output, AnimationStreamSource from) { source = from; }
        public static void SetSortingOrder(this AnimationPlayableOutput output, ushort place) { order = place; }
        public static void SetSourcePlayable(this AnimationPlayableOutput output, AnimationScriptPlayable playable) { PlayableGraph.jobs.Add(playable.job); }
    }
}
