# One pose brought to life: how head, eyes and lids turn. Angles are radians; a turn is a rotation vector.

const Util = preload("util.gd")
const Turns = preload("turns.gd")
const RADIAN = PI / 180.0  # of a degree
# The head's part of a turn: next to none of a small one, then more; all that is beyond what eyes do with ease.
const SMALL = 15.0 * RADIAN
const TILT_SHARE = 0.8  # of up and down the head does less
const EYE_EASE = 20.0 * RADIAN
const TURNED_AWAY = 28.0 * RADIAN  # a body and head that both face farther away than this are turned back
const HEAD_SIDEWAYS = 65.0 * RADIAN
const HEAD_UP = 30.0 * RADIAN
const HEAD_DOWN = 35.0 * RADIAN
# Eyes turn freely within FREE of these, and never beyond.
const EYE_SIDEWAYS = 32.0 * RADIAN
const EYE_UP = 26.0 * RADIAN
const EYE_DOWN = 30.0 * RADIAN
const FREE = 0.7
const LOOK_SIDEWAYS = 110.0 * RADIAN  # beyond these nobody looks, however much the target is behind
const LOOK_UPRIGHT = 65.0 * RADIAN
# What is behind is looked at ever less, so that nothing turns from one side to the other in a moment.
const LOOK_BEHIND = 120.0 * RADIAN
const TURN_BEHIND = 85.0 * RADIAN
const EYES_BEHIND = 100.0 * RADIAN
const TURNED_BACK = 95.0 * RADIAN  # the farthest that a body counts as turned away
const NEAREST = 0.25  # metres; nearer things are looked at as if they were there
const WIDEST = -0.8  # how far lids open beyond rest, of their shutting turn


# Returns {turns: of the rig's lookers, in their own space; eyes: [left, up] of both}. chain: the joints' rotations in their parents'
# space, places: their translations. moves: as gaze.gd returns them. amount: of all looking; calm: of what nobody asked for; share: the
# head's of a turn.
static func look(rig, chain, places, moves, amount, calm, share):
	var turned = [chain[0]]
	var at = [places[0]]
	for n in range(1, chain.size()):
		at.append(at[-1] + Turns.rotate(turned[-1], places[n]))
		turned.append(turned[-1] * chain[n])
	var middle = (rig.eyes[0].at + rig.eyes[1].at) * 0.5
	var eye = at[-1] + Turns.rotate(turned[-1], middle)
	# Where the targets are, seen from there; the eyes' and the head's share of each.
	var eyes_x = 0.0
	var eyes_y = 0.0
	var head_x = moves.head[0]
	var head_y = moves.head[1]
	var near = 0.0
	var whole = 0.0
	for part in moves.parts:
		var away = part[0].at - eye
		var x = rig.left.dot(away)
		var y = rig.up.dot(away)
		var z = rig.ahead.dot(away)
		var level = sqrt(x * x + z * z)
		var sideways = _turning(atan2(x, z), LOOK_SIDEWAYS, LOOK_BEHIND)
		var upwards = Util.within(atan2(y, level), -LOOK_UPRIGHT, LOOK_UPRIGHT)
		var weight = part[0].amount * amount * (1.0 if part[0].asked else calm)
		eyes_x += part[1] * sideways
		eyes_y += part[1] * upwards
		near += part[1] / Util.most(sqrt(level * level + y * y), NEAREST)
		head_x += part[2] * weight * sideways
		head_y += part[2] * weight * upwards
		whole += part[1] * weight
	var vector = _head(rig, turned, head_x, head_y, whole, share)
	var turns = []
	for looker in rig.lookers:
		turns.append(Turns.rotate(Turns.back(turned[looker.place]), vector) * looker.share)
	# Where that brings the eyes: every joint that turns carries what is above it along.
	var moved_to = at[rig.lookers[0].place]
	var so_far = 0.0
	for n in range(rig.lookers.size()):
		var end = at[rig.lookers[n + 1].place] if n + 1 < rig.lookers.size() else at[-1]
		so_far += rig.lookers[n].share
		moved_to += Turns.rotate(Turns.of(vector * so_far, rig.one), end - at[rig.lookers[n].place])
	var head = Turns.of(vector, rig.one) * turned[-1]
	# The point looked at, in the head's space; each eye turns to it the shortest way, so that it does not roll.
	eyes_x += moves.eyes[0]
	eyes_y += moves.eyes[1]
	var ahead = rig.left * (sin(eyes_x) * cos(eyes_y)) + rig.up * sin(eyes_y) + rig.ahead * (cos(eyes_x) * cos(eyes_y))
	var inside = Turns.rotate(Turns.back(head), eye + ahead / Util.most(near, 1e-3) - moved_to)
	var eyes = []
	for side in rig.eyes:
		var away = inside - side.at
		var x = side.left.dot(away)
		var y = side.up.dot(away)
		var across = sqrt(x * x + y * y)
		var angle = _turning(atan2(across, side.ahead.dot(away)), PI, EYES_BEHIND) / Util.most(across, 1e-12) * whole
		eyes.append(within_reach(x * angle + moves.eyes[0] * (1.0 - whole), y * angle + moves.eyes[1] * (1.0 - whole)))
	return {turns = turns, eyes = eyes}


