using System;

namespace Metagraph
{
    /// <summary>
    /// A pose, in arrays to be used again. Rotations [J] local xyzw, Translations [J] local metres, Morphs [K] weights 0..1 in the
    /// order of Graph.Morphs. Right-handed, Y up, as glTF.
    /// </summary>
    public sealed class BodyPose
    {
        public readonly float[] Rotations, Translations, Morphs;

        public BodyPose(Graph graph)
        {
            Rotations = (float[])graph.BaseRotations.Clone();
            Translations = (float[])graph.BaseTranslations.Clone();
            Morphs = new float[graph.Morphs.Count];
        }

        /// <summary>Write the joints' positions [J] xyz in the character's space, metres.</summary>
        public void Positions(Graph graph, double[] positions)
        {
            var turned = new Quat[graph.Joints.Length];
            for (int j = 0; j < turned.Length; j++)
            {
                int parent = graph.Joints[j].Parent;
                Quat above = parent < 0 ? Quat.Identity : turned[parent];
                Vec at = above.Rotate(new Vec(Translations[3 * j], Translations[3 * j + 1], Translations[3 * j + 2]));
                turned[j] = above * Quat.Of(Rotations, j);
                positions[3 * j] = at.X + (parent < 0 ? 0 : positions[3 * parent]);
                positions[3 * j + 1] = at.Y + (parent < 0 ? 0 : positions[3 * parent + 1]);
                positions[3 * j + 2] = at.Z + (parent < 0 ? 0 : positions[3 * parent + 2]);
            }
        }
    }

    /// <summary>
    /// The one evaluator: what pose a plan gives at a time. Layers add their offsets from the base pose, base^-1 * q, multiplied on the
    /// right. Works in arrays of its own, so no frame makes garbage; one for each thread.
    /// </summary>
    public sealed class Player
    {
        /// <summary>A layer's offsets on all joints it reaches.</summary>
        private sealed class Sample
        {
            public readonly Quat[] Turns;
            public readonly Vec[] Moves;

            public Sample(int joints)
            {
                Turns = new Quat[joints];
                Moves = new Vec[joints];
            }
        }

        private readonly Graph graph;
        private readonly Enliven life;
        private readonly Contacts contacts;
        private readonly Weight weight;
        // A clip is led while no joint is farther from the stance than the first, and crossfaded where one is farther than the second:
        // cosines of half that turn.
        private const double LeadWithin = 0.966, FadeBeyond = 0.866;

        private readonly Quat[] composed;
        private readonly Vec[] places;
        private readonly Sample shown, stance, edge, before, seam;

        public Player(Graph graph)
        {
            this.graph = graph;
            int count = graph.Joints.Length;
            composed = new Quat[count];
            places = new Vec[count];
            shown = new Sample(count);
            stance = new Sample(count);
            edge = new Sample(count);
            before = new Sample(count);
            seam = new Sample(count);
            life = graph.Body != null ? new Enliven(graph) : null;
            contacts = graph.ContactRig != null ? new Contacts(graph) : null;
            weight = graph.WeightRig != null ? new Weight(graph) : null;
        }

        /// <summary>
        /// Write the composed pose at a time; alive: with the life layers, as far as the project has them on. Times before 0 and after
        /// the plan's end rest in the first and last stance. Actions whose clip is missing show their stance.
        /// </summary>
        public void PoseAt(Plan plan, double time, bool alive, BodyPose pose)
        {
            for (int j = 0; j < composed.Length; j++)
            {
                composed[j] = Quat.Of(graph.BaseRotations, j);
                places[j] = Base(j);
            }
            Array.Clear(pose.Morphs, 0, pose.Morphs.Length);
            foreach (string layer in Basics.Layers)
            {
                if (plan.Layers[layer].Rests.Count > 0)
                {
                    Compose(plan.Layers[layer], graph.Layers[layer], time);
                    AddMorphs(plan.Layers[layer], time, pose.Morphs);
                }
            }
            for (int j = 0; j < composed.Length; j++)
            {
                composed[j].Unit.Write(pose.Rotations, j);
                pose.Translations[3 * j] = (float)places[j].X;
                pose.Translations[3 * j + 1] = (float)places[j].Y;
                pose.Translations[3 * j + 2] = (float)places[j].Z;
            }
            if (alive && weight != null && graph.Life.On && plan.Life.End > 0)
            {
                weight.Answer(plan, time, pose);
            }
            if (alive && life != null && graph.Life.On && plan.Life.End > 0)
            {
                life.Add(plan, time, pose);
            }
            contacts?.Touch(plan, time, pose);
            for (int k = 0; k < pose.Morphs.Length; k++)
            {
                pose.Morphs[k] = Math.Min(1f, Math.Max(0f, pose.Morphs[k]));
            }
        }

