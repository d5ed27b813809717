"""What participants achieved, and what their time went into."""
