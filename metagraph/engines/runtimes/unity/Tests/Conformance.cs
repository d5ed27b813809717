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
            List<object> found = new List<object>(), heard = new List<object>(), pieces = List(sound["pieces"]);
            for (int n = 0; n < pieces.Count; n++)
            {
                voice.Follow(Number(List(sound["said"])[n]));
                List<VisemeMark> marks = voice.Hear(List(pieces[n]).Select(x => Number(x) / 128.0).ToList());
                found.Add(marks.Select(m => (object)Row(m.At, m.Viseme, m.Weight)).ToList());
                heard.Add(voice.Seconds);
            }
            Compare(folder + ", heard", Row(found, heard), Row(sound["marks"], sound["seconds"]));
        }
        foreach (JsonObject row in vectors.Has("talked") ? List(vectors["talked"]) : new List<object>())
        {
            Compare(folder + ", talked", TalkOf(row), Fields("sentences", row["sentences"], "words", row["words"], "asks", row["asks"]));
        }
        foreach (JsonObject row in vectors.Has("sympathies") ? List(vectors["sympathies"]) : new List<object>())
        {
            Compare(folder + ", sympathies", SympathiesOf(row), Row(row["taken"], row["along"]));
        }
        foreach (List<object> row in vectors.Has("rules") ? List(vectors["rules"]) : new List<object>())
        {
            List<double> numbers = List(row[2]).ConvertAll(Number);
            List<string> texts = List(row[3]).Cast<string>().ToList();
            List<double> answer = SingleRulesRules.AnswerRule(Alphabet.Common, (uint)Number(row[1]), (string)row[0], numbers, texts);
            Compare(folder + ", rules, " + (string)row[0], answer.Cast<object>().ToList(), row[4]);
        }
        var values = new ParameterValues(graph.Parameters);
        foreach (JsonObject row in vectors.Has("settings") ? List(vectors["settings"]) : new List<object>())
        {
            Compare(folder + ", settings", SetOf(graph, values, row), Row(row["request"], row["wrong"], row["now"]));
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

    /// <summary>What is taken up of another's moods, and whose laughs are joined in.</summary>
    private static object SympathiesOf(JsonObject row)
    {
        Func<string, List<MoodFrom>> told = name => List(row[name]).Select(List).Select(
            x => new MoodFrom("told", Number(x[0]), Number(x[1]), Number(x[2]), null, Number(x[3]))).ToList();
        Func<List<MoodFrom>, object> data = moods => moods.Select(m => (object)Row(m.Id, m.Start, m.Valence, m.Arousal, m.End)).ToList();
        List<double> at = List(row["base"]).ConvertAll(Number);
        var own = new Moods(new Mood(at[0], at[1], at[2]), told("own"));
        var others = new Moods(new Mood(), told("others"));
        List<Laugh> laughs = List(row["laughs"]).Select(List).Select(x => new Laugh(Number(x[0]), Number(x[1]))).ToList();
        double share = Number(row["share"]);
        uint seed = (uint)Number(row["seed"]);
        var who = (string)row["who"];
        return Row(
            data(SympathyRules.MoodsTakenUp(own, others, Number(row["end"]), share, seed, who)),
            data(SympathyRules.LaughsAlong(own, laughs, share, seed, who)));
    }

    /// <summary>The request that setting a parameter makes, what is wrong with it, and the values of all then.</summary>
    private static object SetOf(Graph graph, ParameterValues values, JsonObject row)
    {
        object request = null;
        string wrong = "";
        var name = (string)row["name"];
        try
        {
            values.Set(name, row["value"], json =>
            {
                request = Json.Parse(json);
                return name;
            });
        }
        catch (AskException problem)
        {
            wrong = problem.Message;
        }
        var now = new JsonObject();
        graph.Parameters.Keys.ToList().ForEach(each => now[each] = values.Get(each));
        return Row(request, wrong, now);
    }

    /// <summary>Looks at what is said: after each step of a case, and later.</summary>
    private sealed class Watch
    {
        public readonly List<object> Rows = new List<object>();
        private readonly SpeechWatch speech = new SpeechWatch();
        private readonly List<string> said = new List<string>();
        private double seen = -1.0;

        public void Look(Plan plan, double now, List<object> asks)
        {
            List<Speech> speeches = plan.Track.Speeches;
            List<string> ids = asks.Select(ask => (string)((JsonObject)ask)["id"]).ToList();
            for (int n = 0; n < ids.Count; n++)
            {
                if ((string)((JsonObject)asks[n])["do"] == "say" && !said.Contains(ids[n]))
                {
                    said.Add(ids[n]);
                }
            }
            var spoken = new List<object>();
            foreach (string id in said)
            {
                (string text, string last) = SpokenSoFarRules.SpokenUntil(Alphabet.Common, speeches, id, now);
                if (text.Length > 0)
                {
                    spoken.Add(Row(id, text, last));
                }
            }
            Func<double?, object> maybe = seconds => seconds == null || seconds > 1e8 ? null : (object)seconds;
            Rows.Add(Fields(
                "now", now,
                "events", speech.Watch(speeches, seen, now).Select(e => (object)Row(e.Kind, e.At, e.Id, e.Said, e.Reason)).ToList(),
                "spoken", spoken,
                "silent", UtterancesRules.FindForgotten(plan.Track, now).Cast<object>().ToList(),
                "answers", Hearing.Answers(plan, ids.Distinct().ToList()).Select(
                    a => (object)Row(a.Id, a.State, maybe(a.At), maybe(a.Until), a.What.Cast<object>().ToList())).ToList()));
            seen = now;
        }
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
        List<object> watched = one.Has("watched") ? List(one["watched"]) : new List<object>();
        var watch = new Watch();
        foreach (JsonObject step in List(one["steps"]))
        {
            double now = Number(step["now"]);
            List<Ask> asks = Readable(step, now > 0 ? now + graph.Settings.Lookahead : 0, unread);
            plan = Hearing.Hear(graph, plan, now, asks, Number(step["end"]), stances, (bool)one["idle"]);
            if (watched.Count > 0)
            {
                watch.Look(plan, now, List(step["asks"]));
            }
            plan = step["forget"] == null ? plan : Hearing.Since(plan, Number(step["forget"]));
        }
        foreach (JsonObject row in watched.Skip(List(one["steps"]).Count))
        {
            watch.Look(plan, Number(row["now"]), new List<object>());
        }
        int before = failures;
        Compare(where + ", watched", watch.Rows, watched);
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
