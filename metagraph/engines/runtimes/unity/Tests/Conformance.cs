using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Metagraph;

/// <summary>
/// Checks the runtime against conformance vectors: `mono conformance.exe FOLDER...`, each with an export and its vectors.json.
/// Prints one line for each failure and ends with 1 where there was any.
/// </summary>
public static class Conformance
{
    private static double metres, degrees, seconds, weight;
    private static int failures;

    public static int Main(string[] folders)
    {
        foreach (string folder in folders)
        {
            try
            {
                Check(folder);
            }
            catch (Exception error) when (error is IOException || error is MetagraphException || error is FormatException)
            {
                Fail(folder, error.Message);
            }
        }
        Console.WriteLine(failures == 0 ? "all agree" : failures + " failures");
        return failures == 0 && folders.Length > 0 ? 0 : 1;
    }

    private static void Fail(string where, string what)
    {
        failures++;
        Console.WriteLine(where + ": " + what);
    }

    private static void Check(string folder)
    {
        var vectors = (JsonObject)Json.Parse(File.ReadAllText(Path.Combine(folder, "vectors.json")));
        if (Number(vectors["vectors"]) != 1)
        {
            throw new FormatException("the vectors are of another version; update the runtime or write them again");
        }
        string export = File.ReadAllText(Path.Combine(folder, (string)vectors["export"]));
        var glb = (string)((JsonObject)Json.Parse(export))["glb"];
        Graph graph = Graph.Load(export, File.ReadAllBytes(Path.Combine(folder, glb)), (string)vectors["export"]);
        var tolerance = (JsonObject)vectors["tolerance"];
        metres = Number(tolerance["metres"]);
        degrees = Number(tolerance["degrees"]);
        seconds = Number(tolerance["seconds"]);
        weight = Number(tolerance["weight"]);
        foreach (List<object> hash in List(vectors["hashes"]))
        {
            string[] words = List(hash[1]).Cast<string>().ToArray();
            if (ChoiceRules.Key32((uint)Number(hash[0]), words) != Number(hash[2]))
            {
                Fail(folder, "the hash of " + string.Join(" ", words));
            }
        }
        if (vectors.Has("described"))
        {
            Compare(folder + ", described", Json.Parse(graph.Describe()), vectors["described"]);
        }
        foreach (JsonObject sound in vectors.Has("heard") ? List(vectors["heard"]) : new List<object>())
        {
            var voice = new StreamedVoice(Number(sound["rate"]));
            var found = new List<object>();
            foreach (List<object> piece in List(sound["pieces"]))
            {
                List<VisemeMark> marks = voice.Hear(piece.Select(x => Number(x) / 128.0).ToList());
                found.Add(marks.Select(m => (object)new List<object> { m.At, m.Viseme, m.Weight }).ToList());
            }
            Compare(folder + ", heard", found, sound["marks"]);
        }
        foreach (JsonObject row in vectors.Has("talked") ? List(vectors["talked"]) : new List<object>())
        {
            Compare(folder + ", talked", TalkOf(row), Fields("sentences", row["sentences"], "words", row["words"], "asks", row["asks"]));
        }
        foreach (JsonObject one in List(vectors["cases"]))
        {
            Case(folder + ", " + (string)one["name"], graph, one);
        }
    }

    /// <summary>What comes of a text: its sentences, words and gestures.</summary>
    private static object TalkOf(JsonObject row)
    {
        Alphabet alphabet = Alphabet.Common;
        var sentences = new List<object>();
        List<string> letters = alphabet.Letters((string)row["text"]);
        for (int end = 1; end > 0;)
        {
            end = WordGesturesRules.SentenceEnd(alphabet, letters, true);
            if (end > 0)
            {
                sentences.Add(string.Concat(letters.Take(end)));
                letters.RemoveRange(0, end);
            }
        }
        List<ToldWord> told = List(row["told"]).Select(one => new ToldWord(Number(List(one)[0]), Number(List(one)[1]))).ToList();
        double? seconds = row["seconds"] == null ? (double?)null : Number(row["seconds"]);
        List<TextWord> words = WordGesturesRules.WordsOf(alphabet, (string)row["text"], told, seconds);
        var known = Talk.LexiconOf((string)row["language"]);
        var arms = new HashSet<string>(List(row["arms"]).Cast<string>());
        uint seed = (uint)Number(row["seed"]);
        List<ProposedGesture> made = WordGesturesRules.ProposedFor(words, arms, (bool)row["head"], known.Item1, known.Item2, seed);
        return Fields(
            "sentences", sentences,
            "words", words.Select(w => (object)Row(w.Text, w.Plain, w.Start, w.End, w.Mark)).ToList(),
            "asks", WordGesturesRules.GestureAsks(made, Number(row["at"])).Select(ask => (object)Row(
                ask.Do, ask.Layer, new List<object>(ask.Tags), ask.At, (object)ask.Stroke, ask.Late)).ToList());
    }

