# The values a project is made of. All are frozen; mappings in them are never changed in place.
#
# Ids are made once from the project's counter and never change; names are free text for people.
#
# Translated from metagraph/graph/model.py; change that, and translate anew.



# When an action plays within its clip; seconds of the clip.
#
# start, end: the part that plays; `end` None is the clip's end. blend_in, blend_out: seconds of blending from and to the stance,
# within start..end (for a looping stance, blend_in is the overlap at the loop's seam). loop: repeats. earliest_exit: from here on
# the action may be left, or None to play it through. stroke: its most telling moment. ready, stroke_end, relax: where a gesture's
# preparation, stroke and hold end (its retraction ends with it); None as found from the motion (`playback.timing.phases`).
class Timing:
	var start
	var end
	var blend_in
	var blend_out
	var loop
	var earliest_exit
	var stroke
	var ready
	var stroke_end
	var relax

	func _init(
		start_ = 0.0,
		end_ = null,
		blend_in_ = 0.2,
		blend_out_ = 0.3,
		loop_ = false,
		earliest_exit_ = null,
		stroke_ = null,
		ready_ = null,
		stroke_end_ = null,
		relax_ = null
	):
		self.start = start_
		self.end = end_
		self.blend_in = blend_in_
		self.blend_out = blend_out_
		self.loop = loop_
		self.earliest_exit = earliest_exit_
		self.stroke = stroke_
		self.ready = ready_
		self.stroke_end = stroke_end_
		self.relax = relax_


class Stance:
	var id
	var layer
	var name

	func _init(id_, layer_, name_):
		self.id = id_
		self.layer = layer_
		self.name = name_


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


# Planner constants. alpha: how quickly a used action becomes unlikely (4 in the paper). seed: 32-bit.
#
# never_twice: an action is not played twice in a row where there is another. shortest: seconds below which the remainder of a cut
# meta action is not worth keeping. wait: how late, in seconds, a request may start. memory: seconds after which a use no longer
# counts, 0 for never (as in the paper). rest: least seconds in the stance between two actions of a layer. lookahead: seconds
# ahead of now in which a running plan is not changed any more.
class Settings:
	var alpha
	var seed_
	var never_twice
	var shortest
	var wait
	var memory
	var rest
	var lookahead

	func _init(
		alpha_ = 4.0,
		seed_ = 1,
		never_twice_ = true,
		shortest_ = 0.4,
		wait_ = 4.0,
		memory_ = 0.0,
		rest_ = 0.0,
		lookahead_ = 0.1
	):
		self.alpha = alpha_
		self.seed_ = seed_
		self.never_twice = never_twice_
		self.shortest = shortest_
		self.wait = wait_
		self.memory = memory_
		self.rest = rest_
		self.lookahead = lookahead_
