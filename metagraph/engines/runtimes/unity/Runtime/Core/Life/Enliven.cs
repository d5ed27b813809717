using System;

namespace Metagraph
{
    /// <summary>
    /// The life layers at a time: what they add to the composed pose. All is additive: a turn is multiplied on the right of a joint's
    /// rotation, a shift is added to its translation. Works in arrays of its own: nothing is allocated while the plan stays.
    /// </summary>
    internal sealed class Enliven
    {
        private const double Inhale = 0.4; // of a breath
        private const double MorphWide = 0.6; // of a target that opens wide, for a lid as far open as it would be shut
        private static readonly double MorphLook = Solve.Radians(30); // the turn of an eye that a morph target of a look stands for
        private static readonly double MorphFollows = 0.6 / Solve.Radians(40); // how far a target shuts for an eye a radian down
        // Blink, seven of each eye, the channels that joints have, too, then what moods and expressions show.
        private const int Moods = 15 + FaceRig.Channels, Values = Moods + 6;
        private static readonly string[] MoodFace = { "smile", "frown", "brow_down", "brow_up", "brows", "cheeks" };

        private readonly Graph graph;
        private readonly Body body;
        private readonly Solve solve;
        private readonly Quat[] chain, faces;
        private readonly Quat[] shoulders, eyes = new Quat[2];
        private readonly Vec[] places;
        private readonly double[] channels = new double[FaceRig.Channels], shapes = new double[14], values = new double[Values];
        private readonly double[] shut = new double[4], eyeLeft = new double[2], eyeUp = new double[2], weights;
        private readonly Lips lips = new Lips();
        private readonly FaceShown face = new FaceShown();
        private double blink, full;
        private Gaze gaze;
        private Bearing bears = new Bearing();
        private Lane felt; // that `settled` is a place of
        private int settled = -1; // the place of the mood that `bears` is of, -1 on the way from one to the next

        public Enliven(Graph graph)
        {
            this.graph = graph;
            body = graph.Body;
            solve = new Solve(body);
            chain = new Quat[body.Chain.Length];
            places = new Vec[body.Chain.Length];
            shoulders = new Quat[body.Shoulders.Length];
            faces = new Quat[body.Face.Joints.Length];
            weights = new double[graph.Morphs.Count];
        }

        /// <summary>The place among a face's values of a channel by its name in the export; -1 for one nobody knows.</summary>
        internal static int ValueOf(string channel)
        {
            string[] sided = { "blink", "wide", "look_left", "look_right", "look_up", "look_down" };
            for (int n = 0; n < sided.Length; n++)
            {
                if (channel == sided[n] + "_left" || channel == sided[n] + "_right")
                {
                    return 1 + n + (channel.EndsWith("_right", StringComparison.Ordinal) ? 7 : 0);
                }
            }
            int mood = Array.IndexOf(MoodFace, channel);
            if (mood >= 0)
            {
                return Moods + mood;
            }
            if (channel == "blink" || channel == "jaw_open")
            {
                return channel == "blink" ? 0 : 15 + FaceRig.JawOpen;
            }
            int viseme = channel.StartsWith("viseme_", StringComparison.Ordinal) ? Array.IndexOf(Voice.Visemes, channel.Substring(7)) : -1;
            return viseme > 0 ? 15 + FaceRig.JawOpen + viseme : -1;
        }

        /// <summary>Add breathing, gaze, lids and lips to a composed pose and its morph target weights.</summary>
        public void Add(Plan plan, double time, BodyPose pose)
        {
            Find(plan, time, pose.Rotations, pose.Translations);
            Morphs(plan, time, pose.Morphs);
            Turn(pose);
        }

