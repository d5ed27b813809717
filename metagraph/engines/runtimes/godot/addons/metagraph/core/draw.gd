# One extension of a life schedule: lanes filled up to `drawn`. Each event depends only on the one before it, on its own number and
# on what is asked meanwhile.

const Choice = preload("choice.gd")
const Util = preload("util.gd")
const Lane = preload("lane.gd")
const Wanted = preload("wanted.gd")
const Voice = preload("voice.gd")
const AFTER_BLINK = 1.0  # seconds from a blink to one on a stressed syllable, at least
const BLINK_GAPS = [0.57, 0.845]  # of the mean gap: the shortest, and what chance adds
const FIXATION = 0.2  # seconds
const SACCADE = 1.2  # degrees on average
const LARGEST_SACCADE = 4.0
const UPRIGHT = 0.6  # of that, up and down
const AVERSION_GAPS = [0.6, 0.8]
const BETWEEN_AVERSIONS = 0.6  # seconds at least
const SHORTEST_AVERSION = 0.25
const BREATHS = [0.85, 0.3]  # of the mean length and depth: the least, and what chance adds

var graph
var life
var track
var seed32
var cut
var drawn
var modes
var targets
var calm
var _edges = []
var _modes = []
var _strict = []


func _init(whole, of_track, key_seed, from_time, to_time, before):
	graph = whole
	life = graph.life
	track = of_track
	seed32 = key_seed
	cut = from_time
	drawn = to_time
	modes = Lane.until(before.modes, cut)
	var last = modes.rows[-1][0] if modes.rows.size() > 0 else -1
	var starts = []
	var rows = []
	for mode in Wanted.modes_between(track, cut, drawn):
		if starts.size() > 0 or mode[1] != last:
			starts.append(mode[0])
			rows.append([mode[1]])
	modes = Lane.plus(modes, starts, rows)
	targets = Util.part(before.targets, 0, Util.before(before.targets, "start", cut))
	for target in Wanted.targets_between(track, cut, drawn):
		if targets.size() == 0 or not Wanted.like(target, targets[-1]):
			targets.append(target)
	calm = 1.0 - life.stillness


# Lays modes and strict looks out in one row of segments, and lets chance begin at `from_time`.
func begin(from_time):
	cut = from_time
	var edges = modes.starts.duplicate()
	for n in range(targets.size()):
		if n == 0 or targets[n].strict != targets[n - 1].strict:
			edges.append(targets[n].start)
	edges.sort()
	for edge in edges:
		if _edges.size() > 0 and _edges[-1] == edge:
			continue
		_edges.append(edge)
		_modes.append(Util.MODES[modes.rows[Util.most(0, Util.right_of(modes.starts, edge) - 1)][0]])
		_strict.append(targets[Util.most(0, Util.after(targets, "start", edge) - 1)].strict)


func _chance(words):
	return Choice.uniform(seed32, words)


# Returns what the mode at a time makes of the dials.
func _manner(seconds):
	return life.manners[_modes[Util.most(0, Util.right_of(_edges, seconds) - 1)]]


# Returns when `need` has passed since `seconds`, for a clock that runs at the `what`'s speed of each segment; INF where it is not
# before the end.
func _after(seconds, need, what):
	var place = Util.most(0, Util.right_of(_edges, seconds) - 1)
	while seconds < drawn:
		var end = _edges[place + 1] if place + 1 < _edges.size() else drawn
		var rate = _speed(what, life.manners[_modes[place]], _strict[place])
		if rate > 0 and seconds + need / rate < end:
			return seconds + need / rate
		need -= rate * Util.most(0.0, end - seconds)
		seconds = end
		place += 1
	return INF


func _speed(what, ways, strict):
	if what != "aversions":
		return ways[what] * calm
	var rate = life.aversion_rate * ways.aversion_rate
	if strict or rate <= 0:
		return 0.0
	return calm / Util.most(BETWEEN_AVERSIONS, 60.0 / rate - life.aversion_length * ways.aversion_length)


# Each breath [length s, depth] follows the one before; the first began before time 0, so that not everybody breathes alike.
func breaths(lane):
	var starts = []
	var rows = []
	var n = Lane.next_number(lane)
	var at = lane.starts[-1] + lane.rows[-1][0] if lane.starts.size() > 0 else null
	while true:
		if at != null:
			at = Util.most(at, cut)
		var ways = _manner(0.0 if at == null else at)
		var rate = life.breath_rate * ways.breath_rate / 60.0
		if rate <= 0:  # no breath until another mode begins
			var later = Util.right_of(_edges, 0.0 if at == null else at)
			if life.breath_rate <= 0 or later == _edges.size():
				break
			at = _edges[later]
			continue
		var length = (BREATHS[0] + BREATHS[1] * _chance(["breath", str(n), "length"])) / rate
		length *= 1.0 + 2.0 * life.stillness  # slower, too, but never halting
		var depth = ways.breathing * (BREATHS[0] + BREATHS[1] * _chance(["breath", str(n), "depth"]))
		if at == null:
			at = -length * _chance(["breath", "first"])
		if at >= drawn:
			break
		starts.append(at)
		rows.append([length, depth])
		at += length
		n += 1
	return Lane.plus(lane, starts, rows)


