# How energetic an action is, as the export tells it.


# Returns it beside others of its layer and kind, -1..1.
static func measure_vigour(_project, action):
	return action.vigour
