# Find the goals that contacts set for the hands at a time: contacts of the cue that plays and of the loops under it, each
# weighted by how much of it shows.
#
# Translated from metagraph/playback/posing/contact_goals.py; change that, and translate anew.

const ContactSolve = preload("contact_solve.gd")
const ContactSpans = preload("contact_spans.gd")
const CueTimes = preload("cue_times.gd")
const Util = preload("util.gd")
const LEAST = 1e-06  # of a hand: goals with less weight are not solved


# Return a layer's goals for the hands at a time.
#
# `cue` is the one that plays, if it has motion. `place` is the index of the rest in force, -1 for none. `strength` is how much of
# the arms the layer moves, 0..1.
static func layer_goals(rig, project, plan, cue, place, time, strength):
	var out = []
	var shown = [0.0, 0.0]
	if cue != null:
		var weight = CueTimes.cue_weight(cue, time)
		for arm in range(ContactSpans.HANDS.size()):
			var hand = ContactSpans.HANDS[arm]
			if _moves(rig, cue.action, arm, hand):
				shown[arm] = weight
		if cue.action.contacts.size() > 0:
			var left = CueTimes.seam_left(cue, time)
			if left > 0.0:  # the goals at the end of the previous cycle, as far as its pose still shows
				var found = []
				for w in shown:
					found.append(strength * left * w)
				Util.extend(out, _goals(rig, project, cue.action, cue.cycle_to, found))
			var share = strength * (1.0 - left)
			var found2 = []
			for w in shown:
				found2.append(share * w)
			Util.extend(out, _goals(rig, project, cue.action, CueTimes.cue_seconds(cue, time), found2))
	if place >= 0:
		var rest = plan.rests[place]
		var over = 1.0
		if place > 0 and rest.fade_start + rest.fade > time:
			over = CueTimes.ease_((time - rest.fade_start) / rest.fade)
			Util.extend(out, _loop_goals(rig, project, plan.rests[place - 1], time, strength * (1.0 - over), shown))
		Util.extend(out, _loop_goals(rig, project, rest, time, strength * over, shown))
	return out


# Return a loop's goals for the hands, reduced by the cue above it.
static func _loop_goals(rig, project, rest, time, strength, shown):
	var out = []
	var action = rest.action
	if action.contacts.size() == 0:
		return out
	var left = []
	for w in shown:
		left.append(strength * (1.0 - w))
	var both = project.span(action)
	var start = both[0]
	var end = both[1]
	var seam = Util.least(Util.most(0.0, action.timing.blend_in), (end - start) / 2.0)
	var period = end - start - seam
	if period <= 0.0:
		return _goals(rig, project, action, start, left)
	var elapsed = time - rest.start
	var phase = Util.most(elapsed, 0.0) if seam > 0.0 else elapsed
	phase = phase - period * int(floor(phase / period))
	var old = 0.0
	if seam > 0.0 and elapsed >= period:
		old = 1.0 - CueTimes.ease_(phase / seam)
	if old > 0.0:
		var before = start + Util.least(period + phase, end - start)
		var found = []
		for w in left:
			found.append(old * w)
		Util.extend(out, _goals(rig, project, action, before, found))
	var found2 = []
	for w in left:
		found2.append((1.0 - old) * w)
	Util.extend(out, _goals(rig, project, action, start + phase, found2))
	return out


# Return the goals of an action at a second of its clip. `shares` says how much of it shows at the left and the right hand.
static func _goals(rig, project, action, seconds, shares):
	var out = []
	var both = project.span(action)
	var start = both[0]
	var end = both[1]
	for span in action.contacts:
		var arm = _arm(span)
		var to = rig.places.get(span.to)
		if to == null or span.keys.size() == 0 or shares[arm] <= LEAST:
			continue
		var weight = shares[arm] * ContactSpans.contact_weight(span, seconds, start, end)
		if weight > LEAST:
			var key = ContactSpans.contact_key(span, seconds)
			out.append(ContactSolve.HandGoal.new(arm, to, key.at, key.turn, weight))
	return out


static func _arm(span):
	return 0 if span.hand == "left" else 1


# Return whether an action moves a hand, instead of leaving it in the stance.
static func _moves(rig, action, arm, hand):
	if not ["both", hand].has(action.limb):
		return false
	return action.joints.size() == 0 or action.joints.has(rig.hands[arm])
