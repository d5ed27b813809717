"""What researchers use: studies, exhibits, evaluations. Nothing else in the domain imports it."""
