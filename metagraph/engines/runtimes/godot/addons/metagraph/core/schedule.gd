# When the life layers do what: drawn from the seed, event by event, then pure in time. What has begun stays, tick by tick gives what
# one call gives, and what lies behind can be forgotten.
#
# A life schedule is {end, drawn: seconds up to which the lanes are filled, modes, targets, breaths, aversions, saccades, blinks,
# track: what it was drawn from, gaze: made when first looked at}; lanes hold what draw.gd says.

const Util = preload("util.gd")
const Lane = preload("lane.gd")
const Draw = preload("draw.gd")
const BLOCK = 8.0  # seconds drawn at a time, so that a running plan need not draw at every tick
const RECALL = 4.0  # seconds of looks kept when the past is forgotten: longer than any turn of the head takes
const RANDOM = {breaths = "breath_rate", aversions = "aversion_rate", saccades = "saccade_rate", blinks = "blinks"}


static func empty_life():
	var none = Lane.empty_lane()
	return {
		end = 0.0, drawn = 0.0, modes = none, targets = [], breaths = none, aversions = none, saccades = none, blinks = none, track = null,
		gaze = null, rates = {}
	}


# Returns the schedule to `end` seconds. What `before` holds that begins before `now` stays exactly as it was; what it holds for
# later is kept, too, where nothing it was drawn from has changed.
static func schedule(graph, track, seed32, end, before, now):
	if not graph.life.on:
		return Util.but(before, {end = end, track = track})
	var drawn = Util.most(BLOCK, ceil(end / BLOCK) * BLOCK)
	var change = _change(before.track, track)
	if change == "" and drawn == before.drawn:
		return Util.but(before, {end = end, track = track})
	var cut = Util.most(0.0, Util.least(before.drawn, drawn if change == "" else now))
	var chance = Util.least(before.drawn, drawn) if change == "places" else cut
	var draw = Draw.new(graph, track, seed32, cut, drawn, before)
	var out = {end = end, drawn = drawn, modes = draw.modes, targets = draw.targets, track = track, gaze = null, rates = {}}
	for name in RANDOM:
		out[name] = Lane.until(before[name], chance)
		out.rates[name] = graph.life[RANDOM[name]]
	if chance < drawn:
		draw.begin(chance)
		for name in RANDOM:
			out[name] = draw.call(name, out[name])
	return out


# Returns "" where nothing a schedule was drawn from has changed, "places" where only those have, else "all".
static func _change(old, track):
	if old == null:
		return "all"
	if Util.same(old, track):
		return ""
	for list in ["looks", "speeches", "modes", "blinks"]:
		if not Util.same(old[list], track[list]):
			return "all"
	return "places"


# Returns the schedule without what ended before `seconds`; what is drawn on from it stays as it would have been.
static func since(life, seconds):
	var changes = {gaze = null}
	# Gaps run in modes' time from the event before, so the modes since then are needed.
	var needed = INF
	var idle = false
	for name in RANDOM:
		changes[name] = Lane.since(life[name], seconds, 1)
		if changes[name].starts.size() > 0:
			needed = Util.least(needed, changes[name].starts[0])
		elif life.rates.get(name, 1.0) > 0:
			idle = true
	if idle:
		needed = 0.0
	elif needed == INF:
		needed = seconds
	var kept = Util.most(0, Util.after(life.targets, "start", Util.least(needed, seconds - RECALL)) - 1)
	changes.modes = Lane.since(life.modes, needed, 0)
	changes.targets = Util.part(life.targets, kept, life.targets.size())
	return Util.but(life, changes)
