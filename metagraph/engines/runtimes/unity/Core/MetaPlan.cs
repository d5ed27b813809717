// Translated from metagraph/playback/plan.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// What an agent or animator asks for, at any level of abstraction.
    ///
    /// id: unique; it keys the random draws. start: seconds. duration: how long the activity is wanted, None for one action.
    /// action: id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the stance to go
    /// to (kind "transition"). priority: higher wins. resume: whether, when something more important cuts it, its remainder goes
    /// on afterwards. stroke: when a gesture's stroke should come; `start` is then the earliest it may begin. hold: seconds its
    /// hold should last, None for as long as it was made. prepare: whether its preparation plays. among: ids of the only actions
    /// it may be, any where empty.
    /// </summary>
    public sealed class MetaRequest
    {
        public readonly string Id;
        public readonly string Layer;
        public readonly string Kind;
        public readonly double Start;
        public readonly double? Duration;
        public readonly string Action;
        public readonly List<string> Tags;
        public readonly string Limb;
        public readonly string Stance;
        public readonly int Priority;
        public readonly bool Resume;
        public readonly double? Stroke;
        public readonly double? Hold;
        public readonly bool Prepare;
        public readonly List<string> Among;

        public MetaRequest(
            string id,
            string layer,
            string kind,
            double start,
            double? duration = null,
            string action = null,
            List<string> tags = null,
            string limb = null,
            string stance = null,
            int priority = MetaPlanRules.Asked,
            bool resume = false,
            double? stroke = null,
            double? hold = null,
            bool prepare = true,
            List<string> among = null
        )
        {
            Id = id;
            Layer = layer;
            Kind = kind;
            Start = start;
            Duration = duration;
            Action = action;
            Tags = tags ?? new List<string>();
            Limb = limb;
            Stance = stance;
            Priority = priority;
            Resume = resume;
            Stroke = stroke;
            Hold = hold;
            Prepare = prepare;
            Among = among ?? new List<string>();
        }
    }

    /// <summary>
    /// Where writing stands: before meta action `number`, in state number `state` (-1: none yet), which ended at `time` seconds.
    /// </summary>
    public sealed class Cursor
    {
        public readonly int Number;
        public readonly int State;
        public readonly double Time;

        public Cursor(int number = 0, int state = -1, double time = 0.0)
        {
            Number = number;
            State = state;
            Time = time;
        }
    }

    /// <summary>
    /// A request placed in time: `start`..`end` is the window it may use. written: by the Markov model, not asked for. part: 0
    /// for the request itself, n for its n-th remainder after a cut.
    /// </summary>
    public sealed class MetaAction
    {
        public readonly MetaRequest Request;
        public readonly double Start;
        public readonly double End;
        public readonly int Part;
        public readonly bool Written;

        public MetaAction(MetaRequest request, double start, double end, int part = 0, bool written = false)
        {
            Request = request;
            Start = start;
            End = end;
            Part = part;
            Written = written;
        }

        /// <summary>
        /// How important it is: its request's priority; what a model wrote gives way to all that is asked for.
        /// </summary>
        public double Rank
        {
            get
            {
                return Written ? double.NegativeInfinity : Request.Priority;
            }
        }

        /// <summary>What keys this meta action's random draws.</summary>
        public string Key
        {
            get
            {
                return Part == 0 ? Request.Id : Request.Id + "+" + PlainText.Of(Part);
            }
        }
    }

    /// <summary>
    /// What became of a meta action that was not simply played as asked. played: whether something of it still plays.
    /// </summary>
    public sealed class Report
    {
        public readonly string Request;
        public readonly string Outcome;
        public readonly string Message;
        public readonly string Layer;
        public readonly double At;
        public readonly bool Played;
        public readonly bool Written;

        public Report(
            string request,
            string outcome,
            string message,
            string layer,
            double at,
            bool played = false,
            bool written = false
        )
        {
            Request = request;
            Outcome = outcome;
            Message = message;
            Layer = layer;
            At = at;
            Played = played;
            Written = written;
        }
    }

    public static class MetaPlanRules
    {
        public const int Asked = 1; // default priority of a request
        public const int Written = 0; // priority of what the Markov model writes
    }
}