        private Vec Base(int joint)
        {
            return new Vec(graph.BaseTranslations[3 * joint], graph.BaseTranslations[3 * joint + 1], graph.BaseTranslations[3 * joint + 2]);
        }

        private void Compose(LayerPlan plan, LayerGraph of, double time)
        {
            Sample found = LayerAt(plan, of.Reach, time);
            for (int n = 0; n < of.Reach.Length; n++)
            {
                int j = of.Reach[n];
                double weight = of.Weights[n];
                composed[j] *= weight == 1 ? found.Turns[j] : found.Turns[j].Power(weight);
                places[j] += found.Moves[j] * weight;
            }
        }

        /// <summary>A layer's offsets at a time.</summary>
        private Sample LayerAt(LayerPlan plan, int[] reach, double time)
        {
            Cue cue = plan.CueAt(time);
            Clip motion = cue != null ? cue.Action.Clip.Motion : null;
            if (motion == null)
            {
                Stance(plan, reach, time);
                return stance;
            }
            ShowCue(motion, cue, reach, time);
            bool entering = time < cue.Start + cue.BlendIn, leaving = time >= cue.End - cue.BlendOut;
            double[] mask = cue.Action.Mask;
            if (!entering && !leaving && mask == null && cue.Extent == 1)
            {
                return shown;
            }
            Stance(plan, reach, time);
            if ((entering || leaving) && cue.Repeats) // at its ends it moves
            {
                Mix(stance, shown, cue.Weight(time), reach, shown);
            }
            else if (entering || leaving)
            {
                Show(motion, entering ? cue.Entry : cue.ClipSeconds(cue.End), reach, edge);
                Blend(cue.Weight(time), reach);
            }
            if (cue.Extent != 1)
            {
                Extend(cue.Extent, reach);
            }
            foreach (int j in reach)
            {
                if (mask != null && mask[j] < 1)
                {
                    shown.Turns[j] = Quat.Nlerp(stance.Turns[j], shown.Turns[j], mask[j]);
                    shown.Moves[j] = stance.Moves[j] + (shown.Moves[j] - stance.Moves[j]) * mask[j];
                }
            }
            return shown;
        }

        /// <summary>
        /// Show what a cue plays of its clip, without its blends. Where it repeats, it goes on from where the cycle before it ended.
        /// </summary>
        private void ShowCue(Clip motion, Cue cue, int[] reach, double time)
        {
            Show(motion, cue.ClipSeconds(time), reach, shown);
            double left = CueTimesRules.SeamLeft(cue, time);
            if (left > 0)
            {
                Show(motion, cue.CycleFrom, reach, edge);
                Show(motion, cue.CycleTo, reach, seam);
                Lead(edge, seam, left, reach);
            }
        }

        /// <summary>
        /// Blend what is shown in from, or out to, its stance. Where the clip's pose at that edge is near the stance, lead the clip:
        /// add what the stance differs from it. A crossfade would hold the clip back and then hurry it. Where a joint has far to
        /// turn, crossfade: led, it would do its whole movement around a pose that the clip never has.
        /// </summary>
        private void Blend(double weight, int[] reach)
        {
            double near = 1;
            foreach (int j in reach)
            {
                near = Math.Min(near, Math.Abs(Quat.Dot(edge.Turns[j], stance.Turns[j])));
            }
            double far = Basics.Ease((LeadWithin - near) / (LeadWithin - FadeBeyond));
            if (far > 0)
            {
                Mix(stance, shown, weight, reach, seam);
            }
            Lead(edge, stance, 1 - weight, reach);
            if (far > 0)
            {
                Mix(shown, seam, far, reach, shown);
            }
        }

        /// <summary>Add to what is shown a part of the way from a pose to another.</summary>
        private void Lead(Sample from, Sample to, double weight, int[] reach)
        {
            foreach (int j in reach)
            {
                shown.Turns[j] = shown.Turns[j] * Quat.Nlerp(Quat.Identity, from.Turns[j].Inverse * to.Turns[j], weight);
                shown.Moves[j] += (to.Moves[j] - from.Moves[j]) * weight;
            }
        }

        /// <summary>Play what is shown larger or smaller round the stance.</summary>
        private void Extend(double extent, int[] reach)
        {
            foreach (int j in reach)
            {
                if (extent > 1 ? graph.Joints[j].Larger : graph.Joints[j].Smaller)
                {
                    Quat apart = stance.Turns[j].Inverse * shown.Turns[j];
                    shown.Turns[j] = stance.Turns[j] * apart.Power(MoodRules.TurnExtent(extent, apart.W));
                    shown.Moves[j] = stance.Moves[j] + (shown.Moves[j] - stance.Moves[j]) * extent;
                }
            }
        }

