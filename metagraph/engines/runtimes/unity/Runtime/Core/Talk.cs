using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>What was said: the id of the words, and those of their gestures.</summary>
    public sealed class SaidText
    {
        public string Id;
        public List<string> Gestures = new List<string>();
    }

    /// <summary>Text, whole or piece by piece, as speech with the gestures that go with its words. Times are seconds of the character's own.</summary>
    public sealed class Talk
    {
        private const double Start = 0.35; // seconds before a text begins, so that a hand can be where its first stroke needs it
        private const double Between = 0.25; // seconds between two sentences

        private readonly Character character;
        private readonly GestureWords lexicon;
        private readonly HashSet<string> small, arms;
        private readonly bool head;
        private readonly uint seed;
        private readonly string name;
        private uint count;
        private string text = ""; // what came in and is no whole sentence

        /// <summary>
        /// language: "en" or "de-AT"; English where there is no lexicon of it. lexicon: one of your own, JSON as the files have it. name:
        /// what ids begin with. Raises FormatException where the lexicon is not JSON, MetagraphException where it is no lexicon.
        /// </summary>
        public Talk(Character character, string language = "en", string lexicon = null, uint seed = 1, string name = "talk")
        {
            this.character = character;
            this.seed = seed;
            this.name = name;
            var known = LexiconOf(language, lexicon);
            this.lexicon = known.Item1;
            small = known.Item2;
            arms = new HashSet<string>(Gestures("arms").SelectMany(action => action.Tags));
            head = Gestures("head").Any(action => action.Tags.Count > 0);
        }

        /// <summary>
        /// A language's lexicon, and its words that say little by themselves. own: a lexicon as the files have them, instead. Raises as
        /// the constructor does.
        /// </summary>
        public static (GestureWords, HashSet<string>) LexiconOf(string language, string own = null)
        {
            string code = (language ?? "en").ToLowerInvariant().Split('-', '_')[0];
            string known = GestureWordLists.Of.ContainsKey(code) ? GestureWordLists.Of[code] : GestureWordLists.Of["en"];
            var fields = Json.Parse(own ?? known) as JsonObject;
            if (fields == null || !(Field(fields, "rules") is List<object>))
            {
                throw new MetagraphException("the lexicon", "'rules' should be a list", "See docs/agents/text-to-gestures.md");
            }
            List<GestureRule> rules = ((List<object>)fields["rules"]).Select(Rule).ToList();
            var words = new GestureWords(
                rules, code, Rule(Field(fields, "question")), Rule(Field(fields, "exclamation")), Rule(Field(fields, "clause")));
            object told = Field(fields, "small") ?? Field((JsonObject)Json.Parse(known), "small");
            return (words, new HashSet<string>(Texts(told)));
        }

        /// <summary>From when on nothing is said yet.</summary>
        public double Free { get; private set; }

        /// <summary>
        /// Say a text, with gestures on its words. more: further fields of the request "say", JSON: "words" that are told with starts and
        /// ends tell when gestures come, else "duration", else how long lips take. Where it cannot be read, its answer says why.
        /// </summary>
        public SaidText Say(string text, string more = "{}")
        {
            count++;
            var said = new SaidText();
            JsonObject request;
            try
            {
                request = Json.Parse(more ?? "{}") as JsonObject ?? new JsonObject();
            }
            catch (FormatException)
            {
                said.Id = character.Ask(more);
                return said;
            }
            said.Id = Field(request, "id") as string;
            said.Id = string.IsNullOrEmpty(said.Id) ? name + PlainText.Of((int)count) : said.Id;
            double at = Number(Field(request, "at")) ?? character.Now + (Number(Field(request, "after")) ?? Start);
            var asked = new JsonObject();
            request.Names.FindAll(each => each != "after").ForEach(each => asked[each] = request[each]);
            asked["do"] = "say";
            asked["id"] = said.Id;
            asked["text"] = text ?? "";
            asked["at"] = at;
            character.Ask(Json.Write(asked));
            if (character.AnswerTo(said.Id).State == "refused")
            {
                return said;
            }
            List<ToldWord> told = Times(Field(request, "words") as List<object>);
            double? duration = Number(Field(request, "duration"));
            double lasts = duration ?? (told.Count > 0 ? told[told.Count - 1].End : GraphemesRules.ReadAloud(Alphabet.Common, text ?? ""));
            Free = at + lasts + Between;
            List<ProposedGesture> proposed = Proposed(WordGesturesRules.WordsOf(Alphabet.Common, text ?? "", told, duration));
            foreach (GestureAsk ask in WordGesturesRules.GestureAsks(proposed, at))
            {
                var gesture = new JsonObject();
                gesture["do"] = ask.Do;
                gesture["id"] = said.Id + "/" + PlainText.Of(said.Gestures.Count);
                gesture["at"] = ask.At;
                gesture["late"] = ask.Late;
                if (ask.Stroke != null)
                {
                    gesture["layer"] = ask.Layer;
                    gesture["tags"] = new List<object>(ask.Tags);
                    gesture["stroke"] = ask.Stroke.Value;
                }
                said.Gestures.Add(character.Ask(Json.Write(gesture)));
            }
            return said;
        }

        /// <summary>
        /// Break off all that is said, because the other speaks, and forget what came in and is not said yet. What is said next begins at
        /// once. Returns the request's id.
        /// </summary>
        public string Interrupt()
        {
            text = "";
            Free = 0.0;
            return character.Ask("{\"do\": \"interrupt\"}");
        }

        /// <summary>The gestures that go with words.</summary>
        public List<ProposedGesture> Proposed(List<TextWord> words)
        {
            return WordGesturesRules.ProposedFor(words, arms, head, lexicon, small, unchecked(seed + count));
        }

        /// <summary>
        /// Take in what comes next of a text, as a language model writes it: each sentence is said when it is whole, after the one before.
        /// over: whether the text ends here. Returns what was said by it.
        /// </summary>
        public List<SaidText> Take(string piece, bool over = false)
        {
            text += piece ?? "";
            var all = new List<SaidText>();
            while (true)
            {
                List<string> letters = Alphabet.Common.Letters(text);
                int end = WordGesturesRules.SentenceEnd(Alphabet.Common, letters, over);
                if (end == 0)
                {
                    return all;
                }
                List<string> first = letters.GetRange(0, end);
                text = string.Concat(letters.Skip(end));
                if (WordGesturesRules.Telling(Alphabet.Common, first))
                {
                    var at = new JsonObject();
                    at["at"] = Math.Max(Free, character.Now + Start);
                    all.Add(Say(Alphabet.Common.Stripped(string.Concat(first)), Json.Write(at)));
                }
            }
        }

        private IEnumerable<GraphAction> Gestures(string layer)
        {
            return character.Graph.Layers[layer].Actions.Values.Where(action => action.Kind == "gesture");
        }

        /// <summary>Words' times, as requests have them; none where an end is not told.</summary>
        private static List<ToldWord> Times(List<object> words)
        {
            var times = new List<ToldWord>();
            foreach (object word in words ?? new List<object>())
            {
                var row = word as List<object>;
                var fields = word as JsonObject;
                double? start = row != null && row.Count > 2 ? Number(row[1]) : fields != null ? Number(Field(fields, "start")) : null;
                double? end = row != null && row.Count > 2 ? Number(row[2]) : fields != null ? Number(Field(fields, "end")) : null;
                if (start == null || end == null)
                {
                    return new List<ToldWord>();
                }
                times.Add(new ToldWord(start.Value, end.Value));
            }
            return times;
        }

        private static GestureRule Rule(object json)
        {
            var fields = json as JsonObject ?? new JsonObject();
            List<string> words = Texts(Field(fields, "words")), tags = Texts(Field(fields, "tags"));
            return new GestureRule(words, tags, Field(fields, "head") as string ?? "", Number(Field(fields, "strength")) ?? 1.0);
        }

        private static List<string> Texts(object json)
        {
            return (json as List<object> ?? new List<object>()).OfType<string>().ToList();
        }

        private static object Field(JsonObject fields, string name)
        {
            return fields.Has(name) ? fields[name] : null;
        }

        private static double? Number(object json)
        {
            return json is long ? (long)json : json is double ? (double)json : (double?)null;
        }
    }
}
