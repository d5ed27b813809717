# How much an action stands out, as the export tells it.


# Returns it, from 0 for hardly to 1 for much.
static func measure_prominence(_project, action):
	return action.prominence
