using System.IO;
using UnityEditor;
using UnityEngine;

namespace Metagraph
{
    /// <summary>Gives a component that was just added the export that lies beside its model.</summary>
    [InitializeOnLoad]
    public static class ExportFinder
    {
        static ExportFinder()
        {
            ObjectFactory.componentWasAdded += Fill;
        }

        /// <summary>Set the export of a character that has none, if it is called as the model is.</summary>
        public static void Fill(Component added)
        {
            var character = added as MetagraphCharacter;
            if (character == null || character.asset != null || character.export != null || character.glb != null)
            {
                return;
            }
            string model = PrefabUtility.GetPrefabAssetPathOfNearestInstanceRoot(character.gameObject);
            if (string.IsNullOrEmpty(model))
            {
                return;
            }
            character.asset = AssetDatabase.LoadAssetAtPath<MetagraphExport>(Path.ChangeExtension(model, ".metagraph"));
        }
    }
}
