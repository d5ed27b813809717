using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>Which shape the mouth has: the voices of what is said, at any time.</summary>
    internal sealed class Lips
    {
        private const double Closing = 0.12; // seconds the mouth takes to close where speech was cut
        private static readonly Func<Speech, double> Start = speech => speech.Start, End = speech => speech.End;
        // Room for a speech's shapes at three moments, and smoothed over them: a frame makes no garbage.
        private readonly List<double> before = Room(), now = Room(), after = Room(), soft = Room();

        private static List<double> Room()
        {
            return new List<double>(new double[14]);
        }

        /// <summary>Write how much of each shape but silence the mouth shows at a time [14].</summary>
        public void Shapes(Track track, Voices voices, double smoothing, double time, double[] shapes)
        {
            Array.Clear(shapes, 0, shapes.Length);
            int last = Basics.BisectRight(track.Speeches, time + smoothing, Start);
            for (int n = Basics.BisectLeft(track.Speeches, time - Closing - smoothing, End); n < last; n++)
            {
                Speech speech = track.Speeches[n];
                if (!(time > speech.Start - smoothing && time < speech.End + Closing + smoothing))
                {
                    continue;
                }
                Voice voice = voices.Of(speech);
                Show(speech, voice, time, now);
                List<double> shown = now;
                if (smoothing > 0)
                {
                    Show(speech, voice, time - smoothing, before);
                    Show(speech, voice, time + smoothing, after);
                    MouthRules.Soften(soft, before, now, after);
                    shown = soft;
                }
                for (int v = 0; v < shapes.Length; v++)
                {
                    shapes[v] += shown[v];
                }
            }
            double sum = 0.0; // two speeches may meet; together they are one mouth
            foreach (double shape in shapes)
            {
                sum += shape;
            }
            for (int v = 0; v < shapes.Length && sum > 1.0; v++)
            {
                shapes[v] /= sum;
            }
        }

        /// <summary>Write a speech's shapes at a time.</summary>
        private static void Show(Speech speech, Voice voice, double time, List<double> shapes)
        {
            if (time < speech.Start)
            {
                for (int v = 0; v < shapes.Count; v++)
                {
                    shapes[v] = 0.0;
                }
                return;
            }
            double said = Math.Min(time, speech.End) - ItemsRules.FindLineStart(speech);
            int low = Math.Min(Math.Max(Basics.BisectRight(voice.Times, said) - 1, 0), voice.Times.Length - 2);
            double gap = Math.Max(voice.Times[low + 1] - voice.Times[low], 1e-9);
            double part = Basics.Clamp((said - voice.Times[low]) / gap, 0.0, 1.0);
            double share = 1 - Basics.Ease((time - speech.End) / Closing);
            for (int v = 0; v < shapes.Count; v++)
            {
                shapes[v] = share * (voice.Weights[low][v + 1] * (1 - part) + voice.Weights[low + 1][v + 1] * part);
            }
        }
    }
}
