# Keep hands in contact with the body, and outside it, by moving two-bone arms to their goals.
#
# The body's parts are capsules, each fixed to a joint. Rotations are quaternions xyzw, lengths metres; a place is an index into a
# rig's list of joints. The code computes one pose at a time, with plain numbers, the same in all languages.
#
# Translated from metagraph/motion/contact_solve.py; change that, and translate anew.

const PlainVectors = preload("plain_vectors.gd")
const Util = preload("util.gd")
const REACHED = 0.995  # of an arm's length: it does not snap straight
const FOLDED = 0.906  # cosine of the least angle inside an elbow, 25 degrees
const WRIST = 0.819  # cosine of half of how far a contact may turn a hand from where it was, 70 degrees
const SOFT = 0.006  # metres of depth over which the push out of the body sets in
const FIRM = 0.03  # metres of depth from which on a part resists what pushes towards it
const THROUGH = 0.25  # of both radii: who is nearer to the other's line passes through it
const FULL = 0.9  # from here on, it is pushed all the way
const EVEN = 0.05  # how much the middle counts where lines are side by side
const STRAIGHT = [0.31, 0.52, 0.8]  # where a straight arm bends to: no side in particular, but always one
const ELBOW = 0.3  # how little a forearm is pushed near its elbow, which a wrist cannot move
const PASSES = 3  # of the guard
const OBSTACLE = 0  # what a capsule is to the guard: others are pushed out of it
const FOREARM = 1  # pushed out, from the elbow to the wrist
const HAND = 2  # pushed out


# The places of an arm's joints, and of all joints from its upper arm on, parents first.
class ContactArm:
	var upper
	var lower
	var hand
	var below

	func _init(upper_, lower_, hand_, below_):
		self.upper = upper_
		self.lower = lower_
		self.hand = hand_
		self.below = below_


# A part of the body. joint, to: the places of the joints that carry the ends of its line; a, b: where the ends are, in the spaces
# of those joints. arm: 0 left, 1 right, -1 neither. kind: whether it is pushed out of others: an OBSTACLE is not; a FOREARM, from
# the elbow to the wrist, and a HAND are.
class BodyCapsule:
	var joint
	var a
	var to
	var b
	var radius
	var arm
	var kind

	func _init(joint_, a_, to_, b_, radius_, arm_ = -1, kind_ = 0):
		self.joint = joint_
		self.a = a_
		self.to = to_
		self.b = b_
		self.radius = radius_
		self.arm = arm_
		self.kind = kind_


# The part of a skeleton that contacts need. joints: parents first. parents: for each joint, the place of its parent, -1 for a
# root. places: joint name -> place. arms: left, right; hands: the names of their hands. contacts, guard: whether each is on.
class ContactRig:
	var joints
	var parents
	var places
	var arms
	var hands
	var capsules
	var contacts
	var guard

	func _init(joints_, parents_, places_, arms_, hands_, capsules_, contacts_ = true, guard_ = true):
		self.joints = joints_
		self.parents = parents_
		self.places = places_
		self.arms = arms_
		self.hands = hands_
		self.capsules = capsules_
		self.contacts = contacts_
		self.guard = guard_


# Where a wrist should be. arm: 0 left, 1 right. to: a place; at, turn: in its space. weight: 0..1.
class HandGoal:
	var arm
	var to
	var at
	var turn
	var weight

	func _init(arm_, to_, at_, turn_, weight_):
		self.arm = arm_
		self.to = to_
		self.at = at_
		self.turn = turn_
		self.weight = weight_


# A pose of a rig's joints: `local` rotations and `moved` translations are in the parents' space; `turned` and `at` are in the
# character's space, and `spread` computes them.
class ContactPose:
	var local
	var moved
	var turned
	var at

	func _init(local_ = null, moved_ = null, turned_ = null, at_ = null):
		self.local = local_ if local_ != null else []
		self.moved = moved_ if moved_ != null else []
		self.turned = turned_ if turned_ != null else []
		self.at = at_ if at_ != null else []


# Compute where all joints are.
static func spread(rig, pose):
	pose.turned = Util.list(pose.local)
	pose.at = Util.list(pose.moved)
	for place in range(rig.parents.size()):
		_join(rig, pose, place)


