# One layer: its stances and actions by id, in the order they were placed, and how it reaches the joints.

const Remembering = preload("remembering.gd")
const NOTHING = []

var layer
var start  # id of a stance, or null
var stances = {}  # id -> stance
var actions = {}  # id -> action
var kinds = {}  # kind -> true
var markov
var reach = []  # [joint, weight] of those it moves
var strength = 0.0  # how much of the arms it moves, 0..1
var _index = {}  # kind and stance -> actions


func _init(own_layer, own_start):
	layer = own_layer
	start = own_start


# Places an action.
func add(action):
	actions[action.id] = action
	kinds[action.kind] = true
	var node = Remembering.node(action.stance, action.kind)
	if not _index.has(node):
		_index[node] = []
	_index[node].append(action)


# Returns the actions of a kind placed on a stance.
func of(stance, kind):
	return _index.get(Remembering.node(stance, kind), NOTHING)
