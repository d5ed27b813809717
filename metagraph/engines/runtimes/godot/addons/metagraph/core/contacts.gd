# Hands that stay where they touch, and out of the body: what contacts and the guard make of a composed pose.

const Util = preload("util.gd")
const ContactGoals = preload("contact_goals.gd")
const ContactSolve = preload("contact_solve.gd")
const ContactSpans = preload("contact_spans.gd")


# Returns an action's contacts, as exported; none for null.
static func read(data):
	var out = []
	for each in data if data != null else []:
		var keys = []
		for row in each.keys:
			keys.append(ContactSpans.ContactKey.new(row[0], [row[1], row[2], row[3]], [row[4], row[5], row[6], row[7]]))
		out.append(
			ContactSpans.ContactSpan.new(
				each.hand, each.place, each.to, each.start, each.end, keys, each.ease_in, each.ease_out
			)
		)
	return out


# Returns an exported contact rig as it is solved; names: of all joints.
static func rig_of(data, names):
	var joints = _whole(data.joints)
	var parents = _whole(data.parents)
	var places = {}
	for n in range(joints.size()):
		places[names[joints[n]]] = n
	var arms = []
	var hands = []
	for each in data.arms:
		var arm = _whole(each)
		var below = [arm[0]]
		for n in range(arm[0] + 1, parents.size()):
			if below.has(parents[n]):
				below.append(n)
		arms.append(ContactSolve.ContactArm.new(arm[0], arm[1], arm[2], below))
		hands.append(names[joints[arm[2]]])
	var capsules = []
	for c in data.capsules:
		capsules.append(ContactSolve.BodyCapsule.new(int(c.joint), c.a, int(c.to), c.b, c.radius, int(c.arm), int(c.kind)))
	return ContactSolve.ContactRig.new(joints, parents, places, arms, hands, capsules, data.contacts, data.guard)


static func _whole(numbers):
	var out = []
	for n in numbers:
		out.append(int(n))
	return out


# Changes a pose so that hands are where contacts want them, and out of the body. playing: [layer's plan, its cue with motion or null,
# the place of its rest or -1, how much of the arms the layer moves] of each layer.
static func touch(graph, playing, time, pose):
	var rig = graph.contact_rig
	var goals = []
	if rig.contacts:
		for each in playing:
			if each[3] > 0:
				goals += ContactGoals.layer_goals(rig, graph, each[0], each[1], each[2], time, each[3])
	if goals.size() == 0 and not rig.guard:
		return
	var local = []
	var moved = []
	for joint in rig.joints:
		var q = pose.rotations[joint]
		var v = pose.translations[joint]
		local.append([q.x, q.y, q.z, q.w])
		moved.append([v.x, v.y, v.z])
	var found = ContactSolve.ContactPose.new(local, moved)
	ContactSolve.spread(rig, found)
	if not ContactSolve.solve_contacts(rig, found, goals):
		return
	for arm in rig.arms:
		for place in [arm.upper, arm.lower, arm.hand]:
			var q = found.local[place]
			pose.rotations[rig.joints[place]] = graph.shim.quat(q[0], q[1], q[2], q[3])