        private void Turn(BodyPose pose)
        {
            int looker = 0;
            FaceRig face = body.Face;
            float[] rotations = pose.Rotations;
            // A joint may be of the face and an eye, too; then the face has it, and what it had was read before.
            for (int n = 0; n < faces.Length; n++)
            {
                faces[n] = Quat.Of(rotations, face.Joints[n]);
            }
            for (int n = 0; n < shoulders.Length; n++)
            {
                shoulders[n] = Quat.Of(rotations, body.Shoulders[n]);
            }
            for (int n = 0; n < chain.Length; n++)
            {
                bool looks = looker < body.Lookers.Length && body.Lookers[looker].Place == n && gaze != null;
                Quat turned = looks ? chain[n] * Quat.Turn(solve.Turns[looker++]) : chain[n];
                turned.Write(rotations, body.Chain[n]);
            }
            for (int n = 0; n < shoulders.Length; n++)
            {
                Vec turn = body.ShoulderTurns[n] * (full + bears.Lift) + body.ShoulderTenses[n] * bears.Tension
                    + body.ShoulderCloses[n] * bears.Closed;
                (shoulders[n] * Quat.Turn(turn)).Write(rotations, body.Shoulders[n]);
            }
            for (int n = 0; n < 2; n++)
            {
                if (body.Eyes[n].Joint >= 0)
                {
                    Vec turn = body.Eyes[n].TurnLeft * eyeLeft[n] + body.Eyes[n].TurnUp * eyeUp[n];
                    (eyes[n] * Quat.Turn(turn)).Write(rotations, body.Eyes[n].Joint);
                }
            }
            for (int n = 0; n < faces.Length; n++)
            {
                (faces[n] * Quat.Turn(Sum(face.Turns, n))).Write(rotations, face.Joints[n]);
                if (face.Shifted)
                {
                    Vec shift = Sum(face.Shifts, n);
                    pose.Translations[3 * face.Joints[n]] += (float)shift.X;
                    pose.Translations[3 * face.Joints[n] + 1] += (float)shift.Y;
                    pose.Translations[3 * face.Joints[n] + 2] += (float)shift.Z;
                }
            }
        }

        private Vec Sum(Vec[][] shapesOf, int joint)
        {
            var sum = new Vec();
            for (int c = 0; c < channels.Length; c++)
            {
                if (channels[c] != 0)
                {
                    sum += shapesOf[c][joint] * channels[c];
                }
            }
            return sum;
        }

        /// <summary>Add the face's morph target weights, each at most 1.</summary>
        private void Morphs(Plan plan, double time, float[] morphs)
        {
            if (body.Face.Morphs.Count == 0)
            {
                return;
            }
            values[0] = Math.Max((shut[0] + shut[1]) / 2, blink);
            for (int n = 0; n < 2; n++)
            {
                int at = 1 + 7 * n;
                values[at] = shut[n];
                values[at + 1] = -MorphWide * shut[n];
                values[at + 2] = eyeLeft[n] / MorphLook;
                values[at + 3] = -eyeLeft[n] / MorphLook;
                values[at + 4] = eyeUp[n] / MorphLook;
                values[at + 5] = -eyeUp[n] / MorphLook;
            }
            Array.Copy(channels, 0, values, 15, channels.Length);
            ExpressionsRules.ShownFace(face, graph.Life, plan.Life.Swells, plan.Life.Emphases, bears, time);
            foreach (string layer in Basics.Layers)
            {
                Cue cue = plan.Layers[layer].CueAt(time);
                if (cue != null)
                {
                    ExpressionsRules.Answer(face, graph.Life, cue.Action.Tags, cue.Start, cue.End, time);
                }
            }
            ExpressionsRules.Settle(face);
            values[Moods] = face.Smile;
            values[Moods + 1] = face.Frown;
            values[Moods + 2] = face.BrowDown;
            values[Moods + 3] = face.BrowUp;
            values[Moods + 4] = face.Brows;
            values[Moods + 5] = face.Cheeks;
            Array.Clear(weights, 0, weights.Length);
            for (int n = 0; n < body.Face.Morphs.Count; n++)
            {
                MorphShare share = body.Face.Morphs[n];
                if (values[share.Value] > 1e-4)
                {
                    weights[share.Target] += values[share.Value] * share.Weight;
                }
            }
            for (int n = 0; n < weights.Length; n++)
            {
                // As far as clips leave them room.
                morphs[n] += (float)(Math.Min(1.0, weights[n]) * (1.0 - Math.Min(1.0, Math.Max(0.0, morphs[n]))));
            }
        }

