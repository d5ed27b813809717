# How a standing body reacts to its arms: the hips give way, spine and legs compensate, and the feet stay.
#
# Rotations are quaternions xyzw, lengths metres; a place is an index into a rig's list of joints. The code computes one pose at a
# time, with plain numbers, the same in all languages.
#
# How much: a standing person keeps the centre of mass over the feet, so the hips move back as far as the arms move it ahead. The
# weight of each segment is from de Leva 1996. That trunk and legs move against a raised arm is from Bouisset and Zattara 1987.
# The other amounts are ours, chosen by eye on the sample.
#
# Translated from metagraph/motion/weight_solve.py; change that, and translate anew.

const ContactSolve = preload("contact_solve.gd")
const PlainVectors = preload("plain_vectors.gd")
const Util = preload("util.gd")
const BALANCE = 1.4  # factor of the arms' shift of the centre of mass by which the hips compensate
const HASTE = 0.12  # seconds of the arms' speed that are added to the shift
const DIP = 0.05  # seconds: arms that rise this fast press the body down, half as far at most
const SPIN = 30.0  # seconds: how far the pelvis turns against what arms turn about the vertical
const ROLL = 3.0  # radians that the pelvis rolls for a shift to a side of its own height, and
const PITCH = 2.0  # bends for one ahead or back
const MOST_SHIFT = 0.02  # of the height
const MOST_TURN = 0.1  # radians
const SITTING = 0.75  # how high a hip is above its ankle, of the leg's length: below this it does not stand
const STANDING = 0.15  # and this much above it stands altogether
const GIVE = 0.5  # of a shift: over so much a leg's full length makes itself felt


# A joint that turns. left, up, ahead: the character's directions in its own space. share: of the hips' rotation, below 0 for the
# opposite direction.
class WeightBend:
	var place
	var left
	var up
	var ahead
	var share

	func _init(place_, left_, up_, ahead_, share_):
		self.place = place_
		self.left = left_
		self.up = up_
		self.ahead = ahead_
		self.share = share_


# A collar bone. upper: the place of its arm. axis: what lifts it, in its own space. side: 0 left, 1 right.
class WeightCollar:
	var place
	var upper
	var axis
	var side

	func _init(place_, upper_, axis_, side_):
		self.place = place_
		self.upper = upper_
		self.axis = axis_
		self.side = side_


# The part of a skeleton that reacts to its arms. body: its joints; its `arms` are the legs, left and right, its `hands` the names
# of the hands. bends: from the hips up. knees: the direction in which straight legs bend, in the upper legs' own spaces. levers:
# how far the arms are to the left and ahead of the hips. up: the character's up direction. height: of the figure, metres.
# strength: how much of the arms' layer counts, 0..1.
class WeightRig:
	var body
	var bends
	var collars
	var knees
	var levers
	var up
	var height
	var strength

	func _init(body_, bends_, collars_, knees_, levers_, up_, height_, strength_):
		self.body = body_
		self.bends = bends_
		self.collars = collars_
		self.knees = knees_
		self.levers = levers_
		self.up = up_
		self.height = height_
		self.strength = strength_


# Return whether there is anything to react to.
static func moves_body(drive):
	var is_any = false
	for x in drive:
		if x != 0.0:
			is_any = true
			break
	return is_any


# Change a pose of the rig's joints in reaction to its arms; return whether it changed.
#
# drive: as `posing.follow_through.driven` returns it. follow, lift: the user's dials. You need not call `spread` first.
static func answer_arms(rig, pose, drive, follow, lift):
	follow = follow * rig.strength
	lift = lift * rig.strength
	if (follow <= 0.0 and lift <= 0.0) or not moves_body(drive):
		return false
	for collar in rig.collars:
		var turn = _turn(collar.axis, lift * drive[6 + collar.side])
		pose.local[collar.place] = PlainVectors.times(pose.local[collar.place], turn)
		pose.local[collar.upper] = PlainVectors.times(PlainVectors.back(turn), pose.local[collar.upper])
	if follow <= 0.0:
		return true
	ContactSolve.spread(rig.body, pose)
	follow = follow * stands_by(rig, pose)
	if follow <= 0.0:
		return true
	_give_way(rig, pose, drive, follow)
	return true


# Return how much a figure stands: 0 if it sits or lies, 1 on straight legs.
static func stands_by(rig, pose):
	var least = 1.0
	for leg in rig.body.arms:
		var hip = pose.at[leg.upper]
		var knee = pose.at[leg.lower]
		var ankle = pose.at[leg.hand]
		var whole = PlainVectors.length(PlainVectors.minus(knee, hip)) + PlainVectors.length(PlainVectors.minus(ankle, knee))
		if whole > 1e-06:
			least = Util.least(least, PlainVectors.dot(PlainVectors.minus(hip, ankle), rig.up) / whole)
	var x = Util.least(Util.most((least - SITTING) / STANDING, 0.0), 1.0)
	return x * x * (3.0 - 2.0 * x)


