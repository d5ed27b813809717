# Hips, spine and legs that answer the arms, and feet that stay planted: what an export says of them, and what comes of it in a pose.

const Util = preload("util.gd")
const ContactSolve = preload("contact_solve.gd")
const FeetSolve = preload("feet_solve.gd")
const FollowThrough = preload("follow_through.gd")
const PlantedFeet = preload("planted_feet.gd")
const WeightSolve = preload("weight_solve.gd")


# Returns an exported weight rig as it is solved.
static func rig_of(data):
	var parents = _whole(data.parents)
	var legs = []
	for each in data.legs:
		var leg = _whole(each)
		var below = [leg[0]]
		for n in range(leg[0] + 1, parents.size()):
			if below.has(parents[n]):
				below.append(n)
		legs.append(ContactSolve.ContactArm.new(leg[0], leg[1], leg[2], below))
	var bends = []
	for b in data.bends:
		bends.append(WeightSolve.WeightBend.new(int(b.place), b.left, b.up, b.ahead, b.share))
	var collars = []
	for c in data.collars:
		collars.append(WeightSolve.WeightCollar.new(int(c.place), int(c.upper), c.axis, int(c.side)))
	var body = ContactSolve.ContactRig.new(_whole(data.joints), parents, {}, legs, data.hands, [], false, false)
	return WeightSolve.WeightRig.new(body, bends, collars, data.knees, data.levers, data.up, data.height, data.strength)


# Returns what the actions of arms and body weigh, by action; clips: the export's.
static func tracks_of(layers, clips):
	var rows = {}
	for clip in clips:
		rows[clip.id] = clip.arms if clip.arms != null else []
	var out = {}
	for layer in ["arms", "body"]:
		for action in layers[layer].actions.values():
			out[action.id] = FollowThrough.ArmTrack.new(action.clip, rows[action.clip])
	return out


# Returns where the feet of a layer's actions are, by action; layer: it moves the legs; clips: the export's.
static func feet_of(layer, clips):
	var rows = {}
	for clip in clips:
		rows[clip.id] = clip.feet if clip.feet != null else []
	var out = {}
	for action in layer.actions.values():
		out[action.id] = PlantedFeet.FootTrack.new(rows[action.clip])
	return out


static func _whole(numbers):
	var out = []
	for n in numbers:
		out.append(int(n))
	return out


# Returns the times that are looked at for a pose at a time.
static func knots(time):
	var last = FollowThrough.knot_before(time)
	var out = []
	for n in range(last - FollowThrough.KNOTS + 1, last + 1):
		out.append(FollowThrough.knot_time(n))
	return out


# Changes a composed pose so that its feet stay planted and the body answers its arms. playing: for each of `knots`, what plays in arms
# and body: [the layer's plan, its cue with motion or null, the place of its rest or -1]; empty where nothing is answered. legs: the
# same of the layer that moves the legs at that time.
static func answer(graph, playing, legs, time, pose):
	var rig = graph.weight_rig
	var life = graph.life
	var drive = _drive(graph, playing, time)
	var feet = []
	if life.planted_feet > 0:
		feet = PlantedFeet.foot_goals(graph, graph.foot_tracks, rig.height, legs[0], legs[1], legs[2], time)
	if feet.size() == 0 and not WeightSolve.moves_body(drive):
		return
	var local = []
	var moved = []
	for joint in rig.body.joints:
		var q = pose.rotations[joint]
		var v = pose.translations[joint]
		local.append([q.x, q.y, q.z, q.w])
		moved.append([v.x, v.y, v.z])
	var found = ContactSolve.ContactPose.new(local, moved)
	var calm = 1.0 - life.stillness
	var changed = FeetSolve.plant_feet(rig, found, feet, life.planted_feet)
	if drive.size() > 0 and WeightSolve.answer_arms(rig, found, drive, life.follow_through * calm, life.shoulder_lift * calm):
		changed = true
	if not changed:
		return
	for place in range(found.local.size()):
		var q = found.local[place]
		pose.rotations[rig.body.joints[place]] = graph.shim.quat(q[0], q[1], q[2], q[3])
	var hips = rig.bends[0].place
	var v = found.moved[hips]
	pose.translations[rig.body.joints[hips]] = Vector3(v[0], v[1], v[2])


# Returns what of the arms moves the body at a time, nothing where it does not answer them.
static func _drive(graph, playing, time):
	if playing.size() == 0:
		return []
	var rig = graph.weight_rig
	var at = knots(time)
	var driven = []
	for n in range(at.size()):
		var arms = playing[n][0]
		var body = playing[n][1]
		driven.append(
			FollowThrough.arm_sway(
				graph, graph.arm_tracks, rig.body.hands, arms[0], arms[1], arms[2], body[0], body[1], body[2], at[n]
			)
		)
	return FollowThrough.driven(driven, time)


# Whether the bodies of a graph answer their arms.
static func sways(graph):
	var life = graph.life
	return graph.weight_rig.strength > 0 and life.stillness < 1 and (life.follow_through > 0 or life.shoulder_lift > 0)
