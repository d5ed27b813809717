# Compute how much of a cue, or of a stance's loop, shows at a time, with plain numbers. `player` and `Cue.clip_seconds` do the
# same with arrays.
#
# Translated from metagraph/playback/posing/cue_times.py; change that, and translate anew.

const Util = preload("util.gd")
const SEAM = 0.4  # clip seconds in which a cue that repeats makes its cycle's ends meet, at most half of the cycle


# Where a loop is.
#
# `seconds` is the time in its clip, `other` the time on the other side of its seam. `over` is how far it has blended from there
# to here, 1 if no seam shows. `leaves` and `meets` are the clip seconds at which the two sides of the seam begin and end.
class LoopSpot:
	var seconds
	var other
	var over
	var leaves
	var meets

	func _init(seconds_, other_, over_, leaves_, meets_):
		self.seconds = seconds_
		self.other = other_
		self.over = over_
		self.leaves = leaves_
		self.meets = meets_


# Return where a stance's loop is at a time, as `layers.compute_loop_seconds` does.
static func loop_spot(project, rest, time):
	var action = rest.action
	var both = project.span(action)
	var start = both[0]
	var end = both[1]
	var seam = Util.least(Util.most(0.0, action.timing.blend_in), (end - start) / 2.0)
	var period = end - start - seam
	if period <= 0.0:
		return LoopSpot.new(start, start, 1.0, start, start)
	var elapsed = time - rest.start
	var phase = Util.most(elapsed, 0.0) if seam > 0.0 else elapsed
	phase = phase - period * int(floor(phase / period))
	var over = phase / seam if (seam > 0.0 and elapsed >= period and phase < seam) else 1.0
	var other = start + Util.least(period + phase, end - start)
	return LoopSpot.new(start + phase, other, over, start + period, start + seam)


# Return how much of a cue shows at a time, 0..1.
static func cue_weight(cue, time):
	if time < cue.start or time >= cue.end:
		return 0.0
	var rise = ease_((time - cue.start) / cue.blend_in) if cue.blend_in > 0.0 else 1.0
	var fall = ease_((cue.end - time) / cue.blend_out) if cue.blend_out > 0.0 else 1.0
	return rise * fall


# Return the second of its clip that a cue plays at a time.
static func cue_seconds(cue, time):
	var elapsed = time - cue.start
	if cue.repeats:
		var cycle = cue.cycle_to - cue.cycle_from
		var into = cue.entry - cue.cycle_from + elapsed * cue.tempo
		return cue.cycle_from + into - cycle * int(floor(into / cycle))
	if cue.hold <= 0.0:
		return cue.entry + elapsed * cue.tempo
	var held = Util.least(Util.most(elapsed - (cue.hold_from - cue.entry) / cue.tempo, 0.0), cue.hold)
	var more = (elapsed - held) * (cue.tempo - 1.0)
	return cue.entry + elapsed - held + more + held * ((cue.hold_to - cue.hold_from) / cue.hold)


# Return the share, 0..1, of the offset between the end of one cycle and the beginning of the next that is still added at a time,
# so that a cue that repeats does not jump.
static func seam_left(cue, time):
	var cycle = cue.cycle_to - cue.cycle_from
	var into = cue.entry - cue.cycle_from + (time - cue.start) * cue.tempo
	if not cue.repeats or int(floor(into / cycle)) < 1:
		return 0.0
	return 1.0 - ease_((into - cycle * int(floor(into / cycle))) / Util.least(SEAM, 0.5 * cycle))


# Return 3 x^2 - 2 x^3 of x clamped to 0..1.
static func ease_(x):
	x = Util.least(Util.most(x, 0.0), 1.0)
	return x * x * (3.0 - 2.0 * x)
