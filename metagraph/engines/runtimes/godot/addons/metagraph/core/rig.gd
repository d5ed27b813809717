# The life layers' body, as the export resolves it: what breathes and looks, and the face.

const Util = preload("util.gd")


# Returns the rig of an export's `rig`, with vectors and with the face's shapes as lists of [place, vector] for each channel.
static func rig_of(data, shim):
	var out = {
		left = Util.vector(data.left), up = Util.vector(data.up), ahead = Util.vector(data.ahead), chain = _whole(data.chain), breath = [],
		bowed = [], thrust = [], shoulders = [], lookers = [], trunk = int(data.trunk), trunk_ahead = Util.vector(data.trunk_ahead),
		head_ahead = Util.vector(data.head_ahead), eyes = [], partner = Util.vector(data.partner),
		eyes_at_rest = Util.vector(data.eyes_at_rest), one = shim.quat(0.0, 0.0, 0.0, 1.0)
	}
	for each in data.breath:
		out.breath.append(Util.vector(each) * each[3])
	for n in range(data.breath.size()):
		var bowed = data.bowed[n] if data.bowed != null and data.bowed.size() > n else 0.0
		out.bowed.append(Util.vector(data.breath[n]) * bowed)
		var thrust = data.thrust[n] if data.thrust != null and data.thrust.size() > n else 0.0
		out.thrust.append(Util.vector(data.breath[n]) * thrust)
	for each in data.shoulders:
		var tense = Util.vector(each.tense) if each.tense != null else Vector3()
		var closed = Util.vector(each.closed) if each.get("closed") != null else Vector3()
		out.shoulders.append({joint = int(each.joint), turn = Util.vector(each.turn), tense = tense, closed = closed})
	for each in data.lookers:
		out.lookers.append({place = int(each.place), share = each.share})
	for eye in data.eyes:
		out.eyes.append({
			at = Util.vector(eye.at), left = Util.vector(eye.left), up = Util.vector(eye.up), ahead = Util.vector(eye.ahead),
			joint = int(eye.joint), turn_left = Util.vector(eye.turn_left), turn_up = Util.vector(eye.turn_up), down = eye.down
		})
	var face = data.face
	out.face = {
		joints = _whole(face.joints), turns = _shapes(face.turns), shifts = _shapes(face.shifts), follows = face.follows,
		lid_joints = _whole(face.lid_joints), shut_by = face.shut_by, morphs = face.morphs
	}
	var breathes = false
	for each in out.breath:
		breathes = breathes or each.length() > 0
	var seeing = out.eyes[0].joint >= 0 or out.eyes[1].joint >= 0
	var faceless = not seeing and out.face.joints.size() == 0 and face.morphs.size() == 0
	out.empty = not breathes and out.lookers.size() == 0 and out.shoulders.size() == 0 and faceless
	return out


static func _whole(numbers):
	var out = []
	for number in numbers:
		out.append(int(number))
	return out


static func _shapes(channels):
	var out = []
	for channel in channels:
		var shape = []
		for place in range(channel.size()):
			var v = Util.vector(channel[place])
			if v.length() > 0:
				shape.append([place, v])
		out.append(shape)
	return out
