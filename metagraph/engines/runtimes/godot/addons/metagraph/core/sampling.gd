# From a meta plan to specific actions: candidates, the three temporal cases, the draw (Borer et al., section 6.2).
#
# Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.

const Repeating = preload("repeating.gd")
const Wanted = preload("wanted.gd")
const MetaPlan = preload("meta_plan.gd")
const Bounds = preload("bounds.gd")
const Choice = preload("choice.gd")
const CueShapes = preload("cue_shapes.gd")
const Director = preload("director.gd")
const Markov = preload("markov.gd")
const Mood = preload("mood.gd")
const Prominence = preload("prominence.gd")
const Remembering = preload("remembering.gd")
const Vigour = preload("vigour.gd")
const PhaseTimes = preload("phase_times.gd")
const Phases = preload("phases.gd")
const Util = preload("util.gd")
const ON_TIME = 0.1  # seconds by which a request may begin later and still be on time
const LOOP_FADE = 0.6  # seconds of crossfade when a long rest changes from one loop of its stance to another


# One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
class SamplingStep:
	var candidates
	var hop

	func _init(candidates_, hop_ = ""):
		self.candidates = candidates_
		self.hop = hop_


# One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
#
# uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun: keys of meta
# actions whose chain of transitions already plays. served: keys of those that the action of another one serves, too. moods: the
# mood over time. candidates: the actions of each `node` that may be drawn, for the nodes needed so far. prominences: of actions,
# as far as needed. acted: when the last action ended. track: what lasts. model: the one that wrote what was not requested, None
# if there is none. beats: seconds after which a gesture that hardly shows may be done again.
class Performer:
	var project
	var graph
	var seed_
	var stance
	var moods
	var track
	var free_
	var acted
	var uses
	var recent
	var ended
	var cues
	var rests
	var reports
	var begun
	var served
	var candidates
	var prominences
	var model
	var beats

	func _init(
		project_,
		graph_,
		seed_,
		stance_,
		moods_,
		track_,
		free_ = 0.0,
		acted_ = 0.0,
		uses_ = null,
		recent_ = null,
		ended_ = null,
		cues_ = null,
		rests_ = null,
		reports_ = null,
		begun_ = null,
		served_ = null,
		candidates_ = null,
		prominences_ = null,
		model_ = null,
		beats_ = Director.LEAST_BEATS
	):
		self.project = project_
		self.graph = graph_
		self.seed_ = seed_
		self.stance = stance_
		self.moods = moods_
		self.track = track_
		self.free_ = free_
		self.acted = acted_
		self.uses = uses_ if uses_ != null else {}
		self.recent = recent_ if recent_ != null else {}
		self.ended = ended_ if ended_ != null else {}
		self.cues = cues_ if cues_ != null else []
		self.rests = rests_ if rests_ != null else []
		self.reports = reports_ if reports_ != null else []
		self.begun = begun_ if begun_ != null else {}
		self.served = served_ if served_ != null else {}
		self.candidates = candidates_ if candidates_ != null else {}
		self.prominences = prominences_ if prominences_ != null else {}
		self.model = model_
		self.beats = beats_

	# Note that a cue is played.
	func note(cue, then):
		self.cues.append(cue)
		self.free_ = cue.end
		self.acted = cue.end
		self.stance = then
		Remembering.remember(cue, self.uses, self.recent, self.ended)

	# The earliest time at which the next action may begin.
	func ready():
		return self.free_ + (self.project.settings.rest if self.ended.size() > 0 else 0.0)

	# Lay the first loop down; return whether the layer can perform at all.
	func begin(stance):
		var loop = self.loop(stance, "rest/%s" % [self.graph.layer])
		if loop == null:
			return false
		self.rests.append(MetaPlan.Rest.new(stance, loop, 0.0, 0.0, 0.0))
		return true

	# Realise in order those meta actions of a conflict-free meta plan that start before `end`.
	func perform(metas, end):
		var performed = []
		for m in metas:
			if not m.written or self._performs(m, m.start):
				performed.append(m)
		for bound in Bounds.bounds(performed):
			var meta = bound.meta
			if Bounds.begins(meta) >= end:
				continue
			if self.served.size() > 0 and self.served.has(meta.key):
				continue
			if meta.request.late != null:
				self._realise(bound, Util.most(self.ready(), Bounds.begins(meta)))
				continue
			var ready = self.ready()
			if meta.start < ready and not self.begun.has(meta.key):
				var running = "the running action"
				if self.cues.size() > 0:
					running = "'%s'" % [self.cues[-1].action.name]
				var waits = ready - meta.start
				if meta.end <= ready + CueShapes.FITS:
					waits = ready - meta.request.start
					# What is wanted for a certain time is over; what is wanted once may come late.
					var wanted = meta.written or meta.request.duration != null
					if wanted or waits > self.project.settings.wait:
						var why = "wholly covered by %s, which plays until %.2f s" % [running, self.free_]
						self._tell(meta, "covered", why)
						continue
				# What a model wrote is wanted at no certain time.
				if not meta.written and waits > ON_TIME:
					self._tell(meta, "queued", "waits %.2f s for %s" % [waits, running], true)
			self._realise(bound, Util.most(ready, meta.start))

	func _realise(bound, now):
		var meta = bound.meta
		var limit = bound.limit
		if meta.written and not self.begun.has(meta.key) and not self._may_begin(meta, now):
			return
		var steps = self._steps(meta, now)
		if steps == null:
			return
		var cues = []
		var stance = self.stance
		for step in steps:
			var hops = step.hop != ""
			var asked = null if hops else CueShapes.remaining(meta, now)
			var mood = self._mood(asked, now)
			var fitting = Util.list(step.candidates)
			if limit < INF:  # else all fit
				var found = []
				for a in step.candidates:
					if CueShapes.fits_before(self._shape(a, asked, now, mood), limit):
						found.append(a)
				fitting = found
			if fitting.size() == 0:
				var before = "" if meta.written else " before something more important"
				self._tell(meta, "no-room", "nothing fits into the %.2f s%s" % [Util.most(0.0, limit - now), before])
				return
			if not hops and meta.request.action == null:
				var warm = []
				for a in fitting:
					if a.cooldown <= 0 or self._cooled(a) <= self._shape(a, asked, now, mood).start + CueShapes.FITS:
						warm.append(a)
				if warm.size() == 0:
					var found2 = []
					for a in fitting:
						found2.append(self._cooled(a))
					var soonest = Util.least_of(found2)
					self._tell(meta, "cooling", "all that fit are cooling down; the first may play again at %.2f s" % [soonest])
					return
				fitting = warm
			# On the way to a stance it counts when that begins.
			if meta.request.late != null and (not hops or (cues.size() == 0 and steps[steps.size() - 1].hop != "")):
				fitting = self._timely(bound, fitting, now)
				if fitting.size() == 0:
					return
			var action = self._draw(fitting, "%s/%s" % [meta.key, step.hop] if hops else meta.key, now, mood)
			var shape = self._shape(action, asked, now, mood)
			var cue = self._cue(action, shape, bound, hops, stance, mood)
			cues.append(cue)
			now = cue.end
			stance = cue.then
		for one in cues:
			self._keep(one)

	# Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as mode and
	# mood say. Anything may begin a long thought, or end it.
	func _performs(meta, now):
		if not Mood.stirs(Mood.mood_at(self.moods, now), self.seed_, meta.request.id):
			return false
		if meta.request.kind == "transition" and self.track.stays_at(self.graph.layer, now):
			return false
		if self.model == null or self._muses(now) or self._has_mused(now):
			return true
		return Markov.performs(self.model, self.seed_, meta, Wanted.mode_at(self.track, now))

	# Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an
	# interruption, and nothing that would end a thought.
	func _may_begin(meta, now):
		if self.track.hushed_at(now) or not self._performs(meta, now):
			return false
		if self.model == null or self._leads(now) != "":
			return true
		if self._lulls(now):
			return false
		var there = self.stance == Director.musing(self.graph.stances)
		if there and meta.request.kind == "transition" and self._muses(now):
			return false
		return Markov.performs(self.model, self.seed_, meta, Wanted.mode_at(self.track, now))

	# Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are rare
	# anyway.
	func _lulls(now):
		var variety = self.project.settings.variety
		if self.graph.layer != "arms" or variety <= 0 or self.cues.size() == 0 or self._has_mused(now):
			return false
		var last = self.cues[-1]
		var mode = Wanted.mode_at(self.track, now)
		if now >= last.end + Director.MOST_LULL or mode == "thinking":
			return false
		var talks = mode == "talking"
		if talks and last.action.kind == "transition":  # it opens a burst
			return false
		return now < last.end + Director.find_lull(self.seed_, last.meta, talks, variety)

	# Return whether the arms take or keep the stance in which the character thinks.
	func _muses(now):
		if (Wanted.mode_at(self.track, now) != "thinking" or Wanted.mode_at(self.track, now + Director.MUSES) != "thinking"):
			return false
		if self.graph.layer != "arms" or self.project.settings.variety <= 0:
			return false
		return not self.track.stays_at("arms", now) and Director.musing(self.graph.stances) != ""

	# Return whether a thought of the character has ended just now.
	func _has_mused(now):
		if self.graph.layer != "arms" or Wanted.mode_at(self.track, now) == "thinking":
			return false
		return self.project.settings.variety > 0 and Wanted.mode_at(self.track, now - Director.MUSED) == "thinking"

	# Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there home as
	# soon as the thought is over; "" for none.
	func _leads(now):
		if self.graph.layer != "arms" or self.project.settings.variety <= 0:
			return ""
		var muses = Director.musing(self.graph.stances)
		if muses == "" or self.track.stays_at("arms", now):
			return ""
		var home = self.graph.start
		var goal = ""
		if self._muses(now):
			goal = muses
		elif self.stance == muses and home != null and Wanted.mode_at(self.track, now) != "thinking":
			var came = self._moved()
			if came >= 0 and Wanted.mode_at(self.track, came) == "thinking":
				goal = home
		if goal == self.stance or goal == "" or self._chain(goal).size() == 0:
			return ""
		return goal

	# Return the candidates that come least late, if that is not too late; among them those that leave the following requests the
	# most time and serve the most of them.
	func _timely(bound, fitting, now):
		var meta = bound.meta
		var request = meta.request
		var allowed = CueShapes.slack_of(request)
		var mood = self._mood(request, now)
		var late = {}
		for a in fitting:
			late[a.id] = CueShapes.lateness(self.project, a, request, self._shape(a, request, now, mood))
		var found = []
		for a in fitting:
			found.append(late[a.id])
		var least = Util.least_of(found)
		var waits
		if least > allowed + CueShapes.FITS:
			waits = self._cause(request, now)
			self._tell(
				meta,
				"too-late",
				"would come %.2f s late, %.2f s are allowed; it waits for %s" % [least, allowed, waits],
				false,
				least
			)
			return []
		if least > CueShapes.FITS:
			waits = self._cause(request, now)
			self._tell(meta, "late", "comes %.2f s late; it waits for %s" % [least, waits], true, least)
		var timely = []
		for a in fitting:
			if late[a.id] <= Util.most(least, 0.0) + CueShapes.FITS:
				timely.append(a)
		for other in bound.after:
			if not CueShapes.may_share(request, other.request):
				continue
			var both = []
			for a in timely:
				if CueShapes.meets(a, other.request):
					both.append(a)
			var behind = 0.0
			if request.stroke != null and other.request.stroke != null:
				behind = Util.most(0.0, request.stroke + Util.most(least, 0.0) - other.request.stroke)
			if both.size() > 0 and other.request.late != null and behind <= other.request.late + CueShapes.FITS:
				timely = both
				Util.add_to(self.served, other.key)
				var message = "shares the stroke of '%s'" % [request.id]
				self._tell(other, "shared", message, true, behind, meta.key)
		var following = []
		for other2 in bound.after:
			if not self.served.has(other2.key):
				following.append(other2)
		for other in following:
			for slack in [0.0, CueShapes.slack_of(other.request)]:
				var by = self._latest(other.request) + slack
				var over = []
				for a in timely:
					if self._over(a, request, now) <= by:
						over.append(a)
				if over.size() > 0:
					return over
		return timely

	# Return the reason why a request comes late.
	func _cause(request, now):
		if now <= request.start + CueShapes.FITS:
			return "its own preparation"
		if (self.cues.size() > 0 and self.ready() >= now - CueShapes.FITS and self.cues[-1].end >= self.free_ - CueShapes.FITS):
			return "'%s', which plays until %.2f s" % [self.cues[-1].action.name, self.free_]
		return "what comes before it" if self.cues.size() > 0 else "the time it became known at"

	# Return the latest time at which a requested action has to begin to be on time; never in the past.
	func _latest(request):
		if request.stroke == null:
			return request.start
		var least = INF
		for action in self.graph.of(self.stance, request.kind):
			var fits = CueShapes.meets(action, request)
			if request.action != null:
				fits = action.id == request.action
			if fits and self._usable(action):
				var found = Phases.find_phases(self.project, action)
				var lead = found.stroke - found.skip(action.timing.blend_in)
				var speed = self._tempo(action, self._mood(request, request.stroke))
				least = Util.least(least, lead + Mood.drag(lead, speed))
		return request.stroke - least

	# Return the earliest time at which the next action could begin after this one.
	func _over(action, request, now):
		var shape = self._shape(action, request, now, self._mood(request, now))
		return shape.start + CueShapes.hurried(self.project, action, shape) + self.project.settings.rest - CueShapes.FITS

	# Return when an action that should play to its end is left early all the same: early enough for the first following request
	# that can then be in time, late enough for its own stroke; infinity for never.
	func _until(action, shape, bound):
		if bound.after.size() == 0:
			return INF
		var rest = self.project.settings.rest
		var soonest = shape.start + CueShapes.hurried(self.project, action, shape)
		for other in bound.after:
			var in_time = self._latest(other.request) + CueShapes.slack_of(other.request)
			if not self.served.has(other.key) and soonest + rest <= in_time + CueShapes.FITS:
				return Util.most(soonest, Bounds.begins(other) - rest)
		return INF

	# Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action that a
	# model wrote, or that is less important, is left at once; others are left where their retraction begins.
	func make_way(running, asked, now, stopped):
		if stopped:
			self.retract(now)
			return
		var cue = self.cues[-1]
		if running == null or cue.action.kind == "transition" or cue.end - cue.blend_out <= now:
			return
		var at_once = now + Util.most(cue.blend_out, CueShapes.RETRACTION)
		var retracts = at_once
		if not running.written:
			var once = cue.end - cue.start
			if cue.repeats:
				once = Util.least(once, (cue.cycle_to - cue.entry) / cue.tempo + Util.most(cue.blend_out, CueShapes.RETRACTION))
			var shape = CueShapes.CueShape.new(
				cue.start,
				cue.entry,
				cue.end - cue.start,
				once,
				cue.hold_from,
				cue.hold_to,
				cue.hold,
				cue.tempo
			)
			retracts = Util.most(at_once, cue.start + CueShapes.hurried(self.project, cue.action, shape))
		var rest = self.project.settings.rest
		for meta in asked:
			var request = meta.request
			var in_time = self._latest(request) + CueShapes.slack_of(request)
			var soonest = at_once if meta.rank > running.rank else retracts
			if request.late == null or meta.rank < running.rank or in_time < soonest + rest - CueShapes.FITS:
				continue
			var end = Util.most(soonest, Bounds.begins(meta) - rest)
			if end < cue.end:
				var out = Util.most(cue.blend_out, CueShapes.RETRACTION)
				var into = Util.least(cue.blend_in, Util.most(0.0, end - out - cue.start))
				self.cues[-1] = MetaPlan.Cue.new(
					cue.action,
					cue.start,
					end,
					cue.entry,
					into,
					out,
					cue.stance,
					cue.then,
					cue.meta,
					cue.hold_from,
					cue.hold_to,
					cue.hold,
					cue.extent,
					cue.tempo,
					cue.cycle_from,
					cue.cycle_to
				)
				self.free_ = end
				self.ended[cue.action.id] = end
			return

	# Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to.
	func retract(now):
		var cue = self.cues[-1]
		var end = now + CueShapes.STOPPED
		if cue.action.kind == "transition" or cue.end - cue.blend_out <= now or cue.end <= end:
			return
		self.cues[-1] = MetaPlan.Cue.new(
			cue.action,
			cue.start,
			end,
			cue.entry,
			cue.blend_in,
			CueShapes.STOPPED,
			cue.stance,
			cue.then,
			cue.meta,
			cue.hold_from,
			cue.hold_to,
			cue.hold,
			cue.extent,
			cue.tempo,
			cue.cycle_from,
			cue.cycle_to
		)
		self.free_ = end
		self.ended[cue.action.id] = end

	# Return the time from which an action may be drawn again.
	func _cooled(action):
		if action.cooldown > 0 and self.ended.has(action.id):
			return self.ended[action.id] + action.cooldown
		return -INF

	# Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not needed, or
	# if the model wrote it and every candidate played too recently.
	func _steps(meta, now):
		var request = meta.request
		var graph = self.graph
		if request.action != null:
			var action = graph.actions.get(request.action)
			if action == null or not graph.stances.has(action.stance):
				self._tell(meta, "unknown-action", "there is no action '%s' in the %s layer" % [request.action, graph.layer])
				return null
			if action.kind == "stance":
				return self._way(meta, action.stance)
			if not self._arrives(action):
				self._tell(meta, "no-stance", "'%s' ends in a stance that has no loop" % [action.name])
				return null
			if action.stance == self.stance:
				return [SamplingStep.new([action])]
			var way = self._way(meta, action.stance)
			return null if way == null else way + [SamplingStep.new([action])]
		if request.stance != null and ["transition", "stance"].has(request.kind):
			if not graph.stances.has(request.stance):
				self._tell(meta, "no-stance", "there is no stance '%s' in the %s layer" % [request.stance, graph.layer])
				return null
			return self._way(meta, request.stance)
		var leads = self._leads(now) if meta.written else ""
		if leads != "":
			return self._way(meta, leads)
		var here = Remembering.node(self.stance, request.kind)
		if not self.candidates.has(here):
			var found2 = []
			for a in graph.of(self.stance, request.kind):
				if self._usable(a):
					found2.append(a)
			self.candidates[here] = found2
		var every = self.candidates[here]
		if request.among.size() > 0:
			var found3 = []
			for a in every:
				if request.among.has(a.id):
					found3.append(a)
			every = found3
		var found = every
		if request.tags.size() > 0:
			var found4 = []
			for a in every:
				var are_all = true
				for tag in request.tags:
					if not a.tags.has(tag):
						are_all = false
						break
				if are_all:
					found4.append(a)
			found = found4
		var exact = found
		if request.limb != null:
			var found5 = []
			for a in found:
				if a.limb == request.limb:
					found5.append(a)
			exact = found5
		var directed = meta.written and self.project.settings.variety > 0
		if directed:  # the model's limb and tags are wishes, not orders
			every = self._fresh(meta, every, now)
			var fresh = {}
			for a in every:
				Util.add_to(fresh, a.id)
			var found6 = []
			for a in found:
				if fresh.has(a.id):
					found6.append(a)
			found = found6
			var found7 = []
			for a in exact:
				if fresh.has(a.id):
					found7.append(a)
			exact = found7
			if every.size() == 0:
				var moves = self._moves_on(meta, now)
				return [SamplingStep.new(moves)] if moves.size() > 0 else null
			if exact.size() == 0:
				exact = found if found.size() > 0 else every
		elif meta.written:  # nor worth playing the same again
			var again = Util.part(self.recent.get(here, []), -1, self.recent.get(here, []).size())
			var is_any = false
			for a in exact:
				if not again.has(a.id):
					is_any = true
					break
			if not is_any:
				var is_any2 = false
				for a in found:
					if not again.has(a.id):
						is_any2 = true
						break
				exact = found if is_any2 else every
		exact = self._modest(meta, exact, now)
		if exact.size() == 0:
			var name = graph.stances[self.stance].name
			var asked = Util.joined(request.tags + [request.kind], " ")
			if request.limb != null:
				asked = "%s %s" % [request.limb, asked]
			if found.size() > 0:  # whose limb is a wish, too
				self._tell(meta, "other-limb", "stance '%s' has no %s; another will do" % [name, asked], true)
				return [SamplingStep.new(found)]
			var hint = "" if meta.written else self._elsewhere(request)
			self._tell(meta, "no-candidate", "stance '%s' has no %s%s" % [name, asked, hint])
			return null
		return [SamplingStep.new(exact)]

	func _elsewhere(request):
		for action in self.graph.actions.values():
			var holds = action.kind == request.kind
			if holds:
				var are_all = true
				for tag in request.tags:
					if not action.tags.has(tag):
						are_all = false
						break
				holds = are_all
			if holds:
				holds = request.limb == null or request.limb == action.limb
			var fits = holds
			if fits and self.graph.stances.has(action.stance):
				return "; there is one in '%s'" % [self.graph.stances[action.stance].name]
		return ""

	# Return the transitions hop by hop from the current stance to `goal`.
	func _way(meta, goal):
		if goal == self.stance:
			var name = self.graph.stances[goal].name
			self._tell(meta, "already-there", "the layer is in '%s' already" % [name], true)
			return null
		var stances = self._chain(goal)
		if stances.size() == 0:
			var a = self.graph.stances[self.stance].name
			var b = self.graph.stances[goal].name
			self._tell(meta, "no-way", "no chain of transitions leads from '%s' to '%s'" % [a, b])
			return null
		var steps = []
		var at = self.stance
		for following in stances:
			var hops = []
			for a2 in self.graph.of(at, "transition"):
				if a2.end_stance == following and self._usable(a2):
					hops.append(a2)
			steps.append(SamplingStep.new(hops, following))
			at = following
		return steps

	# Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if there is
	# no way. Among equally short ways, the one whose transitions were placed first.
	func _chain(goal):
		var before = {self.stance: ""}
		var queue = [self.stance]
		var at = 0  # what is before it was looked at
		while at < queue.size() and not before.has(goal):
			var stance = queue[at]
			at += 1
			for action in self.graph.of(stance, "transition"):
				var end = action.end_stance
				if end == null or before.has(end) or not self.graph.stances.has(end):
					continue
				if self._usable(action):
					before[end] = stance
					queue.append(end)
		var way = []
		if not before.has(goal):
			return way
		var step = goal
		while step != self.stance:
			way.append(step)
			step = before[step]
		return Util.list(Util.backwards(way))

	# Return whether an action leaves the layer in a stance that has a loop.
	func _arrives(action):
		var end = action.end_stance
		if action.kind != "transition":
			return true
		return end != null and self.graph.stances.has(end) and self.graph.of(end, "stance").size() > 0

	func _usable(action):
		return action.likelihood > 0 and self._arrives(action)

	# Return how an action would play for a request from `now` on, or as a step on the way to it.
	func _shape(action, request, now, mood):
		return CueShapes.shape_of(self.project, action, request, now, self._tempo(action, mood))

	# Return the mood in which a request is played from `at` on, or at its stroke.
	func _mood(request, at):
		if request == null:
			return Mood.mood_at(self.moods, at)
		var mood = Mood.mood_at(self.moods, at if request.stroke == null else request.stroke)
		if request.valence == null and request.arousal == null and request.intensity == null:
			return mood
		return Mood.changed(mood, request.valence, request.arousal, request.intensity)

	# Return the speed of an action in a mood, 1 if it was made for the mood.
	func _tempo(action, mood):
		return 1.0 if (mood.neutral or Mood.made_for(mood, action.tags)) else Mood.tempo(mood)

	# Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or were made
	# for the mood keep their extent.
	func _extent(action, mood):
		if self.graph.layer == "body" or action.kind == "transition" or mood.neutral:
			return 1.0
		return 1.0 if (action.contacts.size() > 0 or action.tags.has(Mood.HELD) or Mood.made_for(mood, action.tags)) else Mood.extent(
			mood
		)

	# Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are left out as
	# long as others are left.
	func _draw(candidates, key, now, mood):
		var left = self._spaced(candidates)
		if left.size() == 1:
			return left[0]
		var neutral = mood.neutral
		var weights = {}
		for a in left:
			var favoured = 1.0 if neutral else Mood.favour(mood, a.tags, Vigour.measure_vigour(self.project, a))
			var weight = a.likelihood / Util.most(self._count(a.id, now), 1.0) * favoured
			weights[a.id] = weight * self._variety(a, now)
		var is_any = false
		for w in weights.values():
			if w > 0:
				is_any = true
				break
		if not is_any:
			return left[0]
		var chosen = Choice.pick(self.seed_, key, "action", weights)
		var first = null
		for a2 in left:
			if a2.id == chosen:
				first = a2
				break
		return first

	# Return the factor by which variety changes an action's likelihood.
	func _variety(action, now):
		var variety = self.project.settings.variety
		if variety <= 0:
			return 1.0
		if action.kind == "transition":
			var talks = self.graph.layer == "arms" and Wanted.mode_at(self.track, now) == "talking"
			return 1.0 + self._count_fresh(action.end_stance, now) if talks else 1.0
		if not self.ended.has(action.id):
			return 1.0
		var shows = self._shows(action)
		var needed = Director.repeat_interval(action.kind, shows, self.beats) * variety
		return Director.freshness(now - self.ended[action.id], needed)

	# Return how much an action stands out.
	func _shows(action):
		if not self.prominences.has(action.id):
			self.prominences[action.id] = Prominence.measure_prominence(self.project, action)
		return self.prominences[action.id]

	# Return the actions that the character may do by itself; see `director`.
	func _fresh(meta, candidates, now):
		var variety = self.project.settings.variety
		var layer = self.graph.layer
		if meta.request.kind == "transition":
			if now < self._moved() + Director.posture(layer) * variety:
				return []
			if layer == "arms" and now < self.acted + Director.LEAST_LULL * variety:
				return []
			if layer != "head":
				return Util.list(candidates)
			if self.stance == self.graph.start:
				var leaves = Choice.uniform(self.seed_, [meta.key, "leaves"]) < Director.LEAVES_HOME
				return Util.list(candidates) if leaves else []
			var home = []
			for a in candidates:
				if a.end_stance == self.graph.start:
					home.append(a)
			var returns = home.size() > 0 and Choice.uniform(self.seed_, [meta.key, "home"]) < Director.GOES_HOME
			return home if returns else Util.list(candidates)
		var share = variety if now < self.acted + Director.LONG_REST * variety else variety * Director.SHORTER
		var reminded = self._shown(now - Director.APART * variety)
		var converses = meta.request.kind == "fidget" and Wanted.mode_at(self.track, now) != "idle"
		var out = []
		for action in candidates:
			var shows = self._shows(action)
			if (reminded or converses) and shows >= Director.STANDS_OUT:
				continue
			var needed = Director.repeat_interval(action.kind, shows, self.beats) * share
			if not self.ended.has(action.id) or now >= self.ended[action.id] + needed:
				out.append(action)
		return out

	# Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and no tags
	# are requested; else all.
	func _modest(meta, candidates, now):
		var request = meta.request
		var every = Util.list(candidates)
		if request.kind != "fidget" or request.tags.size() > 0 or self.project.settings.variety <= 0:
			return every
		if meta.written or Wanted.mode_at(self.track, now) == "idle":
			return every
		var left = []
		for a in every:
			if self._shows(a) < Director.STANDS_OUT:
				left.append(a)
		return left if left.size() > 0 else every

	# Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too recently,
	# and others of another stance have not.
	func _moves_on(meta, now):
		var out = []
		if self.graph.layer != "arms" or meta.request.kind != "gesture" or self.track.stays_at("arms", now):
			return out
		var variety = self.project.settings.variety
		if now < self._moved() + Director.posture("arms") * variety or now < self.acted + Director.LEAST_LULL * variety:
			return out
		for action in self.graph.of(self.stance, "transition"):
			if self._usable(action) and self._count_fresh(action.end_stance, now) > 0:
				out.append(action)
		return out

	# Return how many gestures of a stance have not played for long enough.
	func _count_fresh(stance, now):
		if stance == null:
			return 0
		var variety = self.project.settings.variety
		var count = self.graph.of(stance, "gesture").size()
		for ident in self.ended:
			var end = self.ended[ident]
			var action = self.graph.actions.get(ident)
			if action == null or action.kind != "gesture" or action.stance != stance:
				continue
			var shows = self._shows(action)
			if now < end + Director.repeat_interval("gesture", shows, self.beats) * variety:
				count -= 1
		return count

	# Return when the stance was last changed; minus infinity for never.
	func _moved():
		var latest = -INF
		for ident in self.ended:
			var end = self.ended[ident]
			var action = self.graph.actions.get(ident)
			if action != null and action.kind == "transition":
				latest = Util.most(latest, end)
		return latest

	# Return whether an act that stands out was done since a time.
	func _shown(since):
		for ident in self.ended:
			var end = self.ended[ident]
			var action = self.graph.actions.get(ident)
			if action == null or action.kind == "transition" or end < since:
				continue
			if self._shows(action) >= Director.STANDS_OUT:
				return true
		return false

	# Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so on.
	func _spaced(candidates):
		var default = 1 if self.project.settings.never_twice else 0
		var first = candidates[0]
		var before = self.recent.get(Remembering.node(first.stance, first.kind), [])
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
	func _count(ident, now):
		var memory = self.project.settings.memory
		var alpha = self.project.settings.alpha
		if memory <= 0:
			return alpha * self.uses.get(ident, 0)
		var used = 0
		for cue in Util.backwards(self.cues):
			if cue.start < now - memory:
				break
			if cue.action.id == ident:
				used += 1
		return alpha * used

	# hops: whether it is a transition on the way to the requested action.
	func _cue(action, shape, bound, hops, stance, mood):
		var length = shape.length
		var into = Util.most(0.0, action.timing.blend_in)
		var out = Util.most(0.0, action.timing.blend_out)
		var both = self.project.span(action)
		var begin = both[0]
		var until = both[1]
		var cycle = Repeating.cycle_of(action.kind, action.timing, begin, until)
		if action.timing.earliest_exit != null or cycle > 0:
			var wish = INF if hops else bound.wish
			length = Util.least(length, Util.most(shape.shortest, Util.least(bound.limit, wish) - shape.start))
		elif not hops:
			length = Util.least(length, self._until(action, shape, bound) - shape.start)
			if length < shape.length:
				out = Util.most(out, CueShapes.RETRACTION)
		if shape.entry > begin:
			into = Util.most(into, PhaseTimes.LEAST_BLEND)
		var squeeze = Util.least(1.0, length / (into + out)) if into + out > 0 else 1.0
		var then = stance
		if action.kind == "transition" and action.end_stance != null:
			then = action.end_stance
		var end = shape.start + length
		return MetaPlan.Cue.new(
			action,
			shape.start,
			end,
			shape.entry,
			into * squeeze,
			out * squeeze,
			stance,
			then,
			bound.meta.key,
			shape.hold_from,
			shape.hold_to,
			shape.hold,
			self._extent(action, mood),
			shape.tempo,
			begin if cycle > 0 else 0.0,
			begin + cycle if cycle > 0 else 0.0
		)

	func _keep(cue):
		self.note(cue, cue.then)
		var loop = self.loop(cue.then, cue.meta)
		if loop != null:
			# The loop begins again under the action, so that the action's last pose meets the loop's first.
			# On joints that the action does not move, the change shows. It takes its time there, like a
			# transition.
			var partial = cue.action.limb != "both" or cue.action.joints.size() > 0 or cue.action.joint_weights.size() > 0
			var begin = cue.start + cue.blend_in
			var until = cue.end - cue.blend_out
			var fade = Util.most(0.0, until - begin)
			if partial:
				fade = cue.end - cue.start if cue.then != cue.stance else Util.least(LOOP_FADE, cue.end - cue.start)
				begin = Util.most(cue.start, until - fade)
			self.rests.append(MetaPlan.Rest.new(cue.then, loop, until, begin, fade))

	# Return one of a stance's loops, drawn by likelihood; None if it has none.
	func loop(stance, key):
		var loops = self.graph.of(stance, "stance")
		if loops.size() == 1:
			return loops[0]
		var weights = {}
		for a in loops:
			if a.likelihood > 0:
				weights[a.id] = a.likelihood
		if weights.size() == 0:
			return loops[0] if loops.size() > 0 else null
		var chosen = Choice.pick(self.seed_, key, "loop", weights)
		var first = null
		for a in loops:
			if a.id == chosen:
				first = a
				break
		return first

	# Change between the loops of a stance in long rests, at the end of a loop.
	func vary_rests(end):
		var out = []
		for place in range(self.rests.size()):
			var rest = self.rests[place]
			out.append(rest)
			var loops = self.graph.of(rest.stance, "stance")
			if loops.size() < 2:
				continue
			var until = self.rests[place + 1].fade_start if place + 1 < self.rests.size() else end
			var current = rest
			var change = rest.start
			while true:
				var both = self.project.span(current.action)
				var start = both[0]
				var stop = both[1]
				change += Util.most(1.0, stop - start - current.action.timing.blend_in)
				if not (change <= until):  # nor when it is no number
					break
				var loop = self.loop(rest.stance, "%s/%s" % [self.graph.layer, Util.thousandths(change)])
				if loop != null and loop.id != current.action.id:
					current = MetaPlan.Rest.new(rest.stance, loop, change, change - LOOP_FADE, LOOP_FADE)
					out.append(current)
		self.rests = out

	func _tell(meta, outcome, message, played = false, late = 0.0, by = ""):
		var layer = self.graph.layer
		self.reports.append(MetaPlan.Report.new(
			meta.request.id,
			outcome,
			message,
			layer,
			meta.start,
			played,
			meta.written,
			late,
			by
		))


# Return the performer as it is after a past and the cues that played since.
static func performer_after(project, graph, seed_, begin, past, cues, moods, track):
	var stance = past.stance if graph.stances.has(past.stance) else begin
	var out = Performer.new(
		project,
		graph,
		seed_,
		stance,
		moods,
		track,
		past.free_,
		past.free_,
		past.uses.duplicate(),
		past.recent.duplicate(),
		past.ended.duplicate()
	)
	var found = []
	for a in graph.actions.values():
		if a.kind == "gesture":
			found.append(a)
	out.beats = Director.beat_interval(graph.layer, found.size())
	for cue in cues:
		out.note(cue, cue.then if graph.stances.has(cue.then) else begin)
	return out
