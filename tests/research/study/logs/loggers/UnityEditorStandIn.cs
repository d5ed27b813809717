// Stands in for the parts of Unity's editor that the study log needs, by their names; then someone works with the log on.
using System;
using System.Collections.Generic;
using System.Reflection;
using System.Threading;

namespace UnityEngine
{
    public static class Application
    {
        public static string persistentDataPath = "", unityVersion = "6000.0.0 stand-in";
    }

    public static class Debug
    {
        public static void Log(object words) { Console.WriteLine(words); }
    }

    public static class GUILayout
    {
        public static string pressed = "";
        public static List<string> shown = new List<string>();

        public static bool Button(string words)
        {
            shown.Add((UnityEditor.EditorGUI.disabled > 0 ? "(" : "") + words);
            return UnityEditor.EditorGUI.disabled == 0 && words == pressed;
        }
    }
}

namespace UnityEditor
{
    public class MenuItem : Attribute { public MenuItem(string path) { } }

    public class EditorWindow
    {
        public static EditorWindow opened;
        public static T GetWindow<T>(string title) where T : EditorWindow, new() { var window = new T(); opened = window; return window; }
    }

    public static class EditorGUI
    {
        public static int disabled;

        public class DisabledScope : IDisposable
        {
            readonly bool off;
            public DisabledScope(bool disabled) { off = disabled; EditorGUI.disabled += off ? 1 : 0; }
            public void Dispose() { EditorGUI.disabled -= off ? 1 : 0; }
        }
    }

    public static class EditorGUILayout
    {
        public static Dictionary<string, string> typed = new Dictionary<string, string>();
        public static string TextField(string label, string value)
        {
            return EditorGUI.disabled == 0 && typed.ContainsKey(label) ? typed[label] : value;
        }
    }

    public struct ObjectChangeEventStream { }

    public static class ObjectChangeEvents
    {
        public delegate void ObjectChangeEventsHandler(ref ObjectChangeEventStream stream);
        public static event ObjectChangeEventsHandler changesPublished;
        public static void Publish() { var stream = new ObjectChangeEventStream(); if (changesPublished != null) changesPublished(ref stream); }
    }

    public static class Undo
    {
        public delegate void UndoRedoCallback();
        public static UndoRedoCallback undoRedoPerformed;
        public static string GetCurrentGroupName() { return "Add State \"Wave\\1\"\t"; }
    }
}

static class Session
{
    static void Call(string name)
    {
        var window = UnityEditor.EditorWindow.opened;
        window.GetType().GetMethod(name, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(window, new object[0]);
    }

    static void Press(string words)
    {
        UnityEngine.GUILayout.pressed = words;
        Call("OnGUI");
        UnityEngine.GUILayout.pressed = "";
        Thread.Sleep(20);
    }

    static void Main(string[] words)
    {
        UnityEngine.Application.persistentDataPath = words[0];
        typeof(MetagraphStudyLog).GetMethod("Open", BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, new object[0]);
        Call("OnEnable");
        Press("Begin"); // no task yet: nothing begins
        UnityEditor.EditorGUILayout.typed["Task"] = words[1];
        UnityEditor.ObjectChangeEvents.Publish();
        Press("Begin");
        Press("Begin"); // disabled now
        for (int n = 0; n < 5; n++) UnityEditor.ObjectChangeEvents.Publish();
        Press("Pause");
        UnityEditor.ObjectChangeEvents.Publish();
        Press("Go on");
        UnityEditor.Undo.undoRedoPerformed();
        Thread.Sleep(1000);
        Press("Done");
        UnityEditor.ObjectChangeEvents.Publish();
        Call("OnDisable");
        UnityEditor.ObjectChangeEvents.Publish();
    }
}
