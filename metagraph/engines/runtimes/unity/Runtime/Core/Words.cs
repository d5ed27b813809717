using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>The words everything is told apart by, as lists.</summary>
    internal static class WordsRules
    {
        public static readonly List<string> Layers = Basics.Layers.ToList(), Modes = Basics.Modes.ToList();
        public static readonly List<string> Visemes = Voice.Visemes.ToList();
    }
}
