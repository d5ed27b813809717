using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>The words everything is told apart by, as lists.</summary>
    internal static class WordsRules
    {
        public static readonly List<string> Modes = Basics.Modes.ToList(), Visemes = Voice.Visemes.ToList();
    }
}
