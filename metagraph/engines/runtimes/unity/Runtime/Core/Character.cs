using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace Metagraph
{
    /// <summary>How a character performs. Seed: null for the project's. Idle: the models fill the time nobody asks for.</summary>
    public sealed class CharacterOptions
    {
        public uint? Seed;
        public bool Idle = true;
        /// <summary>Layer -> id of the stance it begins in.</summary>
        public Dictionary<string, string> Stances = new Dictionary<string, string>();
        /// <summary>Seconds that are planned ahead, and seconds of past that answers know of.</summary>
        public double Ahead = 20.0, Recent = 30.0;
    }

    /// <summary>
    /// What began or ended. Kind: begin or end. Layer: body, arms, head, or speech. Action: name of the action; of a speech the id of
    /// its line, else its text. Meta: the ask's id, or the model's. At: seconds. Reason: where all that is said under an id is over,
    /// finished, interrupted or replaced; else "".
    /// </summary>
    public struct CharacterEvent
    {
        public string Kind, Layer, Action, Meta, Reason;
        public double At;
    }

    /// <summary>
    /// One character, played live: requests come in between two updates, are worked into the plan at the next, and each is told what
    /// became of it. Nothing here throws once it is made.
    /// </summary>
    public sealed class Character
    {
        private const double Slack = 2.0; // seconds by which the plan may fall behind its horizon before it is extended
        private const double Cut = 15.0; // seconds between two cuts
        private const double Leap = 3600.0; // seconds an update may move on: all that lies between is planned
        private const int Sounds = 16; // lines whose sound is remembered
        private const int Remembered = 1000; // answers kept after that, and events nobody asked for
        private static readonly string[] Taking = { "withdraw", "interrupt", "pause", "resume", "finish" }; // done once taken up
        private static readonly CharacterEvent[] Nothing = new CharacterEvent[0];

        public readonly Graph Graph;
        private readonly CharacterOptions options;
        private readonly Player player;
        private readonly BodyPose pose;
        private readonly List<Ask> queue = new List<Ask>();
        private readonly HashSet<string> asked = new HashSet<string>(); // ids that the plan can tell of
        private readonly Dictionary<string, Answer> settled = new Dictionary<string, Answer>(); // of what it forgot or never heard of
        private readonly List<string> settling = new List<string>(); // their ids, the oldest first
        private readonly List<KeyValuePair<string, StreamedVoice>> sounds = new List<KeyValuePair<string, StreamedVoice>>(); // the oldest first
        private readonly Dictionary<string, List<object>> streaming = new Dictionary<string, List<object>>(); // shapes of this update
        private List<CharacterEvent> events = new List<CharacterEvent>();
        private int count;
        private readonly ParameterValues parameters;
        private readonly SpeechWatch speech = new SpeechWatch();
        private Track watched; // whose speech was looked at last
        private double seen = double.NegativeInfinity, cutAt;

        public Character(Graph graph, CharacterOptions options = null)
        {
            Graph = graph;
            this.options = options ?? new CharacterOptions();
            parameters = new ParameterValues(graph.Parameters);
            player = new Player(graph);
            pose = new BodyPose(graph);
            Plan = Plan.Empty(this.options.Seed ?? graph.Settings.Seed);
            Plan = Hearing.Hear(graph, Plan, 0.0, new Ask[0], this.options.Ahead, this.options.Stances, this.options.Idle);
        }

        public Plan Plan { get; private set; }

        /// <summary>Seconds of the performance at the last update.</summary>
        public double Now { get; private set; }

        /// <summary>What may be asked for, as JSON: see `Graph.Describe`.</summary>
        public string Describe()
        {
            return Graph.Describe();
        }

        /// <summary>
        /// Ask for something; taken up at the next update. The request is JSON with "do", as an agent sends it; "after": seconds from
        /// now, wins over "at". Returns its id, made up where it has none. What cannot be read is refused: see `AnswerTo`.
        /// </summary>
        public string Ask(string json)
        {
            count++;
            string id = "#" + count.ToString(CultureInfo.InvariantCulture);
            try
            {
                object parsed = Json.Parse(json ?? "");
                var fields = parsed as JsonObject;
                if (fields != null)
                {
                    string own = fields.Has("id") ? fields["id"] as string : null;
                    id = string.IsNullOrEmpty(own) ? id : own;
                    parsed = Named(fields, id);
                }
                queue.Add(Metagraph.Ask.From(parsed));
                settled.Remove(id);
                settling.Remove(id);
                asked.Add(id);
            }
            catch (Exception error) when (error is AskException || error is FormatException)
            {
                Settle(new Answer { Id = id, State = "refused", Why = error.Message });
            }
            return id;
        }

        /// <summary>
        /// Set a parameter of the project to a number, a bool, a string, several strings, or three numbers; null for a trigger. Returns
        /// the id of the request that this makes. A number outside of its range becomes the nearest inside, and what is set to the value
        /// that it has makes no request again. What cannot be set is refused: see `AnswerTo`.
        /// </summary>
        public string SetParameter(string name, object value = null)
        {
            try
            {
                return parameters.Set(name, value, Ask);
            }
            catch (AskException error)
            {
                count++;
                string id = "#" + count.ToString(CultureInfo.InvariantCulture);
                Settle(new Answer { Id = id, State = "refused", Why = error.Message });
                return id;
            }
        }

        /// <summary>
        /// The value that a parameter was set to, else its first one: double, bool, string, or List of object; null for a trigger, and
        /// where there is none of that name.
        /// </summary>
        public object GetParameter(string name)
        {
            return parameters.Get(name);
        }

        /// <summary>
        /// Say a line whose sound comes in while it is said: with each call its next samples, -1..1. The lips do what is heard in them.
        /// An id is one line's; returns it, as Ask does. rate: samples a second, 8000 to 48000.
        /// </summary>
        public string SaySound(string id, IEnumerable<float> samples, double rate)
        {
            if (!(rate >= 8000 && rate <= 48000))
            {
                Settle(new Answer { Id = id, State = "refused", Why = "rate: should be a number from 8000 to 48000" });
                return id;
            }
            count++;
            Speech begun = Plan.Track.LastSpeech(id);
            int place = sounds.FindIndex(one => one.Key == id && one.Value.Rate == rate);
            bool goesOn = place >= 0 && (begun != null || streaming.ContainsKey(id));
            StreamedVoice voice = goesOn ? sounds[place].Value : new StreamedVoice(rate);
            if (begun != null)
            {
                voice.Follow(UtterancesRules.FindSoon(Now, Graph.Settings.Lookahead) - ItemsRules.FindLineStart(begun));
            }
            sounds.RemoveAll(one => one.Key == id);
            sounds.Add(new KeyValuePair<string, StreamedVoice>(id, voice));
            if (sounds.Count > Sounds)
            {
                sounds.RemoveAt(0);
            }
            double from = voice.Seconds;
            List<VisemeMark> marks = voice.Hear(samples.Select(x => (double)x).ToList());
            if (marks.Count == 0)
            {
                marks.Add(new VisemeMark(from, voice.Shape, voice.Weight)); // what goes on
            }
            List<object> visemes;
            if (!streaming.TryGetValue(id, out visemes))
            {
                visemes = streaming[id] = new List<object>();
            }
            visemes.AddRange(marks.Select(mark => (object)new List<object> { mark.At, mark.Viseme, mark.Weight }));
            var said = new JsonObject();
            said["do"] = "say";
            said["id"] = id;
            said["visemes"] = new List<object>(visemes);
            said["set"] = "oculus";
            queue.RemoveAll(ask => ask.Id == id);
            queue.Add(Metagraph.Ask.From(said));
            settled.Remove(id);
            settling.Remove(id);
            asked.Add(id);
            return id;
        }

        /// <summary>The request with its id, and with "at" for "after".</summary>
        private JsonObject Named(JsonObject fields, string id)
        {
            var named = new JsonObject();
            fields.Names.FindAll(name => name != "after").ForEach(name => named[name] = fields[name]);
            named["id"] = id;
            if (fields.Has("after"))
            {
                named["at"] = Now + Metagraph.Ask.Number("after", fields["after"], 0, Metagraph.Ask.Longest);
            }
            return named;
        }

        /// <summary>Keep an answer that will not change any more.</summary>
        private void Settle(Answer answer)
        {
            asked.Remove(answer.Id);
            settled[answer.Id] = answer;
            settling.Remove(answer.Id);
            settling.Add(answer.Id);
            if (settling.Count > Remembered)
            {
                settled.Remove(settling[0]);
                settling.RemoveAt(0);
            }
        }

        /// <summary>
        /// Move on to a time, seconds of the character's own, which begins at 0, never goes backwards, and leaps an hour at most. Works in
        /// what was asked.
        /// </summary>
        public void Update(double now)
        {
            if (now > Now && !double.IsInfinity(now))
            {
                Now = Math.Min(now, Now + Leap);
            }
            try
            {
                PlanOn();
            }
            catch (Exception error) // a fault of the runtime's own must not stop the game: the plan stays as it is
            {
                queue.ForEach(ask => Settle(new Answer { Id = ask.Id, State = "refused", Why = "the runtime failed: " + error.Message }));
                queue.Clear();
                streaming.Clear();
            }
            Listen();
        }

        private void PlanOn()
        {
            if (Plan.Track.Speeches.Exists(s => s.More))
            {
                foreach (string what in UtterancesRules.FindForgotten(Plan.Track, Now))
                {
                    queue.Add(new Ask { Do = "finish", Id = what + ".0", What = what });
                }
            }
            bool far = Plan.End >= Now + options.Ahead - Math.Min(Slack, options.Ahead / 2);
            if (queue.Count > 0 || !far)
            {
                double end = far ? Plan.End : Now + options.Ahead;
                Plan = Hearing.Hear(Graph, Plan, Now, queue, end, options.Stances, options.Idle);
                queue.FindAll(ask => Taking.Contains(ask.Do)).ForEach(ask => Settle(new Answer { Id = ask.Id, State = "done" }));
                queue.Clear();
                streaming.Clear();
            }
            if (seen - cutAt >= Cut)
            {
                cutAt = seen; // what has begun and ended since then is still to be told
                Forget(seen - options.Recent);
            }
        }

        /// <summary>Forget what is over, and settle the answers of what was asked for then.</summary>
        private void Forget(double over)
        {
            List<Answer> known = Hearing.Answers(Plan, asked);
            Plan = Hearing.Since(Plan, over);
            List<Answer> left = Hearing.Answers(Plan, asked);
            for (int n = 0; n < known.Count; n++)
            {
                // What the plan no longer knows was played; so was a look without an end that another has replaced.
                bool played = known[n].Until != null && (known[n].Until < over || left[n].Until == null);
                if (played || known[n].State == "refused" || known[n].State == "done")
                {
                    known[n].State = played ? "done" : known[n].State;
                    Settle(known[n]);
                }
            }
        }

        /// <summary>Note what has begun or ended since the update before.</summary>
        private void Listen()
        {
            foreach (string layer in Basics.Layers)
            {
                List<Cue> cues = Plan.Layers[layer].Cues;
                for (int n = 0; n < cues.Count && cues[n].Start <= Now; n++)
                {
                    Note(cues[n].Start, cues[n].End, layer, cues[n].Action.Name, cues[n].Meta);
                }
            }
            if (SpeechChanges())
            {
                foreach (SpeechEvent one in speech.Watch(Plan.Track.Speeches, seen, Now))
                {
                    Insert(new CharacterEvent
                    {
                        Kind = one.Kind, Layer = "speech", Action = one.Said, Meta = one.Id, At = one.At, Reason = one.Reason,
                    });
                }
                watched = Plan.Track;
            }
            seen = Now;
            if (events.Count > Remembered)
            {
                events.RemoveRange(0, events.Count - Remembered);
            }
        }

        /// <summary>Whether speech may begin or end since the update before. To look for it makes garbage.</summary>
        private bool SpeechChanges()
        {
            if (Plan.Track != watched)
            {
                return true;
            }
            foreach (Speech one in Plan.Track.Speeches)
            {
                if (IsNew(one.Start) || IsNew(one.End) || (one.Over != null && IsNew(one.Over.Value)))
                {
                    return true;
                }
            }
            return false;
        }

        private bool IsNew(double at)
        {
            return at > seen && at <= Now;
        }

        private void Note(double start, double end, string layer, string action, string key)
        {
            bool begins = start > seen && start <= Now, ends = end > seen && end <= Now;
            if (begins || ends)
            {
                string meta = key.Split('+')[0]; // what goes on after a cut is the same
                if (begins)
                {
                    Insert(new CharacterEvent { Kind = "begin", Layer = layer, Action = action, Meta = meta, At = start, Reason = "" });
                }
                if (ends)
                {
                    Insert(new CharacterEvent { Kind = "end", Layer = layer, Action = action, Meta = meta, At = end, Reason = "" });
                }
            }
        }

        /// <summary>Put an event in its place: by time.</summary>
        private void Insert(CharacterEvent one)
        {
            int place = events.Count;
            while (place > 0 && events[place - 1].At > one.At)
            {
                place--;
            }
            events.Insert(place, one);
        }

        /// <summary>What began and ended since this was last asked for, by time; of more than 1000 the latest.</summary>
        public IList<CharacterEvent> Events()
        {
            if (events.Count == 0)
            {
                return Nothing;
            }
            List<CharacterEvent> happened = events;
            events = new List<CharacterEvent>();
            return happened;
        }

        /// <summary>What became of an ask: when it will play, or why it will not.</summary>
        public Answer AnswerTo(string id)
        {
            Answer known;
            if (settled.TryGetValue(id ?? "", out known))
            {
                return known;
            }
            if (!asked.Contains(id ?? ""))
            {
                return new Answer { Id = id, State = "refused", Why = "nothing was asked for as '" + id + "'" };
            }
            if (queue.Exists(ask => ask.Id == id))
            {
                return new Answer { Id = id, State = "planned", Why = "taken up at the next update" };
            }
            return Hearing.AnswerTo(Plan, id);
        }

        /// <summary>
        /// What of something said was spoken until now, up to the word that was begun, and that word; "" where nothing was.
        /// </summary>
        public void Spoken(string id, out string text, out string lastWord)
        {
            (text, lastWord) = SpokenSoFarRules.SpokenUntil(Alphabet.Common, Plan.Track.Speeches, id, Now);
        }

        /// <summary>The pose at the updated time; the same arrays each time. alive: with the life layers.</summary>
        public BodyPose Pose(bool alive = true)
        {
            player.PoseAt(Plan, Now, alive, pose);
            return pose;
        }
    }
}