static func _join(rig, pose, place):
	var above = rig.parents[place]
	if above < 0:
		pose.turned[place] = pose.local[place]
		pose.at[place] = pose.moved[place]
	else:
		var turn = pose.turned[above]
		var both = PlainVectors.rotated(turn, pose.moved[place])
		var x = both[0]
		var y = both[1]
		var z = both[2]
		var both2 = pose.at[above]
		var ax = both2[0]
		var ay = both2[1]
		var az = both2[2]
		pose.turned[place] = PlainVectors.times(turn, pose.local[place])
		pose.at[place] = [ax + x, ay + y, az + z]


# Move hands to their goals, then push hands and forearms out of the body; return whether anything moved. Call `spread` first.
static func solve_contacts(rig, pose, goals):
	var moved = false
	var held = [0.0, 0.0]
	var across = 0.0  # how much one arm is held on the other
	for goal in goals:
		held[goal.arm] = Util.least(1.0, held[goal.arm] + goal.weight)
		if _on_arm(rig, goal.to, 1 - goal.arm):
			across = Util.most(across, goal.weight)
	var rounds = 0 if goals.size() == 0 else (2 if across > 0.0 else 1)
	var wrists = []
	for arm in rig.arms:
		wrists.append(pose.at[arm.hand])
	var hands = []
	for arm in rig.arms:
		hands.append(pose.turned[arm.hand])
	while rounds > 0:
		rounds -= 1
		for side in range(rig.arms.size()):
			if held[side] > 0.0:
				_hold(rig, pose, goals, side, wrists[side], hands[side])
				moved = true
	var kept = []
	for arm in rig.arms:
		kept.append(pose.at[arm.hand])
	if rig.guard and _guarded(rig, pose, held, across):
		moved = true
		for side in range(rig.arms.size()):
			if across > 0.0 and held[side] > 0.0:
				var pushed = PlainVectors.minus(pose.at[rig.arms[side].hand], kept[side])
				_hold(rig, pose, goals, side, PlainVectors.plus(wrists[side], pushed), hands[side])
	return moved


static func _on_arm(rig, place, arm):
	var is_any = false
	for below in rig.arms[arm].below:
		if place == below:
			is_any = true
			break
	return is_any


# Move a hand to the weighted mean of its goals. wrist, hand: its position and rotation without goals.
static func _hold(rig, pose, goals, side, wrist, hand):
	var total = 0.0
	var x = 0.0
	var y = 0.0
	var z = 0.0
	var a = 0.0
	var b = 0.0
	var c = 0.0
	var d = 0.0
	var both = hand
	var hx = both[0]
	var hy = both[1]
	var hz = both[2]
	var hw = both[3]
	var k
	for goal in goals:
		if goal.arm == side and goal.weight > 0.0:
			k = goal.weight
			var both2 = PlainVectors.plus(pose.at[goal.to], PlainVectors.rotated(pose.turned[goal.to], goal.at))
			var px = both2[0]
			var py = both2[1]
			var pz = both2[2]
			var both3 = PlainVectors.times(pose.turned[goal.to], goal.turn)
			var qx = both3[0]
			var qy = both3[1]
			var qz = both3[2]
			var qw = both3[3]
			x = x + k * px
			y = y + k * py
			z = z + k * pz
			total = total + k
			if qx * hx + qy * hy + qz * hz + qw * hw < 0.0:
				k = -k
			a = a + k * qx
			b = b + k * qy
			c = c + k * qz
			d = d + k * qw
	var weight = Util.least(1.0, total)
	var mean = [x / total, y / total, z / total]
	var turn = _within_wrist(hand, PlainVectors.unit_turn([a, b, c, d]))
	var both4 = turn
	var tx = both4[0]
	var ty = both4[1]
	var tz = both4[2]
	var tw = both4[3]
	var rest = 1.0 - weight
	k = -weight if tx * hx + ty * hy + tz * hz + tw * hw < 0.0 else weight
	turn = PlainVectors.unit_turn([hx * rest + tx * k, hy * rest + ty * k, hz * rest + tz * k, hw * rest + tw * k])
	bring(rig, pose, side, PlainVectors.plus(wrist, PlainVectors.scaled(PlainVectors.minus(mean, wrist), weight)), turn, STRAIGHT)


