using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using UnityEngine;
using UnityEngine.Events;

namespace Metagraph
{
    /// <summary>Performs a Metagraph export on the joints below this object, which are found by name, or on its humanoid avatar.</summary>
    [DisallowMultipleComponent]
    [AddComponentMenu("Metagraph/Metagraph Character")]
    public sealed class MetagraphCharacter : MonoBehaviour
    {
        /// <summary>Layer (or "speech"), name of the action (or the line's id, or the words), id of the request.</summary>
        [Serializable]
        public sealed class ActionEvent : UnityEvent<string, string, string> { }

        [Tooltip("The imported file .metagraph")]
        public MetagraphExport asset;
        [Tooltip("Without an asset: the exported JSON")]
        public TextAsset export;
        [Tooltip("The export's file .glb.bytes")]
        public TextAsset glb;
        [Tooltip("Or its path below StreamingAssets (not on Android and the web, where these are no files)")]
        public string glbPath = "";
        [Tooltip("How poses reach the figure. Automatic: an animation job where there is an Animator, else transforms")]
        public PoseOutput output = PoseOutput.Automatic;
        [Tooltip("-1: the project's")]
        public long seed = -1;
        [Tooltip("Whether it performs when nobody asks for anything")]
        public bool idle = true;
        [Tooltip("Whether it breathes, looks and blinks")]
        public bool alive = true;
        [Tooltip("Whether gestures go with the words it says")]
        public bool gestures = true;
        [Tooltip("Of the words that gestures go with: en, de, es, fr")]
        public string language = "en";
        public ActionEvent begin = new ActionEvent();
        public ActionEvent end = new ActionEvent();

        private struct Shape
        {
            public SkinnedMeshRenderer Renderer;
            public int Index, Morph;
            public float Full; // the weight at which it shows in full: 1 or 100, as the importer has it
        }

        private readonly List<Shape> shapes = new List<Shape>();
        private Character character;
        private Talk talk;
        private IPoseWriter writer;
        private double time;

        /// <summary>The character that performs; null where its export could not be loaded.</summary>
        public Character Character
        {
            get { return character; }
        }

        private void Awake()
        {
            try
            {
                if (asset == null && (export == null || (glb == null && string.IsNullOrEmpty(glbPath))))
                {
                    throw new MetagraphException(name, "has no export", "Set Asset to the imported file .metagraph in the inspector.");
                }
                Graph graph = SharedGraphs.Of(
                    asset != null ? (object)asset : export, asset != null ? (object)asset : glb != null ? (object)glb : glbPath, Load);
                character = new Character(graph, new CharacterOptions { Seed = seed < 0 ? (uint?)null : (uint)seed, Idle = idle });
                talk = new Talk(character, language, null, seed < 0 ? 1u : (uint)seed, "said#");
                writer = Bind(graph);
            }
            catch (Exception error) when (error is MetagraphException || error is IOException || error is UnauthorizedAccessException)
            {
                Debug.LogError(error.Message, this);
                character = null;
                enabled = false;
            }
        }

        private void OnDestroy()
        {
            if (writer != null)
            {
                writer.Dispose();
            }
        }

        /// <summary>Read the export, for this and all other characters of the same assets.</summary>
        private Graph Load()
        {
            if (asset != null)
            {
                return Report(asset.Read());
            }
            byte[] bytes = glb != null ? glb.bytes : File.ReadAllBytes(Path.Combine(Application.streamingAssetsPath, glbPath));
            return Report(Graph.Load(export.text, bytes, export.name));
        }

        private Graph Report(Graph graph)
        {
            graph.Problems.ForEach(problem => Debug.LogWarning(problem, this));
            return graph;
        }

        /// <summary>Assets may have been imported anew since the last play, where scripts are not loaded again.</summary>
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            SharedGraphs.Clear();
        }

