# Compute how far the arms of a plan have moved their mass away from its stance at a time.
#
# The body reacts with a delay. So it does not follow the arms at one moment, but a cubic B-spline through their places at four
# earlier fixed times. This is smooth, and depends only on plan and time.
#
# Translated from metagraph/playback/posing/follow_through.py; change that, and translate anew.

const CueTimes = preload("cue_times.gd")
const Util = preload("util.gd")
const STEP = 0.08  # seconds between the sampled times; the answer comes two of them late
const OFFSET = 0.0111  # seconds by which they are shifted from whole steps, where cues begin and end
const KNOTS = 4
const RATE = 10.0  # rows of a track in a second of its clip
const UNIT = 1e-05  # metres, or radians, of 1 in a row
const NUMBERS = 8  # in a row


# How the arms of a clip move their mass.
#
# `clip` is its id. `rows` has a row for each tenth of a second, relative to the base pose: how far the left arm shifts the centre
# of mass of the whole body to the left, up and ahead, the same for the right arm, and how far each collar bone lags behind its
# arm; in units of `UNIT`.
class ArmTrack:
	var clip
	var rows

	func _init(clip_, rows_):
		self.clip = clip_
		self.rows = rows_


# Return the number of the last sampled time for a pose at `time`.
static func knot_before(time):
	return int(floor((time - OFFSET) / STEP))


# Return the time of a sample, in seconds.
static func knot_time(number):
	return number * STEP + OFFSET


# Return how far the arms are from their stance at a time, as a row of a track, in metres and radians.
#
# `tracks` are by action. `hands` names the joints of the hands. `cue` is that of the arms' layer, if it has motion, and `place`
# the index of the rest in force, -1 for none; `body_cue` and `body_place` are the same for the body's layer. A cue whose clip the
# body's layer also shows moves the hips itself and does not count.
static func arm_sway(project, tracks, hands, arms, cue, place, body, body_cue, body_place, time):
	var out = []
	for n2 in range(NUMBERS):
		out.append(0.0)
	if cue == null:
		return out
	var track = tracks.get(cue.action.id)
	if track == null or track.rows.size() == 0:
		return out
	var weight = CueTimes.cue_weight(cue, time)
	var share = cue.extent * (1.0 - _shown(tracks, body, body_cue, body_place, track.clip, time))
	if weight <= 0.0 or share <= 0.0:
		return out
	var row = _row(track, CueTimes.cue_seconds(cue, time))
	var rest = _stance(project, tracks, arms, place, time)
	var entering = time < cue.start + cue.blend_in
	if cue.repeats:
		var back = CueTimes.seam_left(cue, time)
		var ends = _row(track, cue.cycle_to)
		var begins = _row(track, cue.cycle_from)
		var found = []
		for n3 in range(NUMBERS):
			found.append(row[n3] + back * (ends[n3] - begins[n3]))
		row = found
		var found2 = []
		for n4 in range(NUMBERS):
			found2.append(rest[n4] + weight * (row[n4] - rest[n4]))
		row = found2
	elif entering or time >= cue.end - cue.blend_out:
		var edge = _row(track, cue.entry if entering else CueTimes.cue_seconds(cue, cue.end))
		var found3 = []
		for n5 in range(NUMBERS):
			found3.append(row[n5] + (1.0 - weight) * (rest[n5] - edge[n5]))
		row = found3
	var left = share * UNIT if _moves(cue.action, "left", hands[0]) else 0.0
	var right = share * UNIT if _moves(cue.action, "right", hands[1]) else 0.0
	for n in range(NUMBERS):
		out[n] = (row[n] - rest[n]) * (left if (n < 3 or n == 6) else right)
	return out


# Return the eight numbers that move the body at a time, and their change per second. `sways` has the rows of the last `KNOTS`
# times before it.
static func driven(sways, time):
	var u = (time - OFFSET) / STEP
	u = u - int(floor(u))
	var back = 1.0 - u
	var weights = [
		back * back * back / 6.0,
		(3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
		(3.0 * u + 3.0 * u * u - 3.0 * u * u * u + 1.0) / 6.0,
		u * u * u / 6.0
	]
	var slopes = [-back * back / 2.0, (3.0 * u * u - 4.0 * u) / 2.0, (1.0 + 2.0 * u - 3.0 * u * u) / 2.0, u * u / 2.0]
	var out = []
	for n2 in range(2 * NUMBERS):
		out.append(0.0)
	for n in range(NUMBERS):
		for k in range(KNOTS):
			out[n] += weights[k] * sways[k][n]
			out[NUMBERS + n] += slopes[k] * sways[k][n] / STEP
	return out


# Return whether an action moves an arm, instead of leaving it in the stance.
static func _moves(action, side, hand):
	if not ["both", side].has(action.limb):
		return false
	return action.joints.size() == 0 or action.joints.has(hand)


# Return how much a layer shows of a clip, 0..1.
static func _shown(tracks, plan, cue, place, clip, time):
	var left = 1.0
	var out = 0.0
	if cue != null:
		var weight = CueTimes.cue_weight(cue, time)
		left = 1.0 - weight
		if _is_of(tracks, cue.action, clip):
			out += weight
	if place >= 0:
		var rest = plan.rests[place]
		var over = 1.0
		if place > 0 and rest.fade_start + rest.fade > time:
			over = CueTimes.ease_((time - rest.fade_start) / rest.fade)
			if _is_of(tracks, plan.rests[place - 1].action, clip):
				out += left * (1.0 - over)
		if _is_of(tracks, rest.action, clip):
			out += left * over
	return Util.least(1.0, out)


static func _is_of(tracks, action, clip):
	var track = tracks.get(action.id)
	return track != null and track.clip == clip


# Return the row of the stance under the cues.
static func _stance(project, tracks, plan, place, time):
	if place < 0:
		var found = []
		for n in range(NUMBERS):
			found.append(0.0)
		return found
	var rest = plan.rests[place]
	var row = _loop(project, tracks, rest, time)
	if place > 0 and rest.fade_start + rest.fade > time:
		var over = CueTimes.ease_((time - rest.fade_start) / rest.fade)
		var before = _loop(project, tracks, plan.rests[place - 1], time)
		var found2 = []
		for n in range(NUMBERS):
			found2.append(before[n] + (row[n] - before[n]) * over)
		row = found2
	return row


# Return the row of a loop, with its end blended into its beginning.
static func _loop(project, tracks, rest, time):
	var track = tracks.get(rest.action.id)
	if track == null or track.rows.size() == 0:
		var found = []
		for n in range(NUMBERS):
			found.append(0.0)
		return found
	var spot = CueTimes.loop_spot(project, rest, time)
	var row = _row(track, spot.seconds)
	if spot.over < 1.0:
		var old = 1.0 - CueTimes.ease_(spot.over)
		var before = _row(track, spot.other)
		var found2 = []
		for n in range(NUMBERS):
			found2.append(row[n] + (before[n] - row[n]) * old)
		row = found2
	return row


# Return a track's row at a second of the clip, interpolated linearly.
static func _row(track, seconds):
	var last = track.rows.size() - 1
	var at = Util.least(Util.most(seconds * RATE, 0.0), float(last))
	var low = Util.least(int(floor(at)), Util.most(0, last - 1))
	var part = at - low
	var a = track.rows[low]
	var b = track.rows[Util.least(low + 1, last)]
	var found = []
	for n in range(NUMBERS):
		found.append(a[n] + (b[n] - a[n]) * part)
	return found
