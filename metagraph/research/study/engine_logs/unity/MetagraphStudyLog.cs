// Writes the log of a timing study while people work in Unity's editor (2021.3 or later): put it into a folder "Editor".
// Window > Metagraph study log. Compiled and run with classes that stand in for the editor's; NOT RUN in Unity.
// Nothing that is typed is written.
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Text;
using UnityEditor;
using UnityEngine;

public sealed class MetagraphStudyLog : EditorWindow
{
    string participant = "P01", task = "";
    StreamWriter file;
    readonly Stopwatch clock = new Stopwatch();
    string run = "";
    int n, index;
    bool working, paused;

    [MenuItem("Window/Metagraph study log")]
    static void Open() => GetWindow<MetagraphStudyLog>("Study");

    void OnEnable()
    {
        ObjectChangeEvents.changesPublished += Changed;
        Undo.undoRedoPerformed += Undone;
    }

    void OnDisable()
    {
        ObjectChangeEvents.changesPublished -= Changed;
        Undo.undoRedoPerformed -= Undone;
        Done();
        file?.Dispose();
        file = null;
    }

    void OnGUI()
    {
        using (new EditorGUI.DisabledScope(working))
        {
            participant = EditorGUILayout.TextField("Participant", participant);
            task = EditorGUILayout.TextField("Task", task);
            if (GUILayout.Button("Begin")) Begin();
        }
        using (new EditorGUI.DisabledScope(!working))
        {
            if (GUILayout.Button(paused ? "Go on" : "Pause")) Pause();
            if (GUILayout.Button("Done")) Done();
        }
    }

    void Begin()
    {
        if (working || participant.Length == 0 || task.Length == 0) return;
        if (file == null)
        {
            run = Guid.NewGuid().ToString("N").Substring(0, 12);
            string path = Path.Combine(Application.persistentDataPath, $"study-{run}-unity.jsonl");
            file = new StreamWriter(path, true, new UTF8Encoding(false)) { AutoFlush = true };
            clock.Restart();
            UnityEngine.Debug.Log("Study log: " + path);
            Tell("begin", ("participant", participant), ("engine", "unity"), ("version", Application.unityVersion));
        }
        working = true;
        Phase("begin");
    }

    void Pause()
    {
        paused = !paused;
        Tell("pause", ("state", paused ? "begin" : "end"));
    }

    void Done()
    {
        if (!working) return;
        if (paused) Pause();
        working = false;
        Phase("end");
        index++;
    }

    void Changed(ref ObjectChangeEventStream stream)
    {
        if (working && !paused) Tell("edit", ("what", "settings"), ("words", Undo.GetCurrentGroupName()));
    }

    void Undone()
    {
        if (working && !paused) Tell("undo", ("words", "Undo or redo"));
    }

    void Phase(string state) =>
        Tell("phase", ("name", "task"), ("state", state), ("condition", "unity"), ("task", task), ("index", index), ("why", "done"));

    void Tell(string type, params (string, object)[] fields)
    {
        if (file == null) return;
        var line = new StringBuilder();
        line.Append("{\"n\":").Append(n++).Append(",\"run\":\"").Append(run).Append("\",\"mono\":");
        line.Append(clock.Elapsed.TotalSeconds.ToString("F6", CultureInfo.InvariantCulture));
        line.Append(",\"wall\":\"").Append(DateTime.UtcNow.ToString("yyyy-MM-ddTHH:mm:ss.fff", CultureInfo.InvariantCulture));
        line.Append("Z\",\"type\":\"").Append(type).Append('"');
        foreach (var field in fields)
        {
            object value = field.Item2;
            line.Append(",\"").Append(field.Item1).Append("\":");
            if (value is int whole) line.Append(whole.ToString(CultureInfo.InvariantCulture));
            else line.Append(Quoted(Convert.ToString(value, CultureInfo.InvariantCulture)));
        }
        file.WriteLine(line.Append('}').ToString());
    }

    static string Quoted(string text)
    {
        var line = new StringBuilder("\"");
        foreach (char c in text ?? "")
        {
            if (c == '"' || c == '\\') line.Append('\\').Append(c);
            else if (c < ' ') line.Append("\\u").Append(((int)c).ToString("x4"));
            else line.Append(c);
        }
        return line.Append('"').ToString();
    }
}
