# The values a project is made of. All are frozen; mappings in them are never changed in place.
#
# Ids are made once from the project's counter and never change; names are free text for people.
#
# Translated from metagraph/graph/model.py; change that, and translate anew.



# A first-order model over (limb, kind) that writes meta actions when nobody asks for any (Borer et al., 7.3).
#
# matrix: rows of probabilities, each summing to 1. gap: mean seconds of rest between two actions. positive, negative: share of
# gestures asked for with that tag, where tags are not part of the states. tags: one text a state, the tags (blanks between them)
# it asks for; empty when tags are not part of the states. lengths: (mean, standard deviation) seconds of each state's actions;
# empty where that is not known. modes: what is performed of what it writes while one is said to idle, to listen and to talk, a
# row each: shares of gestures, fidgets and transitions, 0..1; empty where the mode makes no difference.
class Markov:
	var layer
	var states
	var matrix
	var gap
	var positive
	var negative
	var tags
	var lengths
	var modes

	func _init(
		layer_,
		states_,
		matrix_,
		gap_ = 2.5,
		positive_ = 0.0,
		negative_ = 0.0,
		tags_ = null,
		lengths_ = null,
		modes_ = null
	):
		self.layer = layer_
		self.states = states_
		self.matrix = matrix_
		self.gap = gap_
		self.positive = positive_
		self.negative = negative_
		self.tags = tags_ if tags_ != null else []
		self.lengths = lengths_ if lengths_ != null else []
		self.modes = modes_ if modes_ != null else []

	# Return the tags a state asks for, "" for none.
	func tag(state):
		return self.tags[state] if self.tags.size() > 0 else ""
