// Translated from metagraph/playback/life/expressions.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The weights of a face's channels, without lids and lips. brow_up raises only the inner ends of the brows, brows the whole
    /// of them. The same object is filled again for each time (`shown_face`, `answer`, `settle`).
    /// </summary>
    public sealed class FaceShown
    {
        public double Smile;
        public double Frown;
        public double BrowDown;
        public double BrowUp;
        public double Brows;
        public double Cheeks;

        public FaceShown(
            double smile = 0.0,
            double frown = 0.0,
            double browDown = 0.0,
            double browUp = 0.0,
            double brows = 0.0,
            double cheeks = 0.0
        )
        {
            Smile = smile;
            Frown = frown;
            BrowDown = browDown;
            BrowUp = browUp;
            Brows = brows;
            Cheeks = cheeks;
        }
    }

    public static class ExpressionsRules
    {
        // Swells: how the face of a mood comes up; rows: length s, amount, 1 where the mode was listening.
        public const double SwellGap = 3.5; // seconds between two, on average
        public const double ShortestSwell = 0.9;
        public const double LongestSwell = 4.0;
        public const double SwellRises = 0.35; // of its length
        public const double Kept = 0.75; // of a mood's face between swells
        public const double Warmth = 0.35; // of a smile that a listener's swell is
        // Emphases: brows raised in speech, and where somebody reacts to something; rows: length s, amount, rise s.
        public const double Early = 0.06; // seconds a raise begins before its syllable
        public const double Raise = 0.35; // seconds it takes at least
        public const double RaiseChance = 0.3; // and what chance adds
        public const double RaiseRises = 0.12;
        // seconds before the end of a question that its brows begin to rise, but in its second half
        public const double Asking = 0.8;
        public const double AskingOn = 0.5; // seconds they take to sink after it
        public const double AskingLifts = 0.8; // of a full raise
        public const double Reacting = 1.2; // seconds they take where a reaction begins
        public const double LongestEmphasis = 1.5; // seconds
        // Cues: what those with certain tags show.
        public const double CueRises = 0.25; // seconds
        public const double CueLasts = 1.8;
        public const double CueFalls = 0.6;
        public const double FlashFrom = 0.1; // seconds after a greeting begins
        public const double FlashRises = 0.08;
        public const double FlashLasts = 0.4;
        public const string Greeting = "greeting";
        // Of smile, frown, brow_down, brow_up, brows.
        public static readonly Dictionary<string, List<double>> Shown = new Dictionary<string, List<double>> {
            { "greeting", new List<double> { 0.6, 0.0, 0.0, 0.0, 0.1 } },
            { "positive", new List<double> { 0.3, 0.0, 0.0, 0.0, 0.15 } },
            { "agree", new List<double> { 0.1, 0.0, 0.0, 0.0, 0.1 } },
            { "negative", new List<double> { 0.0, 0.2, 0.35, 0.0, 0.0 } },
            { "surprise", new List<double> { 0.0, 0.0, 0.0, 0.0, 0.9 } },
            { "question", new List<double> { 0.0, 0.0, 0.0, 0.0, 0.6 } },
            { "unsure", new List<double> { 0.0, 0.3, 0.0, 0.2, 0.5 } },
            { "thinking", new List<double> { 0.0, 0.1, 0.35, 0.0, 0.0 } }
         };
        public static readonly List<string> Marks = new List<string> { "?", "？", "؟" }; // at the end of questions
        public const double Duchenne = 0.2; // the smile from which on cheeks rise

        /// <summary>Return the lane of swells filled from `cut` to `drawn` seconds.</summary>
        public static Lane SwellsOn(Track track, uint seed, double cut, double drawn, Lane before)
        {
            var times = new List<double>();
            var rows = new List<List<double>>();
            var number = before.Next;
            var over = before.Times.Count > 0
                ? before.Times[before.Times.Count - 1] + before.Rows[before.Rows.Count - 1][0]
                : 0.0;
            while (true)
            {
                var key = ChoiceRules.Keyed(seed, "swell", PlainText.Of(number));
                var gap = SwellGap * (0.3 + 1.4 * ChoiceRules.ChanceOf(key, "gap"));
                var at = Math.Max(cut, over + gap);
                if (at >= drawn)
                {
                    return before.Plus(times, rows);
                }
                var length = ShortestSwell;
                length += (LongestSwell - ShortestSwell) * ChoiceRules.ChanceOf(key, "length");
                var amount = 0.6 + 0.4 * ChoiceRules.ChanceOf(key, "amount");
                times.Add(at);
                rows.Add(new List<double> { length, amount, track.ToldMode(at) == "listening" ? 1.0 : 0.0 });
                over = at + length;
                number += 1;
            }
        }

        /// <summary>
        /// Return the lane of emphases filled from `cut` to `drawn` seconds: on the share of stressed syllables that
        /// `accent_brows` says, at the end of questions, and where a reaction begins.
        /// </summary>
        public static Lane EmphasesOn(
            LifeSettings life,
            Track track,
            Voices voices,
            uint seed,
            double cut,
            double drawn,
            Lane before
        )
        {
            var found = new List<List<double>>();
            double chance = default(double);
            foreach (Speech speech in track.Speeches)
            {
                if (speech.End <= cut || speech.Start >= drawn)
                {
                    continue;
                }
                double at = default(double);
                foreach (var one in VoiceRules.Stressed(voices, speech).Select((item, n) => (n, item)))
                {
                    var n = one.Item1;
                    var peak = one.Item2;
                    var begin = ItemsRules.FindLineStart(speech);
                    at = Math.Max(speech.Start, begin + peak - Early);
                    if (at >= speech.End || begin + peak < speech.Start)
                    {
                        continue;
                    }
                    if (ChoiceRules.Uniform(seed, speech.Id, "brows", PlainText.Of(n)) >= life.AccentBrows)
                    {
                        continue;
                    }
                    chance = ChoiceRules.Uniform(seed, speech.Id, "raise", PlainText.Of(n));
                    found.Add(new List<double> { at, Raise + RaiseChance * chance, 0.5 + 0.5 * chance, RaiseRises });
                }
                if (Asks(speech))
                {
                    var length = ItemsRules.MeasureLine(speech);
                    var lead = Math.Min(Asking, 0.5 * length);
                    at = Math.Max(speech.Start, ItemsRules.FindLineStart(speech) + length - lead);
                    if (at < speech.End)
                    {
                        found.Add(new List<double> { at, lead + AskingOn, AskingLifts, lead });
                    }
                }
            }
            foreach (ModeFrom change in track.Modes)
            {
                if (change.Mode == "reacting" && life.AccentBrows > 0)
                {
                    chance = ChoiceRules.Uniform(seed, change.Id, "raise");
                    found.Add(new List<double> { change.Start, Reacting, 0.6 + 0.4 * chance, RaiseRises });
                }
            }
            var times = new List<double>();
            var rows = new List<List<double>>();
            foreach (List<double> event_ in found.OrderBy(x => x[0]).ThenBy(x => x[3]).ToList())
            {
                if (cut <= event_[0] && event_[0] < drawn)
                {
                    times.Add(event_[0]);
                    rows.Add(PlainLists.Part(event_, 1));
                }
            }
            return before.Plus(times, rows);
        }

        /// <summary>Return whether a speech is a question, by its last sign.</summary>
        public static bool Asks(Speech speech)
        {
            var text = speech.Text.Trim();
            return text != "" && Marks.Any(mark => PlainText.PartedLast(text, mark).Item3 == "");
        }

        /// <summary>Fill in the face at a time, from the mood and the drawn events.</summary>
        public static void ShownFace(FaceShown face, LifeSettings life, Lane swells, Lane emphases, Bearing bears, double seconds)
        {
            var calm = 1 - life.Stillness;
            var swell = 0.0;
            var warm = 0.0;
            var n = PlainLists.Right(swells.Times, seconds) - 1;
            double length = default(double);
            double amount = default(double);
            double gone = default(double);
            double rise = default(double);
            if (n >= 0)
            {
                length = swells.Rows[n][0];
                amount = swells.Rows[n][1];
                var listens = swells.Rows[n][2];
                gone = seconds - swells.Times[n];
                rise = SwellRises * length;
                swell = amount * MoodRules.Faded(Math.Min(gone / rise, (length - gone) / (length - rise)));
                warm = listens * swell;
            }
            var share = 1 - calm * Math.Min(1.0, life.Expressions) * (1 - Kept) * (1 - swell);
            var much = calm * life.Expressions;
            var brows = 0.0;
            n = PlainLists.Right(emphases.Times, seconds) - 1;
            while (n >= 0 && seconds - emphases.Times[n] < LongestEmphasis)
            {
                length = emphases.Rows[n][0];
                amount = emphases.Rows[n][1];
                rise = emphases.Rows[n][2];
                gone = seconds - emphases.Times[n];
                brows = Math.Max(brows, amount * MoodRules.Faded(Math.Min(gone / rise, (length - gone) / (length - rise))));
                n -= 1;
            }
            face.Smile = share * bears.Smile + much * Warmth * warm * (1 - bears.Frown);
            face.Frown = share * bears.Frown;
            face.BrowDown = share * bears.BrowDown;
            face.BrowUp = share * bears.BrowUp;
            face.Brows = share * bears.Brows + much * brows;
        }

        /// <summary>Add what a cue with these tags, from `start` to `end`, shows on a face at a time.</summary>
        public static void Answer(FaceShown face, LifeSettings life, List<string> tags, double start, double end, double seconds)
        {
            var much = (1 - life.Stillness) * life.Expressions;
            if (much <= 0 || seconds <= start || seconds >= Math.Min(end, start + CueLasts))
            {
                return;
            }
            var gone = seconds - start;
            var shows = much * MoodRules.Faded(Math.Min(gone / CueRises, (Math.Min(end, start + CueLasts) - seconds) / CueFalls));
            foreach (string tag in tags)
            {
                if (Shown.ContainsKey(tag))
                {
                    var of = Shown[tag];
                    face.Smile += shows * of[0];
                    face.Frown += shows * of[1];
                    face.BrowDown += shows * of[2];
                    face.BrowUp += shows * of[3];
                    face.Brows += shows * of[4];
                }
                if (tag == Greeting)
                {
                    var flash = gone - FlashFrom;
                    var left = FlashLasts - flash;
                    face.Brows += much * MoodRules.Faded(Math.Min(flash / FlashRises, left / (FlashLasts - FlashRises)));
                }
            }
        }

        /// <summary>Clamp all weights to 0..1, and raise the cheeks with a smile.</summary>
        public static void Settle(FaceShown face)
        {
            face.Smile = MoodRules.Within(face.Smile, 0.0, 1.0);
            face.Frown = MoodRules.Within(face.Frown, 0.0, 1.0);
            face.BrowDown = MoodRules.Within(face.BrowDown, 0.0, 1.0);
            face.BrowUp = MoodRules.Within(face.BrowUp, 0.0, 1.0);
            face.Brows = MoodRules.Within(face.Brows, 0.0, 1.0);
            face.Cheeks = MoodRules.Within((face.Smile - Duchenne) / (1 - Duchenne), 0.0, 1.0);
        }
    }
}
