// Translated from metagraph/playback/cue_times.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// What of a cue shows at a time, in plain numbers: `player` and `Cue.clip_seconds` have it for arrays.
    /// </summary>
    public static class CueTimesRules
    {
        /// <summary>Return how much of a cue shows at a time, 0..1.</summary>
        public static double CueWeight(Cue cue, double time)
        {
            if (time < cue.Start || time >= cue.End)
            {
                return 0.0;
            }
            var rise = cue.BlendIn > 0.0 ? Ease((time - cue.Start) / cue.BlendIn) : 1.0;
            var fall = cue.BlendOut > 0.0 ? Ease((cue.End - time) / cue.BlendOut) : 1.0;
            return rise * fall;
        }

        /// <summary>Return the second of its clip that a cue plays at a time.</summary>
        public static double CueSeconds(Cue cue, double time)
        {
            var elapsed = time - cue.Start;
            if (cue.Hold <= 0.0)
            {
                return cue.Entry + elapsed * cue.Tempo;
            }
            var held = Math.Min(Math.Max(elapsed - (cue.HoldFrom - cue.Entry) / cue.Tempo, 0.0), cue.Hold);
            var more = (elapsed - held) * (cue.Tempo - 1.0);
            return cue.Entry + elapsed - held + more + held * ((cue.HoldTo - cue.HoldFrom) / cue.Hold);
        }

        /// <summary>Return 3 x^2 - 2 x^3 of x within 0..1.</summary>
        public static double Ease(double x)
        {
            x = Math.Min(Math.Max(x, 0.0), 1.0);
            return x * x * (3.0 - 2.0 * x);
        }
    }
}
