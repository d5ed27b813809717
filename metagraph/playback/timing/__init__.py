"""When an action prepares, strikes and retracts, and how its timing is edited."""
