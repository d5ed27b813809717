using UnityEngine;

namespace Metagraph.Samples
{
    /// <summary>Greets when the scene begins, and tells what plays.</summary>
    [RequireComponent(typeof(MetagraphCharacter))]
    public sealed class Greeter : MonoBehaviour
    {
        public string words = "Hello! How are you?";

        private void Start()
        {
            var character = GetComponent<MetagraphCharacter>();
            character.Look("user");
            character.Say(words);
            character.Gesture("greeting");
            character.begin.AddListener((layer, action, id) => Debug.Log(layer + " begins " + action));
        }
    }
}