    private static void Case(string where, Graph graph, JsonObject one)
    {
        var stances = new Dictionary<string, string>();
        foreach (string layer in ((JsonObject)one["stances"]).Names)
        {
            stances[layer] = (string)((JsonObject)one["stances"])[layer];
        }
        Plan plan = Plan.Empty((uint)Number(one["seed"]));
        var unread = new List<Report>();
        foreach (JsonObject step in List(one["steps"]))
        {
            double now = Number(step["now"]);
            List<Ask> asks = Readable(step, now > 0 ? now + graph.Settings.Lookahead : 0, unread);
            plan = Hearing.Hear(graph, plan, now, asks, Number(step["end"]), stances, (bool)one["idle"]);
            plan = step["forget"] == null ? plan : Hearing.Since(plan, Number(step["forget"]));
        }
        int before = failures;
        var expected = (JsonObject)one["plan"];
        Compare(where + ", plan", PlanData(plan), expected["layers"]);
        Compare(where + ", reports", Reports(plan, unread), expected["reports"]);
        Compare(where + ", life", LifeData(plan.Life), one["life"]);
        if (failures > before)
        {
            return; // no pose can agree where the plans do not
        }
        var player = new Player(graph);
        foreach (JsonObject pose in List(one["poses"]))
        {
            ComparePose(where + ", pose at " + pose["time"] + " s" + ((bool)pose["alive"] ? "" : ", not alive"), graph, player, plan, pose);
        }
    }

    /// <summary>Return the asks of a step that can be read; of others a report is added.</summary>
    private static List<Ask> Readable(JsonObject step, double at, List<Report> unread)
    {
        var asks = new List<Ask>();
        foreach (object data in List(step["asks"]))
        {
            try
            {
                asks.Add(Ask.From(data));
            }
            catch (AskException problem)
            {
                object id = ((JsonObject)data)["id"];
                unread.Add(new Report((string)id, "not-understood", problem.Message, "arms", at));
            }
        }
        return asks;
    }

    // --- what a plan is, as plain data in the vectors' order

    private static object Fields(params object[] pairs)
    {
        var found = new JsonObject();
        for (int n = 0; n < pairs.Length; n += 2)
        {
            found[(string)pairs[n]] = pairs[n + 1];
        }
        return found;
    }

    private static List<object> Row(params object[] values)
    {
        return new List<object>(values);
    }

    private static object PlanData(Plan plan)
    {
        var found = new JsonObject();
        foreach (string layer in Basics.Layers)
        {
            LayerPlan of = plan.Layers[layer];
            found[layer] = Fields(
                "metas", of.Metas.ConvertAll<object>(m => Row(m.Key, m.Start, m.End, m.Written)),
                "cues", of.Cues.ConvertAll(c => Fields(
                    "action", c.Action.Id, "start", c.Start, "end", c.End, "entry", c.Entry, "blend_in", c.BlendIn, "blend_out", c.BlendOut,
                    "stance", c.Stance, "then", c.Then, "meta", c.Meta, "hold_from", c.HoldFrom, "hold_to", c.HoldTo, "hold", c.Hold, "extent", c.Extent, "tempo", c.Tempo,
                    "cycle_from", c.CycleFrom, "cycle_to", c.CycleTo)),
                "rests", of.Rests.ConvertAll<object>(r => Row(r.Stance, r.Action.Id, r.Start, r.FadeStart, r.Fade)));
        }
        return found;
    }

    private static object Reports(Plan plan, List<Report> unread)
    {
        IEnumerable<Report> sorted = plan.Reports.Concat(unread).OrderBy(r => r.Request, Comparer<string>.Create(Basics.Compare))
            .ThenBy(r => r.Outcome, StringComparer.Ordinal).ThenBy(r => r.Layer, StringComparer.Ordinal)
            .ThenBy(r => r.At).ThenBy(r => r.Played);
        return sorted.Select(r => (object)Row(r.Request, r.Outcome, r.Layer, r.At, r.Played)).ToList();
    }

