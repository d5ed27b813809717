// Stand-ins for the types of Unity's editor that the package uses.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace UnityEditor
{
    public sealed class InitializeOnLoadAttribute : Attribute { }
    public static class ObjectFactory
    {
        public static event Action<Component> componentWasAdded;
        public static void Add(Component one) { componentWasAdded(one); }
    }
    public static class PrefabUtility
    {
        public static string GetPrefabAssetPathOfNearestInstanceRoot(UnityEngine.Object one) { return one.name; }
    }
    public static class AssetDatabase
    {
        public static readonly Dictionary<string, UnityEngine.Object> known = new Dictionary<string, UnityEngine.Object>();
        public static T LoadAssetAtPath<T>(string path) where T : UnityEngine.Object
        {
            UnityEngine.Object found;
            return known.TryGetValue(path.Replace('\\', '/'), out found) ? found as T : null;
        }
    }
    public struct EditorCurveBinding
    {
        public string path, property;
        public Type type;
        public static EditorCurveBinding FloatCurve(string path, Type type, string property)
        {
            return new EditorCurveBinding { path = path, type = type, property = property };
        }
    }
    public sealed class AnimationClipSettings { public bool loopTime; }
    public static class AnimationUtility
    {
        public static string CalculateTransformPath(Transform one, Transform root)
        {
            if (ReferenceEquals(one, root)) { return ""; }
            string above = CalculateTransformPath(one.parent, root);
            return above == "" ? one.name : above + "/" + one.name;
        }
        public static void SetEditorCurve(AnimationClip clip, EditorCurveBinding at, AnimationCurve curve)
        {
            clip.curves.Add(at.path + ":" + at.property, curve);
        }
        public static AnimationClipSettings GetAnimationClipSettings(AnimationClip clip) { return new AnimationClipSettings(); }
        public static void SetAnimationClipSettings(AnimationClip clip, AnimationClipSettings settings) { clip.loops = settings.loopTime; }
    }
}

namespace UnityEditor.AssetImporters
{
    public sealed class ScriptedImporterAttribute : Attribute { public ScriptedImporterAttribute(int version, string extension) { } }
    public abstract class ScriptedImporter : UnityEngine.Object { public abstract void OnImportAsset(AssetImportContext context); }
    public sealed class AssetImportContext
    {
        public string assetPath;
        public UnityEngine.Object main;
        public readonly List<string> told = new List<string>(), needs = new List<string>();
        public readonly Dictionary<string, UnityEngine.Object> made = new Dictionary<string, UnityEngine.Object>();
        public void DependsOnSourceAsset(string path) { needs.Add(path); }
        public void DependsOnArtifact(string path) { needs.Add(path); }
        public void AddObjectToAsset(string id, UnityEngine.Object one) { made.Add(id, one); }
        public void SetMainObject(UnityEngine.Object one) { main = one; }
        public void LogImportError(string words) { told.Add("error: " + words); }
        public void LogImportWarning(string words) { told.Add("warning: " + words); }
    }
}
