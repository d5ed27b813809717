using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace Metagraph
{
    /// <summary>
    /// Makes a character of an export: the file .metagraph has its clips, and the files .json and .glb lie beside it. The result is a
    /// prefab of the imported GLB with the component MetagraphCharacter, the export, and an AnimationClip for each clip.
    /// </summary>
    [ScriptedImporter(1, "metagraph")]
    public sealed class MetagraphImporter : ScriptedImporter
    {
        [Tooltip("Whether to make AnimationClips")]
        public bool makeClips = true;
        [Tooltip("How the character's poses reach its figure")]
        public PoseOutput output = PoseOutput.Automatic;

        /// <summary>The GLB is imported before this is.</summary>
        public static string[] GatherDependenciesFromSourceFile(string path)
        {
            return new[] { Path.ChangeExtension(path, ".glb") };
        }

        public override void OnImportAsset(AssetImportContext context)
        {
            string path = context.assetPath, json = Path.ChangeExtension(path, ".json");
            string humanoid = Path.ChangeExtension(path, ".humanoid.json"), model = Path.ChangeExtension(path, ".glb");
            context.DependsOnSourceAsset(json);
            if (!File.Exists(json))
            {
                context.LogImportError(path + ": " + Path.GetFileName(json) + " does not lie beside it. Copy the whole export.");
                return;
            }
            var export = ScriptableObject.CreateInstance<MetagraphExport>();
            export.name = Path.GetFileNameWithoutExtension(path);
            export.json = File.ReadAllText(json);
            export.motion = File.ReadAllBytes(path);
            if (File.Exists(humanoid))
            {
                context.DependsOnSourceAsset(humanoid);
                export.humanoid = File.ReadAllText(humanoid);
            }
            Graph graph;
            try
            {
                graph = export.Read();
            }
            catch (MetagraphException error)
            {
                context.LogImportError(error.Message);
                return;
            }
            graph.Problems.ForEach(problem => context.LogImportWarning(problem));
            context.AddObjectToAsset("export", export);
            context.DependsOnArtifact(model);
            GameObject figure = MakeFigure(context, model, export);
            if (makeClips)
            {
                var maker = new ClipMaker(graph, figure.transform);
                foreach (ClipEntry entry in graph.Clips.Values)
                {
                    if (entry.Motion != null)
                    {
                        context.AddObjectToAsset("clip " + entry.Id, maker.Make(entry));
                    }
                }
            }
            context.AddObjectToAsset("character", figure);
            context.SetMainObject(figure);
        }

        private GameObject MakeFigure(AssetImportContext context, string model, MetagraphExport export)
        {
            var imported = AssetDatabase.LoadAssetAtPath<GameObject>(model);
            if (imported == null)
            {
                context.LogImportWarning(model + " is not imported. Install the package glTFast or UnityGLTF; until then there is no mesh.");
            }
            GameObject figure = imported != null ? Instantiate(imported) : new GameObject();
            figure.name = export.name;
            var clips = figure.GetComponent<Animation>();
            if (clips != null)
            {
                DestroyImmediate(clips); // glTFast's, which would play by itself
            }
            var character = figure.AddComponent<MetagraphCharacter>();
            character.asset = export;
            character.output = output;
            return figure;
        }
    }
}