        /// <summary>Find blend shapes by their names, and how poses are shown.</summary>
        private IPoseWriter Bind(Graph graph)
        {
            BindShapes(graph);
            var animator = GetComponent<Animator>();
            if (output == PoseOutput.Humanoid)
            {
                return new HumanoidWriter(graph, asset != null ? asset.humanoid : "", animator);
            }
            Transform[] joints = FindJoints(graph);
            bool job = output == PoseOutput.AnimationJob || (output == PoseOutput.Automatic && animator != null);
            if (job && animator == null)
            {
                throw new MetagraphException(name, "has no Animator", "Add one, or choose another Output.");
            }
            return job ? (IPoseWriter)new PlayableWriter(animator, joints) : new TransformWriter(joints);
        }

        /// <summary>Return the objects below that are called as joints; null for those that are not there.</summary>
        private Transform[] FindJoints(Graph graph)
        {
            var found = new Dictionary<string, Transform>();
            foreach (Transform one in GetComponentsInChildren<Transform>(true))
            {
                if (!found.ContainsKey(one.name))
                {
                    found[one.name] = one;
                }
            }
            var joints = new Transform[graph.Joints.Length];
            var lost = new List<string>();
            for (int j = 0; j < joints.Length; j++)
            {
                if (!found.TryGetValue(graph.Joints[j].Name, out joints[j]))
                {
                    lost.Add(graph.Joints[j].Name);
                }
            }
            if (lost.Count > 0)
            {
                string names = string.Join(", ", lost.ToArray());
                Debug.LogWarning("no object below is called " + names + "; these joints stay as they are", this);
            }
            return joints;
        }

        private void BindShapes(Graph graph)
        {
            foreach (SkinnedMeshRenderer renderer in GetComponentsInChildren<SkinnedMeshRenderer>(true))
            {
                Mesh mesh = renderer.sharedMesh;
                for (int k = 0; mesh != null && k < graph.Morphs.Count; k++)
                {
                    int index = mesh.GetBlendShapeIndex(graph.Morphs[k]);
                    if (index >= 0)
                    {
                        float full = mesh.GetBlendShapeFrameWeight(index, mesh.GetBlendShapeFrameCount(index) - 1);
                        shapes.Add(new Shape { Renderer = renderer, Index = index, Morph = k, Full = full });
                    }
                }
            }
        }

        /// <summary>Before animators are evaluated: plan, and give an animation job its pose.</summary>
        private void Update()
        {
            if (character == null)
            {
                return;
            }
            time += Time.deltaTime;
            character.Update(time);
            if (writer.Early)
            {
                writer.Write(character.Pose(alive));
            }
        }

        /// <summary>After animators: set transforms, where no job does, and blend shapes; then tell what began and ended.</summary>
        private void LateUpdate()
        {
            if (character == null)
            {
                return;
            }
            BodyPose pose = character.Pose(alive);
            if (!writer.Early)
            {
                writer.Write(pose);
            }
            for (int n = 0; n < shapes.Count; n++)
            {
                shapes[n].Renderer.SetBlendShapeWeight(shapes[n].Index, pose.Morphs[shapes[n].Morph] * shapes[n].Full);
            }
            IList<CharacterEvent> events = character.Events();
            for (int n = 0; n < events.Count; n++)
            {
                CharacterEvent one = events[n];
                (one.Kind == "begin" ? begin : end).Invoke(one.Layer, one.Action, one.Meta);
            }
        }

        /// <summary>Ask for anything, as JSON with "do"; returns the request's id, null while nothing is loaded.</summary>
        public string Ask(string json)
        {
            return character == null ? null : character.Ask(json);
        }

        /// <summary>What became of a request; null while nothing is loaded.</summary>
        public Answer AnswerTo(string id)
        {
            return character == null ? null : character.AnswerTo(id);
        }

        /// <summary>What may be asked for, as JSON: layers with stances, actions and tags, lines, points; null while nothing is loaded.</summary>
        public string Describe()
        {
            return character == null ? null : character.Describe();
        }

        /// <summary>Set a parameter of the project, see `Character.SetParameter`; null while nothing is loaded.</summary>
        public string SetParameter(string parameter, object value = null)
        {
            return character == null ? null : character.SetParameter(parameter, value);
        }

        /// <summary>Make a gesture that has all the tags.</summary>
        public string Gesture(params string[] tags)
        {
            return Ask("{\"do\":\"gesture\",\"tags\":[" + string.Join(",", Array.ConvertAll(tags ?? new string[0], Json.Quote)) + "]}");
        }