    private static object LifeData(Schedule life)
    {
        List<object> targets = life.Targets.ConvertAll<object>(t => Row(
            t.Start, t.To.Point == null ? (object)t.To.Name : t.To.Point.Cast<object>().ToList(), t.Since, t.Amount, t.Strict, t.Asked));
        return Fields(
            "modes", Lanes(life.Modes), "breaths", Lanes(life.Breaths), "aversions", Lanes(life.Aversions),
            "saccades", Lanes(life.Saccades), "blinks", Lanes(life.Blinks), "targets", targets, "moods", Lanes(life.Moods),
            "swells", Lanes(life.Swells), "emphases", Lanes(life.Emphases));
    }

    private static List<object> Lanes(Lane lane)
    {
        return lane.Times.Select((start, n) => (object)new object[] { start }.Concat(lane.Rows[n].Cast<object>()).ToList()).ToList();
    }

    // --- comparing

    private static double Number(object value)
    {
        return value is long ? (long)value : (double)value;
    }

    private static List<object> List(object value)
    {
        return (List<object>)value;
    }

    /// <summary>Compare plain data: numbers within the tolerance of seconds, all else alike, lists in order.</summary>
    private static void Compare(string where, object ours, object theirs)
    {
        if (theirs is JsonObject && ours is JsonObject)
        {
            JsonObject a = (JsonObject)ours, b = (JsonObject)theirs;
            foreach (string name in b.Names)
            {
                Compare(where + "." + name, a.Has(name) ? a[name] : "nothing", b[name]);
            }
            return;
        }
        if (theirs is List<object> && ours is List<object>)
        {
            List<object> a = List(ours), b = List(theirs);
            for (int n = 0; n < Math.Min(a.Count, b.Count); n++)
            {
                Compare(where + "[" + n + "]", a[n], b[n]);
            }
            if (a.Count != b.Count)
            {
                Fail(where, a.Count + " instead of " + b.Count);
            }
            return;
        }
        bool numbers = (ours is double || ours is long) && (theirs is double || theirs is long);
        if (numbers ? !(Math.Abs(Number(ours) - Number(theirs)) <= seconds) : !Equals(ours, theirs))
        {
            Fail(where, (ours ?? "null") + " instead of " + (theirs ?? "null"));
        }
    }

    private static void ComparePose(string where, Graph graph, Player player, Plan plan, JsonObject expected)
    {
        var pose = new BodyPose(graph);
        player.PoseAt(plan, Number(expected["time"]), (bool)expected["alive"], pose);
        var positions = new double[3 * graph.Joints.Length];
        pose.Positions(graph, positions);
        double farthest = 0, widest = 0, heaviest = 0;
        for (int j = 0; j < graph.Joints.Length; j++)
        {
            List<double> at = List(List(expected["positions"])[j]).ConvertAll(Number);
            double x = positions[3 * j] - at[0], y = positions[3 * j + 1] - at[1], z = positions[3 * j + 2] - at[2];
            farthest = Largest(farthest, Math.Sqrt(x * x + y * y + z * z));
            List<double> q = List(List(expected["rotations"])[j]).ConvertAll(Number);
            Quat apart = new Quat(q[0], q[1], q[2], q[3]).Inverse * Quat.Of(pose.Rotations, j);
            double turned = Math.Sqrt(apart.X * apart.X + apart.Y * apart.Y + apart.Z * apart.Z);
            widest = Largest(widest, 2 * Math.Atan2(turned, Math.Abs(apart.W)) * 180 / Math.PI);
        }
        var morphs = (JsonObject)expected["morphs"];
        foreach (string name in morphs.Names.Union(graph.Morphs))
        {
            int place = graph.Morphs.IndexOf(name);
            double ours = place < 0 ? 0 : pose.Morphs[place], theirs = morphs.Has(name) ? Number(morphs[name]) : 0;
            heaviest = Largest(heaviest, Math.Abs(ours - theirs));
        }
        if (!(farthest <= metres && widest <= degrees && heaviest <= weight))
        {
            Fail(where, farthest + " m, " + widest + " degrees, " + heaviest + " of a morph target apart");
        }
    }

    /// <summary>The larger one; what is no number stays none, so that it cannot pass.</summary>
    private static double Largest(double a, double b)
    {
        return double.IsNaN(a) || a > b ? a : b;
    }
}