# The eyes' small jumps: [to the left, up], degrees.
func saccades(lane):
	if life.saccade_rate <= 0 or calm <= 0:
		return lane
	var mean = Util.most(60.0 / life.saccade_rate, FIXATION + 0.01)
	var last = lane.starts[-1] if lane.starts.size() > 0 else 0.0
	var starts = []
	var rows = []
	var n = Lane.next_number(lane)
	while true:
		var need = FIXATION + (mean - FIXATION) * Util.least(4.0, -log(_chance(["saccade", str(n), "gap"])))
		last = Util.most(cut, _after(last, need, "saccade_rate"))
		if not last < drawn:
			return Lane.plus(lane, starts, rows)
		var size = Util.least(LARGEST_SACCADE, -SACCADE * log(_chance(["saccade", str(n), "size"]))) * _manner(last).saccades
		var turn = 2.0 * PI * _chance(["saccade", str(n), "way"])
		starts.append(last)
		rows.append([size * sin(turn + PI / 2.0), UPRIGHT * size * sin(turn)])
		n += 1


# Looks away: [end s, to the left, up], of the dial's angle.
func aversions(lane):
	if life.aversion_rate <= 0 or life.aversion_length <= 0 or life.aversion_angle <= 0 or calm <= 0:
		return lane
	var last = lane.rows[-1][0] if lane.rows.size() > 0 else 0.0
	var starts = []
	var rows = []
	var n = Lane.next_number(lane)
	while true:
		var need = AVERSION_GAPS[0] + AVERSION_GAPS[1] * _chance(["aversion", str(n), "gap"])
		var at = Util.most(cut, Util.most(last + BETWEEN_AVERSIONS, _after(last, need, "aversions")))
		if not at < drawn:
			return Lane.plus(lane, starts, rows)
		var ways = _manner(at)
		var length = life.aversion_length * ways.aversion_length * (0.6 + 0.8 * _chance(["aversion", str(n), "length"]))
		last = at + Util.most(SHORTEST_AVERSION, length)
		var size = ways.aversion_angle * (0.7 + 0.6 * _chance(["aversion", str(n), "size"]))
		var turn = 2.0 * PI * _chance(["aversion", str(n), "way"])
		starts.append(at)
		rows.append([last, size * sin(turn + PI / 2.0), UPRIGHT * size * sin(turn)])
		n += 1


# Blinks: [0 of itself, 1 on a stressed syllable, 2 asked for].
func blinks(lane):
	var shut = life.blink_close + life.blink_open
	var mean = 60.0 / life.blinks if life.blinks > 0 and calm > 0 else INF
	var last
	if lane.starts.size() > 0:
		last = lane.starts[-1]
	else:
		last = -0.5 * Util.least(mean, 10.0) * _chance(["blink", "first"])
	var accents = _accents(Util.most(0.0, Util.least(cut, last))) if calm > 0 and life.accent_blinks > 0 else []
	var asked = []
	for item in track.blinks:
		asked.append(item.start)
	var starts = []
	var rows = []
	var n = Lane.next_number(lane)
	var place = 0
	while true:
		var own = INF
		if mean < INF:
			var need = mean * (BLINK_GAPS[0] + BLINK_GAPS[1] * _chance(["blink", str(n), "gap"]))
			own = Util.most(cut, _after(last, need, "blinks"))
		while place < accents.size() and not _suits(accents[place], last, shut):
			place += 1
		var stressed = accents[place][0] if place < accents.size() else INF
		var wish = Util.left_of(asked, Util.most(cut, last + shut))
		var wanted = asked[wish] if wish < asked.size() else INF
		var at = Util.least(own, Util.least(stressed, wanted))
		if at >= drawn:
			return Lane.plus(lane, starts, rows)
		starts.append(at)
		rows.append([2 if at == wanted else (1 if at == stressed else 0)])
		last = at
		n += 1


# Returns whether a stressed syllable [seconds, first of its speech] may bring a blink: the first always, others some time after
# the last blink.
func _suits(accent, last, shut):
	return accent[0] >= cut and accent[0] >= last + (shut + 0.1 if accent[1] else AFTER_BLINK / calm)


# Returns the stressed syllables from `start` to the end that may bring blinks, as [seconds, first of its speech].
func _accents(start):
	var out = []
	for speech in track.speeches:
		if speech.end <= start or speech.start >= drawn:
			continue
		var accents = Voice.of(graph, speech).accents
		for n in range(accents.size()):
			var at = speech.start + accents[n]
			if at >= start and at < Util.least(speech.end, drawn) and _chance([speech.id, "accent", str(n)]) < life.accent_blinks:
				out.append([at, n == 0])
	return out
