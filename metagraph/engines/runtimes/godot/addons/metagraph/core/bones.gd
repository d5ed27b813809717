# Which bone of an engine's skeleton is which joint. Importers change names: Godot 4 writes `_` for `:` and `/`, Godot 3 small letters.

const KEPT = "abcdefghijklmnopqrstuvwxyz0123456789"


# Returns {joint: bone} for the joints that are among the bones; names that are the same first, else but for case and signs.
static func places(joints, bones):
	var loose = {}
	for n in range(bones.size()):
		loose[_plain(bones[n])] = n
	var out = {}
	for joint in range(joints.size()):
		var bone = bones.find(joints[joint])
		if bone < 0:
			bone = loose.get(_plain(joints[joint]), -1)
		if bone >= 0:
			out[joint] = bone
	return out


static func _plain(name):
	var small = name.to_lower()
	var out = ""
	for n in range(small.length()):
		if KEPT.find(small[n]) >= 0:
			out += small[n]
	return out
