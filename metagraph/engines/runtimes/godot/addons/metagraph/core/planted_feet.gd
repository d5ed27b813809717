# Find where the feet of a standing body should be while the body's layer blends. They do not glide from one pose to the other:
# they are held, and move one after the other in a step.
#
# A clip gives the positions of its feet, and when they stand. A pose depends only on plan and time, so each step's time, order
# and height follow from the two poses that it joins.
#
# Translated from metagraph/playback/posing/planted_feet.py; change that, and translate anew.

const FeetSolve = preload("feet_solve.gd")
const PlainVectors = preload("plain_vectors.gd")
const CueTimes = preload("cue_times.gd")
const Util = preload("util.gd")
const FOOT_RATE = 10.0  # rows of a track in a second of its clip
const FOOT_UNIT = 1e-05  # the value of 1 in a row
const FOOT_NUMBERS = 8  # in a row, for each foot
const STEPPING = 0.5  # seconds that two steps take if a cue leaves them time
const LEAST_PART = 0.15  # of that time for the foot with the shorter way
const NEARBY = 0.015  # metres: feet with a shorter way move together, slowly
const WAITS = 0.12  # of a step's time: the foot is lifted before it moves and lowered after it
const LIFT = 0.25  # how high a foot is lifted for a short step, as a share of its way
const MOST_LIFT = 0.08  # metres: the limit that no foot reaches
const FAR = 0.25  # of the height: no foot steps that much farther
const TOO_FAR = 0.1
const QUICK = 0.65  # of the height, a second: above, feet step less and glide more
const TOO_QUICK = 0.2  # as much quicker, they only glide


# Where a clip's feet are.
#
# `rows` has a row for each tenth of a second, with the left foot and then the right: whether it stands (0 to 1), its joint's
# position and rotation in the character's space; in units of `FOOT_UNIT`.
class FootTrack:
	var rows

	func _init(rows_):
		self.rows = rows_


# Return where both feet should be at a time; an empty list if nothing blends or it is unknown.
#
# `tracks` are by action. `height` is the figure's. `plan` is the body's layer. `cue` is the one that plays, if it has motion, and
# `place` the index of the rest in force, -1 for none.
static func foot_goals(project, tracks, height, plan, cue, place, time):
	if place < 0:
		return []
	if cue == null:
		if not _changes(project, plan, place, time):
			return []
		return _stance(project, tracks, height, plan, place, time)
	var track = tracks.get(cue.action.id)
	var masked = cue.action.joints.size() > 0 or cue.action.joint_weights.size() > 0
	if track == null or track.rows.size() == 0 or masked:
		return []
	var came = cue.start + _entering(track, cue)
	var goes = cue.end - _leaving(track, cue)
	if time >= came and time < goes:
		return []
	var here = foot_row(track, CueTimes.cue_seconds(cue, time))
	var at
	var first
	var last
	if time < came:
		at = Util.least(time, cue.start + cue.blend_in)
		var before = _stance(project, tracks, height, plan, place, at)
		first = _stance(project, tracks, height, plan, place, cue.start)
		last = foot_row(track, CueTimes.cue_seconds(cue, came))
		return stepped(height, before, here, first, last, time - cue.start, came - cue.start)
	at = Util.most(time, cue.end - cue.blend_out)
	var after = _stance(project, tracks, height, plan, place, at)
	first = foot_row(track, CueTimes.cue_seconds(cue, goes))
	last = _stance(project, tracks, height, plan, place, cue.end)
	return stepped(height, here, after, first, last, time - goes, cue.end - goes)


# Return how long the feet take to enter a cue: its blend, and longer while it stands.
static func _entering(track, cue):
	return _lasting(track, cue, cue.blend_in, cue.start, 1.0)


# Return how long the feet take to leave a cue.
static func _leaving(track, cue):
	return _lasting(track, cue, cue.blend_out, cue.end, -1.0)


static func _lasting(track, cue, blend, edge, way):
	if blend <= 0.0:
		return 0.0
	var spare = Util.most(0.0, cue.end - cue.start - cue.blend_in - cue.blend_out)
	var most = Util.least(STEPPING, blend + 0.5 * spare)
	var out = blend
	var step = 1.0 / FOOT_RATE
	while out < most and _stands(track, CueTimes.cue_seconds(cue, edge + way * Util.least(out + step, most))):
		out = Util.least(out + step, most)
	return out


static func _stands(track, seconds):
	var goals = foot_row(track, seconds)
	return goals[0].planted >= 1.0 and goals[1].planted >= 1.0


