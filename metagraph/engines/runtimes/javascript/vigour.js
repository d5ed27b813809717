/** How energetic an action is beside others of its layer and kind, as the export tells it, -1..1. @returns {number} */
export const measureVigour = (project, action) => action.vigour;
