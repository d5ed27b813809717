"""From requests to poses: planner, composer, player."""
