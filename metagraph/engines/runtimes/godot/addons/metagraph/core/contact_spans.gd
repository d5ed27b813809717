# Contacts of an action: where on the body a hand stays, or moves along it, for a part of its clip.
#
# A contact gives the position of the wrist and the rotation of the hand in the space of a joint. So it holds whatever else moves
# that joint: a breathing spine, a layer below, a body of another shape.
#
# Translated from metagraph/motion/contact_spans.py; change that, and translate anew.

const Util = preload("util.gd")
const HANDS = ["left", "right"]
const PLACES = ["palm", "fingertips", "back", "wrist"]
const EASE = 0.15  # seconds in which a hand comes to a contact, and leaves it, by default
const SETTLES = 0.3  # seconds it takes at least where the contact lasts: what it touches may be far from its place


# Where a hand is on a joint at a moment. time: clip seconds. at: the wrist in the joint's own space, metres. turn: how the hand
# is turned there, xyzw.
class ContactKey:
	var time
	var at
	var turn

	func _init(time_, at_, turn_):
		self.time = time_
		self.at = at_
		self.turn = turn_


# A hand that stays at a place on the body.
#
# hand: left or right. place: the part of the hand that touches: palm, fingertips, back, wrist. to: the name of the joint it stays
# with. start, end: clip seconds. keys: one for a hand that stays, more, in order, for one that moves over the body. ease_in,
# ease_out: seconds inside the span in which the contact sets in and fades out; they do not apply if the action begins, or ends,
# within the span.
class ContactSpan:
	var hand
	var place
	var to
	var start
	var end
	var keys
	var ease_in
	var ease_out

	func _init(hand_, place_, to_, start_, end_, keys_, ease_in_ = EASE, ease_out_ = EASE):
		self.hand = hand_
		self.place = place_
		self.to = to_
		self.start = start_
		self.end = end_
		self.keys = keys_
		self.ease_in = ease_in_
		self.ease_out = ease_out_


# Return how much a hand is held at a second of the clip, 0..1. first, last: the seconds of the clip that play.
static func contact_weight(span, seconds, first, last):
	if seconds < span.start or seconds > span.end:
		return 0.0
	var shown = 1.0
	var comes = span.start > first and span.ease_in > 0.0
	var goes = span.end < last and span.ease_out > 0.0
	var least = Util.least(SETTLES, (span.end - span.start) / (2.0 if (comes and goes) else 1.0))
	if comes:
		shown = Util.least(shown, (seconds - span.start) / Util.most(span.ease_in, least))
	if goes:
		shown = Util.least(shown, (span.end - seconds) / Util.most(span.ease_out, least))
	return shown * shown * (3.0 - 2.0 * shown)


# Return where a hand is at a second of the clip, interpolated linearly between two keys.
static func contact_key(span, seconds):
	var before = span.keys[0]
	for after in span.keys:
		if after.time >= seconds:
			if after.time <= before.time:
				return after
			var part = (seconds - before.time) / (after.time - before.time)
			var both = before.at
			var ax = both[0]
			var ay = both[1]
			var az = both[2]
			var both2 = after.at
			var bx = both2[0]
			var by = both2[1]
			var bz = both2[2]
			var at = [ax + (bx - ax) * part, ay + (by - ay) * part, az + (bz - az) * part]
			var both3 = before.turn
			var px = both3[0]
			var py = both3[1]
			var pz = both3[2]
			var pw = both3[3]
			var both4 = after.turn
			var qx = both4[0]
			var qy = both4[1]
			var qz = both4[2]
			var qw = both4[3]
			var other = -part if px * qx + py * qy + pz * qz + pw * qw < 0.0 else part
			var own = 1.0 - part
			var x = px * own + qx * other
			var y = py * own + qy * other
			var z = pz * own + qz * other
			var w = pw * own + qw * other
			var size = 1.0 / Util.most(sqrt(x * x + y * y + z * z + w * w), 1e-12)
			return ContactKey.new(seconds, at, [x * size, y * size, z * size, w * size])
		before = after
	return before