        /// <summary>Find the offsets of the stance that lies under the cues.</summary>
        private void Stance(LayerPlan plan, int[] reach, double time)
        {
            int current = plan.RestAt(time);
            Rest rest = plan.Rests[current];
            Loop(rest, time, reach, stance);
            if (current > 0 && rest.FadeStart + rest.Fade > time)
            {
                Loop(plan.Rests[current - 1], time, reach, before);
                Mix(before, stance, Basics.Ease((time - rest.FadeStart) / rest.Fade), reach, stance);
            }
        }

        private void Loop(Rest rest, double time, int[] reach, Sample found)
        {
            Clip motion = rest.Action.Clip.Motion;
            if (motion == null)
            {
                foreach (int j in reach)
                {
                    found.Turns[j] = Quat.Identity;
                    found.Moves[j] = new Vec();
                }
                return;
            }
            double other, old, seconds = LoopSeconds(rest, time, out other, out old);
            Show(motion, seconds, reach, found);
            if (old > 0)
            {
                Show(motion, other, reach, seam);
                Mix(found, seam, old, reach, found);
            }
        }

        /// <summary>
        /// Clip seconds of a loop, those of its seam's other side, and how much of that shows. The loop's last seconds fade into its
        /// first, and its period is that much shorter. One with a seam waits in its first pose until it begins.
        /// </summary>
        private static double LoopSeconds(Rest rest, double time, out double other, out double old)
        {
            GraphAction action = rest.Action;
            double elapsed = time - rest.Start, seam = Math.Min(action.Timing.BlendIn, action.Length / 2), period = action.Length - seam;
            other = action.Start;
            old = 0.0;
            if (period <= 0)
            {
                return action.Start;
            }
            double phase = (seam > 0 ? Math.Max(elapsed, 0.0) : elapsed) % period;
            phase = phase < 0 ? phase + period : phase;
            if (seam > 0 && elapsed >= period)
            {
                other = action.Start + Math.Min(period + phase, action.Length);
                old = 1 - Basics.Ease(phase / seam);
            }
            return action.Start + phase;
        }

        /// <summary>Crossfade two samples, `weight` of the second.</summary>
        private static void Mix(Sample a, Sample b, double weight, int[] reach, Sample found)
        {
            foreach (int j in reach)
            {
                found.Turns[j] = Quat.Nlerp(a.Turns[j], b.Turns[j], weight);
                found.Moves[j] = a.Moves[j] + (b.Moves[j] - a.Moves[j]) * weight;
            }
        }

        /// <summary>Find a clip's offsets from the base pose at clip seconds: joined by lerp and normalised lerp between frames.</summary>
        private void Show(Clip clip, double seconds, int[] reach, Sample found)
        {
            int low, high;
            double part;
            clip.Locate(seconds, out low, out high, out part);
            foreach (int j in reach)
            {
                Quat turned = Quat.Nlerp(clip.Rotation(low, j), clip.Rotation(high, j), part);
                found.Turns[j] = Quat.Of(graph.BaseRotations, j).Inverse * turned;
                found.Moves[j] = new Vec(clip.Still[3 * j], clip.Still[3 * j + 1], clip.Still[3 * j + 2]) - Base(j);
            }
            int count = clip.Translated.Length;
            for (int n = 0; n < count; n++)
            {
                int a = 3 * (low * count + n), b = 3 * (high * count + n);
                float[] at = clip.Translations;
                var from = new Vec(at[a], at[a + 1], at[a + 2]);
                var to = new Vec(at[b], at[b + 1], at[b + 2]);
                found.Moves[clip.Translated[n]] = from + (to - from) * part - Base(clip.Translated[n]);
            }
        }

        /// <summary>Add the morph target weights of a layer's clips.</summary>
        private static void AddMorphs(LayerPlan plan, double time, float[] morphs)
        {
            Cue cue = plan.CueAt(time);
            double weight = cue != null ? cue.Weight(time) : 0.0, other, old;
            if (cue != null)
            {
                AddMorphs(cue.Action.Clip.Motion, cue.ClipSeconds(time), weight, morphs);
            }
            Rest rest = plan.Rests[plan.RestAt(time)];
            double seconds = LoopSeconds(rest, time, out other, out old);
            AddMorphs(rest.Action.Clip.Motion, seconds, (1 - weight) * (1 - old), morphs);
            AddMorphs(rest.Action.Clip.Motion, other, (1 - weight) * old, morphs);
        }

        private static void AddMorphs(Clip clip, double seconds, double share, float[] morphs)
        {
            if (clip == null || clip.Morphs.Length == 0 || share <= 0)
            {
                return;
            }
            int low, high, count = clip.Morphs.Length;
            double part;
            clip.Locate(seconds, out low, out high, out part);
            for (int k = 0; k < count; k++)
            {
                double a = clip.Weights[low * count + k], b = clip.Weights[high * count + k];
                morphs[clip.Morphs[k]] += (float)(share * (a + (b - a) * part));
            }
        }
    }
}
