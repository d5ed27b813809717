# Move feet to where they should stand, with two-bone legs whose knees keep their direction. The hips move along and sink, so that
# no leg snaps straight.
#
# Rotations are quaternions xyzw, lengths metres. The code computes one pose at a time, with plain numbers, the same in all
# languages. All amounts are ours, chosen by eye.
#
# Translated from metagraph/motion/feet_solve.py; change that, and translate anew.

const ContactSolve = preload("contact_solve.gd")
const PlainVectors = preload("plain_vectors.gd")
const WeightSolve = preload("weight_solve.gd")
const Util = preload("util.gd")
const NEAR = 0.0001  # metres that a foot may be away before it is brought
const NEARLY = 0.001  # radians that it may be turned away
const FOLLOWS = 0.7  # of the feet's way the hips come along
const LEANS = 0.1  # of the way to the foot that stands, while the other is
const HIGH = 0.05  # metres in the air
const TURNING = 0.15  # metres that a turn of a radian counts as way


# Where a foot's joint should be, in the character's space. planted: how firmly it stands there, 0..1. lift: height of a step
# above that, metres.
class FootGoal:
	var at
	var turn
	var planted
	var lift

	func _init(at_, turn_, planted_, lift_):
		self.at = at_
		self.turn = turn_
		self.planted = planted_
		self.lift = lift_


# Return the distance between two places of a foot, in metres; a rotation counts as a distance, too.
static func foot_way(a, b):
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
	var along = Util.absolute(ax * bx + ay * by + az * bz + aw * bw)
	var turn = 2.0 * sqrt(Util.most(0.0, 2.0 - 2.0 * along))
	return PlainVectors.length(PlainVectors.minus(b.at, a.at)) + TURNING * turn


# Move feet to their goals, as far as these are planted; return whether anything moved. goals: left and right, or none. strength:
# the user's dial. You need not call `spread` first.
static func plant_feet(rig, pose, goals, strength):
	if goals.size() != 2 or strength <= 0.0:
		return false
	var body = rig.body
	ContactSolve.spread(body, pose)
	strength = strength * WeightSolve.stands_by(rig, pose)
	if strength <= 0.0:
		return false
	var feet = []
	for leg in body.arms:
		feet.append(pose.at[leg.hand])
	var soles = []
	for leg in body.arms:
		soles.append(pose.turned[leg.hand])
	var reaches = []
	for leg in body.arms:
		reaches.append(PlainVectors.length(PlainVectors.minus(pose.at[leg.hand], pose.at[leg.upper])))
	var hips = rig.bends[0].place
	var middle = pose.at[hips]
	var shift = [0.0, 0.0, 0.0]
	var size = 0.0
	var moved = false
	for side in range(2):
		var goal = goals[side]
		var part = strength * goal.planted
		var way = PlainVectors.minus(PlainVectors.plus(goal.at, PlainVectors.scaled(rig.up, goal.lift)), feet[side])
		var far = PlainVectors.length(way)
		if far > NEAR and part > 0.0:
			way = PlainVectors.scaled(way, part * (far - NEAR) / far)
			var lean = LEANS * part * goal.lift / HIGH
			shift = PlainVectors.plus(
				shift,
				PlainVectors.plus(
					PlainVectors.scaled(way, 0.5 * FOLLOWS),
					PlainVectors.scaled(PlainVectors.minus(feet[1 - side], middle), lean)
				)
			)
			feet[side] = PlainVectors.plus(feet[side], way)
			size += PlainVectors.length(way)
			moved = true
		var both = PlainVectors.times(goal.turn, PlainVectors.back(soles[side]))
		var x = both[0]
		var y = both[1]
		var z = both[2]
		var w = both[3]
		var turn = 2.0 * sqrt(x * x + y * y + z * z)
		if turn > NEARLY and part > 0.0:
			var k = part * (turn - NEARLY) / turn
			var along = -k if w < 0.0 else k  # the shorter way
			var turned = PlainVectors.unit_turn([x * along, y * along, z * along, 1.0 - k + Util.absolute(w) * k])
			soles[side] = PlainVectors.times(turned, soles[side])
			moved = true
	if not moved:
		return false
	shift = PlainVectors.minus(shift, PlainVectors.scaled(rig.up, PlainVectors.dot(shift, rig.up)))
	var above = body.parents[hips]
	var space = [0.0, 0.0, 0.0, 1.0] if above < 0 else PlainVectors.back(pose.turned[above])
	pose.moved[hips] = PlainVectors.plus(pose.moved[hips], PlainVectors.rotated(space, shift))
	ContactSolve.spread(body, pose)
	var soft = WeightSolve.GIVE * (size + PlainVectors.length(shift))
	var low = 0.0
	for side in range(2):
		low = Util.most(low, WeightSolve.hips_sink(rig, pose, side, feet[side], reaches[side], soft))
	if low > 0.0:
		pose.moved[hips] = PlainVectors.plus(pose.moved[hips], PlainVectors.rotated(space, PlainVectors.scaled(rig.up, -low)))
		ContactSolve.spread(body, pose)
	for side in range(2):
		ContactSolve.bring(body, pose, side, feet[side], soles[side], rig.knees[side])
	return true