        /// <summary>Go to a stance, by id or name.</summary>
        public string Go(string stance, bool stay = false)
        {
            return Stance(stance, stay);
        }

        /// <summary>Go to a stance, by id or name; stay: the models do not leave it of their own accord.</summary>
        public string Stance(string stance, bool stay = false)
        {
            return Ask("{\"do\":\"stance\",\"stance\":" + Json.Quote(stance) + ",\"stay\":" + (stay ? "true" : "false") + "}");
        }

        /// <summary>Look at a named point: "user", "ahead", or one that `Place` has put somewhere.</summary>
        public string Look(string name)
        {
            return Ask("{\"do\":\"look\",\"to\":" + Json.Quote(name) + "}");
        }

        /// <summary>Look at a point of the world.</summary>
        public string Look(Vector3 world)
        {
            return Ask("{\"do\":\"look\",\"to\":" + Point(world) + "}");
        }

        /// <summary>Put a named point somewhere in the world; who looks at it follows it.</summary>
        public string Place(string name, Vector3 world)
        {
            return Ask("{\"do\":\"place\",\"name\":" + Json.Quote(name) + ",\"point\":" + Point(world) + "}");
        }

        /// <summary>
        /// Say a line of the project, by its id; or, where there is none of that id, these words, with gestures that go with them unless
        /// `gestures` is off.
        /// </summary>
        public string Say(string lineOrText)
        {
            bool line = character != null && character.Graph.Lines.ContainsKey(lineOrText ?? "");
            if (character != null && !line && gestures)
            {
                return talk.Say(lineOrText).Id;
            }
            return Ask("{\"do\":\"say\",\"" + (line ? "line" : "text") + "\":" + Json.Quote(lineOrText) + "}");
        }

        /// <summary>
        /// Say what comes in piece by piece, as a language model writes it: each sentence, with its gestures, when it is whole, after the
        /// one before. over: whether the text ends here. Returns the ids of what it says by it.
        /// </summary>
        public List<string> SayPiece(string piece, bool over = false)
        {
            return talk == null ? new List<string>() : talk.Take(piece, over).ConvertAll(said => said.Id);
        }

        /// <summary>
        /// Break off all that is said, because the other speaks: the voice stops at its next sound, gestures go back, and the character
        /// looks at the other. What is said next begins at once.
        /// </summary>
        public string Interrupt()
        {
            return talk == null ? null : talk.Interrupt();
        }

        /// <summary>Take a request back, by its id; all of them without one.</summary>
        public string Withdraw(string id = "")
        {
            return Ask("{\"do\":\"withdraw\",\"what\":" + Json.Quote(id) + "}");
        }

        /// <summary>Be in a mood from now on: "happy", "sad" and others; "neutral" ends it. intensity: 0 to 1.</summary>
        public string Mood(string mood, float intensity = 1)
        {
            return Ask("{\"do\":\"mood\",\"mood\":" + Json.Quote(mood) + ",\"intensity\":" + Word(intensity) + "}");
        }

        /// <summary>From now on be "idle", "listening", "talking", "thinking" or "reacting"; null leaves it to what is said.</summary>
        public string Mode(string mode)
        {
            return Ask("{\"do\":\"mode\",\"mode\":" + (mode == null ? "null" : Json.Quote(mode)) + "}");
        }

        /// <summary>
        /// Say a line whose sound comes in while it is said: with each call its next samples, -1..1; the lips do what is heard. An id is
        /// one line's; returns it. rate: samples a second, 8000 to 48000.
        /// </summary>
        public string SaySound(string id, float[] samples, double rate)
        {
            return character == null ? null : character.SaySound(id, samples, rate);
        }

        /// <summary>A point of the world in the character's space, right-handed again.</summary>
        private string Point(Vector3 world)
        {
            Vector3 own = transform.InverseTransformPoint(world);
            return "[" + Word(-own.x) + "," + Word(own.y) + "," + Word(own.z) + "]";
        }

        private static string Word(float value)
        {
            return value.ToString("R", CultureInfo.InvariantCulture);
        }
    }
}
