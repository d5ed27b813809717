# The draw of one action among the candidates that did not play too recently (Borer et al., section 6.2).
#
# Translated from metagraph/playback/planning/drawing.py; change that, and translate anew.

const Choice = preload("choice.gd")
const Directing = preload("directing.gd")
const Mood = preload("mood.gd")
const Remembering = preload("remembering.gd")
const Vigour = preload("vigour.gd")
const Util = preload("util.gd")


# Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are left out as
# long as others are left.
static func draw_action(state, candidates, key, now, mood):
	var left = keep_spaced(state, candidates)
	if left.size() == 1:
		return left[0]
	var neutral = mood.neutral
	var weights = {}
	for a in left:
		var favoured = 1.0 if neutral else Mood.favour(mood, a.tags, Vigour.measure_vigour(state.project, a))
		var weight = a.likelihood / Util.most(count_uses(state, a.id, now), 1.0) * favoured
		weights[a.id] = weight * Directing.weigh_variety(state, a, now)
	var is_any = false
	for w in weights.values():
		if w > 0:
			is_any = true
			break
	if not is_any:
		return left[0]
	var chosen = Choice.pick(state.seed_, key, "action", weights)
	var first = null
	for a2 in left:
		if a2.id == chosen:
			first = a2
			break
	return first


# Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so on.
static func keep_spaced(state, candidates):
	var default = 1 if state.project.settings.never_twice else 0
	var first = candidates[0]
	var before = state.recent.get(Remembering.node(first.stance, first.kind), [])
	if candidates.size() < 2 or before.size() == 0:
		return candidates
	var needs = {}
	for a in candidates:
		needs[a.id] = default if a.spacing == null else a.spacing
	var found = []
	for a in candidates:
		found.append(needs[a.id])
	for less in range(Util.most_of(found) + 1):
		var left = []
		for a in candidates:
			if Remembering.rested(before, a.id, needs[a.id] - less):
				left.append(a)
		if left.size() > 0:
			return left
	return candidates


# Return c_k of section 6.2, alpha times the uses, over the settings' memory.
static func count_uses(state, ident, now):
	var memory = state.project.settings.memory
	var alpha = state.project.settings.alpha
	if memory <= 0:
		return alpha * state.uses.get(ident, 0)
	var used = 0
	for cue in Util.backwards(state.cues):
		if cue.start < now - memory:
			break
		if cue.action.id == ident:
			used += 1
	return alpha * used


# Return the time from which an action may be drawn again.
static func find_cooled(state, action):
	if action.cooldown > 0 and state.ended.has(action.id):
		return state.ended[action.id] + action.cooldown
	return -INF
