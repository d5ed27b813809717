# The Markov model that performs when there are no requests: a first-order chain over (limb, kind).
#
# The arms matrix is the paper's (Borer et al., figure 11), learned from annotated casual conversation. Body and head have no
# published matrix; theirs are ours, shaped on the paper's labels: the head nods and now and then changes its tilt, the body
# mostly rests, shifts and fidgets. The shares of what is performed in the modes idle, listening and talking are ours, too: the
# hands gesture with the character's own speech, and the head nods at the other's.
#
# Translated from metagraph/playback/planning/markov.py; change that, and translate anew.

const Words = preload("words.gd")
const MetaPlan = preload("meta_plan.gd")
const Choice = preload("choice.gd")
const Util = preload("util.gd")
const KINDS = ["gesture", "fidget", "transition"]  # as in `Markov.modes`
const LISTENS = 1  # place of the row that stands for modes of which a model says nothing


static func BEGIN():
	return MetaPlan.Cursor.new()
const RESTS = 0.9  # standard deviation of rests, times their mean


# Return the meta actions that start before `until` seconds, from the cursor on, and the cursor before the first one left out.
#
# Rests are log-normal about the mean gap (`rest_length`): most are short, some long, as people's are. Windows are as `length`
# says. kinds: those that the graph has; states of other kinds are passed over, so that half-filled graphs perform, too.
#
# Each draw is keyed by the meta action's number. So a longer horizon only appends, and continuing from a cursor gives bit for bit
# the same as writing in one go. After a row of zeros, the chain starts again from any state.
static func write(chain, seed_, until, kinds = null, cursor = null):
	if cursor == null:
		cursor = BEGIN()
	var number = cursor.number
	var state = cursor.state
	var time = cursor.time
	var open_to = []
	for pair in chain.states:
		var kind2 = pair[1]
		open_to.append(1.0 if (kinds == null or kinds.has(kind2)) else 0.0)
	var rows = {}
	var out = []
	var is_any = false
	for p in open_to:
		if p > 0:
			is_any = true
			break
	var able = is_any
	while able:
		var ident = "auto/%s/%d" % [chain.layer, number]
		var key = Choice.keyed(seed_, [ident])
		var start = time + rest_length(chain, key)
		if not (start < until):  # nor when it is no number
			break
		if not rows.has(state):
			rows[state] = _row(chain, state, open_to)
		state = int(Choice.picked(key, "state", rows[state]))
		var both = chain.states[state]
		var limb = both[0]
		var kind = both[1]
		var seconds = length(chain, state, key)
		var tags = Util.list(Util.words(chain.tag(state)))
		if kind == "gesture" and chain.tags.size() == 0:
			var draw = Choice.chance_of(key, "tag")
			if draw < chain.positive:
				tags = ["positive"]
			elif draw < chain.positive + chain.negative:
				tags = ["negative"]
		var request = MetaPlan.MetaRequest.new(ident, chain.layer, kind, start, seconds, null, tags, limb, null, MetaPlan.WRITTEN)
		out.append(MetaPlan.MetaAction.new(request, start, start + seconds, 0, true))
		number = number + 1
		time = start + seconds
	return [out, MetaPlan.Cursor.new(number, state, time)]


# Return the probability of each state that may follow a state (-1: before the first), by its index; of all allowed states if none
# may follow.
static func _row(chain, state, open_to):
	var row = Util.list(open_to)
	if 0 <= state and state < row.size():
		var found = []
		for n in range(chain.matrix[state].size()):
			var p = chain.matrix[state][n]
			var may = open_to[n]
			found.append(p * may)
		row = found
	var is_any = false
	for p in row:
		if p > 0:
			is_any = true
			break
	if not is_any:
		row = Util.list(open_to)
	var found2 = {}
	for i in range(row.size()):
		var p = row[i]
		if p > 0:
			found2[str(i)] = p
	return found2


# Return whether something that the model wrote is performed in a mode (`Markov.modes`). What is left out does not change the
# rest, so it does not matter when a mode became known.
static func performs(chain, seed_, meta, mode):
	if chain.modes.size() == 0 or not KINDS.has(meta.request.kind):
		return true
	var place = Words.MODES.find(mode)
	var row = chain.modes[place if place < chain.modes.size() else LISTENS]
	var share = row[KINDS.find(meta.request.kind)]
	return share >= 1 or Choice.uniform(seed_, [meta.request.id, "mode"]) < share


# Return how many seconds a meta action of a key lasts: uniform from 1 to 3 if the model has no lengths; else log-normal with the
# state's mean and standard deviation.
static func length(chain, state, key):
	if chain.lengths.size() == 0:
		return 1.0 + 2.0 * Choice.chance_of(key, "length")
	var both = chain.lengths[state]
	var mean = both[0]
	var deviation = both[1]
	return Choice.log_normal(mean, deviation, Choice.chance_of(key, "length"), Choice.chance_of(key, "length2"))


# Return how many seconds of rest come before a meta action of a key: log-normal with the mean `chain.gap`, between a fifth and
# five times of it.
static func rest_length(chain, key):
	var drawn = Choice.log_normal(chain.gap, RESTS * chain.gap, Choice.chance_of(key, "gap"), Choice.chance_of(key, "gap2"))
	return Util.least(5.0 * chain.gap, Util.most(0.2 * chain.gap, drawn))
