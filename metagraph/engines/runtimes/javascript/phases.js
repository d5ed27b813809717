/** A gesture's phases, as the export tells them. @returns {import("./phase_times.js").Phases} */
export const phases = (project, action) => action.phases;