# Return a hand's rotation, limited to what the wrist allows from the hand's earlier rotation.
static func _within_wrist(hand, turn):
	var both = PlainVectors.times(turn, PlainVectors.back(hand))
	var x = both[0]
	var y = both[1]
	var z = both[2]
	var w = both[3]
	if w < 0.0:
		x = -x
		y = -y
		z = -z
		w = -w
	if w >= WRIST:
		return turn
	var k = sqrt(1.0 - WRIST * WRIST) / Util.most(sqrt(x * x + y * y + z * z), 1e-12)
	return PlainVectors.times([x * k, y * k, z * k, WRIST], hand)


# Move a wrist to a goal, or as near as the arm reaches, with the elbow on the side to which it is bent; rotate the hand. side_of:
# the direction in which a straight arm bends, in the upper arm's own space.
static func bring(rig, pose, side, goal, hand, side_of):
	var arm = rig.arms[side]
	var root = pose.at[arm.upper]
	var elbow = pose.at[arm.lower]
	var wrist = pose.at[arm.hand]
	var bone = PlainVectors.minus(elbow, root)
	var fore = PlainVectors.minus(wrist, elbow)
	var above_elbow = PlainVectors.length(bone)
	var below_elbow = PlainVectors.length(fore)
	var now = PlainVectors.length(PlainVectors.minus(wrist, root))
	if above_elbow < 1e-06 or below_elbow < 1e-06 or now < 1e-06:
		return
	var way = PlainVectors.minus(goal, root)
	var most = Util.most(REACHED * (above_elbow + below_elbow), now)
	var least = Util.least(
		sqrt(above_elbow * above_elbow + below_elbow * below_elbow - 2.0 * FOLDED * above_elbow * below_elbow),
		now
	)
	var far = Util.least(Util.most(PlainVectors.length(way), least), most)
	var ahead = PlainVectors.unit(way)
	var before = PlainVectors.scaled(PlainVectors.minus(wrist, root), 1.0 / now)
	var aside = PlainVectors.minus(bone, PlainVectors.scaled(before, PlainVectors.dot(bone, before)))
	# A straight arm has no side: it bends to one that goes with its bone.
	var spare = PlainVectors.rotated(pose.turned[arm.upper], side_of)
	spare = PlainVectors.minus(spare, PlainVectors.scaled(before, PlainVectors.dot(spare, before)))
	aside = PlainVectors.plus(aside, PlainVectors.scaled(spare, Util.most(0.0, 0.01 * above_elbow - PlainVectors.length(aside))))
	aside = PlainVectors.unit(PlainVectors.rotated(PlainVectors.between(before, ahead), aside))
	var along = (above_elbow * above_elbow + far * far - below_elbow * below_elbow) / (2.0 * far)
	var high = sqrt(Util.most(0.0, above_elbow * above_elbow - along * along))
	var knee = PlainVectors.plus(PlainVectors.scaled(ahead, along), PlainVectors.scaled(aside, high))
	var swing = PlainVectors.between(PlainVectors.unit(bone), PlainVectors.unit(knee))
	var fold = PlainVectors.between(
		PlainVectors.unit(PlainVectors.rotated(swing, fore)),
		PlainVectors.unit(PlainVectors.minus(PlainVectors.scaled(ahead, far), knee))
	)
	var both = PlainVectors.times(fold, swing)
	var above = _above(rig, pose, arm.upper)
	pose.local[arm.upper] = PlainVectors.times(PlainVectors.back(above), PlainVectors.times(swing, pose.turned[arm.upper]))
	above = PlainVectors.times(swing, _above(rig, pose, arm.lower))
	pose.local[arm.lower] = PlainVectors.times(PlainVectors.back(above), PlainVectors.times(both, pose.turned[arm.lower]))
	above = PlainVectors.times(both, _above(rig, pose, arm.hand))
	pose.local[arm.hand] = PlainVectors.times(PlainVectors.back(above), hand)
	for place in arm.below:
		_join(rig, pose, place)


static func _above(rig, pose, place):
	var above = rig.parents[place]
	return [0.0, 0.0, 0.0, 1.0] if above < 0 else pose.turned[above]


