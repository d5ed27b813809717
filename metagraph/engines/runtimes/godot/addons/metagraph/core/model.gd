# Define the values that a project is made of. All are frozen, and their mappings never change in place.
#
# Ids are made once from the content they are for and never change. Names are free text for people.
#
# Translated from metagraph/graph/model.py; change that, and translate anew.



# When an action plays within its clip. All times are seconds of the clip.
#
# `start` and `end` bound the part that plays; an `end` of None is the clip's end. `blend_in` and `blend_out` are the seconds of
# blending from and to the stance, inside that part. For a looping stance, `blend_in` is the overlap at the loop's seam. `loop`
# repeats the part. From `earliest_exit` on, the next action may start; None plays the action to its end. `stroke` is its most
# expressive moment. `ready`, `stroke_end` and `relax` are the ends of a gesture's preparation, stroke and hold; its retraction
# ends with the action. None takes the times found from the motion (`playback.timing.phases`). `repeat` is the number of seconds
# for which a gesture or fidget repeats its part if no request says how long; it plays the nearest whole number of times. 0 plays
# it once.
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
	var repeat

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
		relax_ = null,
		repeat_ = 0.0
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
		self.repeat = repeat_


class Stance:
	var id
	var layer
	var name

	func _init(id_, layer_, name_):
		self.id = id_
		self.layer = layer_
		self.name = name_


# A first-order model over (limb, kind). It writes meta actions when there are no requests (Borer et al., 7.3).
#
# `matrix` has rows of probabilities, each of which sums to 1. `gap` is the mean rest between two actions, in seconds. `positive`
# and `negative` are the shares of gestures that request that tag, if tags are not part of the states. `tags` has one text for
# each state: the tags it requests, with blanks between them; it is empty if tags are not part of the states. `lengths` has the
# mean and standard deviation of each state's actions, in seconds; it is empty if they are unknown. `modes` has one row for each
# mode, in the order of `words.MODES`: the shares, 0 to 1, of the written gestures, fidgets and transitions that are performed in
# that mode. Without the last two rows, thinking and reacting are as listening. It is empty if the mode makes no difference.
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

	# Return the tags that a state requests, "" for none.
	func tag(state):
		return self.tags[state] if self.tags.size() > 0 else ""


# The planner's constants.
#
# `alpha` says how quickly a used action becomes unlikely (4 in the paper). `seed` has 32 bits. With `never_twice`, an action is
# not played twice in a row if there is another. `shortest` is the minimum length, in seconds, of a remainder that is kept when a
# meta action is cut. `wait` is how many seconds late a request may start. `memory` is the number of seconds after which a use no
# longer counts, 0 for never (as in the paper). `rest` is the least number of seconds in the stance between two actions of a
# layer. A running plan is not changed for the next `lookahead` seconds. `variety`, 0..4, multiplies the times of
# `planning.director`, which decide how rarely actions repeat and stances change; 0 is as in the paper.
class Settings:
	var alpha
	var seed_
	var never_twice
	var shortest
	var wait
	var memory
	var rest
	var lookahead
	var variety

	func _init(
		alpha_ = 4.0,
		seed_ = 1,
		never_twice_ = true,
		shortest_ = 0.4,
		wait_ = 4.0,
		memory_ = 0.0,
		rest_ = 0.0,
		lookahead_ = 0.1,
		variety_ = 1.0
	):
		self.alpha = alpha_
		self.seed_ = seed_
		self.never_twice = never_twice_
		self.shortest = shortest_
		self.wait = wait_
		self.memory = memory_
		self.rest = rest_
		self.lookahead = lookahead_
		self.variety = variety_
