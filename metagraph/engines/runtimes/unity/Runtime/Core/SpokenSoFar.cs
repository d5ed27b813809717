// Translated from metagraph/speech/spoken_so_far.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The part of an utterance that was spoken until a moment, for the history from which a language model continues.
    /// </summary>
    public static class SpokenSoFarRules
    {
        /// <summary>
        /// Return the part of an utterance that was spoken until `seconds`, up to the word that was begun, and that word; "" if
        /// nothing was spoken. said: all speeches, by start.
        /// </summary>
        public static (string, string) SpokenUntil(Alphabet alphabet, List<Speech> said, string ident, double seconds)
        {
            var text = "";
            var last = "";
            var paced = false;
            var pieces = Pieces(said, ident, seconds);
            foreach (var one in pieces.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var piece = one.Item2;
                var found = SpokenOf(alphabet, piece, Math.Min(seconds, piece.End) - ItemsRules.FindLineStart(piece));
                string words = found.Item1;
                string word = found.Item2;
                var joins = paced && piece.Timing != null && piece.Timing.Paced;
                if (n > 0 && text != "" && words != "" && !joins)
                {
                    text += " ";
                }
                text += words;
                last = word == "" ? last : word;
                paced = piece.Timing != null && piece.Timing.Paced;
            }
            return (alphabet.Stripped(text), last);
        }

        /// <summary>
        /// Return the pieces of the last utterance with an id; one that continues after a pause is one utterance.
        /// </summary>
        private static List<Speech> Pieces(List<Speech> said, string ident, double seconds)
        {
            var out_ = new List<Speech>();
            foreach (Speech piece in said)
            {
                if (piece.Id != ident || piece.Start >= seconds || UtterancesRules.IsPaused(piece.Start))
                {
                    continue;
                }
                if (out_.Count > 0 && out_[out_.Count - 1].Asked != piece.Asked)
                {
                    out_ = new List<Speech>();
                }
                else if (out_.Count > 0 && piece.Skip > 0)
                {
                    out_.RemoveAt(out_.Count - 1);
                }
                out_.Add(piece);
            }
            return out_;
        }

        /// <summary>Return the part of one piece that was spoken in its first `seconds`, and its last word.</summary>
        private static (string, string) SpokenOf(Alphabet alphabet, Speech piece, double seconds)
        {
            var letters = alphabet.Letters(piece.Text);
            var words = new List<SpokenWord>();
            if (piece.Timing != null && piece.Timing.Words.Count > 0)
            {
                words = piece.Timing.Words.ToList();
            }
            else if (piece.Timing == null || !piece.Timing.Paced)
            {
                words = WordGesturesRules.WordsOf(
                    alphabet,
                    piece.Text,
                    new List<ToldWord>(),
                    ItemsRules.MeasureLine(piece)
                ).Select(w => new SpokenWord(w.Text, w.Start)).ToList();
            }
            var begun = words.Where(word => word.Start < seconds).Select(word => word.Text).ToList();
            if (begun.Count == 0)
            {
                var silent = piece.Timing != null && piece.Timing.Paced && words.Count == 0;
                return (silent ? piece.Text : "", "");
            }
            var end = 0;
            foreach (string word in begun)
            {
                end = EndOfLetters(letters, alphabet.Letters(word), end);
                if (end < 0) // the text says it otherwise
                {
                    return (string.Join(" ", begun), begun[begun.Count - 1]);
                }
            }
            var stop = end;
            while (stop < letters.Count && !Parts(alphabet, letters[stop]))
            {
                stop += 1;
            }
            var first = end;
            while (first > 0 && alphabet.Stripped(letters[first - 1]) != "")
            {
                first -= 1;
            }
            if (begun.Count == words.Count && piece.Timing != null && piece.Timing.Paced)
            {
                stop = letters.Count;
            }
            var whole = WordGesturesRules.WordsOf(alphabet, string.Join("", PlainLists.Part(letters, first, end)));
            return (
                string.Join("", PlainLists.Part(letters, 0, stop)),
                whole.Count > 0 ? whole[whole.Count - 1].Text : begun[begun.Count - 1]
            );
        }

        /// <summary>Return whether a letter after a word is not a mark that belongs to it.</summary>
        private static bool Parts(Alphabet alphabet, string letter)
        {
            return alphabet.Stripped(letter) == "" || WordGesturesRules.Telling(alphabet, new List<string> { letter });
        }

        /// <summary>Return the index after a word in a text, searching from `first`; -1 if it is not there.</summary>
        private static int EndOfLetters(List<string> letters, List<string> word, int first)
        {
            for (int start = first; start < letters.Count - word.Count + 1; start++)
            {
                if (word.Select((item, n) => (n, item)).All(pair => letters[start + pair.Item1] == pair.Item2))
                {
                    return start + word.Count;
                }
            }
            return -1;
        }
    }
}