# Returns the head's turn towards a target `left` and `up` of ahead, in the character's space.
static func _head(rig, turned, left, up, amount, share):
	var beyond = Util.least(1.0, 2.0 * share)
	var x = head_part(left, share)
	var y = TILT_SHARE * head_part(up, share)
	x += beyond * _excess(left - x, EYE_EASE)
	y += beyond * _excess(up - y, EYE_EASE)
	# A character that has turned away as a whole turns its head back; one whose head alone or body alone has, means it.
	var rests = []
	for each in [[rig.trunk, rig.trunk_ahead], [turned.size() - 1, rig.head_ahead]]:
		var facing = Turns.rotate(turned[each[0]], each[1])
		var x_ahead = rig.left.dot(facing)
		var z_ahead = rig.ahead.dot(facing)
		var gap = left - atan2(x_ahead, z_ahead)
		gap = gap - 2.0 * PI if gap > PI else (gap + 2.0 * PI if gap < -PI else gap)
		rests.append(_turning(gap, TURNED_BACK, TURN_BEHIND) * Util.smooth(2.0 * sqrt(x_ahead * x_ahead + z_ahead * z_ahead)))
	var turn_back = Util.most(Util.least(rests[0], rests[1]), 0.0) + Util.least(Util.most(rests[0], rests[1]), 0.0)
	x += beyond * amount * _excess(turn_back, Util.most(TURNED_AWAY, abs(left)))
	x = Util.within(x, -HEAD_SIDEWAYS, HEAD_SIDEWAYS)
	y = Util.within(y, -HEAD_DOWN, HEAD_UP)
	# First up, then round: the head does not tilt to a shoulder.
	var cx = cos(0.5 * x)
	var sx = sin(0.5 * x)
	var cy = cos(0.5 * y)
	var sy = -sin(0.5 * y)
	var a = cx * sy
	var b = sx * cy
	var c = -sx * sy
	var length = sqrt(a * a + b * b + c * c)
	var k = 2.0 * atan2(length, cx * cy) / length if length > 1e-12 else 0.0
	return rig.left * (a * k) + rig.up * (b * k) + rig.ahead * (c * k)


# Returns the head's part of a turn: `share` of a wide one, next to none of a small one.
static func head_part(angle, share):
	return share * angle * abs(angle) / (abs(angle) + SMALL)


# Returns an eye's turn [left, up] kept within what eyes can do, softly near the limit.
static func within_reach(left, up):
	var x = left / EYE_SIDEWAYS
	var y = up / (EYE_UP if up > 0 else EYE_DOWN)
	var far = sqrt(x * x + y * y)
	if far <= FREE:
		return [left, up]
	var k = (FREE + (1.0 - FREE) * tanh((far - FREE) / (1.0 - FREE))) / far
	return [left * k, up * k]


# Returns how far a lid is shut: 0 open as at rest, 1 shut. down: the eye's pitch. follow: of the lid, a radian of it. already: how far
# a clip has shut it; a blink shuts what is left.
static func lid(down, follow, already, blink):
	var shut = Util.within(already + follow * down, WIDEST, 1.0)
	return shut + blink * (1.0 - shut)


# Returns what a rotation near rest has in common with four numbers.
static func part_along(q, row):
	var along = q.x * row[0] + q.y * row[1] + q.z * row[2] + q.w * row[3]
	return along if q.w >= 0 else -along


# Returns an angle kept within a limit, and ever less of it from `behind` to half a turn.
static func _turning(angle, most, behind):
	return Util.within(angle, -most, most) * (1.0 - Util.smooth((abs(angle) - behind) / (PI - behind)))


static func _excess(x, free):
	var over = Util.most(abs(x) - free, 0.0)
	return -over if x < 0 else over
