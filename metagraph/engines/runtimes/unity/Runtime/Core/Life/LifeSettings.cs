using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>What a mode makes of the amounts and rates: factors, 1 leaves them as they are.</summary>
    public sealed class Manner
    {
        public double Breathing = 1.0, BreathRate = 1.0, AversionRate = 1.0, AversionLength = 1.0, AversionAngle = 1.0;
        public double Saccades = 1.0, SaccadeRate = 1.0, Blinks = 1.0;
        private const double Most = 4.0;

        internal static Manner From(Node json)
        {
            var manner = new Manner();
            foreach (string name in json.Names)
            {
                Node value = json[name];
                switch (name)
                {
                    case "breathing": manner.Breathing = value.Within(0, Most); break;
                    case "breath_rate": manner.BreathRate = value.Within(0, Most); break;
                    case "aversion_rate": manner.AversionRate = value.Within(0, Most); break;
                    case "aversion_length": manner.AversionLength = value.Within(0, Most); break;
                    case "aversion_angle": manner.AversionAngle = value.Within(0, Most); break;
                    case "saccades": manner.Saccades = value.Within(0, Most); break;
                    case "saccade_rate": manner.SaccadeRate = value.Within(0, Most); break;
                    case "blinks": manner.Blinks = value.Within(0, Most); break;
                }
            }
            return manner;
        }

        /// <summary>What it makes of the amounts, each that a mood changes times a factor.</summary>
        internal Manner Scaled(double breathing, double breathRate, double aversionRate, double saccadeRate, double blinks)
        {
            var ways = (Manner)MemberwiseClone();
            ways.Breathing *= breathing;
            ways.BreathRate *= breathRate;
            ways.AversionRate *= aversionRate;
            ways.SaccadeRate *= saccadeRate;
            ways.Blinks *= blinks;
            return ways;
        }
    }

    /// <summary>What planning asks of the settings.</summary>
    public static class LifeRules
    {
        public static Manner GetManner(LifeSettings life, string mode)
        {
            return life.Manner(mode);
        }

        public static Manner Scaled(
            Manner ways, double breathing, double breathRate, double aversionRate, double saccadeRate, double blinks)
        {
            return ways.Scaled(breathing, breathRate, aversionRate, saccadeRate, blinks);
        }

        public static bool IsSameLife(LifeSettings one, LifeSettings other)
        {
            return one == other;
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
        public double Lids = 1.0, Blinks = 17.0, AccentBlinks = 0.7, BlinkClose = 0.07, BlinkOpen = 0.10, Lips = 1.0, LipSmoothing = 0.03;
        public double FollowThrough = 1.0, ShoulderLift = 1.0, PlantedFeet = 1.0;
        public double Expressions = 1.0, AccentBrows = 0.4;
        public double Valence, Arousal, Intensity = 1.0;

        private readonly Dictionary<string, Manner> modes = new Dictionary<string, Manner>
        {
            { "idle", new Manner { AversionRate = 1.1, AversionLength = 2.4, AversionAngle = 1.4, SaccadeRate = 0.85 } },
            { "listening", new Manner { AversionRate = 1.0, AversionLength = 1.5, AversionAngle = 1.1, Saccades = 0.9, Blinks = 1.45 } },
            { "talking", new Manner { Breathing = 1.15, BreathRate = 1.1, AversionRate = 1.35, AversionLength = 2.3, AversionAngle = 1.3, Blinks = 0.65 } },
            { "thinking", new Manner { Breathing = 0.8, AversionRate = 1.1, AversionLength = 3.8, AversionAngle = 1.3, Saccades = 0.7, SaccadeRate = 0.6 } },
            { "reacting", new Manner { Breathing = 1.2, AversionRate = 0.2, AversionAngle = 0.6, Saccades = 0.7, Blinks = 1.6 } },
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
                    case "stillness": life.Stillness = value.Within(0, 1); break;
                    case "breathing": life.Breathing = value.Within(0, 2); break;
                    case "breath_rate": life.BreathRate = value.Within(0, 40); break;
                    case "gaze": life.Gaze = value.Within(0, 1); break;
                    case "head_share": life.HeadShare = value.Within(0, 1); break;
                    case "aversion_rate": life.AversionRate = value.Within(0, 40); break;
                    case "aversion_length": life.AversionLength = value.Within(0, 5); break;
                    case "aversion_angle": life.AversionAngle = value.Within(0, 40); break;
                    case "saccades": life.Saccades = value.Within(0, 2); break;
                    case "saccade_rate": life.SaccadeRate = value.Within(0, 180); break;
                    case "lids": life.Lids = value.Within(0, 2); break;
                    case "blinks": life.Blinks = value.Within(0, 60); break;
                    case "accent_blinks": life.AccentBlinks = value.Within(0, 1); break;
                    case "blink_close": life.BlinkClose = value.Within(0.02, 1); break;
                    case "blink_open": life.BlinkOpen = value.Within(0.02, 1); break;
                    case "lips": life.Lips = value.Within(0, 2); break;
                    case "lip_smoothing": life.LipSmoothing = value.Within(0, 0.2); break;
                    case "expressions": life.Expressions = value.Within(0, 2); break;
                    case "accent_brows": life.AccentBrows = value.Within(0, 1); break;
                    case "valence": life.Valence = value.Within(-1, 1); break;
                    case "arousal": life.Arousal = value.Within(-1, 1); break;
                    case "intensity": life.Intensity = value.Within(0, 2); break;
                    case "follow_through": life.FollowThrough = value.Within(0, 2); break;
                    case "shoulder_lift": life.ShoulderLift = value.Within(0, 2); break;
                    case "planted_feet": life.PlantedFeet = value.Within(0, 1); break;
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
