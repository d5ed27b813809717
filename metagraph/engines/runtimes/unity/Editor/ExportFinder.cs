using System.IO;
using UnityEditor;
using UnityEngine;

namespace Metagraph
{
    /// <summary>Gives a component that was just added the JSON and the motions that lie beside its model.</summary>
    [InitializeOnLoad]
    public static class ExportFinder
    {
        static ExportFinder()
        {
            ObjectFactory.componentWasAdded += Fill;
        }

        /// <summary>Set what a character lacks, where the files beside its model are called like the model.</summary>
        public static void Fill(Component added)
        {
            var character = added as MetagraphCharacter;
            if (character == null || character.export != null || character.glb != null)
            {
                return;
            }
            string model = PrefabUtility.GetPrefabAssetPathOfNearestInstanceRoot(character.gameObject);
            if (string.IsNullOrEmpty(model))
            {
                return;
            }
            character.export = AssetDatabase.LoadAssetAtPath<TextAsset>(Path.ChangeExtension(model, ".json"));
            character.glb = AssetDatabase.LoadAssetAtPath<TextAsset>(model + ".bytes");
        }
    }
}