# Push forearms and hands out of the capsules they are inside, by the smallest shift of the wrists; return whether any was inside.
# held: how much a contact holds each hand, which is then not pushed.
#
# An arm that passes through a capsule is pushed to one side before the middle and to the other side after it. The push gets
# weaker towards the middle, so that the arm does not jump.
static func _guarded(rig, pose, held, across):
	var local = Util.list(pose.local)
	var turned = Util.list(pose.turned)
	var at = Util.list(pose.at)
	var whole = [1.0, 1.0]
	var moved = false
	for number in range(PASSES):
		var ends = capsule_ends(rig, pose)
		var balls = _balls(rig, ends)
		var found = false
		var first = number == 0
		var shifts = []
		for side2 in range(rig.arms.size()):
			shifts.append(_shift(rig, ends, balls, side2, held, across, whole, first))
		for side in range(shifts.size()):
			var shift = shifts[side]
			if PlainVectors.length(shift) > 0.0:
				var hand = rig.arms[side].hand
				bring(rig, pose, side, PlainVectors.plus(pose.at[hand], shift), pose.turned[hand], STRAIGHT)
				found = true
		if not found:
			break
		moved = true
	if moved and Util.least(whole[0], whole[1]) < 1.0:
		var goals = []
		for arm2 in rig.arms:
			goals.append(pose.at[arm2.hand])
		pose.local = local
		pose.turned = turned
		pose.at = at
		for side in range(rig.arms.size()):
			var arm = rig.arms[side]
			var way = PlainVectors.minus(goals[side], pose.at[arm.hand])
			if PlainVectors.length(way) > 0.0:
				var goal = PlainVectors.plus(pose.at[arm.hand], PlainVectors.scaled(way, whole[side]))
				bring(rig, pose, side, goal, pose.turned[arm.hand], STRAIGHT)
	return moved


# Return both ends of every capsule's line, one after the other.
static func capsule_ends(rig, pose):
	var out = []
	for capsule in rig.capsules:
		out.append(PlainVectors.plus(pose.at[capsule.joint], PlainVectors.rotated(pose.turned[capsule.joint], capsule.a)))
		out.append(PlainVectors.plus(pose.at[capsule.to], PlainVectors.rotated(pose.turned[capsule.to], capsule.b)))
	return out


# Return a ball round each capsule: its middle and radius.
static func _balls(rig, ends):
	var out = []
	for n in range(rig.capsules.size()):
		var capsule = rig.capsules[n]
		var both = ends[2 * n]
		var ax = both[0]
		var ay = both[1]
		var az = both[2]
		var both2 = ends[2 * n + 1]
		var bx = both2[0]
		var by = both2[1]
		var bz = both2[2]
		var x = bx - ax
		var y = by - ay
		var z = bz - az
		var size = 0.5 * sqrt(x * x + y * y + z * z) + capsule.radius
		out.append([ax + 0.5 * x, ay + 0.5 * y, az + 0.5 * z, size])
	return out


# Return the shift of a wrist that brings its arm out of all other capsules, or closer to that. whole: for each side, the share of
# the shift to apply, which the first pass finds.
static func _shift(rig, ends, balls, side, held, across, whole, first):
	var shift = [0.0, 0.0, 0.0]
	var own = 1.0 - held[side]
	if own <= 0.0:
		return shift
	for i in range(rig.capsules.size()):
		var mine = rig.capsules[i]
		if mine.arm != side or mine.kind == OBSTACLE:
			continue
		var both = balls[i]
		var mx = both[0]
		var my = both[1]
		var mz = both[2]
		var size = both[3]
		for k in range(balls.size()):
			var both2 = balls[k]
			var ox = both2[0]
			var oy = both2[1]
			var oz = both2[2]
			var most = both2[3]
			var dx = ox - mx
			var dy = oy - my
			var dz = oz - mz
			var reach = most + size
			if dx * dx + dy * dy + dz * dz >= reach * reach:
				continue  # most are nowhere near
			var other = rig.capsules[k]
			if other.arm == side:
				continue
			var share = own
			if other.arm >= 0:
				share = Util.least(own, 1.0 - across)
				if other.kind != OBSTACLE:  # both give way
					share = share * (1.0 - 0.5 * (1.0 - held[other.arm]))
			if share <= 0.0:
				continue
			var both3 = apart(ends, 2 * i, 2 * k)
			var x = both3[0]
			var y = both3[1]
			var z = both3[2]
			var gap = both3[3]
			var radii = mine.radius + other.radius
			if gap >= radii or gap < 1e-09:
				continue
			var depth = radii - gap
			var amount = depth - 0.5 * SOFT if depth > SOFT else depth * depth / (2.0 * SOFT)
			# Near to the line it is not pushed all the way, and about it not at all.
			var inner = Util.least(1.0, Util.most(0.0, (gap / radii - THROUGH) / (FULL - THROUGH)))
			inner = inner * inner * (3.0 - 2.0 * inner)
			if first:
				whole[side] = Util.least(whole[side], 1.0 - share * (1.0 - inner))
				inner = 1.0
			amount = amount * share * inner
			var part = _along(ends, 2 * i, 2 * k) if mine.kind == FOREARM else 1.0
			var way = [x / gap, y / gap, z / gap]
			var pushed = part * PlainVectors.dot(way, shift)
			if pushed < 0.0:  # others push towards it: what hardly touches or hardly counts hardly resists
				pushed = pushed * share * Util.least(1.0, depth / FIRM)
			var left = amount - pushed
			if left > 0.0:
				shift = PlainVectors.plus(shift, PlainVectors.scaled(way, left * part / (part * part + ELBOW * (1.0 - part))))
	return shift