# Shift and rotate the hips, undo that in the spine, and move the legs so that the feet stay.
static func _give_way(rig, pose, drive, follow):
	var body = rig.body
	var vx = drive[8] + drive[11]
	var vy = drive[9] + drive[12]
	var vz = drive[10] + drive[13]
	var spin = 0.0
	for side in range(rig.levers.size()):
		var lever = rig.levers[side]
		var both = lever
		var lx = both[0]
		var lz = both[1]
		spin += lz * drive[8 + 3 * side] - lx * drive[10 + 3 * side]
	var most = MOST_SHIFT * rig.height
	var x = _soft(-follow * BALANCE * (drive[0] + drive[3] + HASTE * vx), most)
	var y = _soft(-follow * DIP * vy, 0.5 * most)
	var z = _soft(-follow * BALANCE * (drive[2] + drive[5] + HASTE * vz), most)
	var yaw = _soft(-follow * SPIN * spin / (rig.height * rig.height), MOST_TURN)
	var roll = ROLL * x / rig.height
	var pitch = -PITCH * z / rig.height
	var feet = []
	for leg in body.arms:
		feet.append(pose.at[leg.hand])
	var soles = []
	for leg in body.arms:
		soles.append(pose.turned[leg.hand])
	var reaches = []
	for leg in body.arms:
		reaches.append(PlainVectors.length(PlainVectors.minus(pose.at[leg.hand], pose.at[leg.upper])))
	var hips = rig.bends[0]
	var shift = PlainVectors.plus(
		PlainVectors.plus(PlainVectors.scaled(hips.left, x), PlainVectors.scaled(hips.up, y)),
		PlainVectors.scaled(hips.ahead, z)
	)
	shift = PlainVectors.rotated(pose.turned[hips.place], shift)
	for bend in rig.bends:
		var axis = PlainVectors.plus(
			PlainVectors.plus(PlainVectors.scaled(bend.left, pitch), PlainVectors.scaled(bend.up, yaw)),
			PlainVectors.scaled(bend.ahead, roll)
		)
		pose.local[bend.place] = PlainVectors.times(pose.local[bend.place], _turn(axis, bend.share))
	var above = body.parents[hips.place]
	var space = [0.0, 0.0, 0.0, 1.0] if above < 0 else PlainVectors.back(pose.turned[above])
	pose.moved[hips.place] = PlainVectors.plus(pose.moved[hips.place], PlainVectors.rotated(space, shift))
	ContactSolve.spread(body, pose)
	var size = PlainVectors.length([x, y, z]) + 0.1 * rig.height * PlainVectors.length([yaw, roll, pitch])
	var low = 0.0
	for side in range(feet.size()):
		low = Util.most(low, hips_sink(rig, pose, side, feet[side], reaches[side], GIVE * size))
	if low > 0.0:
		var down = PlainVectors.rotated(space, PlainVectors.scaled(rig.up, -low))
		pose.moved[hips.place] = PlainVectors.plus(pose.moved[hips.place], down)
		ContactSolve.spread(body, pose)
	for side in range(feet.size()):
		ContactSolve.bring(body, pose, side, feet[side], soles[side], rig.knees[side])


# Return how far the hips have to sink so that the leg reaches the foot. It sets in gently, a little before the limit. reach: the
# distance of hip and foot before.
static func hips_sink(rig, pose, side, foot, reach, soft):
	var leg = rig.body.arms[side]
	var hip = pose.at[leg.upper]
	var knee = pose.at[leg.lower]
	var ankle = pose.at[leg.hand]
	var whole = PlainVectors.length(PlainVectors.minus(knee, hip)) + PlainVectors.length(PlainVectors.minus(ankle, knee))
	var most = Util.most(ContactSolve.REACHED * whole, reach)
	var way = PlainVectors.minus(hip, foot)
	var high = PlainVectors.dot(way, rig.up)
	var aside = PlainVectors.dot(way, way) - high * high
	if high <= 0.0 or aside >= most * most or soft <= 0.0:
		return 0.0
	var over = high - sqrt(most * most - aside)
	if over >= soft:
		return over
	return 0.0 if over <= -soft else (over + soft) * (over + soft) / (4.0 * soft)


# Return a number limited smoothly to below `most`; small numbers stay almost as they are.
static func _soft(x, most):
	return x / sqrt(1.0 + x / most * (x / most))


# Return the rotation about an axis by its length times an angle, radians.
static func _turn(axis, angle):
	var both = axis
	var x = both[0]
	var y = both[1]
	var z = both[2]
	var size = PlainVectors.length(axis)
	if size <= 0.0:
		return [0.0, 0.0, 0.0, 1.0]
	var half = 0.5 * size * angle
	var k = sin(half) / size
	return [x * k, y * k, z * k, cos(half)]
