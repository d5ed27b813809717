/**
 * Find actions and stances by id or name.
 *
 * Translated from metagraph/playback/planning/finding.py; change that, and translate anew.
 */


/**
 * Return the action with an id or, failing that, with a name; of several with the same name, the likeliest. layer: None for
 * any.
 * @param {MetaGraph[]} graphs
 * @param {string} word
 * @param {?string} layer
 * @returns {?Action}
 */
export function actionCalled(graphs, word, layer) {
  for (const graph of graphs) {
    const found = graph.actions.get(word) ?? null;
    if (found !== null && (layer === null || layer === graph.layer)) {
      return found;
    }
  }
  let best = null;
  for (const graph of graphs) {
    if (layer === null || layer === graph.layer) {
      for (const action of [...graph.actions.values()]) {
        if (action.name === word && (best === null || action.likelihood > best.likelihood)) {
          best = action;
        }
      }
    }
  }
  return best;
}

/**
 * Return the stance with an id or, failing that, with a name, in the first layer that has one.
 * @param {MetaGraph[]} graphs
 * @param {string} word
 * @param {?string} layer
 * @returns {?Stance}
 */
export function stanceCalled(graphs, word, layer) {
  for (const graph of graphs) {
    if (layer === null || layer === graph.layer) {
      const found = graph.stances.get(word) ?? null;
      if (found !== null) {
        return found;
      }
      for (const stance of [...graph.stances.values()]) {
        if (stance.name === word) {
          return stance;
        }
      }
    }
  }
  return null;
}
