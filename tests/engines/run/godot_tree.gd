# Plays an AnimationTree in Godot 3 on what the importer would make of a GLB: a skeleton and an AnimationPlayer with a track for each
# bone. Its one argument is a JSON file: {glb, tree, layers, bones: joint -> bone, loops, play: animations to read, steps}; a step
# is {travel: layer -> state, seconds} or {ways: [[layer, from, to]]}. Prints a JSON a step.
extends SceneTree

const Glb = preload("res://addons/metagraph/core/glb.gd")
const Shim = preload("res://addons/metagraph/core/shim3.gd")
const STEP = 1.0 / 60

var order
var glb
var tree
var skeleton = Skeleton.new()


func _init():
	order = Shim.parse(Shim.text_of(Shim.read_bytes(OS.get_cmdline_args()[-1])))
	glb = Glb.new(Shim.read_bytes(order.glb), Shim)
	var scene = Spatial.new()
	root.add_child(scene)
	skeleton.name = "Skeleton"
	scene.add_child(skeleton)
	build()
	var player = AnimationPlayer.new()
	player.name = "AnimationPlayer"
	scene.add_child(player)
	for animation in glb.animations:
		player.add_animation(animation.name, made(animation))
	tree = AnimationTree.new()
	scene.add_child(tree)
	tree.tree_root = load(order.tree)
	tree.anim_player = tree.get_path_to(player)
	tree.process_mode = AnimationTree.ANIMATION_PROCESS_MANUAL
	for layer in order.layers:
		tree.set("parameters/add_" + layer + "/add_amount", 1.0)
	tree.active = true
	tree.advance(0)  # the first goes to the start whatever is asked
	for step in order.steps:
		print(to_json(ways(step.ways) if step.has("ways") else played(step)))
	quit()


func playback(layer):
	return tree.get("parameters/" + layer + "/playback")


func played(step):
	for layer in step.get("travel", {}):
		playback(layer).travel(step.travel[layer])
	for _n in range(int(round(step.seconds / STEP))):
		tree.advance(STEP)
	var out = {states = {}, joints = {}}
	for layer in order.layers:
		out.states[layer] = playback(layer).get_current_node()
	for joint in order.bones:
		var pose = skeleton.get_bone_global_pose(skeleton.find_bone(order.bones[joint]))
		var turn = pose.basis.get_rotation_quat()
		out.joints[joint] = {
			position = [pose.origin.x, pose.origin.y, pose.origin.z], rotation = [turn.x, turn.y, turn.z, turn.w]
		}
	return out


# Returns for each way the states it leads over; a first one may already be under way.
func ways(asked):
	var out = []
	for way in asked:
		var now = playback(way[0])
		now.start(way[1])
		tree.advance(0)
		now.travel(way[2])
		tree.advance(0)
		var path = Array(now.get_travel_path())
		out.append(path if now.get_current_node() == way[1] else [now.get_current_node()] + path)
	return {ways = out}


func build():
	for node in glb.nodes:
		if order.bones.has(node.name):
			skeleton.add_bone(order.bones[node.name])
			var pose = Transform(Basis(quat(node.rotation)), vector(node.translation))
			skeleton.set_bone_rest(skeleton.get_bone_count() - 1, pose)
	for node in glb.nodes:
		for child in node.get("children", []):
			var bone = skeleton.find_bone(order.bones[glb.nodes[child].name])
			skeleton.set_bone_parent(bone, skeleton.find_bone(order.bones[node.name]))


# Returns an animation, without tracks where it is not to be played.
func made(animation):
	var out = Animation.new()
	out.loop = animation.name in order.loops
	var joints = {}
	for channel in animation.channels:
		var times = glb.numbers(channel.times)
		out.length = max(out.length if joints.size() > 0 else 0.01, times[-1])
		if not joints.has(channel.node):
			joints[channel.node] = {}
		joints[channel.node][channel.path] = channel
	if animation.name in order.play:
		for node in joints:
			if order.bones.has(glb.nodes[node].name):
				track(out, node, joints[node])
	return out


# Adds a bone's track, relative to its rest as the importer writes it: a key wherever one of its channels has one.
func track(out, node, channels):
	var bone = order.bones[glb.nodes[node].name]
	var rest = skeleton.get_bone_rest(skeleton.find_bone(bone))
	var place = out.add_track(Animation.TYPE_TRANSFORM)
	out.track_set_path(place, NodePath("Skeleton:" + bone))
	var times = {}
	for path in channels:
		for time in glb.numbers(channels[path].times):
			times[time] = true
	for time in times:
		var turn = Quat(rest.basis)
		var shift = rest.origin
		if channels.has("rotation"):
			var at = between(channels.rotation, time, 4)
			turn = quat(at[0]).slerp(quat(at[1]), at[2])
		if channels.has("translation"):
			var at = between(channels.translation, time, 3)
			shift = vector(at[0]).linear_interpolate(vector(at[1]), at[2])
		var pose = rest.affine_inverse() * Transform(Basis(turn), shift)
		out.transform_track_insert_key(place, time, pose.origin, Quat(pose.basis), Vector3(1, 1, 1))


# Returns the rows before and after a time, and how far it is between them.
func between(channel, time, width):
	var times = glb.numbers(channel.times)
	var after = min(times.bsearch(time), times.size() - 1)
	var before = max(after - 1, 0)
	var view = glb.view(channel.rows)
	var span = times[after] - times[before]
	var part = 1.0 if span <= 0 else clamp((time - times[before]) / span, 0.0, 1.0)
	return [glb.row(view, before, width), glb.row(view, after, width), part]


func quat(row):
	return Quat(row[0], row[1], row[2], row[3]).normalized()


func vector(row):
	return Vector3(row[0], row[1], row[2])
