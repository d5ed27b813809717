# The life layers' dials and what each mode makes of them, see docs/reference/export-rigs.md.

const DIALS = {
	on = true, stillness = 0.0, breathing = 1.0, breath_rate = 14.0, gaze = 1.0, head_share = 0.6, aversion_rate = 12.0,
	aversion_length = 0.93, aversion_angle = 14.0, saccades = 1.0, saccade_rate = 60.0, lids = 1.0, blinks = 17.0, accent_blinks = 0.7,
	blink_close = 0.07, blink_open = 0.10, lips = 1.0, lip_smoothing = 0.03, expressions = 1.0, accent_brows = 0.4,
	valence = 0.0, arousal = 0.0, intensity = 1.0, follow_through = 1.0, shoulder_lift = 1.0, planted_feet = 1.0
}
const FACTORS = {
	breathing = 1.0, breath_rate = 1.0, aversion_rate = 1.0, aversion_length = 1.0, aversion_angle = 1.0, saccades = 1.0,
	saccade_rate = 1.0, blinks = 1.0
}
const MANNERS = {
	idle = {aversion_rate = 1.1, aversion_length = 2.4, aversion_angle = 1.4, saccade_rate = 0.85},
	listening = {aversion_rate = 1.0, aversion_length = 1.5, aversion_angle = 1.1, saccades = 0.9, blinks = 1.45},
	talking = {breathing = 1.15, breath_rate = 1.1, aversion_rate = 1.35, aversion_length = 2.3, aversion_angle = 1.3, blinks = 0.65},
	thinking = {
		breathing = 0.8, aversion_rate = 1.1, aversion_length = 3.8, aversion_angle = 1.3, saccades = 0.7, saccade_rate = 0.6
	},
	reacting = {breathing = 1.2, aversion_rate = 0.2, aversion_angle = 0.6, saccades = 0.7, blinks = 1.6}
}


# Returns all dials from those that an export says; `manners` {mode: factors} among them.
static func life_of(said):
	var out = _over(DIALS, said)
	var own = said.get("modes", {})
	var manners = {}
	for mode in MANNERS:
		manners[mode] = _over(FACTORS, own.get(mode, MANNERS[mode]))
	out.manners = manners
	return out


static func _over(usual, said):
	var out = usual.duplicate()
	for name in said:
		if out.has(name):
			out[name] = said[name]
	return out


# Returns what a mode makes of the amounts.
static func get_manner(life, mode):
	return life.manners[mode]


# Returns what a mode makes of the amounts, each that a mood changes times a factor.
static func scaled(ways, breathing, breath_rate, aversion_rate, saccade_rate, blinks):
	var out = ways.duplicate()
	out.breathing *= breathing
	out.breath_rate *= breath_rate
	out.aversion_rate *= aversion_rate
	out.saccade_rate *= saccade_rate
	out.blinks *= blinks
	return out


# Returns whether two are the same settings.
static func is_same_life(one, other):
	return typeof(one) == typeof(other) and one == other
