using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace Metagraph
{
    /// <summary>An ask that cannot be read or understood; the message says what is wrong.</summary>
    public sealed class AskException : Exception
    {
        public AskException(string message) : base(message) { }
    }

    /// <summary>
    /// What can be asked of a character: the same fields as in JSON, where "do" says which kind it is. Times are seconds of the
    /// performance, lengths seconds, points metres in the character's space.
    /// </summary>
    public sealed class Ask
    {
        public string Do, Id = "", Layer, Limb, Action, Stance, Line, Text = "", Mode, Name, What = "";
        public double? At, Duration, Stroke, Hold, Late;
        /// <summary>Of its mood, null where it tells nothing: valence and arousal -1..1, intensity 0..2.</summary>
        public double? Valence, Arousal, Intensity;
        public double Amount = 1.0;
        public int Priority = 1;
        public bool Prepare = true, Gestures = true, Resume, Stay, Strict;
        public string[] Tags = Basics.None;
        public Spot To = new Spot(WantedRules.Partner);
        public double[] Point;

        /// <summary>
        /// When the words and mouth shapes of a "say" come, as JSON has them: lists [word, start, end] and [seconds, viseme], or
        /// JsonObjects. Set: of the visemes' names, null for what they tell.
        /// </summary>
        public List<object> Words = new List<object>(), Visemes = new List<object>(), Characters = new List<object>();

        /// <summary>Whether more of a "say" comes under its id, so that it is not over when it falls silent.</summary>
        public bool More;
        public string Set;

        internal const double Longest = 1e6;

        private static readonly Dictionary<string, string> Fields = new Dictionary<string, string>
        {
            { "gesture", "layer tags limb duration stroke hold prepare resume late mood intensity" },
            { "fidget", "layer tags limb duration resume late mood intensity" },
            { "action", "action layer duration stroke hold prepare late mood intensity" },
            { "stance", "stance layer stay late" },
            { "change", "layer limb duration late" },
            { "nod", "tags late mood intensity" },
            { "shake", "tags late mood intensity" },
            { "look", "to duration amount strict" },
            { "blink", "" },
            { "say", "line text duration gestures words visemes characters more set mood intensity" },
            { "mode", "mode" },
            { "mood", "mood intensity duration" },
            { "place", "name point" },
            { "withdraw", "what" },
            { "interrupt", "what" },
            { "pause", "what" },
            { "resume", "what" },
            { "finish", "what" },
            { "bml", "bml" },
        };

        /// <summary>What "do" may be; blocks of BML are read by the desktop alone.</summary>
        public static IEnumerable<string> AllWords
        {
            get { return Fields.Keys.Where(word => word != "bml"); }
        }

        public Ask With(string id, double at)
        {
            var copy = (Ask)MemberwiseClone();
            copy.Id = id;
            copy.At = at;
            return copy;
        }

        /// <summary>The ask that plain JSON says. Raises AskException naming the field.</summary>
        public static Ask From(object json)
        {
            var fields = json as JsonObject;
            if (fields == null)
            {
                throw new AskException("a request should be an object");
            }
            string kind = fields.Has("do") ? fields["do"] as string : null;
            string own;
            if (kind == null || !Fields.TryGetValue(kind, out own))
            {
                throw new AskException("do: should be one of " + string.Join(", ", new List<string>(Fields.Keys).ToArray()));
            }
            var known = new HashSet<string>(("do id at told priority " + own).Split(' '));
            // A kind that finds things by their name looks in every layer, unless told where.
            var ask = new Ask { Do = kind, Layer = kind == "action" || kind == "stance" ? null : "arms" };
            foreach (string name in fields.Names)
            {
                if (name.Length == 0 || !known.Contains(name))
                {
                    throw new AskException("a '" + kind + "' has no field '" + name + "'");
                }
                ask.Take(name, fields[name]);
            }
            foreach (string name in new[] { "action", "stance", "name", "point", "bml" })
            {
                if (known.Contains(name) && !fields.Has(name))
                {
                    throw new AskException(name + ": is missing");
                }
            }
            return ask;
        }

        private void Take(string name, object value)
        {
            switch (name)
            {
                case "id": Id = Word(name, value, 0, 200); break;
                case "at": At = Seconds(name, value, Longest); break;
                case "told": Seconds(name, value, Longest); break;
                case "priority": Priority = Whole(name, value); break;
                case "layer": Layer = value == null && Layer == null ? null : OneOf(name, value, Basics.Layers); break;
                case "tags": Tags = Texts(name, value); break;
                case "limb": Limb = value == null ? null : OneOf(name, value, Basics.Limbs); break;
                case "duration": Duration = Seconds(name, value, Longest); break;
                case "stroke": Stroke = Seconds(name, value, Longest); break;
                case "hold": Hold = Seconds(name, value, 600); break;
                case "late": Late = Seconds(name, value, 600); break;
                case "prepare": Prepare = Flag(name, value); break;
                case "resume": Resume = Flag(name, value); break;
                case "action": Action = Word(name, value, 1, 200); break;
                case "stance": Stance = Word(name, value, 1, 200); break;
                case "stay": Stay = Flag(name, value); break;
                case "to": To = value is string ? new Spot(Word(name, value, 1, 200)) : new Spot(Place(name, value)); break;
                case "amount": Amount = Number(name, value, 0, 1); break;
                case "strict": Strict = Flag(name, value); break;
                case "line": Line = value is long ? ((long)value).ToString(CultureInfo.InvariantCulture) : LineName(name, value); break;
                case "text": Text = Word(name, value, 0, 20000); break;
                case "gestures": Gestures = Flag(name, value); break;
                case "words": Words = Entries(name, value, 4000); break;
                case "visemes": Visemes = Entries(name, value, 20000); break;
                case "characters": Characters = Entries(name, value, 20000); break;
                case "more": More = Flag(name, value); break;
                case "set": Set = value == null ? null : OneOf(name, value, LineTimingRules.Sets.ToArray()); break;
                case "mode": Mode = value == null ? null : OneOf(name, value, Basics.Modes); break;
                case "mood": Feel(name, value); break;
                case "intensity": Intensity = value == null ? (double?)null : Number(name, value, 0, 2); break;
                case "name": Name = Word(name, value, 1, 200); break;
                case "point": Point = Place(name, value); break;
                case "what": What = Word(name, value, 0, 200); break;
                case "bml": Word(name, value, 0, 200000); break;
            }
        }

        /// <summary>Take a mood: a name, or valence and arousal.</summary>
        internal void Feel(string name, object value)
        {
            var text = value as string;
            var pair = value as List<object>;
            if (value == null || (pair != null && pair.Count == 2))
            {
                Valence = value == null ? (double?)null : Number(name, pair[0], -1, 1);
                Arousal = value == null ? (double?)null : Number(name, pair[1], -1, 1);
                return;
            }
            if (text == null || !MoodRules.Moods.ContainsKey(text))
            {
                throw new AskException(name + ": should be valence and arousal, or one of " + string.Join(", ", MoodRules.Moods.Keys));
            }
            Valence = MoodRules.Moods[text].Item1;
            Arousal = MoodRules.Moods[text].Item2;
        }

        private static string Word(string name, object value, int least, int most)
        {
            var text = value as string;
            if (text == null || text.Length < least || Basics.Length(text) > most)
            {
                throw new AskException(name + ": should be a text of " + least + " to " + most + " characters");
            }
            return text;
        }

        private static string LineName(string name, object value)
        {
            return value == null ? null : Word(name, value, 1, 200);
        }

        private static string OneOf(string name, object value, string[] words)
        {
            if (Array.IndexOf(words, value as string) < 0)
            {
                throw new AskException(name + ": should be one of " + string.Join(", ", words));
            }
            return (string)value;
        }

        private static string[] Texts(string name, object value)
        {
            var items = value as List<object>;
            if (items == null)
            {
                throw new AskException(name + ": should be a list of texts");
            }
            return items.ConvertAll(item => Word(name, item, 0, 200)).ToArray();
        }

        private static List<object> Entries(string name, object value, int most)
        {
            var items = value as List<object>;
            if (items == null || items.Count > most)
            {
                throw new AskException(name + ": should be a list of at most " + most + " entries");
            }
            return items;
        }

        private static bool Flag(string name, object value)
        {
            if (!(value is bool))
            {
                throw new AskException(name + ": should be true or false");
            }
            return (bool)value;
        }

        private static int Whole(string name, object value)
        {
            if (!(value is long) || (long)value < -1000 || (long)value > 1000)
            {
                throw new AskException(name + ": should be a whole number from -1000 to 1000");
            }
            return (int)(long)value;
        }

        internal static double Number(string name, object value, double least, double most)
        {
            double number = value is long ? (long)value : value is double ? (double)value : double.NaN;
            if (!(number >= least && number <= most))
            {
                string range = least.ToString(CultureInfo.InvariantCulture) + " to " + most.ToString(CultureInfo.InvariantCulture);
                throw new AskException(name + ": should be a number from " + range);
            }
            return number;
        }

        private static double? Seconds(string name, object value, double most)
        {
            return value == null ? (double?)null : Number(name, value, 0, most);
        }

        private static double[] Place(string name, object value)
        {
            var items = value as List<object>;
            if (items == null || items.Count != 3)
            {
                throw new AskException(name + ": should be three numbers of metres");
            }
            return items.ConvertAll(item => Number(name, item, -1e6, 1e6)).ToArray();
        }
    }
}