        /// <summary>Find what the life layers make of a composed pose.</summary>
        private void Find(Plan plan, double time, float[] rotations, float[] translations)
        {
            LifeSettings life = graph.Life;
            double calm = 1 - life.Stillness;
            full = BreathAt(plan.Life.Breaths, life, time);
            Bear(plan.Life.Moods, time);
            for (int n = 0; n < chain.Length; n++)
            {
                int joint = body.Chain[n];
                chain[n] = Quat.Of(rotations, joint);
                places[n] = new Vec(translations[3 * joint], translations[3 * joint + 1], translations[3 * joint + 2]);
                double angle = full * body.Angles[n] + bears.Droop * body.Bowed[n] + bears.Thrust * body.Thrust[n];
                if (angle != 0)
                {
                    chain[n] *= Quat.About(body.Breath[n], angle);
                }
            }
            eyeLeft[0] = eyeLeft[1] = eyeUp[0] = eyeUp[1] = 0.0;
            if (body.Lookers.Length == 0 || plan.Life.Targets.Count == 0)
            {
                gaze = null;
            }
            else
            {
                if (gaze == null || gaze.Schedule != plan.Life)
                {
                    gaze = new Gaze(plan.Life, life, body, graph.Points);
                }
                gaze.At(time);
                solve.Look(chain, places, gaze, life.Gaze, calm, life.HeadShare);
                Array.Copy(solve.EyesLeft, eyeLeft, 2);
                Array.Copy(solve.EyesUp, eyeUp, 2);
            }
            blink = MoodRules.ShutIn(BlinkAt(plan.Life.Blinks, life, time), bears.Lids);
            FindLids(life, rotations);
            if (life.Lips > 0)
            {
                lips.Shapes(plan.Track, graph.Voices, life.LipSmoothing, time, shapes);
                for (int v = 0; v < shapes.Length; v++)
                {
                    channels[FaceRig.JawOpen + 1 + v] = shapes[v] * life.Lips;
                }
            }
        }

        /// <summary>Find posture and face of the mood that shows; nothing is allocated while that stays.</summary>
        private void Bear(Lane moods, double time)
        {
            if (felt != moods)
            {
                felt = moods;
                settled = -1;
            }
            int place = Math.Max(0, PlainLists.Right(moods.Times, time) - 1);
            bool stays = place == 0 || time - moods.Times[place] >= MoodRules.Fade;
            if (stays && place == settled)
            {
                return;
            }
            Mood mood = MoodRules.Shown(moods.Times, moods.Rows, time);
            bears = mood.Neutral ? new Bearing() : MoodRules.Bearing(mood);
            settled = stays ? place : -1;
        }

        private void FindLids(LifeSettings life, float[] rotations)
        {
            FaceRig face = body.Face;
            double leftDown = -eyeUp[0], rightDown = -eyeUp[1];
            for (int n = 0; n < 2; n++)
            {
                if (body.Eyes[n].Joint >= 0)
                {
                    eyes[n] = Quat.Of(rotations, body.Eyes[n].Joint);
                    leftDown += n == 0 ? eyes[n].Along(body.Eyes[n].Down) : 0.0;
                    rightDown += n == 1 ? eyes[n].Along(body.Eyes[n].Down) : 0.0;
                }
            }
            int[] lids = face.LidJoints;
            bool joints = Math.Max(Math.Max(lids[0], lids[1]), Math.Max(lids[2], lids[3])) >= 0;
            for (int k = 0; k < 4; k++)
            {
                double already = lids[k] >= 0 ? Quat.Of(rotations, lids[k]).Along(face.ShutBy[k]) : 0.0;
                double follows = joints ? face.Follows[k] : k < 2 ? MorphFollows : 0.0;
                shut[k] = Solve.Lid(k % 2 == 0 ? leftDown : rightDown, life.Lids * follows, already, blink);
                channels[k] = shut[k] - already;
            }
            channels[FaceRig.Blink] = blink;
        }

        /// <summary>How full the chest is, 0 at rest, about 1 at the top of a breath.</summary>
        private static double BreathAt(Lane lane, LifeSettings life, double time)
        {
            int n = PlainLists.Right(lane.Times, time) - 1;
            if (n < 0)
            {
                return 0.0;
            }
            double gone = (time - lane.Times[n]) / lane.Rows[n][0];
            double depth = life.Breathing * (1 - life.Stillness) * lane.Rows[n][1];
            return depth * Basics.Ease(Math.Min(gone / Inhale, (1 - gone) / (1 - Inhale)));
        }

        /// <summary>How far a blink has shut the eyes, 0..1.</summary>
        private static double BlinkAt(Lane lane, LifeSettings life, double time)
        {
            double whole = life.BlinkClose + life.BlinkOpen, found = 0.0;
            // A slow one may still be opening when the next begins.
            for (int n = PlainLists.Right(lane.Times, time) - 1; n >= 0 && time - lane.Times[n] < whole; n--)
            {
                double gone = time - lane.Times[n];
                double far = lane.Rows[n][0] == 3 ? ScheduleRules.Half : 1; // some are incomplete
                found = Math.Max(found, far * Basics.Ease(Math.Min(gone / life.BlinkClose, (whole - gone) / life.BlinkOpen)));
            }
            return found;
        }
    }
}