# Return both feet during a step, after `passed` of its `seconds`. `first` and `last` are their places when it begins and ends,
# which decide the order and size of the steps.
static func stepped(height, before, after, first, last, passed, seconds):
	if before.size() == 0 or after.size() == 0 or first.size() == 0 or last.size() == 0:
		return []
	var ways = []
	for side in range(2):  # a foot that does not stand before or after needs no time for a step
		var stands = first[side].planted * last[side].planted
		ways.append(stands * FeetSolve.foot_way(first[side], last[side]))
	var part = 0.5
	if ways[0] + ways[1] > 0.0:
		part = Util.least(Util.most(ways[0] / (ways[0] + ways[1]), LEAST_PART), 1.0 - LEAST_PART)
	# To the left, the left foot goes first: the right foot would have to pass it.
	var moved = PlainVectors.plus(PlainVectors.minus(last[0].at, first[0].at), PlainVectors.minus(last[1].at, first[1].at))
	var left_first = PlainVectors.dot(moved, PlainVectors.minus(first[0].at, first[1].at)) >= -1e-09
	var longer = Util.most(ways[0], ways[1])
	var far = 1.0 - CueTimes.ease_((longer / height - FAR) / TOO_FAR)
	var apart = CueTimes.ease_(longer / NEARBY)
	var shares = [1.0 - apart * (1.0 - part), 1.0 - apart * part]
	var quickest = Util.most(ways[0] / shares[0], ways[1] / shares[1])
	far *= 1.0 - CueTimes.ease_((quickest / (height * Util.most(seconds, 0.001)) - QUICK) / TOO_QUICK)
	var u = passed / seconds if seconds > 0.0 else 1.0
	var out = []
	for side in range(2):
		var share = shares[side]
		var begin = 0.0 if left_first == (side == 0) else 1.0 - share
		var x = Util.least(Util.most((u - begin) / share, 0.0), 1.0)
		var go = CueTimes.ease_((x - WAITS) / (1.0 - 2.0 * WAITS))
		var rise = LIFT * ways[side]
		var air = 16.0 * x * x * (1.0 - x) * (1.0 - x) * rise / (1.0 + rise / MOST_LIFT)
		out.append(_mixed(before[side], after[side], go, air, far))
	return out


# Return a foot between two places.
static func _mixed(a, b, x, air, share):
	var both = a.turn
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var aw = both[3]
	var both2 = b.turn
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	var bw = both2[3]
	var k = -x if ax * bx + ay * by + az * bz + aw * bw < 0.0 else x
	var rest = 1.0 - x
	var turn = PlainVectors.unit_turn([ax * rest + bx * k, ay * rest + by * k, az * rest + bz * k, aw * rest + bw * k])
	var at = PlainVectors.plus(a.at, PlainVectors.scaled(PlainVectors.minus(b.at, a.at), x))
	return FeetSolve.FootGoal.new(at, turn, share * a.planted * b.planted, a.lift * rest + b.lift * x + air)


# Return the index of the rest in force at a time, searching from another.
static func _resting(plan, place, time):
	while place > 0 and plan.rests[place].fade_start > time:
		place -= 1
	while place + 1 < plan.rests.size() and plan.rests[place + 1].fade_start <= time:
		place += 1
	return place


static func _fades(plan, place, time):
	var rest = plan.rests[place]
	return place > 0 and rest.fade_start + rest.fade > time


# Return whether a stance blends: between two rests, or at a loop's seam.
static func _changes(project, plan, place, time):
	var rest = plan.rests[place]
	if _fades(plan, place, time):
		return true
	return CueTimes.loop_spot(project, rest, time).over < 1.0


# Return where the feet of the stance under the cues are at a time.
static func _stance(project, tracks, height, plan, place, time):
	place = _resting(plan, place, time)
	var rest = plan.rests[place]
	var goals = _loop(project, tracks, height, rest, time)
	if not _fades(plan, place, time):
		return goals
	var old = plan.rests[place - 1]
	var ends = rest.fade_start + rest.fade
	return stepped(
		height,
		_loop(project, tracks, height, old, time),
		goals,
		_loop(project, tracks, height, old, rest.fade_start),
		_loop(project, tracks, height, rest, ends),
		time - rest.fade_start,
		rest.fade
	)


# Return where the feet of a loop are. They also go from its end to its beginning in steps.
static func _loop(project, tracks, height, rest, time):
	var track = tracks.get(rest.action.id)
	if track == null or track.rows.size() == 0:
		return []
	var spot = CueTimes.loop_spot(project, rest, time)
	var here = foot_row(track, spot.seconds)
	if spot.over >= 1.0:
		return here
	var seam = spot.meets - project.span(rest.action)[0]
	var before = foot_row(track, spot.other)
	var leaves = foot_row(track, spot.leaves)
	var meets = foot_row(track, spot.meets)
	return stepped(height, before, here, leaves, meets, spot.over * seam, seam)


# Return where a clip's feet are at a second of the clip, interpolated linearly.
static func foot_row(track, seconds):
	var last = track.rows.size() - 1
	var at = Util.least(Util.most(seconds * FOOT_RATE, 0.0), float(last))
	var low = Util.least(int(floor(at)), Util.most(0, last - 1))
	var part = at - low
	var a = track.rows[low]
	var b = track.rows[Util.least(low + 1, last)]
	var v = []
	for n2 in range(2 * FOOT_NUMBERS):
		v.append(FOOT_UNIT * (a[n2] + (b[n2] - a[n2]) * part))
	var out = []
	for side in range(2):
		var n = FOOT_NUMBERS * side
		var turn = PlainVectors.unit_turn([v[n + 4], v[n + 5], v[n + 6], v[n + 7]])
		out.append(FeetSolve.FootGoal.new([v[n + 1], v[n + 2], v[n + 3]], turn, v[n], 0.0))
	return out
