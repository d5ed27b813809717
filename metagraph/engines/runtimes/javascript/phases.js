/** A gesture's phases, as the export tells them. @returns {import("./phase_times.js").Phases} */
export const findPhases = (project, action) => action.phases;

/** Return the seconds from an action's start to its stroke. */
export const lead = (project, action) => action.phases.stroke - action.start;

/** Return how long before its stroke any gesture of a layer with these tags begins. */
export function findLongestLead(project, graph, tags) {
  let longest = 0;
  for (const action of graph.actions.values()) {
    if (action.kind === "gesture" && tags.every((tag) => action.tags.includes(tag))) longest = Math.max(longest, lead(project, action));
  }
  return longest;
}
