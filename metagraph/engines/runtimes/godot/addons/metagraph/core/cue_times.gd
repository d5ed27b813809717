# What of a cue shows at a time, in plain numbers: `player` and `Cue.clip_seconds` have it for arrays.
#
# Translated from metagraph/playback/cue_times.py; change that, and translate anew.

const Util = preload("util.gd")


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
	if cue.hold <= 0.0:
		return cue.entry + elapsed * cue.tempo
	var held = Util.least(Util.most(elapsed - (cue.hold_from - cue.entry) / cue.tempo, 0.0), cue.hold)
	var more = (elapsed - held) * (cue.tempo - 1.0)
	return cue.entry + elapsed - held + more + held * ((cue.hold_to - cue.hold_from) / cue.hold)


# Return 3 x^2 - 2 x^3 of x within 0..1.
static func ease_(x):
	x = Util.least(Util.most(x, 0.0), 1.0)
	return x * x * (3.0 - 2.0 * x)
