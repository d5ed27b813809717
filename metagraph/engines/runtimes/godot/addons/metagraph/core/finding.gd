# Find actions and stances by id or name.
#
# Translated from metagraph/playback/planning/finding.py; change that, and translate anew.



# Return the action with an id or, failing that, with a name; of several with the same name, the likeliest. layer: None for any.
static func action_called(graphs, word, layer):
	for graph in graphs:
		var found = graph.actions.get(word)
		if found != null and (layer == null or layer == graph.layer):
			return found
	var best = null
	for graph in graphs:
		if layer == null or layer == graph.layer:
			for action in graph.actions.values():
				if action.name == word and (best == null or action.likelihood > best.likelihood):
					best = action
	return best


# Return the stance with an id or, failing that, with a name, in the first layer that has one.
static func stance_called(graphs, word, layer):
	for graph in graphs:
		if layer == null or layer == graph.layer:
			var found = graph.stances.get(word)
			if found != null:
				return found
			for stance in graph.stances.values():
				if stance.name == word:
					return stance
	return null