# Return where on the line that begins at `ends[i]` the shortest way from the line at `ends[k]` ends, 0..1. For nearly parallel
# lines, where it could end anywhere, the result moves towards the middle.
static func _along(ends, i, k):
	var a = ends[i]
	var c = ends[k]
	var u = PlainVectors.minus(ends[i + 1], a)
	var v = PlainVectors.minus(ends[k + 1], c)
	var w = PlainVectors.minus(a, c)
	var uu = PlainVectors.dot(u, u)
	var uv = PlainVectors.dot(u, v)
	var vv = PlainVectors.dot(v, v)
	var uw = PlainVectors.dot(u, w)
	var vw = PlainVectors.dot(v, w)
	if uu <= 1e-12:
		return 0.0
	var stiff = (1.0 + EVEN) * uu
	var middle = 0.5 * EVEN * uu - uw
	if vv <= 1e-12:
		return Util.least(Util.most(middle / stiff, 0.0), 1.0)
	var s = Util.least(Util.most((vv * middle + uv * vw) / (stiff * vv - uv * uv), 0.0), 1.0)
	var t = (uv * s + vw) / vv
	if t < 0.0 or t > 1.0:
		s = Util.least(Util.most((uv * Util.least(Util.most(t, 0.0), 1.0) + middle) / stiff, 0.0), 1.0)
	return s


# Return the shortest way from the line that begins at `ends[k]` to the one at `ends[i]`, and its length. Its vectors are written
# out, since a guarded pose asks some thirty times.
static func apart(ends, i, k):
	var both = ends[i]
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var both2 = ends[i + 1]
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	var both3 = ends[k]
	var cx = both3[0]
	var cy = both3[1]
	var cz = both3[2]
	var both4 = ends[k + 1]
	var dx = both4[0]
	var dy = both4[1]
	var dz = both4[2]
	var ux = bx - ax
	var uy = by - ay
	var uz = bz - az
	var vx = dx - cx
	var vy = dy - cy
	var vz = dz - cz
	var wx = ax - cx
	var wy = ay - cy
	var wz = az - cz
	var uu = ux * ux + uy * uy + uz * uz
	var uv = ux * vx + uy * vy + uz * vz
	var vv = vx * vx + vy * vy + vz * vz
	var uw = ux * wx + uy * wy + uz * wz
	var vw = vx * wx + vy * wy + vz * wz
	var s = 0.0
	var t = 0.0
	if uu > 1e-12:
		var below = uu * vv - uv * uv
		if below > 1e-09 * uu * vv:
			s = Util.least(Util.most((uv * vw - vv * uw) / below, 0.0), 1.0)
		if vv > 1e-12:
			t = (uv * s + vw) / vv
			if t < 0.0 or t > 1.0:
				t = Util.least(Util.most(t, 0.0), 1.0)
				s = Util.least(Util.most((uv * t - uw) / uu, 0.0), 1.0)
		else:
			s = Util.least(Util.most(-uw / uu, 0.0), 1.0)
	elif vv > 1e-12:
		t = Util.least(Util.most(vw / vv, 0.0), 1.0)
	var x = wx + ux * s - vx * t
	var y = wy + uy * s - vy * t
	var z = wz + uz * s - vz * t
	return [x, y, z, sqrt(x * x + y * y + z * z)]
