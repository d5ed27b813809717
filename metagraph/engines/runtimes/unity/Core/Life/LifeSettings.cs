using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>What a mode makes of the amounts and rates: factors, 1 leaves them as they are.</summary>
    public sealed class Manner
    {
        public double Breathing = 1.0, BreathRate = 1.0, AversionRate = 1.0, AversionLength = 1.0, AversionAngle = 1.0;
        public double Saccades = 1.0, SaccadeRate = 1.0, Blinks = 1.0;

        internal static Manner From(Node json)
        {
            var manner = new Manner();
            Node found;
            manner.Breathing = json.Maybe("breathing", out found) ? found.Number : manner.Breathing;
            manner.BreathRate = json.Maybe("breath_rate", out found) ? found.Number : manner.BreathRate;
            manner.AversionRate = json.Maybe("aversion_rate", out found) ? found.Number : manner.AversionRate;
            manner.AversionLength = json.Maybe("aversion_length", out found) ? found.Number : manner.AversionLength;
            manner.AversionAngle = json.Maybe("aversion_angle", out found) ? found.Number : manner.AversionAngle;
            manner.Saccades = json.Maybe("saccades", out found) ? found.Number : manner.Saccades;
            manner.SaccadeRate = json.Maybe("saccade_rate", out found) ? found.Number : manner.SaccadeRate;
            manner.Blinks = json.Maybe("blinks", out found) ? found.Number : manner.Blinks;
            return manner;
        }
    }

    /// <summary>
    /// How alive the character is. Rates are a minute, lengths seconds, angles degrees. Stillness multiplies every amount by
    /// 1 - stillness; at 1 only lips and what is asked for move. An export leaves out what is as it stands here.
    /// </summary>
    public sealed class LifeSettings
    {
        public bool On = true;
        public double Stillness, Breathing = 1.0, BreathRate = 14.0, Gaze = 1.0, HeadShare = 0.6;
        public double AversionRate = 12.0, AversionLength = 0.93, AversionAngle = 14.0, Saccades = 1.0, SaccadeRate = 60.0;
        public double Lids = 1.0, Blinks = 17.0, AccentBlinks = 1.0, BlinkClose = 0.07, BlinkOpen = 0.10, Lips = 1.0, LipSmoothing = 0.03;

        private readonly Dictionary<string, Manner> modes = new Dictionary<string, Manner>
        {
            { "idle", new Manner { AversionRate = 1.1, AversionLength = 2.4, AversionAngle = 1.4, SaccadeRate = 0.85 } },
            { "listening", new Manner { AversionRate = 0.6, AversionLength = 0.46, AversionAngle = 0.8, Saccades = 0.9 } },
            { "talking", new Manner { Breathing = 1.15, BreathRate = 1.1, AversionRate = 1.25 } },
        };

        public Manner Manner(string mode)
        {
            return modes[mode];
        }

        internal static LifeSettings From(Node json)
        {
            var life = new LifeSettings();
            foreach (string name in json.Names)
            {
                Node value = json[name];
                switch (name)
                {
                    case "on": life.On = value.Flag; break;
                    case "stillness": life.Stillness = value.Number; break;
                    case "breathing": life.Breathing = value.Number; break;
                    case "breath_rate": life.BreathRate = value.Number; break;
                    case "gaze": life.Gaze = value.Number; break;
                    case "head_share": life.HeadShare = value.Number; break;
                    case "aversion_rate": life.AversionRate = value.Number; break;
                    case "aversion_length": life.AversionLength = value.Number; break;
                    case "aversion_angle": life.AversionAngle = value.Number; break;
                    case "saccades": life.Saccades = value.Number; break;
                    case "saccade_rate": life.SaccadeRate = value.Number; break;
                    case "lids": life.Lids = value.Number; break;
                    case "blinks": life.Blinks = value.Number; break;
                    case "accent_blinks": life.AccentBlinks = value.Number; break;
                    case "blink_close": life.BlinkClose = value.Number; break;
                    case "blink_open": life.BlinkOpen = value.Number; break;
                    case "lips": life.Lips = value.Number; break;
                    case "lip_smoothing": life.LipSmoothing = value.Number; break;
                    case "modes":
                        foreach (string mode in value.Names)
                        {
                            life.modes[mode] = Metagraph.Manner.From(value[mode]);
                        }
                        break;
                }
            }
            return life;
        }
    }
}
