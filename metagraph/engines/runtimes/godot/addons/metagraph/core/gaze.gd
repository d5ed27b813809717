# Where the gaze goes at a time: eased moves from target to target, with aversions and saccades on top. What is looked at is the sum of
# all moves so far, each from the target before, so a target may change at any time, or every frame, and nothing jumps.

const Util = preload("util.gd")
const Wanted = preload("wanted.gd")
const EYE_TIME = 0.021  # seconds
const EYE_TIME_PER_DEGREE = 0.0022
const HEAD_LAG = 0.04  # seconds the head sets off after the eyes
const HEAD_TIME = 0.55  # seconds until it has settled
const HEAD_TIME_PER_DEGREE = 0.006
const ENDING = 0.12  # seconds in which a new look ends an aversion
const SPRING = 8.0  # how many of the spring's own times a move takes

var _graph
var _life  # the life schedule
var _aims = {}
var _averting  # radians
var _darting


func _init(graph, life):
	_graph = graph
	_life = life
	var calm = 1.0 - graph.life.stillness
	_averting = graph.life.aversion_angle * PI / 180.0 * calm * graph.life.gaze
	_darting = graph.life.saccades * PI / 180.0 * calm


# Returns a critically damped spring's way from 0 to 1, for x from 0 to 1.
static func settle(x):
	if x <= 0:
		return 0.0
	return 1.0 if x >= 1 else (1.0 - (1.0 + SPRING * x) * exp(-SPRING * x)) / (1.0 - (1.0 + SPRING) * exp(-SPRING))


# Returns {parts: [aim, the eyes' share, the head's share] of each target, together 1; eyes, head: what aversions and saccades add, [left,
# up] radians}.
func at(time):
	var targets = _life.targets
	var last = Util.most(0, Util.after(targets, "start", time) - 1) if targets.size() > 0 else -1
	var place = last
	var parts = []
	var came = 0.0
	var turned = 0.0
	var strict = 0.0
	while place >= 0 and (came < 1 or turned < 1):
		if not _aims.has(place):
			_aims[place] = _aim(place)
		var aim = _aims[place]
		var gone = time - aim.start
		var now = Util.smooth(gone / aim.eyes)
		var head = settle((gone - HEAD_LAG) / aim.head)
		parts.append([aim, now - came, head - turned])
		if aim.strict:
			strict += now - came
		came = now
		turned = head
		place -= 1
	var eyes_x = 0.0
	var eyes_y = 0.0
	var head_x = 0.0
	var head_y = 0.0
	var n = Util.right_of(_life.aversions.times, time) - 1
	if n >= 0 and _averting > 0:
		var start = _life.aversions.times[n]
		var row = _life.aversions.rows[n]
		var size = sqrt(row[1] * row[1] + row[2] * row[2]) * _graph.life.aversion_angle
		var scale = _averting * (1.0 - strict)
		if last >= 0 and targets[last].since > start:  # a new look ends it
			scale *= 1.0 - Util.smooth((time - targets[last].since) / ENDING)
		var slow = HEAD_TIME + HEAD_TIME_PER_DEGREE * size
		var went = time - start
		var gone = time - row[0]
		if gone < HEAD_LAG + slow:
			var fast = EYE_TIME + EYE_TIME_PER_DEGREE * size
			var now = scale * (Util.smooth(went / fast) - Util.smooth(gone / fast))
			var head = scale * (settle((went - HEAD_LAG) / slow) - settle((gone - HEAD_LAG) / slow))
			eyes_x = row[1] * now
			eyes_y = row[2] * now
			head_x = row[1] * head
			head_y = row[2] * head
	n = Util.right_of(_life.saccades.times, time) - 1
	if n >= 0 and _darting > 0:
		var to = _life.saccades.rows[n]
		var from = _life.saccades.rows[n - 1] if n > 0 else [0.0, 0.0]
		var x = to[0] - from[0]
		var y = to[1] - from[1]
		var way = Util.smooth((time - _life.saccades.times[n]) / (EYE_TIME + EYE_TIME_PER_DEGREE * sqrt(x * x + y * y)))
		eyes_x += _darting * (from[0] + x * way)
		eyes_y += _darting * (from[1] + y * way)
	return {parts = parts, eyes = [eyes_x, eyes_y], head = [head_x, head_y]}


# Returns a target as it is met: {start, at, amount, asked, strict, eyes, head: seconds their moves to it take}.
func _aim(place):
	var target = _life.targets[place]
	var seen = _seen(target)
	var angle = _between(seen[1], _seen(_life.targets[place - 1])[1]) if place > 0 else 0.0
	return {
		start = target.start if place > 0 else -INF, at = seen[0], amount = 0.0 if seen[2] else target.amount, asked = target.asked,
		strict = target.strict, eyes = EYE_TIME + EYE_TIME_PER_DEGREE * angle, head = HEAD_TIME + HEAD_TIME_PER_DEGREE * angle
	}


# Returns [where a target is, its direction from where the eyes are at rest, whether it is nowhere, which is ahead].
func _seen(target):
	var rig = _graph.rig
	var there = rig.partner
	if typeof(target.to) != TYPE_STRING:
		there = Util.vector(target.to)
	elif target.to != Wanted.AHEAD and _graph.points.has(target.to):
		there = _graph.points[target.to]
	elif target.to != Wanted.PARTNER:
		return [rig.partner, rig.ahead, true]
	return [there, there - rig.eyes_at_rest, false]


# Returns the angle between two directions, degrees.
static func _between(a, b):
	var cosine = a.dot(b) / Util.most(a.length() * b.length(), 1e-12)
	return acos(Util.least(1.0, Util.most(-1.0, cosine))) * 180.0 / PI
