/** How much an action stands out, as the export tells it, 0..1. @returns {number} */
export const measureProminence = (project, action) => action.prominence;
